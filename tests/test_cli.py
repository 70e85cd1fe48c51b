"""The command line, run as users run it: output, JSON, exit status, one-line errors."""

from __future__ import annotations

import json
import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from zygopin import Foot

GRASP = ("perch", "--radius-mm", "8")
ZEROS = ",".join("0" * 14)
NO_CONTACT = ("check", "--radius-mm", "8", "--height-mm=-20", "--controls", ZEROS)


def run(*arguments: str, cwd: Path | None = None) -> subprocess.CompletedProcess[str]:
    command = [sys.executable, "-m", "zygopin", *arguments]
    environment = {**os.environ, "COLUMNS": "80"}
    return subprocess.run(
        command, capture_output=True, text=True, check=False, cwd=cwd, env=environment
    )


@pytest.fixture(scope="module")
def perch_document() -> dict:
    result = run(*GRASP, "--json")
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    return json.loads(result.stdout)


def test_perch_grasps_the_parrots_perch(perch_document):
    verdict = perch_document["verdict"]
    assert verdict["stable"]
    assert verdict["grasping"]
    assert verdict["feasible"]
    assert verdict["reason"] is None
    assert perch_document["engines"]["max_difference"] <= 1e-9
    assert perch_document["scalar_product"]["section"] <= 0


def test_perch_document_has_the_documented_shape(perch_document):
    assert set(perch_document) == {
        "foot",
        "branch",
        "controls",
        "verdict",
        "scalar_product",
        "hold",
        "phalanges",
        "engines",
    }
    hold = perch_document["hold"]
    assert (hold["friction"], hold["toe_force"]) == (0.5, 1.0)
    assert perch_document["verdict"]["held"]
    for bracket in ("quality", "least_friction", "pull_limit"):
        assert 0 <= hold[bracket]["low"] <= hold[bracket]["high"]
    assert set(perch_document["branch"]) == {"radius", "centre", "axis", "length"}
    assert perch_document["branch"]["radius"] == pytest.approx(0.008)
    assert perch_document["branch"]["length"] is None
    assert [len(v) for v in perch_document["controls"].values()] == [2, 3, 4, 5]
    assert len(perch_document["phalanges"]) == 14
    keys = {"finger", "phalanx", "clearance", "t", "tangent", "point", "normal"}
    assert all(set(phalanx) == keys for phalanx in perch_document["phalanges"])
    assert Foot.from_mapping(perch_document["foot"]) == Foot.preset("parrot")


def test_a_toe_twice_as_strong_bears_twice_the_pull(perch_document):
    stronger = run("perch", "--radius-mm", "8", "--toe-force-n", "2", "--json")
    hold, twice = perch_document["hold"], json.loads(stronger.stdout)["hold"]
    assert twice["pull_limit"]["low"] == pytest.approx(2 * hold["pull_limit"]["low"])
    assert twice["quality"] == hold["quality"]


@pytest.mark.parametrize(
    ("option", "value", "message"),
    [
        ("--friction", "-0.1", "friction = -0.1 is not a coefficient from 0 to 1000"),
        ("--friction", "nan", "friction = nan"),
        ("--toe-force-n", "0", "toe force = 0.0 is not a positive number of newtons"),
    ],
)
def test_a_hold_that_cannot_be_is_one_line(option, value, message):
    result = run("perch", "--radius-mm", "8", option, value)
    assert result.returncode == 2
    assert result.stderr.startswith(f"zygopin: {message}")
    assert result.stderr.count("\n") == 1


def test_check_confirms_what_perch_found(perch_document, tmp_path):
    file = tmp_path / "perch.json"
    file.write_text(json.dumps(perch_document))
    height = perch_document["branch"]["centre"][2] * 1e3
    where = ("--radius-mm", "8", f"--height-mm={height!r}")
    from_file = run("check", *where, "--controls", str(file), "--json")
    assert from_file.returncode == 0, from_file.stderr
    again = json.loads(from_file.stdout)
    assert again["verdict"]["grasping"]
    assert again["controls"] == perch_document["controls"]
    numbers = ",".join(str(v) for vs in again["controls"].values() for v in vs)
    typed = run("check", *where, "--controls", numbers)
    assert typed.returncode == 0
    assert "grasping yes, feasible yes" in typed.stdout


def test_controls_with_seven_decimals_still_grasp(perch_document):
    height = perch_document["branch"]["centre"][2] * 1e3
    controls = perch_document["controls"].values()
    numbers = ",".join(f"{v:.7f}" for values in controls for v in values)
    options = ("--radius-mm", "8", f"--height-mm={height:.9f}", "--controls", numbers)
    assert run("check", *options).returncode == 0


