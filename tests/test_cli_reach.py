"""The commands `reach` and `validate`: output, files, exit status, one-line errors."""

from __future__ import annotations

import json
import subprocess
import sys
import tracemalloc
from zipfile import ZipFile

import numpy as np
import pytest
from test_cli import run as run_alone

from zygopin import Foot, ParameterError, finger_reach, forward_kinematics, to_urdf
from zygopin.reach_output import write_arrays

FIGURE = ("reach", "--preset", "paper", "--finger", "3", "--omega-deg", "15,30")
SMALL = (*FIGURE, "--levels", "5")


def test_validate_passes_and_says_what_it_took():
    result = run_alone("validate", "--preset", "paper")
    assert result.returncode == 0, result.stdout
    assert result.stderr == ""
    lines = result.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert lines[-1] == "16 of 16 rows keep to their bounds"
    assert sum("38416" in line for line in lines) == 2


def test_validate_prints_one_json_document(run):
    result = run("validate", "--preset", "owl", "--levels", "4", "--json")
    assert result.returncode == 0
    document = json.loads(result.stdout)
    assert document["ok"]
    assert Foot.from_mapping(document["foot"]) == Foot.preset("owl")
    assert len(document["rows"]) == 18
    assert [row["pose"] for row in document["rows"]] == (
        [None] * 12 + ["zygodactyl"] * 4 + ["spread"] * 2
    )
    assert {row["finger"] for row in document["rows"][12:]} == {"finger4"}
    assert {row["check"] for row in document["rows"]} == {
        "grid",
        "words",
        "random",
        "limit",
    }
    for row in document["rows"]:
        assert row["ok"]
        assert row["levels"] == (3 if row["check"] == "limit" else 4)


def test_the_table_of_the_owl_names_the_spread_pose_within_80_columns(run):
    lines = run("validate", "--preset", "owl", "--levels", "4").stdout.splitlines()
    assert max(map(len, lines)) <= 80
    spread = [line.split()[:3] for line in lines if "spread" in line]
    assert spread == [["finger4", "spread", "grid"], ["finger4", "spread", "words"]]
    assert lines[-1] == "18 of 18 rows keep to their bounds"


def test_a_wrong_angle_in_a_urdf_fails_with_status_1(run, tmp_path):
    foot = Foot.preset("parrot")
    file = tmp_path / "foot.urdf"
    file.write_text(to_urdf(foot.replace(omega=0.999 * foot.omega)), encoding="utf-8")
    result = run("validate", "--urdf", str(file), "--levels", "3")
    assert result.returncode == 1
    assert "NO" in result.stdout
    assert "16 of 16" not in result.stdout


def test_reach_reproduces_the_reference_values(run):
    result = run(*FIGURE, "--json")
    assert result.returncode == 0
    document = json.loads(result.stdout)
    wide = document["sets"][1]
    assert wide["points"] == 1_185_921
    assert wide["x"] == pytest.approx([0.653267, 1.381966], abs=1e-6)
    assert wide["z"] == pytest.approx([-1.021775, 0], abs=1e-6)
    assert wide["depth_bound"] == pytest.approx(0.236068, abs=1e-6)
    assert wide["hull_area"] == pytest.approx(0.226553, abs=1e-6)
    assert wide["hull"] is None
    assert document["sets"][0]["omega"] == pytest.approx(np.pi / 12)
    assert document["finger"] == "finger3"
    assert len(document["levels"]) == 33


def test_reach_writes_every_file_and_prints_where(run, tmp_path):
    kinds = {"png": "a.png", "html": "b.html", "npz": "c.npz"}
    kinds |= {"convergence": "d.png", "dimension": "e.png"}
    options = [f"--{kind}={tmp_path / name}" for kind, name in kinds.items()]
    result = run(*SMALL, *options)
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    lines = result.stdout.splitlines()
    assert max(len(line) for line in lines if str(tmp_path) not in line) <= 80
    for name in kinds.values():
        assert f": {tmp_path / name}" in result.stdout
        assert (tmp_path / name).stat().st_size > 1000
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_arrays_hold_points_levels_and_bounds(run, tmp_path):
    file = tmp_path / "a.npz"
    assert run(*SMALL, "--npz", str(file)).returncode == 0
    again = tmp_path / "b.npz"
    run(*SMALL, "--npz", str(again))
    assert file.read_bytes() == again.read_bytes()
    with np.load(file) as arrays:
        assert arrays["points"].shape == (2, 5**4)
        index = 5**3 * 1 + 5**2 * 4 + 5 * 0 + 2
        word = arrays["levels"][[1, 4, 0, 2]]
        controls = np.zeros(14)
        controls[5:9] = word
        foot = Foot.preset("paper").replace(omega=float(arrays["omega"][1]))
        tip = forward_kinematics(foot, controls)[8, 1]
        turned = np.exp(1j * arrays["azimuth"]) * arrays["points"][1, index].real
        place = [turned.real, turned.imag, arrays["points"][1, index].imag]
        np.testing.assert_allclose(tip, place, atol=1e-14)
        assert arrays["depth_bound"] == pytest.approx([0.236068] * 2, abs=1e-6)


