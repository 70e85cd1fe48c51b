"""Bounds on the junction before a contact: never wrong, and of use."""

from __future__ import annotations

import math

import numpy as np
import pytest
from axes import one_finger
from tangencies import (
    TOLERANCE,
    base_distance,
    cases,
    projected,
    random_controls,
    random_view,
    tangencies,
)

from zygopin.branch_grid import BranchGrid
from zygopin.contact_hull import Circles, Criterion, contact_possible
from zygopin.projection import BACK, PALM
from zygopin.tangent_poses import tangent_poses

Y = np.array([0.0, 1.0, 0.0])


def circles(finger, centre, radius, beyond=-np.inf):
    """Branches of one centre."""
    at = np.full(len(radius), complex(finger.flat(centre)))
    return Circles(at, np.asarray(radius), np.broadcast_to(beyond, len(radius)))


@pytest.mark.parametrize("first", range(300, 316, 4))
def test_no_contact_is_ruled_out(first):
    rng, tried = np.random.default_rng(first), 0
    for view, finger, rank, side, solid, made in cases(range(first, first + 4)):
        made = made.take((made.radius <= base_distance(view)) | (not solid))
        criterion = Criterion(TOLERANCE * view[0].size, solid)
        beyond = made.wrap - 10 ** rng.uniform(-7, -1, len(made.wrap))
        for least in (-np.inf, beyond):
            seen = circles(finger, view[2], made.radius, least)
            assert contact_possible(finger, seen, rank, side, criterion).all()
            tried += len(made.radius)
    assert tried > 20


@pytest.mark.parametrize("first", range(400, 408, 4))
def test_no_contact_with_a_twig_is_ruled_out(first):
    # Thinner than ranges are fine: what is bounded may lie inside the twig.
    tried = 0
    for seed in range(first, first + 4):
        (foot, axis, away), rng = random_view(seed), np.random.default_rng(seed)
        near = away / np.linalg.norm(away) * rng.uniform(0.05, 0.8) * foot.size
        view, finger = (foot, axis, near), projected(foot, axis)
        for rank in range(1, len(finger.lengths) + 1):
            controls = random_controls(rng, 4000, len(finger.lengths))
            made = tangencies(*view, rank, controls)
            made = made.take(made.radius < 0.03 * view[0].size)
            for side in (PALM, BACK):
                some = made.contacts(side=side, solid=True, least=1e-5 * view[0].size)
                some = some.take(some.radius <= base_distance(view))
                criterion = Criterion(TOLERANCE * view[0].size)
                for least in (-np.inf, some.wrap - 1e-6):
                    seen = circles(finger, view[2], some.radius, least)
                    assert contact_possible(finger, seen, rank, side, criterion).all()
                    tried += len(some.radius)
    assert tried > 5


@pytest.mark.parametrize("omega", [3.11, 3.14, 1.5616519, 6.2])
@pytest.mark.parametrize("axis", [(0, 1, 0), (-0.62, 0.77, 0.16)])
def test_closed_joints_near_a_half_turn_are_not_ruled_out(omega, axis):
    # A range of wraps then holds pitches on both sides of a half turn.
    axis = np.array(axis) / np.linalg.norm(axis)
    foot = one_finger(2, omega=omega, rho=1.2)
    finger, rng = projected(foot, axis), np.random.default_rng(1)
    for centre in rng.uniform(-0.3, 0.3, (40, 3)):
        for rank in (1, 2):
            made = tangencies(foot, axis, centre, rank, np.ones((1, 2)))
            for side in (PALM, BACK):
                one = made.contacts(side=side, solid=False)
                seen = circles(finger, centre, one.radius, one.wrap - 1e-7)
                criterion = Criterion(1e-6, solid=False)
                assert contact_possible(finger, seen, rank, side, criterion).all()


@pytest.mark.parametrize("share", [0.3, 0.1, 0.03])
def test_narrow_views_rule_nothing_out_that_is_there(share):
    # The phalanx's projected length changes quickly with the wrap.
    axis = np.array([1.0, share, 0.7])
    axis /= np.linalg.norm(axis)
    foot = one_finger(1, omega=1.76)
    finger, rng = projected(foot, axis), np.random.default_rng(2)
    for centre in rng.uniform(-0.4, 0.4, (30, 3)):
        made = tangencies(foot, axis, centre, 1, rng.random((60, 1)))
        for side in (PALM, BACK):
            some = made.contacts(side=side, solid=False)
            seen = circles(finger, centre, some.radius, some.wrap - 1e-6)
            criterion = Criterion(1e-6, solid=False)
            assert contact_possible(finger, seen, 1, side, criterion).all()