def test_check_of_the_straight_foot_is_no_grasp():
    zeros = ",".join("0" * 14)
    options = ("--radius-mm", "8", "--height-mm", "-20", "--controls", zeros)
    result = run("check", *options)
    assert result.returncode == 1
    assert "stable no, grasping no, feasible yes" in result.stdout
    assert result.stderr == (
        "zygopin: no feasible grasp: no toe reaches the branch, "
        "the nearest stays 10.47 mm away\n"
    )


def test_tables_fit_eighty_columns():
    for arguments in (GRASP, ("presets",), ("presets", "owl")):
        lines = run(*arguments).stdout.splitlines()
        assert lines
        assert max(map(len, lines)) <= 80


def test_perch_writes_the_scene(tmp_path):
    file = tmp_path / "deep" / "scene.html"
    result = run(*GRASP, "--html", str(file))
    assert result.returncode == 0
    assert f"scene: {file}" in result.stdout
    assert file.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--radius-mm", "500"), "take a thinner branch"),
        (("--radius-mm", "8", "--height-mm", "-500"), "move the branch under the foot"),
        (("--radius-mm", "1.2", "--preset", "paper"), "a grasp needs 90°"),
    ],
)
def test_a_branch_that_cannot_be_grasped_gets_a_reason_and_status_1(options, words):
    result = run("perch", *options, "--json")
    assert result.returncode == 1
    assert len(result.stderr.splitlines()) == 1
    assert words in result.stderr
    verdict = json.loads(result.stdout)["verdict"]
    assert not (verdict["grasping"] and verdict["feasible"])
    assert words in verdict["reason"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("perch",), "--radius-mm"),
        (("perch", "--radius-mm", "nan"), "'nan' is not a positive number"),
        (("perch", "--radius-mm", "-3"), "'-3' is not a positive number"),
        (("perch", "--radius-mm", "8", "--height-mm", "inf"), "'inf' is not a number"),
        (("perch", "--radius-mm", "8", "--height-mm", "-3"), "give at most -8"),
        (("perch", "--radius-mm", "8", "--pitch-deg", "90"), "too steep"),
        ((*GRASP, "--preset", "parot"), "did you mean 'parrot'?"),
        ((*GRASP, "--preset", "owl", "--foot", "x"), "exclude each other"),
        (
            (*GRASP, "--foot", "no-such.yaml"),
            "no-such.yaml: cannot be read",
        ),
        ((*GRASP, "--rho", "1"), "--rho = 1 is not a number above 1"),
        ((*GRASP, "--rho", "x"), "'x' is not a valid float"),
        ((*GRASP, "--omega-deg", "180"), "--omega-deg = 180 is not in (0, 360)"),
        ((*GRASP, "--splay-deg", "90"), "--splay-deg = 90 is not in [0, 90)"),
        ((*GRASP, "--thickness-mm", "99"), "--thickness-mm = 99 is not from 0"),
        (("check", "--radius-mm", "8"), "Missing option"),
        (
            ("check", *GRASP[1:], "--height-mm", "-20", "--controls", "0,1"),
            "give 14 numbers",
        ),
        (
            ("check", *GRASP[1:], "--height-mm", "-20", "--controls", "0," * 13 + "2"),
            "controls[13] = 2.0 is not in [0, 1]",
        ),
        (
            ("check", *GRASP[1:], "--height-mm", "-20", "--controls", "none.json"),
            "none.json: cannot be read: No such file",
        ),
        (("presets", "stork"), "unknown preset 'stork'"),
        (("urdf", "-o", "/dev/null/x"), "cannot be written"),
        (("fly",), "No such command 'fly'"),
    ],
)
def test_bad_input_is_one_line_and_status_2(arguments, words):
    result = run(*arguments)
    assert result.returncode == 2
    assert result.stdout == ""
    assert len(result.stderr.splitlines()) == 1
    assert result.stderr.startswith("zygopin: ")
    assert words in result.stderr


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("[[0, 0], [1, 1]]", "give 14 numbers"),
        (json.dumps([[0.5] * 14]), "holds many poses"),
        ('{"foot": {"name": "owl"}, "controls": []}', "of another foot"),
        ("[1, 2", "not JSON"),
        ("3", "holds no controls"),
        ('{"finger1": [0, 0]}', "controls[finger2] = None is not given"),
        ('{"fingr1": [0, 0]}', "did you mean 'finger1'?"),
        ('{"finger1": [0, "x"]}', "controls[finger1]"),
    ],
)
def test_a_bad_controls_file_is_one_line(content, words, tmp_path):
    file = tmp_path / "controls.json"
    file.write_text(content)
    where = ("--radius-mm", "8", "--height-mm", "-20")
    result = run("check", *where, "--controls", str(file))
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) == 1
    assert words in result.stderr


