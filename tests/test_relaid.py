"""Poses moved to other branches: what was tangent is tangent there, by the checks."""

from __future__ import annotations

import numpy as np
import pytest

from zygopin import Foot, check_grasp
from zygopin.branch_grid import BranchGrid
from zygopin.perch import search_perch
from zygopin.relaid import relaid
from zygopin.toe_contacts import ToeSearch
from zygopin.witnesses import tangent_sides

FOOT = Foot.preset("parrot")
AXIS = (0.2, 1.0, 0.1)


def grid_beside(branch):
    """Branches around one: it is the middle one."""
    size, off = FOOT.size, np.array([-1.0, 0.0, 1.0])
    heights = branch.centre[2] + 0.002 * size * off
    radii = branch.radius + 0.001 * size * off
    return BranchGrid(heights, radii, AXIS, branch.centre[:2])


@pytest.fixture(scope="module", params=[0.12, 0.2, 0.35])
def planned(request):
    """A grasp of the middle branch, the branches around it, and the sides."""
    radius = request.param * FOOT.size
    branch = BranchGrid(-radius - 0.12 * FOOT.size, radius, AXIS).at(0, 0)
    plan = search_perch(FOOT, branch)
    assert plan.grasping
    return plan, grid_beside(branch), tangent_sides(plan.report)


def moved(planned, row, column, sides):
    plan, grid, _ = planned
    fingers, cell = ToeSearch(FOOT, grid).fingers, (np.array([row]), np.array([column]))
    return relaid(fingers, grid, cell, plan.controls[None], sides[None])[0]


def test_a_pose_stays_where_it_is_on_its_own_branch(planned):
    assert moved(planned, 1, 1, planned[2]) == pytest.approx(planned[0].controls)


def test_what_is_laid_again_is_tangent_beside(planned):
    plan, grid, sides = planned
    for row, column in ((0, 0), (0, 2), (1, 2), (2, 0), (2, 1)):
        pose = moved(planned, row, column, sides)
        near = check_grasp(FOOT, pose, grid.at(row, column))
        # But where the joint cannot turn that far, or the phalanx is too short now.
        laid = (pose < 1) & (sides != 0) & (np.abs(near.t - 0.5) <= 0.5)
        assert laid.sum() >= 0.7 * (sides != 0).sum()
        assert np.abs(near.clearance[laid]).max() < 1e-12 * FOOT.size
        assert np.array_equal(tangent_sides(near)[laid], sides[laid])
        # Joints that close no contact keep their angles.
        assert np.array_equal(pose[sides == 0], plan.controls[sides == 0])


def test_without_contacts_nothing_moves(planned):
    pose = moved(planned, 0, 2, np.zeros_like(planned[2]))
    assert np.array_equal(pose, planned[0].controls)


def test_no_poses_are_no_poses(planned):
    _, grid, _ = planned
    none = np.zeros(0, dtype=int)
    empty = np.zeros((0, FOOT.phalanx_count))
    fingers = ToeSearch(FOOT, grid).fingers
    assert relaid(fingers, grid, (none, none), empty, empty.astype(np.int8)).shape == (
        0,
        FOOT.phalanx_count,
    )