def test_one_phalanx_is_ruled_out_where_its_circle_says():
    # Length 1, pitch 0 to 90 degrees, circles below: tangent from the base.
    finger = projected(one_finger(1, rho=2.0, scale=2.0, omega=math.pi / 2), Y)
    centre = np.array([-0.3j, -0.5j, -2.0j, -0.5 - 0.5j, 1 + 1j, 1.2 - 0.1j])
    radius = np.array([0.2, 0.4, 0.5, 0.2, 0.3, 0.4])
    seen = Circles(centre, radius, np.full(6, -np.inf))
    found = {
        side: contact_possible(finger, seen, 1, side, Criterion(1e-9)).tolist()
        for side in (PALM, BACK)
    }
    # The third is out of reach, the fourth behind, the fifth above; the last one's
    # palm tangent starts upward, its back's ends before the phalanx does not.
    assert found[PALM] == [True, True, False, False, False, False]
    assert found[BACK] == [False, False, False, False, False, False]


@pytest.mark.parametrize("solid", [True, False])
@pytest.mark.parametrize("rank", [1, 2, 3])
def test_branches_out_of_reach_are_ruled_out(rank, solid):
    finger = projected(one_finger(3, 0.3, omega=1.0), Y)
    seen = Circles(np.array([-3j, 4.0 + 0j, 3j]), np.full(3, 0.4), np.full(3, -np.inf))
    for side in (PALM, BACK):
        criterion = Criterion(1e-6, solid)
        assert not contact_possible(finger, seen, rank, side, criterion).any()


def test_contacts_farther_round_than_the_finger_is_long_are_ruled_out():
    finger = projected(one_finger(3, omega=1.5), Y)
    beyond = np.array([0.0, 1.0, 2.9, 4.5])
    seen = Circles(np.full(4, -0.6j), np.full(4, 0.59), beyond)
    found = contact_possible(finger, seen, 3, PALM, Criterion(1e-6))
    # At most 1.236 long, on radius 0.59: no more than 2.1 rad and some margin.
    assert found.tolist() == [True, True, False, False]


@pytest.mark.parametrize("share", [0.9, 0.6])
def test_a_toe_bent_close_around_a_branch_is_not_ruled_out(share):
    # Chords of a circle hardly wider than the branch: no shorter way leads around.
    foot = one_finger(9, math.pi / 60, rho=1.001, omega=0.5)
    finger, step = projected(foot, Y), foot.lengths[0]
    radius = step / (2 * math.tan(0.2))
    grid = BranchGrid(-radius * 1.001, share * radius)
    poses = tangent_poses(finger, grid, np.ones((9, 1, 1), bool))
    for rank in np.flatnonzero(np.isfinite(poses.wrap[:, 0, 0])) + 1:
        beyond = poses.wrap[rank - 1, 0] - 1e-6
        seen = Circles(grid.centres(finger), grid.radii, beyond)
        assert contact_possible(finger, seen, rank, PALM, Criterion(1e-6)).all()
    assert np.nanmax(poses.wrap) > 2


def test_ways_through_the_branch_are_ruled_out_only_if_solid():
    # Random poses that enter: some of the branches are ruled out for solid ones.
    foot, counts = one_finger(3, rho=1.2, omega=1.2), {}
    finger, centre = projected(foot, Y), np.array([0.5, 0.0, -0.3])
    controls = np.random.default_rng(3).random((3000, 3))
    made = tangencies(foot, Y, centre, 3, controls).contacts(side=PALM, solid=False)
    seen = circles(finger, centre, made.radius, made.wrap - 1e-3)
    for solid in (True, False):
        found = contact_possible(finger, seen, 3, PALM, Criterion(1e-6, solid))
        counts[solid] = found.mean()
    assert counts[False] == 1
    assert counts[True] < 1


def test_the_answer_for_many_circles_is_that_for_each():
    finger, rng = projected(one_finger(3, 0.4, omega=1.2), Y), np.random.default_rng(4)
    centre = rng.uniform(-1.5, 1.5, 900) + 1j * rng.uniform(-1.5, 0.5, 900)
    many = Circles(centre, rng.uniform(0.05, 0.9, 900), rng.uniform(-1, 2, 900))
    whole = contact_possible(finger, many, 2, PALM, Criterion(1e-6))
    assert 0.02 < whole.mean() < 0.98
    for i in range(0, 900, 60):
        one = Circles(*(x[i : i + 1] for x in (centre, many.radius, many.beyond)))
        assert contact_possible(finger, one, 2, PALM, Criterion(1e-6))[0] == whole[i]


def test_no_circles_have_no_answer():
    finger = projected(one_finger(2), Y)
    none = Circles(np.zeros(0, complex), np.zeros(0), np.zeros(0))
    assert contact_possible(finger, none, 2, PALM, Criterion(1e-6)).shape == (0,)
