"""The tangency system: its solutions, and that it has no others."""

from __future__ import annotations

import math

import numpy as np
import pytest
from entry_checks import broken, numbers

from zygopin import Foot, count_systems
from zygopin.paper import tangency, tangency_solver
from zygopin.paper.finger_plane import widths
from zygopin.paper.tangency import solved_branches, tangency_system
from zygopin.paper.tangency_solver import solve

FOOT = Foot.preset("paper")


@pytest.fixture
def fresh():
    """No solutions are kept, before or after."""
    solved_branches.cache_clear()
    yield
    solved_branches.cache_clear()


def test_the_system_holds():
    found = numbers(tangency_system())
    assert found["solutions"] > 100
    assert found["changed_radius"] == pytest.approx(1e-3)
    assert count_systems(FOOT, (1, 3), tangency.LEVELS) > found["solutions"]


@pytest.mark.usefixtures("fresh")
def test_the_printed_ellipse_solves_it_no_more(monkeypatch):
    printed = {"true": widths(FOOT)["printed"]}
    monkeypatch.setattr(tangency_solver, "widths", lambda _: printed)
    assert {"incidence", "theta", "t"} <= broken(tangency_system())


def test_a_phalanx_on_a_circle_by_hand():
    # Ω = 0: a phalanx from i straight down to −i, a circle of radius 1 around −1.
    foot = FOOT.replace(splay=0.0)
    lines = np.array(0.0 + 1j), np.array(-2j)
    for radius, misfit in ((1.0, 1.0), (1e-9, 1e-9), (0.25, 0.25)):
        found = solve(foot, lines, 0.0, radius)
        assert found.misfit == pytest.approx(misfit)
        assert found.t == pytest.approx(0.5)
    beside = solve(foot, (np.array(0.3 + 1j), np.array(-2j)), 0.2, 0.3)
    assert beside.misfit == pytest.approx(0, abs=1e-15)
    assert (beside.t, math.cos(beside.angle)) == pytest.approx((0.4, 1.0))


def test_a_line_that_touches_beyond_the_bone_is_no_solution():
    foot = FOOT.replace(splay=0.0)
    short = solve(foot, (np.array(0.3 + 1j), np.array(-0.5j)), 0.0, 0.3)
    assert (short.t, short.misfit) == pytest.approx((1.0, 0.5))
