"""Poses laid on branches are tangent in space, and nothing before them enters."""

from __future__ import annotations

import math

import numpy as np
import pytest
from axes import one_finger
from tangencies import cases, projected, random_view

from zygopin import Branch
from zygopin.branch_grid import BranchGrid
from zygopin.clearance import branch_clearance
from zygopin.kinematics import forward_kinematics
from zygopin.laid_contact import lay_on
from zygopin.projection import BACK, PALM
from zygopin.tangent_poses import FEW, TangentPoses, tangent_poses

Y = np.array([0.0, 1.0, 0.0])


def assert_tangent(foot, controls, branch, rank, *, solid):
    """By the clearance in space: touching inside the bone, nothing before inside."""
    near = branch_clearance(forward_kinematics(foot, controls), foot.radii, branch)
    margin = 1e-9 * foot.size
    assert np.abs(near.distance[..., rank - 1]).max() <= margin
    assert (np.abs(near.t[..., rank - 1] - 0.5) <= 0.5 + 1e-9).all()
    if solid:
        assert (near.distance[..., : rank - 1] >= -margin).all()


@pytest.mark.parametrize("seed", range(30))
@pytest.mark.parametrize("side", [PALM, BACK])
def test_what_fits_is_tangent_in_space(seed, side):
    foot, axis, centre = random_view(seed)
    finger, rng = projected(foot, axis), np.random.default_rng(seed)
    centres = np.full(400, complex(finger.flat(centre)))
    radius = np.abs(centres) * rng.uniform(0.05, 0.95, 400)
    for rank in range(1, foot.phalanx_count + 1):
        controls = np.zeros((400, foot.phalanx_count))
        controls[:, : rank - 1] = free = rng.random((400, rank - 1))
        made = lay_on(finger, free, centres, radius, side, solid=True)
        fits = made.excess == 0
        assert (made.control[fits] <= 1).all()
        controls[fits, rank - 1] = made.control[fits]
        if fits.any():
            branch = Branch(radius[fits], centre, axis)
            assert_tangent(foot, controls[fits], branch, rank, solid=True)


def test_contacts_in_space_are_laid_again():
    tried = 0
    for view, finger, rank, side, solid, made in cases(range(12)):
        foot, _, centre = view
        given = made.controls[:, rank - 1]
        made = made.take((given > 1e-6) & (given < 1 - 1e-6))
        centres = np.full(len(made.radius), complex(finger.flat(centre)))
        free = made.controls[:, : rank - 1]
        found = lay_on(finger, free, centres, made.radius, side, solid)
        assert (found.excess <= 1e-9 * foot.size).all()
        assert np.allclose(found.control, made.controls[:, rank - 1], atol=1e-6)
        assert np.allclose(found.wrap, made.wrap, atol=1e-6)
        tried += len(made.radius)
    assert tried > 100


def test_one_phalanx_on_a_branch_by_hand():
    # From the base, a tangent to a circle 2 away of radius 1 falls 30 degrees away
    # from the centre's direction: here straight down, so 60 degrees of pitch.
    finger = projected(one_finger(1, scale=4.0, omega=math.pi / 2), Y)
    one = (np.zeros((1, 0)), np.array([-2j]), np.ones(1))
    made = lay_on(finger, *one, PALM, solid=True)
    assert made.excess == [0]
    assert made.control == pytest.approx([2 / 3])
    assert made.wrap == pytest.approx([math.pi / 3])
    # The other side: 120 degrees, more than the joint turns.
    made = lay_on(finger, *one, BACK, solid=True)
    assert made.control == pytest.approx([4 / 3])
    assert made.excess == pytest.approx(finger.lengths * math.pi / 6)


def test_what_does_not_fit_says_by_how_much():
    finger = projected(one_finger(1, scale=1.618033988749895, omega=1.5), Y)
    free, radius = np.zeros((3, 0)), np.array([0.5, 0.5, 0.5])
    centre = np.array([-0.3j, -2.5j, 2 - 0.5j])
    made = lay_on(finger, free, centre, radius, PALM, solid=True)
    tangent = math.sqrt(2.5**2 - 0.5**2)
    assert made.excess[0] >= 0.2
    assert made.excess[1] == pytest.approx(tangent - 1)
    assert made.excess[2] == pytest.approx(1.0)


def test_phalanges_that_enter_are_in_excess_if_solid():
    finger = projected(one_finger(2, scale=1.618033988749895, omega=3.0), Y)
    free, centre = np.zeros((1, 1)), np.array([0.5 - 0.1j])
    loose = lay_on(finger, free, centre, np.array([0.3]), PALM, solid=False)
    solid = lay_on(finger, free, centre, np.array([0.3]), PALM, solid=True)
    assert solid.excess - loose.excess == pytest.approx([0.2])


