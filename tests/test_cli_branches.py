"""The command `branches`: table, JSON, CSV, filters, exit status, one-line errors."""

from __future__ import annotations

import csv
import json

import numpy as np
import pytest

from zygopin import Foot, cli_branches, stable_branches

PAPER = ("branches", "--preset", "paper")
PARROT = ("branches", "--levels", "3")


def document(run, *arguments):
    result = run(*arguments, "--json")
    assert result.stderr == ""
    return json.loads(result.stdout), result.returncode


def test_the_table_says_how_many_systems_and_fits_80_columns(run):
    result = run(*PAPER, "--verify")
    assert result.returncode == 0
    assert result.stderr == ""
    lines = result.stdout.splitlines()
    assert max(map(len, lines)) <= 80
    assert lines[0] == "paper, finger1,finger3, levels 2: 720 systems"
    assert "17 solutions; listed: 17, of them 17 stable, 5 families" in lines
    assert lines[-1].startswith("FCL: contacts within ")
    assert lines[-1].endswith("0 disagree")
    (row,) = [line for line in lines if "-1312" in line]
    assert row.split() == ["-1312", "1126", "2,", "4", "0.19,", "0.47", "both", "yes"]
    assert any("…-∞" in line and "…∞" in line for line in lines)


@pytest.mark.parametrize("extra", [(), ("--tied",), ("--yaw-deg=10", "--x-mm=2")])
def test_tables_of_other_feet_fit_80_columns(run, extra):
    for preset in ("parrot", "owl", "paper"):
        result = run("branches", "--preset", preset, "--levels", "4", *extra)
        assert max(map(len, result.stdout.splitlines())) <= 80
        assert result.returncode in (0, 1)


def test_the_document_holds_what_the_function_finds(run):
    found = stable_branches(Foot.preset("parrot"), (1, 3), 3)
    got, status = document(run, *PARROT)
    assert status == 0
    assert Foot.from_mapping(got["foot"]) == found.foot
    assert got["pair"] == ["finger1", "finger3"]
    assert got["placement"]["axis"] == [0, 1, 0]
    assert got["counts"]["systems"] == 5760
    assert got["levels"] == [0, 0.5, 1]
    assert got["section"] is None
    assert got["listed"] == got["matching"] == got["solutions"] == len(found)
    assert got["fcl"] is None
    for row, branch in enumerate(got["branches"]):
        assert branch["height"] == found.height[row]
        assert branch["radius"] == found.radius[row]
        assert branch["controls"]["finger3"] == found.controls[row, 2:].tolist()
        assert branch["phalanges"] == found.phalanx[row].tolist()
        assert branch["grasping"]["section"] == found.grasping[row]
        assert branch["feasible"] == found.feasible[row]
        assert branch["stable"]


def test_levels_may_be_listed(run):
    one, _ = document(run, *PAPER, "--levels", "0,0.5,1")
    other, _ = document(run, *PAPER, "--levels", "3")
    assert one["branches"] == other["branches"]


def test_an_endless_family_ends_in_null(run):
    got, _ = document(run, *PAPER)
    endless = [each for each in got["branches"] if None in each["radii"]]
    assert len(endless) == 2
    assert all(None in each["heights"] for each in endless)


def test_filters_list_only_what_has_the_verdicts(run):
    got, _ = document(run, *PARROT, "--feasible", "--grasping")
    assert 0 < got["matching"] < got["solutions"]
    for branch in got["branches"]:
        assert branch["feasible"]
        assert branch["grasping"]["section"]


def test_a_limit_shortens_the_list_but_not_the_counts(run):
    got, _ = document(run, *PARROT, "--limit", "3")
    assert got["listed"] == len(got["branches"]) == 3
    assert got["matching"] == 125
    lines = run(*PARROT, "--limit", "3").stdout.splitlines()
    assert lines[-1] == "the first 3 are listed: --limit, --csv give more"


def test_more_than_a_document_should_hold_is_refused(run, monkeypatch):
    monkeypatch.setattr(cli_branches, "MOST_LISTED", 100)
    result = run(*PARROT, "--json")
    assert result.returncode == 2
    assert "give --limit" in result.stderr
    assert run(*PARROT, "--json", "--limit", "200").returncode == 0


