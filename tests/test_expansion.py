"""Bounds of expansions hold, with conditions and without."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zygopin.expansion import Expansion, most_under

SEEDS = st.integers(0, 2**32 - 1)


def linear(values, slopes, half):
    """Functions that are linear in the variables, over one box."""
    slope = np.array(slopes, float)[:, None]
    half = np.array(half, float)[:, None]
    return Expansion(np.array([values], float), slope, np.zeros(1), half)


def test_an_upper_bound_by_hand():
    # 2x - y + 0.5 for |x| <= 0.5, |y| <= 0.25.
    assert linear(0.5, (2.0, -1.0), (0.5, 0.25)).high[0] == 1.75


@given(SEEDS)
def test_the_bound_under_conditions_holds_where_they_are_met(seed):
    rng = np.random.default_rng(seed)
    half = rng.uniform(0, 1, (3, 40))
    shifts = half * rng.uniform(-1, 1, (200, 3, 40))
    made = [
        Expansion(
            rng.standard_normal(40),
            rng.standard_normal((3, 40)),
            rng.uniform(0, 0.2, 40),
            half,
        )
        for _ in range(3)
    ]
    values = [
        each.value
        + np.sum(each.slope * shifts, axis=1)
        + each.slack * rng.uniform(-1, 1, (200, 40))
        for each in made
    ]
    goal, *conditions = made
    bound = most_under(goal, conditions, passes=2)
    met = np.all([each >= 0 for each in values[1:]], axis=0)
    assert (np.where(met, values[0], -np.inf) <= bound + 1e-12).all()
    assert (bound <= goal.high + 1e-12).all()


def test_a_condition_cuts_the_bound_exactly_where_all_is_linear():
    # The largest x + y with x + 2y <= 1 in the square |x|, |y| <= 1: at (1, 0).
    goal, square = linear(0, (1, 1), (1, 1)), (1, 1)
    assert most_under(goal, [linear(1, (-1, -2), square)])[0] == pytest.approx(1.0)
    assert most_under(goal, [])[0] == 2.0