def two_sets(first=9, second=9):
    """The sets of one finger at two joint limits, each of some levels."""
    return [
        finger_reach(Foot(omega=0.3), "finger3", first),
        finger_reach(Foot(omega=0.5), "finger3", second),
    ]


def test_an_archive_is_what_numpy_reads_and_holds_no_time(tmp_path):
    sets = two_sets()
    path = write_arrays(sets, tmp_path / "a.npz")
    with np.load(path, allow_pickle=False) as arrays:
        np.testing.assert_array_equal(arrays["points"], [s.points for s in sets])
        assert arrays["points"].dtype == complex
        assert arrays["omega"].tolist() == [0.3, 0.5]
        assert arrays["depth"] == 4
        assert arrays["scale"].shape == ()
    with ZipFile(path) as archive:
        assert archive.testzip() is None
        assert {member.date_time[0] for member in archive.infolist()} == {1980}


def test_writing_an_archive_takes_the_memory_of_one_set(tmp_path):
    sets = two_sets(25, 25)
    tracemalloc.start()
    try:
        write_arrays(sets, tmp_path / "a.npz")
        _, peak = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    assert peak < 1.3 * sets[0].points.nbytes


def test_sets_of_different_sizes_make_no_archive(tmp_path):
    with pytest.raises(ParameterError, match=r"points of the sets = \[16, 81\] is not"):
        write_arrays(two_sets(2, 3), tmp_path / "a.npz")
    assert not list(tmp_path.iterdir())


def test_vertices_of_the_hull_come_with_their_words(run):
    found = json.loads(run(*SMALL, "--hull", "--json").stdout)["sets"][1]["hull"]
    foot = Foot.preset("paper")
    for vertex in found:
        controls = np.zeros(14)
        controls[5:9] = vertex["controls"]
        tip = forward_kinematics(foot, controls)[8, 1]
        assert np.hypot(*tip[:2]) == pytest.approx(abs(vertex["x"]), abs=1e-12)
        assert tip[2] == pytest.approx(vertex["z"], abs=1e-12)


def test_fingers_have_names_too(run):
    options = ("--preset", "anisodactyl", "--finger", "hallux", "--depth", "3")
    document = json.loads(run("reach", *options, "--levels", "4", "--json").stdout)
    assert document["finger"] == "hallux"
    assert document["sets"][0]["points"] == 64


def test_long_fingers_get_fewer_levels(run):
    document = json.loads(run("reach", "--finger", "4", "--json").stdout)
    assert len(document["levels"]) == 18


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("reach", "--finger", "5"), "finger = 5 is not an integer from 1 to 4"),
        (("reach", "--finger", "fingr1"), "did you mean 'finger1'?"),
        (("reach", "--levels", "1"), "'--levels': 1 is not in the range"),
        (("reach", "--depth", "0"), "'--depth': 0 is not in the range"),
        (("reach", "--omega-deg", "15,"), "'' is not a number of degrees"),
        (("reach", "--omega-deg", "15,180"), "--omega-deg = 180 is not in (0, 360)"),
        (("reach", "--levels", "3000"), "bytes"),
        (("reach", "--preset", "crow"), "unknown preset 'crow'"),
        ((*SMALL, "--png", "/dev/null/a.png"), "cannot be written"),
        ((*SMALL, "--npz", "/dev/null/a.npz"), "cannot be written"),
        (("reach", "--html", "/dev/null/a.html", "--levels", "2"), "cannot be written"),
        (("validate", "--levels", "1"), "'--levels': 1 is not in the range"),
        (("validate", "--rho", "1"), "--rho = 1 is not a number above 1"),
        (("validate", "--urdf", "none.urdf"), "none.urdf: cannot be read: No such"),
        (("validate", "--urdf", __file__), "the URDF is not XML"),
    ],
)
def test_bad_input_is_one_line_and_status_2(run, arguments, words):
    result = run(*arguments)
    assert result.returncode == 2
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert result.stderr.startswith("zygopin: ")
    assert words in result.stderr


def test_without_matplotlib_the_extra_is_named_in_one_line(tmp_path):
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "from zygopin.cli import main\n"
        f"main({[*SMALL, '--png', str(tmp_path / 'a.png')]!r})\n"
    )
    command = [sys.executable, "-c", code]
    result = subprocess.run(command, capture_output=True, text=True, check=False)
    assert result.returncode == 2
    assert result.stderr.splitlines() == [
        "zygopin: matplotlib is not installed: pip install 'zygopin[plots]' adds it"
    ]
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("command", ["reach", "validate"])
def test_help_fits(command):
    result = run_alone(command, "--help")
    assert result.returncode == 0
    assert max(map(len, result.stdout.splitlines())) <= 80
