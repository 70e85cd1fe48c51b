"""Proofs that no two toes are a quarter turn apart: never wrong, and of use."""

from __future__ import annotations

import math

import numpy as np
import pytest
from planted import planted

from zygopin import Finger, Foot
from zygopin.branch_grid import BranchGrid
from zygopin.quarter_turn import grasp_possible
from zygopin.toe_contacts import ToeSearch

PARROT = Foot.preset("parrot")
TWO = Foot(
    rho=1.2, omega=1.4, fingers=(Finger("a", 3, 0.2), Finger("b", 2, math.pi - 0.2))
)


def possible(foot, grid, *, wrap=None, tangent=None, open_=None):
    """What is left of a grid, with nothing known unless it is given."""
    search, every = ToeSearch(foot, grid), (len(foot.fingers), *grid.shape)
    return grasp_possible(
        search,
        foot.opposable_pairs,
        np.ones(grid.shape, dtype=bool) if open_ is None else open_,
        np.ones(every, dtype=bool) if tangent is None else tangent,
        np.full(every, np.nan) if wrap is None else wrap,
        1e-6 * foot.size,
    )


@pytest.mark.parametrize("axis", [(0.0, 1.0, 0.0), (0.3, 1.0, -0.2)])
@pytest.mark.parametrize("foot", [PARROT, TWO], ids=["parrot", "two"])
@pytest.mark.parametrize("known", [False, True])
def test_no_grasp_is_disproved(foot, axis, known):
    found = [planted(foot, seed, axis, count=60_000) for seed in range(2)]
    height, radius = (
        np.concatenate([getattr(each, name)[each.grasping] for each in found])[:20]
        for name in ("height", "radius")
    )
    assert len(height) > 5
    heights, rows = np.unique(height, return_inverse=True)
    radii, columns = np.unique(radius, return_inverse=True)
    grid = BranchGrid(heights, radii, axis)
    open_ = np.zeros(grid.shape, dtype=bool)
    open_[rows, columns] = True
    every = np.broadcast_to(open_, (len(foot.fingers), *grid.shape))
    wrap = ToeSearch(foot, grid).poses(every).wrap if known else None
    assert np.array_equal(possible(foot, grid, wrap=wrap, open_=open_), open_)


def test_toes_too_short_for_a_quarter_turn_are_disproved():
    # One phalanx each, down to 45 degrees: tangent lines from the base meet the circle
    # of radius r at distance d at angles of at most acos(r/d) from the nearest line,
    # so 90 degrees apart only if r/d is below cos 45, and the tangent is in reach.
    foot = Foot(
        rho=2.0,
        scale=2.0,
        omega=math.pi / 2,
        fingers=(Finger("a", 1, 0.0), Finger("b", 1, math.pi)),
    )
    distance, radii = 0.9, np.array([0.3, 0.5, 0.6, 0.66, 0.8])
    left = possible(foot, BranchGrid([-distance], radii))[0]
    apart = 2 * np.arccos(radii / distance)
    assert np.array_equal(left, apart >= math.pi / 2)


def test_known_wraps_of_a_quarter_turn_prove_nothing():
    grid = BranchGrid([-0.5, -0.6], [0.1, 0.2])
    wrap = np.full((2, 2, 2), math.pi / 4)
    assert possible(TWO, grid, wrap=wrap).all()


def test_only_what_is_open_is_left():
    grid = BranchGrid([-0.5, -0.6], [0.1, 0.2])
    open_ = np.array([[True, False], [False, True]])
    left = possible(TWO, grid, open_=open_)
    assert not (left & ~open_).any()


def test_toes_that_cannot_be_tangent_leave_nothing():
    grid = BranchGrid([-0.5, -0.6], [0.1, 0.2])
    tangent = np.ones((2, 2, 2), dtype=bool)
    tangent[1] = False
    assert not possible(TWO, grid, tangent=tangent).any()


def test_branches_out_of_reach_are_disproved():
    grid = BranchGrid([-9.0, -7.0], [0.1, 0.2])
    assert not possible(TWO, grid).any()


def test_what_is_left_is_little_more_than_what_is_found():
    # The share of branches that are neither grasped in a random pose nor disproved.
    search_grid = BranchGrid(np.linspace(-0.3, -2.2, 10), np.linspace(0.05, 0.6, 9))
    every = np.broadcast_to(search_grid.valid, (2, *search_grid.shape))
    toes = ToeSearch(TWO, search_grid).poses(every)
    left = possible(TWO, search_grid, wrap=toes.wrap, open_=search_grid.valid)
    around = np.nan_to_num(toes.wrap.sum(axis=0), nan=-9.0) >= math.pi / 2
    assert not (around & ~left & search_grid.valid).any()
    assert (left & ~around).mean() < 0.08
