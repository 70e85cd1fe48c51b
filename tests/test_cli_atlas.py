"""The command `atlas`: table, map, JSON, files, and one-line errors."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
from made_atlases import made_atlas
from test_atlas_regions import written_atlas
from test_cli import run as run_alone

import zygopin.atlas
from zygopin import Answer, Foot, load_atlas, region_map
from zygopin.atlas import VERDICTS
from zygopin.atlas_output import (
    LETTERS,
    MAP_SHAPE,
    answer_shares,
    atlas_document,
    graspable_range,
    largest_wrap,
    map_lines,
    summary_lines,
    title_line,
    verdict_rows,
)
from zygopin.atlas_regions import Region
from zygopin.branch import branch_axis
from zygopin.presets import write_parameters


@pytest.fixture
def asked(monkeypatch):
    """What the atlas is asked for; it answers with a made one."""
    questions = []

    def answer(foot, grid, *, workers, progress):
        assert workers >= 1
        progress("looking it up")
        questions.append((foot, grid))
        return made_atlas()

    monkeypatch.setattr(zygopin.atlas, "branch_atlas", answer)
    return questions


@pytest.fixture(scope="module")
def short_toes(tmp_path_factory):
    """The file of a foot of two short toes: its atlas takes seconds."""
    foot = Foot.preset("parrot")
    first, _, third, _ = foot.fingers
    toes = (
        dataclasses.replace(first, phalanges=1),
        dataclasses.replace(third, phalanges=2),
    )
    path = tmp_path_factory.mktemp("foot") / "short.yaml"
    return write_parameters(path, foot.replace(fingers=toes).to_mapping())


def test_a_real_atlas_is_printed_saved_and_agrees_with_its_file(short_toes, tmp_path):
    path = tmp_path / "atlas.npz"
    options = ("--foot", str(short_toes), "--cells", "12", "--npz", str(path))
    result = run_alone("atlas", *options)
    assert result.returncode == 0, result.stderr
    lines = result.stdout.splitlines()
    assert max(map(len, lines[:-1])) <= 80
    assert lines[0].endswith("12 heights x 12 radii")
    assert lines[-1] == f"arrays: {path}"
    atlas = load_atlas(path)
    assert atlas.grid.shape == (12, 12)
    for line in (*summary_lines(atlas), *map_lines(atlas)):
        assert line in lines
    row = next(line.split() for line in lines if line.startswith(" grasping"))
    assert row == list(verdict_rows(atlas)[3])
    for cell in np.argwhere(atlas.grasping == Answer.YES):
        assert atlas.report(*cell).grasping


def test_options_make_the_grid(run, asked):
    options = ("--cells", "5x6", "--radii-mm", "1:28", "--heights-mm", "-40:0")
    pose = ("--yaw-deg", "20", "--pitch-deg", "-10", "--x-mm", "3")
    result = run("atlas", "--pair", "1,finger3", *options, *pose)
    assert result.returncode == 0, result.stderr
    ((foot, grid),) = asked
    assert [finger.name for finger in foot.fingers] == ["finger1", "finger3"]
    np.testing.assert_allclose(grid.heights, np.linspace(-0.04, 0, 5))
    np.testing.assert_allclose(grid.radii, np.linspace(0.001, 0.028, 6))
    np.testing.assert_allclose(grid.axis, branch_axis(np.radians(20), np.radians(-10)))
    np.testing.assert_allclose(grid.offset, (0.003, 0))


def test_the_usual_grid_is_in_proportion_to_the_foot(run, asked):
    for name in ("paper", "parrot"):
        assert run("atlas", "--preset", name).returncode == 0
        foot, grid = asked[-1]
        assert grid.shape == (64, 64)
        np.testing.assert_allclose(grid.heights[[0, -1]] / foot.size, (-1.2, 0))
        np.testing.assert_allclose(grid.radii[[0, -1]] / foot.size, (0.02, 0.8))


@pytest.mark.usefixtures("asked")
def test_json_is_the_document(run):
    result = run("atlas", "--json")
    assert result.returncode == 0
    document = json.loads(result.stdout)
    assert document == json.loads(json.dumps(atlas_document(made_atlas())))
    assert Foot.from_mapping(document["foot"]) == made_atlas().foot


@pytest.mark.usefixtures("asked")
def test_all_files_are_written_and_named(run, tmp_path):
    names = {"npz": "arrays", "png": "figure", "wrap-png": "wrap", "html": "scene"}
    paths = {name: tmp_path / f"{name}.file" for name in names}
    options = [word for name in names for word in (f"--{name}", str(paths[name]))]
    result = run("atlas", *options, "--scene-height-mm", "-20")
    assert result.returncode == 0, result.stderr
    expected = [f"{what}: {paths[name]}" for name, what in names.items()]
    assert result.stdout.splitlines()[-4:] == expected
    for name, start in (("png", b"\x89PNG"), ("wrap-png", b"\x89PNG"), ("npz", b"PK")):
        assert paths[name].read_bytes().startswith(start)
    assert paths["html"].read_text("utf-8").startswith("<!DOCTYPE html>")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--cells", "1"), "a number from 2 to 4096"),
        (("--cells", "4x"), "a number from 2"),
        (("--cells", "many"), "a number from 2"),
        (("--cells", "4096"), "at most 4194304 cells"),
        (("--radii-mm", "0:5"), "positive"),
        (("--radii-mm", "5"), "is not LOW:HIGH"),
        (("--heights-mm", "0:-40"), "does not ascend"),
        (("--heights-mm", "7"), "such as -40:0"),
        (("--pair", "1"), "is not two fingers"),
        (("--pair", "1,4"), "opposable"),
        (("--pair", "1,thumb"), "thumb"),
        (("--scene-height-mm", "-5"), "goes with --html"),
        (("--rho", "0.5"), "--rho"),
    ],
)
def test_bad_input_is_one_line_and_status_two(run, monkeypatch, options, words):
    monkeypatch.setattr(zygopin.atlas, "branch_atlas", None)
    result = run("atlas", *options)
    assert result.returncode == 2
    assert words in result.stderr
    assert len(result.stderr.splitlines()) == 1


@pytest.mark.usefixtures("asked")
def test_a_file_that_cannot_be_written_is_one_line(run, tmp_path):
    (tmp_path / "file").write_text("in the way")
    for option in ("--png", "--html", "--npz"):
        result = run("atlas", option, str(tmp_path / "file" / "a"))
        assert result.returncode == 2
        assert len(result.stderr.splitlines()) == 1


def test_shares_count_branches_that_do_not_hold_the_base():
    atlas = written_atlas()
    shares = answer_shares(atlas, "grasping")
    assert shares == {"yes": 1 / 11, "no": 8 / 11, "undecided": 2 / 11}
    assert verdict_rows(atlas)[3] == ("grasping", "9.1%", "72.7%", "18.2%")
    assert [row[0] for row in verdict_rows(atlas)] == list(VERDICTS)


def test_ranges_and_wraps_are_those_of_the_grasps():
    atlas = made_atlas()
    rows, columns = np.nonzero(atlas.grasping == Answer.YES)
    radii = atlas.grid.radii[columns]
    assert graspable_range(atlas) == (radii.min(), radii.max())
    largest = largest_wrap(atlas)
    assert largest["wrap"] == np.max(atlas.wrap[rows, columns, 0])
    assert largest["bound"] == pytest.approx(largest["wrap"] + 0.1)


def test_no_grasp_is_told():
    nothing = np.where(made_atlas().grasping == Answer.YES, 0, made_atlas().grasping)
    atlas = dataclasses.replace(made_atlas(), grasping=nothing.astype(np.int8))
    assert graspable_range(atlas) is None
    assert largest_wrap(atlas) is None
    assert summary_lines(atlas)[0].endswith("no radius of the grid")
    assert atlas_document(atlas)["graspable_radii"] is None


def test_the_map_has_a_letter_for_each_branch_from_the_highest_down():
    atlas = made_atlas()
    lines = map_lines(atlas)[1:8]
    heights = [float(line[:9]) for line in lines]
    assert heights == sorted(heights, reverse=True)
    for line, codes in zip(lines[::-1], region_map(atlas), strict=True):
        letters = "".join(LETTERS[Region(code)] for code in codes)
        assert line[9:] == letters.rstrip()


def test_a_large_map_is_thinned_to_a_terminal():
    atlas = made_atlas(30, 70)
    lines = map_lines(atlas)
    assert max(map(len, lines[:-1])) <= 80
    ends = next(place for place, line in enumerate(lines) if "radius [mm]" in line)
    assert ends - 1 == MAP_SHAPE[0]
    assert lines[1].split()[0] == f"{atlas.grid.heights[-1] * 1e3:.4g}"


def test_the_title_names_what_is_turned():
    assert title_line(made_atlas()).endswith("7 heights x 9 radii")
    turned = title_line(made_atlas(3, 3, tuple(branch_axis(0.5, -0.2))))
    assert turned.endswith("yaw 28.65°, pitch -11.46°")