@pytest.mark.parametrize("factor", [1e-3, 1e4])
def test_similar_feet_lie_alike(factor):
    foot, axis, centre = random_view(11)
    large = foot.replace(scale=factor, thickness=factor * foot.thickness)
    free, radius = np.random.default_rng(0).random((50, 1)), np.full(50, 0.2)
    made = []
    for each, size in ((foot, 1.0), (large, factor)):
        finger = projected(each, axis)
        at = np.full(50, complex(finger.flat(centre)) * size)
        made.append(lay_on(finger, free, at, radius * size, PALM, solid=True))
    assert np.allclose(made[0].control, made[1].control)
    assert np.allclose(made[0].wrap, made[1].wrap)
    assert np.allclose(made[0].excess * factor, made[1].excess, atol=1e-12 * factor)


FOOT = one_finger(4, 0.2, rho=1.2, omega=1.0, thickness=0.05)
HEIGHTS, RADII = np.linspace(-0.2, -1.4, 41), np.linspace(0.05, 0.8, 41)
GRID = BranchGrid(HEIGHTS[::8], RADII[::10], (0, 1, 0.2))
FINE = BranchGrid(HEIGHTS, RADII, (0, 1, 0.2))


def poses(grid=GRID, **options):
    finger = projected(FOOT, grid.axis)
    wanted = np.broadcast_to(grid.valid, (4, *grid.shape))
    return tangent_poses(finger, grid, wanted, **options)


@pytest.mark.parametrize("grid", [GRID, FINE], ids=["few", "many"])
@pytest.mark.parametrize("options", [{}, {"solid": False}, {"side": BACK}])
def test_poses_found_on_a_grid_are_tangent_in_space(options, grid):
    found = poses(grid, **options)
    for rank in range(1, 5):
        cells = np.nonzero(np.isfinite(found.wrap[rank - 1]))
        controls = found.controls[rank - 1][cells]
        assert ((controls >= 0) & (controls <= 1)).all()
        assert (controls[:, rank:] == 0).all()
        solid = options.get("solid", True)
        if len(cells[0]):
            assert_tangent(FOOT, controls, grid.at(*cells), rank, solid=solid)
    assert np.isfinite(found.wrap).any()
    assert np.isnan(found.wrap[:, ~grid.valid]).all()


def test_the_search_from_coarse_to_fine_misses_next_to_nothing():
    assert FINE.valid.sum() > FEW  # so that it begins on a coarser grid
    few, many = poses().wrap, poses(FINE).wrap[:, ::8, ::10]
    both = np.isfinite(few) & np.isfinite(many)
    assert both.sum() > 30
    assert (np.isfinite(few) != np.isfinite(many)).sum() <= 1
    assert np.abs(few - many)[both].max() < 0.15  # neither search is exhaustive


def test_the_best_pose_is_that_of_some_phalanx_nearest_to_the_aim():
    found = poses()
    for count, aim in ((2, 9.0), (4, 9.0), (4, 1.0)):
        wrap, controls = found.best(count, aim)
        assert controls.shape == (*GRID.shape, count)
        missed = np.abs(found.wrap[:count] - aim)
        least = np.fmin.reduce(missed, axis=0)
        assert np.array_equal(np.abs(wrap - aim), least, equal_nan=True)
        row, column = np.argwhere(np.isfinite(wrap))[0]
        rank = np.nanargmin(missed[:, row, column])
        same = found.controls[rank, row, column, :count]
        assert np.array_equal(controls[row, column], same)


def test_no_pose_is_no_best():
    wrap = np.array([[[np.nan]], [[1.0]]])
    found = TangentPoses(wrap, np.zeros((2, 1, 1, 2)))
    assert np.isnan(found.best(1, 9.0)[0]).all()
    assert found.best(2, 9.0)[0] == [[1.0]]


def test_an_aim_is_met_where_it_can_be():
    far, near = poses(), poses(aim=1.0)
    both = np.isfinite(far.wrap) & np.isfinite(near.wrap)
    off = np.abs(near.wrap - 1.0) - np.abs(far.wrap - 1.0)
    assert (off[both] <= 1e-3).all()
    assert (off[both] < -0.1).any()


def test_poses_are_the_same_each_time():
    assert np.array_equal(poses().wrap, poses().wrap, equal_nan=True)


def test_a_pose_at_a_joint_s_stop_keeps_its_control_within_one():
    for seed in range(40):
        rng = np.random.default_rng(seed)
        foot = one_finger(1, omega=rng.uniform(0.3, 1.5))
        centre = np.array([rng.uniform(0, 0.3), 0, -0.6])
        bones = forward_kinematics(foot, np.ones(1))
        near = branch_clearance(bones, foot.radii, Branch(0.01, centre, Y))
        radius = near.distance + 0.01
        grid = BranchGrid(centre[2], radius, Y, centre[:2])
        finger, wanted = projected(foot, Y), np.ones((1, 1, 1), bool)
        for side in (PALM, BACK):
            assert tangent_poses(finger, grid, wanted, side=side).controls.max() <= 1


def test_a_finger_seen_edgewise_has_none():
    grid = BranchGrid([-0.3], [0.1], (1, 0, 0), (0, 0.2))
    finger = projected(one_finger(2), grid.axis)
    found = tangent_poses(finger, grid, np.ones((2, 1, 1), bool))
    assert np.isnan(found.wrap).all()
