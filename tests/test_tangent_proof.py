"""Proofs that no pose exists: never wrong, and given where a branch is out of reach."""

from __future__ import annotations

import math

import numpy as np
import pytest
from axes import one_finger
from tangencies import TOLERANCE, base_distance, cases, projected

from zygopin.branch_grid import BranchGrid
from zygopin.projection import BACK, PALM
from zygopin.tangent_poses import tangent_poses
from zygopin.tangent_proof import Criterion, farthest_wrap, unproved

Y = np.array([0.0, 1.0, 0.0])


def grid_around(view, radii, rng):
    """A grid with the given radii at one height, and others; the row of the height."""
    foot, axis, centre = view
    others = centre[2] + foot.size * rng.standard_normal(3)
    heights = np.unique([centre[2], *others])[:: rng.choice([-1, 1])]
    more = radii.mean() * np.array([0.4, 0.9, 1.3])
    grid = BranchGrid(heights, np.unique([*radii, *more]), axis, centre[:2])
    return grid, int(np.flatnonzero(heights == centre[2])[0])


def tangent_cells(view, rank, made, rng):
    """A grid, and its cells on which phalanx `rank` has contacts: (grid, asked)."""
    grid, row = grid_around(view, made.radius, rng)
    asked = np.zeros((view[0].phalanx_count, *grid.shape), dtype=bool)
    asked[rank - 1, row, np.searchsorted(grid.radii, made.radius)] = True
    return grid, asked


def extreme(made, solid, view):
    """The contacts of least and largest radius and wrap, off the base if solid."""
    made = made.take((made.radius <= base_distance(view)) | (not solid))
    if not len(made.radius):
        return made
    keys = (made.radius, -made.radius, made.wrap, -made.wrap)
    return made.take(np.unique([np.argmin(key) for key in keys]))


@pytest.mark.parametrize("first", range(0, 12, 2))
def test_no_branch_with_a_contact_is_proved_out(first):
    rng, tried = np.random.default_rng(first), 0
    for view, finger, rank, _, solid, made in cases(range(first, first + 2), most=4):
        made = extreme(made, solid, view)
        if len(made.radius):
            grid, asked = tangent_cells(view, rank, made, rng)
            criterion = Criterion(TOLERANCE * view[0].size, solid)
            left = unproved(finger, grid, asked, criterion)
            assert np.array_equal(left, asked)
            tried += int(asked.sum())
    assert tried


@pytest.mark.parametrize("first", range(100, 104, 2))
def test_no_branch_with_a_contact_that_far_round_is_proved_out(first):
    rng = np.random.default_rng(first)
    for view, finger, rank, _, solid, made in cases(range(first, first + 2), most=4):
        made = extreme(made, solid, view)
        for i in range(len(made.radius))[-1:]:
            one = made.take(np.array([i]))
            grid, asked = tangent_cells(view, rank, one, rng)
            criterion = Criterion(TOLERANCE * view[0].size, solid)
            beyond = np.full(grid.shape, 1.0)
            beyond[asked[rank - 1]] = one.wrap[0] - 10 ** rng.uniform(-6, -1)
            assert unproved(finger, grid, asked, criterion, beyond=beyond)[asked].all()


def test_bounds_on_the_wrap_hold_for_solid_contacts():
    tried = 0
    for view, finger, rank, _, _, made in cases(range(200, 205), solids=(True,)):
        made = made.take(made.radius <= base_distance(view))
        if not len(made.radius):
            continue
        radii, places = np.unique(made.radius, return_inverse=True)
        grid = BranchGrid(view[2][2], radii, view[1], view[2][:2])
        tolerance = TOLERANCE * view[0].size
        most = farthest_wrap(finger, grid, rank, tolerance)[0, places]
        wound = np.minimum(made.wrap, 2 * math.pi - made.wrap)
        assert (np.abs(wound) <= most + 1e-12).all()
        tried += len(made.radius)
    assert tried > 10


def test_the_farthest_wraps_by_hand():
    finger = projected(one_finger(2, rho=2.0, scale=2.0), Y)
    grid = BranchGrid([-2.0], [0.5, 1.0, 1.9, 2.1])
    # Lengths 1 and 0.5. The tangent from 2 away is longer than the finger for the
    # thinner two: cosines from the triangle's sides. For r = 1.9 the rest is an arc.
    one, two = (farthest_wrap(finger, grid, rank, 1e-12)[0] for rank in (1, 2))
    assert np.isneginf(one[[0, 3]]).all()
    assert one[1] == pytest.approx(0.0, abs=1e-5)
    assert two[0] == pytest.approx(0.0, abs=1e-5)
    assert two[1] == pytest.approx(math.acos((4 + 1 - 2.25) / 4))
    tangent = math.sqrt(4 - 1.9**2)
    arc = math.acos(1.9 / 2) + (1.5 - tangent) / 1.9
    assert two[2] == pytest.approx(arc)
    assert np.isneginf(two[3])