@pytest.mark.parametrize(
    ("content", "words"),
    [
        ("rho: [", "not YAML"),
        ("- 1", "holds list, not a mapping"),
        ("rho: 0.5", "rho = 0.5 is not a number above 1"),
        ("rhoo: 2", "did you mean 'rho'?"),
        ("fingers: [{name: A, phalanges: 2, azimuth: 0}]", "lower-case"),
        ("fingers: [{name: a, phalanges: 0, azimuth: 0}]", "a.phalanges = 0"),
        ("thickness: .nan", "thickness = nan"),
    ],
)
def test_a_bad_foot_file_is_one_line(content, words, tmp_path):
    file = tmp_path / "foot.yaml"
    file.write_text(content)
    result = run("perch", "--foot", str(file), "--radius-mm", "8")
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) == 1
    assert str(file) in result.stderr
    assert words in result.stderr


def test_controls_may_be_json_in_place():
    where = ("--radius-mm", "8", "--height-mm", "-20")
    result = run("check", *where, "--controls", json.dumps([0] * 14))
    assert result.returncode == 1
    assert "stable no" in result.stdout


def test_output_that_cannot_be_written_is_one_line_and_status_2():
    with open("/dev/full", "w", encoding="utf-8") as full:
        result = subprocess.run(
            [sys.executable, "-m", "zygopin", "presets"],
            stdout=full,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert result.returncode == 2
    assert result.stderr.startswith("zygopin: the output cannot be written: No space")
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize("command", ["presets", "perch --radius-mm 8 --json"])
def test_output_that_is_closed_is_one_line_and_status_2(command):
    words = f"{shlex.quote(sys.executable)} -m zygopin {command} >&-"
    result = subprocess.run(
        ["bash", "-c", words],
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    assert result.returncode == 2
    assert result.stderr == "zygopin: the output cannot be written: it is closed\n"


def test_a_reader_that_leaves_early_is_no_verdict():
    python = shlex.quote(sys.executable)
    command = f"{python} -m zygopin presets owl | true; echo ${{PIPESTATUS[0]}}"
    result = subprocess.run(
        ["bash", "-c", command], capture_output=True, text=True, check=True
    )
    assert result.stdout.strip() in ("141", "0")
    assert result.stderr == ""


def test_urdf_writes_its_files_and_lists_them(tmp_path):
    result = run("urdf", "--preset", "owl", "-o", str(tmp_path), "--glb", "--json")
    assert result.returncode == 0
    *files, glb = [Path(name) for name in json.loads(result.stdout)["files"]]
    assert glb.name == "foot.glb"
    assert glb.read_bytes().startswith(b"glTF")
    assert [file.name for file in files] == [
        "foot.urdf",
        "foot_tendon.urdf",
        "foot.srdf",
        "foot_tendon.srdf",
    ]
    assert all("finger4_reversal" in file.read_text() for file in files)


def test_urdf_writes_mujoco_models_on_demand(tmp_path):
    result = run("urdf", "--scale-mm", "12", "-o", str(tmp_path), "--mjcf")
    assert result.returncode == 0
    names = [Path(line).name for line in result.stdout.splitlines()]
    assert names[4:] == ["foot.xml", "foot_tendon.xml", "scene.xml"]


def test_presets_json_holds_each_number_and_its_source():
    presets = json.loads(run("presets", "--json").stdout)
    assert set(presets) == {"paper", "paper-figure", "parrot", "owl", "anisodactyl"}
    fields = {"rho", "omega", "splay", "scale", "thickness", "density", "fingers"}
    for preset in presets.values():
        assert set(preset["sources"]) == fields
        assert all(preset["sources"].values())


def test_overrides_reach_the_foot():
    options = ("--rho", "1.3", "--omega-deg", "80", "--splay-deg", "20")
    sizes = ("--scale-mm", "14", "--thickness-mm", "2")
    result = run(*GRASP, *options, *sizes, "--json")
    foot = json.loads(result.stdout)["foot"]
    assert foot["rho"] == 1.3
    assert foot["omega"] == pytest.approx(1.3962634)
    assert foot["scale"] == pytest.approx(0.014)
    assert foot["thickness"] == pytest.approx(0.002)
    assert foot["fingers"][1]["azimuth"] == pytest.approx(0.3490658)


@pytest.mark.parametrize("command", [(), ("urdf",), ("perch",), ("check",)])
def test_help_documents_every_option(command):
    result = run(*command, "--help")
    assert result.returncode == 0
    assert result.stdout.startswith("Usage: ")
    assert max(map(len, result.stdout.splitlines())) <= 80
