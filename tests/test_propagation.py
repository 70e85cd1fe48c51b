"""Poses that move over a grid: each is checked, and more is shown than before."""

from __future__ import annotations

import numpy as np
import pytest

from zygopin import Foot, check_grasp
from zygopin.branch_grid import BranchGrid
from zygopin.grasp import Criteria
from zygopin.perch import search_perch
from zygopin.propagation import propagate, turned
from zygopin.toe_contacts import ToeSearch
from zygopin.witnesses import MERITS, Witnesses

FOOT = Foot.preset("parrot")
SIZE = FOOT.size
GRID = BranchGrid(np.linspace(-0.4, -0.3, 6) * SIZE, np.linspace(0.1, 0.15, 7) * SIZE)
FINGERS = ToeSearch(FOOT, GRID).fingers
WANTED = np.full(GRID.shape, MERITS["grasping"])


def seeded():
    """Witnesses with one grasp, in a corner."""
    found, cell = Witnesses(FOOT, GRID, Criteria()), (np.array([0]), np.array([0]))
    plan = search_perch(FOOT, GRID.at(0, 0))
    assert plan.grasping
    found.offer(cell, plan.controls[None])
    assert found.shows("grasping").sum() == 1
    return found


@pytest.fixture(scope="module")
def spread():
    found = seeded()
    propagate(found, FINGERS, WANTED)
    return found


def test_one_grasp_becomes_that_of_most_branches_around(spread):
    assert spread.shows("grasping").mean() > 0.9


@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_every_pose_that_arrived_grasps(spread, engine):
    cells = np.nonzero(spread.shows("grasping"))
    controls = spread.controls[cells]
    report = check_grasp(FOOT, controls, GRID.at(*cells), engine=engine)
    assert (report.grasping & report.feasible).all()


def test_nothing_goes_where_nothing_is_wanted():
    found, goal = seeded(), np.zeros(GRID.shape, dtype=int)
    goal[:2] = MERITS["grasping"]
    propagate(found, FINGERS, goal)
    assert found.shows("grasping")[:2].sum() > 7
    assert not found.merit[2:].any()


def test_without_a_pose_nothing_moves():
    found = Witnesses(FOOT, GRID, Criteria())
    propagate(found, FINGERS, WANTED)
    assert not found.merit.any()


def test_the_same_again(spread):
    again = seeded()
    propagate(again, FINGERS, WANTED)
    assert np.array_equal(again.controls, spread.controls, equal_nan=True)


def test_turned_poses_stay_within_their_limits():
    rng = np.random.default_rng(0)
    poses = rng.integers(0, 2, (400, FOOT.phalanx_count)).astype(float)
    made = turned(poses, rng)
    assert (made >= 0).all()
    assert (made <= 1).all()
    moved = (made != poses).mean(axis=1)
    # Half of the steps at a limit lead beyond it; shares are 0.2, 0.5 or 1.
    assert moved.max() <= 1
    assert 0.1 < moved.mean() < 0.5