def everything(finger, grid):
    return np.broadcast_to(grid.valid, (len(finger.lengths), *grid.shape)).copy()


@pytest.mark.parametrize("solid", [True, False])
def test_a_branch_out_of_reach_is_proved_out(solid):
    finger = projected(one_finger(3, omega=1.0), Y)
    grid = BranchGrid([-3.0, -2.0, 2.0], [0.1, 0.3, 0.5])
    left = unproved(finger, grid, everything(finger, grid), Criterion(1e-6, solid))
    assert not left.any()


def test_one_phalanx_is_decided_as_its_circle_says():
    # Length 1, straight down at 90 degrees: tangent to a circle at (x, z) with
    # pitch in [0, 90] degrees and the foot of the perpendicular within the bone.
    finger = projected(one_finger(1, rho=2.0, scale=2.0, omega=math.pi / 2), Y)
    heights, radii = np.linspace(-1.5, 0.7, 24), np.linspace(0.03, 1.2, 20)
    grid = BranchGrid(heights, radii, Y, (0.6, 0.0))
    asked = everything(finger, grid)
    left = unproved(finger, grid, asked, Criterion(1e-9))[0]
    distance = np.hypot(0.6, heights)[:, None]
    with np.errstate(invalid="ignore"):
        off = np.arcsin(radii / distance)
        tangent = np.sqrt(distance**2 - radii**2)
    reached, nearly = tangent <= 1, tangent <= 1.03
    centre = -np.arctan2(heights, 0.6)[:, None]
    # How far the nearer of the two pitches is off its range.
    pitch = np.stack([centre - off, centre + off])
    lack = np.fmax(-pitch, pitch - math.pi / 2).min(axis=0)
    expected = asked[0] & reached & (lack <= 0)
    assert not (expected & ~left).any()
    # As finely as the search resolves: a part of the finger's length.
    assert not (left & ~(asked[0] & nearly & (lack <= 0.03))).any()
    assert 0.1 < expected.mean() < 0.9


def test_a_straight_toe_lies_only_on_branches_below_and_above_it():
    # A joint that hardly turns: the circle's top, or its bottom, is at height 0.
    finger = projected(one_finger(3, omega=1e-6), Y)
    heights = np.array([-0.5, -0.3, 0.3, 0.5])
    grid = BranchGrid(heights, [0.2, 0.3, 0.4, 0.5], Y, (0.9, 0.0))
    left = unproved(finger, grid, everything(finger, grid), Criterion(1e-5))
    expected = np.abs(heights)[:, None] == grid.radii
    assert np.array_equal(left.any(axis=0), expected)
    # 0.9 along: the second of the lengths 0.618, 0.382, 0.236.
    assert np.array_equal(left[1], expected)
    assert not left[[0, 2]].any()


FOOT = one_finger(2, 0.2, rho=1.2, omega=1.0, thickness=0.05)
ONE = one_finger(1, 0.2, 0.3, omega=1.0, thickness=0.05)
BUDGET = 4000
"""Boxes for one phalanx and side: the search is cut short, its answer still holds."""

GRID = BranchGrid(np.linspace(0.4, -1.6, 7), np.linspace(0.05, 0.8, 5), (0.2, 1, 0.1))


@pytest.mark.parametrize("solid", [True, False])
def test_a_pose_and_a_proof_exclude_each_other(solid):
    finger, criterion = projected(FOOT, GRID.axis), Criterion(1e-6, solid)
    asked = everything(finger, GRID)
    left = unproved(finger, GRID, asked, criterion)
    found = np.zeros_like(left)
    for side in (PALM, BACK):
        poses = tangent_poses(finger, GRID, asked, side=side, solid=solid)
        found |= np.isfinite(poses.wrap)
    assert not (found & ~left).any()
    assert found.any()
    assert (asked & ~left).any()
    assert not (left & ~asked).any()


def test_what_enters_is_proved_out_only_if_solid():
    finger = projected(FOOT, GRID.axis)
    asked = everything(finger, GRID)
    loose, solid = (
        unproved(finger, GRID, asked, Criterion(1e-6, flag)) for flag in (False, True)
    )
    assert not (solid & ~loose).any()
    poses = tangent_poses(finger, GRID, asked & ~solid, side=PALM, solid=False)
    assert np.isfinite(poses.wrap[1]).any()


