"""The command `touch`: its table, its JSON, its figure, and one-line errors."""

from __future__ import annotations

import json

import numpy as np
import pytest
from test_cli import run as run_alone

from zygopin import Branch, Foot, touch_intervals, touch_plots
from zygopin.branch import branch_axis
from zygopin.touch_output import touch_document, touch_lines, touch_rows

PAPER = ("touch", "--preset", "paper", "--omega-deg", "60", "--height-mm", "-600")


def test_the_table_says_what_was_found_and_what_is_proved():
    result = run_alone(*PAPER)
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    lines = result.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert lines[0] == "paper: radii that are touched and not entered [mm]"
    (row,) = [line.split() for line in lines if line.startswith(" finger1")]
    least, bound, most, cap = map(float, row[1:5])
    assert 228.5 < bound <= least < 229.5
    assert most == cap == 600
    assert "finger1 and finger3: 229.1 to 600 mm" in lines


def test_json_is_what_the_function_finds(run):
    pose = ("--x-mm", "100", "--yaw-deg", "20", "--pitch-deg", "-10")
    result = run(*PAPER, *pose, "--json")
    assert result.returncode == 0
    document = json.loads(result.stdout)
    foot = Foot.from_mapping(document["foot"])
    axis = document["axis"]
    np.testing.assert_allclose(axis["centre"], (0.1, 0, -0.6))
    expected = branch_axis(np.radians(20), np.radians(-10))
    np.testing.assert_allclose(axis["direction"], expected)
    found = touch_intervals(foot, Branch(1.0, axis["centre"], axis["direction"]))
    for index, finger in enumerate(document["fingers"]):
        assert finger["finger"] == foot.fingers[index].name
        least, most = finger["least"], finger["most"]
        brackets = [least["bound"], least["attained"], most["attained"], most["bound"]]
        np.testing.assert_allclose(
            brackets, [*found.least[index], *found.most[index]], atol=1e-12
        )
        assert len(least["controls"]) == foot.fingers[index].phalanges
        assert finger["converged"]
    pair = document["pairs"][0]
    first, second = (found.least[index, 1] for index in (0, 1))
    assert pair["fingers"] == ["finger1", "finger2"]
    assert pair["radii"][0] == pytest.approx(max(first, second))
    assert not pair["proved_none"]


@pytest.fixture
def few_feet(monkeypatch):
    """The figure shows two joint limits and two scaling factors."""
    monkeypatch.setattr(touch_plots, "OMEGAS", np.array([0.5, 1.0]))
    monkeypatch.setattr(touch_plots, "RHOS", np.array([1.2, 1.6]))


@pytest.mark.usefixtures("few_feet")
def test_the_figure_is_written(run, tmp_path):
    path = tmp_path / "bands.png"
    result = run(*PAPER, "--png", str(path))
    assert result.returncode == 0
    assert result.stdout.splitlines()[-1] == f"figure: {path}"
    assert path.read_bytes().startswith(b"\x89PNG")


@pytest.mark.usefixtures("few_feet")
def test_a_figure_that_cannot_be_written_is_one_line(run, tmp_path):
    (tmp_path / "file").write_text("in the way")
    result = run(*PAPER, "--png", str(tmp_path / "file" / "bands.png"))
    assert result.returncode == 2
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("touch",), "--height-mm"),
        ((*PAPER, "--x-mm", "far"), "millimetres"),
        ((*PAPER, "--rho", "0.5"), "--rho"),
    ],
)
def test_bad_input_is_one_line_and_status_two(run, arguments, words):
    result = run(*arguments)
    assert result.returncode == 2
    assert words in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_fingers_that_are_never_clear_have_no_radius():
    found = touch_intervals(Foot.preset("parrot"), Branch(1.0, (0, 0, 0)))
    for row in touch_rows(found):
        assert row[1:5] == ("none", "", "none", "")
    for line in touch_lines(found):
        assert line.endswith("no radius, proved")
    assert touch_document(found)["pairs"][0]["radii"] is None


def test_pairs_that_share_no_radius_are_proved_so():
    ahead = Branch(1.0, (1.5, 0, 0.3))
    found = touch_intervals(Foot.preset("paper"), ahead)
    pairs = touch_document(found)["pairs"]
    for pair in pairs:
        assert (pair["radii"] is None) == pair["proved_none"]
    assert any(pair["proved_none"] for pair in pairs)


def test_bounds_that_are_wider_than_wanted_are_told():
    foot = Foot.preset("parrot")
    axis = Branch(1.0, (0.006, 0.0, -0.014), branch_axis(0.35))
    wide = touch_intervals(foot, axis, max_boxes=2, tolerance=1e-6)
    assert not wide.converged.all()
    assert touch_lines(wide)[-1].startswith("wider than 1e-06 of its length: finger")