def test_the_csv_file_holds_all_with_their_controls(run, tmp_path):
    file = tmp_path / "deep" / "branches.csv"
    result = run(*PARROT, "--csv", str(file))
    assert result.returncode == 0
    assert result.stdout.splitlines()[-1] == f"table: {file}"
    found = stable_branches(Foot.preset("parrot"), (1, 3), 3)
    with file.open(encoding="ascii") as text:
        rows = list(csv.DictReader(text))
    assert len(rows) == len(found)
    for name, values in (
        ("height_m", found.height),
        ("radius_1_m", found.radii[:, 1]),
        ("finger3_t", found.t[:, 1]),
        ("grasping_base_to_tip", found.grasping_base_to_tip),
        ("finger3_control4", found.controls[:, 5]),
    ):
        np.testing.assert_array_equal([float(row[name]) for row in rows], values)
    before = file.read_bytes()
    run(*PARROT, "--csv", str(file))
    assert file.read_bytes() == before


@pytest.mark.parametrize(
    ("section", "radius"), [("printed", 0.6512), ("circle", 0.6180)]
)
def test_tied_branches_in_the_sources_readings(run, section, radius):
    arguments = (*PAPER, "--tied", "--section", section)
    got, status = document(run, *arguments)
    assert status == 0
    second = [b for b in got["branches"] if b["phalanges"] == [2, 2]]
    assert [b["radius"] for b in second] == pytest.approx([radius], abs=5e-5)
    assert not second[0]["stable"]
    assert got["stable"] < got["matching"]
    assert got["section"] == section
    title = run(*arguments).stdout.splitlines()[0]
    assert title.endswith("levels 2: 72 equations, branches under the base")


def test_tied_branches_are_those_under_the_base(run):
    got, _ = document(run, *PAPER, "--tied", "--verify")
    assert got["stable"] == got["matching"] == 3
    assert got["fcl"]["disagreeing"] == 0
    assert all(b["height"] == -b["radius"] for b in got["branches"])


def test_nothing_found_is_status_1(run):
    result = run("branches", "--x-mm", "5000", "--grasping")
    assert result.returncode == 1
    assert "listed: 0, of them" in result.stdout


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--pair", "1,4"), "finger1 and finger4"),
        (("--pair", "1"), "not two fingers"),
        (("--pair", "1,thumb"), "unknown finger 'thumb'"),
        (("--levels", "1"), "number of levels = 1"),
        (("--levels", "few"), "--levels = few"),
        (("--levels", "400", "--pair", "3,4"), "take fewer levels"),
        (("--levels", "0,0.5"), "add 0 and 1"),
        (("--levels", "0,x,1"), "try 0,0.5,1"),
        (("--section", "circle"), "--section goes with --tied"),
        (("--tied", "--x-mm", "1"), "no --x-mm"),
        (("--tied", "--section", "circle", "--yaw-deg", "5"), "geometric"),
        (("--pitch-deg", "90"), "off the vertical"),
        (("--preset", "nobody"), "nobody"),
    ],
)
def test_bad_input_is_one_line_and_status_2(run, arguments, message):
    result = run("branches", *arguments)
    assert result.returncode == 2
    assert message in result.stderr
    assert len(result.stderr.splitlines()) == 1


def test_what_cannot_be_solved_is_not_blamed_on_the_file(run, tmp_path, monkeypatch):
    monkeypatch.setattr("zygopin.memory.limit", lambda most=None: most or 5000)
    file = tmp_path / "branches.csv"
    result = run(*PAPER, "--tied", "--levels", "3", "--csv", str(file))
    assert result.returncode == 2
    assert "take fewer levels" in result.stderr
    assert str(file) not in result.stderr
    assert list(tmp_path.iterdir()) == []


def test_an_unwritable_file_is_status_2(run, tmp_path):
    result = run(*PAPER, "--csv", str(tmp_path))
    assert result.returncode == 2
    assert "not a regular file" in result.stderr
