"""Nothing that a caller passes ends the process, or what comes back from a call."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import FrozenInstanceError, fields, is_dataclass, replace
from pathlib import Path

import numpy as np
import pytest
from bad_inputs import ENTRIES, good
from examples import branch, foot

import zygopin as zg

HERE = Path(__file__).parent
CALLS = HERE / "native_calls.py"

OLD_XACRO = "ignore:private variables, such as:DeprecationWarning"
"""What xacro says on Python 3.10."""

SLOW = (
    "design_foot",
    "export_",
    "paper_report",
    "plot_",
    "save_",
    "sweep",
    "to_",
    "write_",
)
"""Entries that return texts and files, or take their time."""


@pytest.mark.parametrize(
    "groups", [("grasp", "distance"), ("solid", "model", "record")]
)
def test_no_bad_call_reaches_a_native_library(groups):
    paths = os.pathsep.join([str(HERE.parent), str(HERE)])
    ended = subprocess.run(
        [sys.executable, "-W", "error", "-W", OLD_XACRO, str(CALLS), *groups],
        capture_output=True,
        text=True,
        check=False,
        env={**os.environ, "PYTHONPATH": paths},
    )
    lines = ended.stdout.splitlines()
    wrong = [line for line in lines if line.startswith("WRONG")]
    assert not wrong, "\n".join(wrong)
    assert ended.returncode == 0, f"died after {lines[-1:]}: {ended.stderr}"
    assert ended.stderr == ""
    assert len(lines) > 30


def held(value: object) -> list[object]:
    """The records that a value holds, itself among them."""
    if isinstance(value, (list, tuple)):
        return [found for each in value for found in held(each)]
    if isinstance(value, dict):
        return held(list(value.values()))
    if not is_dataclass(value) or isinstance(value, type):
        return []
    return [value, *held([getattr(value, each.name) for each in fields(value)])]


@pytest.mark.parametrize(
    "entry",
    [each for each in ENTRIES if not each.name.startswith(SLOW)],
    ids=lambda entry: entry.name,
)
def test_what_comes_back_cannot_be_changed(entry):
    """And good arguments are good: the table of bad ones stands on them."""
    result = entry.call(**{name: good(entry, name) for name in entry.parameters})
    for record in held(result):
        for field in fields(record):
            value = getattr(record, field.name)
            with pytest.raises(FrozenInstanceError):
                setattr(record, field.name, value)
            if isinstance(value, np.ndarray):
                what = f"{entry.name}: {type(record).__name__}.{field.name}"
                assert not value.flags.writeable, what


def test_what_was_given_can_be_changed_without_harm():
    cube = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
    for make, *given in (
        (zg.Branch, np.array(0.005), np.array([0.0, 0, -0.01]), np.array([0.0, 1, 0])),
        (zg.Sphere, 0.01, np.zeros(3)),
        (zg.Box, np.ones(3), np.zeros(3), np.eye(3)),
        (zg.Capsule, 0.01, cube[:2].copy()),
        (zg.ConvexMesh, cube),
        (zg.BranchGrid, np.array([-2.0, -1.0]), np.array([0.1, 0.2])),
        (zg.Contacts, cube[:3].copy(), cube[1:4].copy()),
        (zg.ControlSystem, 1.5, 1.0, np.array([0.0, 0.5, 1.0])),
        (zg.Placement, np.array([0.0, 1.0, 0.0])),
        (zg.Law.through, np.array([0.0, 1.0]), np.zeros((2, 4))),
        (zg.Motion.through, np.array([0.0, 1.0]), np.zeros((2, 3))),
    ):
        made = make(*given)
        for values in given:
            if isinstance(values, np.ndarray):
                values[...] = np.nan
        for field in fields(made):
            value = getattr(made, field.name)
            if isinstance(value, np.ndarray):
                assert np.isfinite(value).all(), f"{make}: {field.name}"
        if isinstance(made, (zg.Law, zg.Motion)):
            assert np.isfinite(made.at(np.array([0.5]))).all()


def test_a_changed_mesh_is_checked_again():
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
    mesh = zg.ConvexMesh(corners)
    moved = replace(mesh, vertices=mesh.vertices + 1.0)
    np.testing.assert_allclose(moved.planes[:, :3], mesh.planes[:, :3])
    with pytest.raises(zg.ParameterError, match="coplanar"):
        replace(mesh, vertices=mesh.vertices * [1, 1, 0])


def test_threads_are_checked_whatever_the_batch():
    none = np.zeros((0, foot().phalanx_count))
    for call in (
        lambda: zg.forward_kinematics(foot(), none, threads=0),
        lambda: zg.forward_kinematics(foot(), none, azimuths=[0.0, 3.0], threads="2"),
        lambda: zg.grasp_verdicts(foot(), none, branch(), threads=0),
        lambda: zg.grasp_verdicts(foot(), none[:0], branch(), threads=2.5),
    ):
        with pytest.raises(zg.ParameterError, match=r"threads = .* is not an integer"):
            call()