def test_the_answer_for_a_grid_is_that_for_its_branches():
    finger, criterion = projected(ONE, GRID.axis), Criterion(1e-6)
    asked = everything(finger, GRID)
    whole = unproved(finger, GRID, asked, criterion)
    for row, column in ((0, 0), (2, 3), (3, 1), (4, 4), (6, 2)):
        one = BranchGrid(GRID.heights[row], GRID.radii[column], GRID.axis)
        part = asked[:, row : row + 1, column : column + 1]
        found = unproved(finger, one, part, criterion)
        assert np.array_equal(found[:, 0, 0], whole[:, row, column])


def test_a_height_through_the_base_in_the_middle_proves_nothing_of_the_others():
    finger, criterion = projected(ONE, Y), Criterion(1e-6)
    for heights in ([-0.5, 0.5], [-0.5, 0.0, 0.5], [-0.5, 0.5 + 1e-13]):
        grid = BranchGrid(heights, [0.2, 0.3])
        asked = everything(finger, grid)
        left = unproved(finger, grid, asked, criterion)
        assert left[0, 0].all()


def test_a_contact_behind_is_found_there_and_nowhere_else():
    # The straight toe passes under the branch: 59 degrees back, its back touching.
    finger = projected(one_finger(1, omega=0.5), Y)
    grid, asked = BranchGrid([0.3], [0.3], Y, (0.5, 0.0)), np.ones((1, 1, 1), bool)
    wrap = tangent_poses(finger, grid, asked, side=BACK).wrap.item()
    assert wrap == pytest.approx(-math.atan2(0.5, 0.3))
    for sense in (1, -1):
        criterion = Criterion(1e-6, sense=sense)
        for off, left in ((-1e-6, True), (0.1, False)):
            bound = np.full((1, 1), sense * wrap + off)
            found = unproved(finger, grid, asked, criterion, beyond=bound)
            assert found.all() == left
    palmar = Criterion(1e-6, palmar=True)
    assert not unproved(finger, grid, asked, palmar).any()


def test_contacts_not_far_enough_round_are_proved_out():
    finger, criterion = projected(FOOT, GRID.axis), Criterion(1e-6)
    grid = BranchGrid([-0.5, -0.6], [0.3, 0.4], GRID.axis)
    asked = everything(finger, grid)
    poses = tangent_poses(finger, grid, asked, side=PALM)
    most = np.nanmax(poses.wrap, axis=0)
    for beyond, possible in ((most - 0.01, True), (most + 0.3, False)):
        left = unproved(finger, grid, asked, criterion, beyond=beyond)
        assert (left.any(axis=0) == possible).all()


@pytest.mark.parametrize("factor", [1e-4, 1e3])
def test_similar_feet_are_proved_alike(factor):
    large = ONE.replace(scale=factor, thickness=factor * ONE.thickness)
    answers = []
    for foot, size in ((ONE, 1.0), (large, factor)):
        grid = BranchGrid(GRID.heights * size, GRID.radii * size, GRID.axis)
        finger = projected(foot, GRID.axis)
        asked = everything(finger, grid)
        answers.append(unproved(finger, grid, asked, Criterion(1e-6 * size)))
    assert np.array_equal(*answers)


def test_mirrored_branches_are_proved_alike():
    answers = []
    for sense in (1, -1):
        foot = one_finger(1, sense * 0.2, 0.3, omega=1.0, thickness=0.05)
        axis = GRID.axis * (1, sense, 1)
        grid = BranchGrid(GRID.heights, GRID.radii, axis, (0.1, 0.0))
        finger = projected(foot, -axis if sense < 0 else axis)
        asked = everything(finger, grid)
        answers.append(unproved(finger, grid, asked, Criterion(1e-6)))
    assert np.array_equal(*answers)


def test_of_a_finger_seen_edgewise_nothing_is_proved():
    grid = BranchGrid([-0.3, -9.0], [0.1], (1, 0, 0), (0, 0.2))
    finger = projected(one_finger(2), grid.axis)
    asked = np.array([[[True], [False]], [[False], [True]]])
    assert np.array_equal(unproved(finger, grid, asked, Criterion(1e-6)), asked)


def test_nothing_asked_is_nothing_left():
    finger = projected(FOOT, GRID.axis)
    asked = np.zeros((2, *GRID.shape), bool)
    assert not unproved(finger, GRID, asked, Criterion(1e-6)).any()
