"""The command `strike`: output, files, exit status, one-line errors."""

from __future__ import annotations

import json

import numpy as np
import pytest
from test_cli import run as run_alone

from zygopin import Foot, Sphere, forward_kinematics, obstacle_clearance

MAIN = ("strike", "--preset", "owl", "--prey-radius-mm", "15")


def test_the_owl_grips_its_prey(tmp_path):
    page = tmp_path / "strike.html"
    result = run_alone(*MAIN, "--html", str(page), "--json")
    assert result.returncode == 0, result.stderr
    assert result.stderr == ""
    document = json.loads(result.stdout)
    assert document["end"]["mode"] == "locked"
    assert document["grip"]["feasible"]
    assert document["grip"]["grasping"]
    assert len(document["grip"]["fingers"]) >= 3
    assert document["obstacle"] == {
        "kind": "sphere",
        "radius": 0.015,
        "centre": [0.0, 0.0, 0.0],
    }
    kinds = [event["kind"] for event in document["events"]]
    assert kinds[0] == "engaged"
    assert kinds[-1] == "locked"
    assert page.read_text(encoding="utf-8").startswith("<!DOCTYPE html>")


def test_the_end_can_be_rebuilt_from_what_is_printed(run):
    document = json.loads(run(*MAIN, "--json").stdout)
    foot = Foot.from_mapping(document["foot"])
    end = document["end"]
    azimuths = [end["azimuths"][finger.name] for finger in foot.fingers]
    bones = forward_kinematics(foot, end["controls"], azimuths=azimuths)
    base = np.array(end["base"])
    bones = bones @ base[:3, :3].T + base[:3, 3]
    ball = Sphere(document["obstacle"]["radius"], document["obstacle"]["centre"])
    near = obstacle_clearance(bones, foot.radii, ball)
    listed = [phalanx["clearance"] for phalanx in document["phalanges"]]
    assert near.distance == pytest.approx(listed, abs=1e-12)
    touching = [phalanx["touching"] for phalanx in document["phalanges"]]
    assert list(np.abs(near.distance) <= document["tolerance"]) == touching
    held = {p["finger"] for p in document["phalanges"] if p["touching"]}
    assert held == set(document["grip"]["fingers"])


def test_the_log_fits_the_terminal(run):
    result = run(*MAIN)
    assert result.returncode == 0
    assert "engages the tendon" in result.stdout
    assert "locked; 3 toes touch" in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (("--miss-mm", "150,0"), "free; no toe touches the target; feasible"),
        (("--reading", "paper"), "toes pass into the target, none rests on it; not"),
    ],
)
def test_a_miss_and_a_toe_that_passes_through_exit_1(run, change, words):
    result = run(*MAIN, *change)
    assert result.returncode == 1
    assert words in " ".join(result.stdout.split())


def test_a_branch_is_gripped_too(run):
    way = ("--slope-deg", "90", "--reversal", "0")
    result = run("strike", "--preset", "parrot", "--branch-radius-mm", "8", *way)
    assert result.returncode == 0, result.stdout


def test_fcl_gives_the_same_strike(run):
    exact, fcl = (
        json.loads(run(*MAIN, "--engine", engine, "--json").stdout)
        for engine in ("exact", "fcl")
    )
    for one, other in zip(exact["events"], fcl["events"], strict=True):
        assert (one["kind"], one["finger"]) == (other["kind"], other["finger"])
        assert one["time"] == pytest.approx(other["time"], abs=1e-9)


@pytest.mark.parametrize("ending", ["npz", "json"])
def test_the_whole_record_is_saved(run, tmp_path, ending):
    path = tmp_path / f"strike.{ending}"
    assert run(*MAIN, "--save", str(path)).returncode == 0
    if ending == "npz":
        with np.load(path) as archive:
            document = json.loads(str(archive["document"]))
            record = {name: archive[name] for name in archive.files}
    else:
        document = json.loads(path.read_text(encoding="utf-8"))
        record = {name: np.array(value) for name, value in document["record"].items()}
    count = len(record["times"])
    foot = Foot.from_mapping(document["foot"])
    assert record["bones"].shape == (count, foot.phalanx_count, 2, 3)
    assert record["base"].shape == (count, 4, 4)
    assert set(record["modes"]) == {"free", "closing", "locked"}
    assert (np.diff(record["times"]) >= 0).all()
    times = {event["time"] for event in document["events"]}
    assert times <= set(record["times"].tolist())


def test_a_figure_is_drawn(run, tmp_path):
    path = tmp_path / "strike.png"
    assert run(*MAIN, "--png", str(path)).returncode == 0
    assert path.read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ((), "give one of --prey-radius-mm and --branch-radius-mm"),
        (("--prey-radius-mm", "9", "--branch-radius-mm", "9"), "give one of"),
        (("--prey-radius-mm", "-1"), "not a positive number of millimetres"),
        (("--prey-radius-mm", "9", "--miss-mm", "1"), "--miss-mm = 1 is not x,y"),
        (("--prey-radius-mm", "9", "--slope-deg", "0"), "--slope-deg = 0 is not"),
        (("--prey-radius-mm", "9", "--speed", "0"), "metres per second"),
        (("--prey-radius-mm", "9", "--closing-ms", "nan"), "milliseconds"),
        (("--prey-radius-mm", "9", "--open", "2"), "--open"),
        (("--prey-radius-mm", "9", "--save", "x.csv"), ".npz or .json"),
        (("--prey-radius-mm", "9", "--preset", "dodo"), "unknown preset"),
    ],
)
def test_bad_input_is_one_line_and_exit_2(run, arguments, words):
    result = run("strike", *arguments)
    assert result.returncode == 2
    assert words in result.stderr
    assert len(result.stderr.splitlines()) == 1
    assert result.stdout == ""
