"""Expansions enclose the functions that they stand for."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zygopin.expansion import Expansion, most_under

SEEDS = st.integers(0, 2**32 - 1)


def boxes(seed, count=40, width=0.5):
    """Boxes of three variables, and points in each: (variables, points)."""
    rng = np.random.default_rng(seed)
    middle, half = rng.uniform(-2, 2, (3, count)), rng.uniform(0, width, (3, count))
    points = middle + half * rng.uniform(-1, 1, (200, 3, count))
    variables = [Expansion.variable(i, middle, half) for i in range(3)]
    return variables, np.moveaxis(points, 1, 0)


def assert_encloses(expansion, values):
    margin = 1e-12 * (1 + np.abs(expansion.value))
    assert (values >= expansion.low - margin).all()
    assert (values <= expansion.high + margin).all()


@given(SEEDS)
def test_arithmetic_encloses_every_value_in_the_box(seed):
    (x, y, z), (a, b, c) = boxes(seed)
    assert_encloses(x + y - z * 2.0 + 1.0, a + b - 2 * c + 1)
    assert_encloses(x * y - z * x, a * b - c * a)
    assert_encloses((x * y).squared() - z, (a * b) ** 2 - c)
    cosine, sine = (x + y * z).wave()
    assert_encloses(cosine, np.cos(a + b * c))
    assert_encloses(sine * x, np.sin(a + b * c) * a)


@given(SEEDS)
def test_roots_and_inverses_enclose_where_the_function_keeps_its_distance(seed):
    (x, y, _), (a, b, _) = boxes(seed)
    square = x.squared() + y.squared() + 0.3
    assert_encloses(square.root(0.3), np.sqrt(a**2 + b**2 + 0.3))
    assert_encloses(square.inverse(0.3), 1 / (a**2 + b**2 + 0.3))


def test_slack_shrinks_with_the_square_of_the_box():
    middle = np.array([[0.7], [0.2]])

    def slack(width):
        half = np.full((2, 1), width)
        x, y = (Expansion.variable(i, middle, half) for i in range(2))
        return ((x * y).wave()[0] * (x + 2.0).inverse(1.0)).slack[0]

    assert slack(0.01) / slack(0.005) == pytest.approx(4.0, rel=0.05)


def test_a_sum_s_bounds_by_hand():
    middle, half = np.array([[1.0], [2.0]]), np.array([[0.5], [0.25]])
    x, y = (Expansion.variable(i, middle, half) for i in range(2))
    total = x * 2.0 - y
    assert (total.low[0], total.high[0]) == (-1.25, 1.25)


@given(SEEDS)
def test_the_bound_under_conditions_holds_where_they_are_met(seed):
    (x, y, z), (a, b, c) = boxes(seed)
    goal, least = x + y * z, [x * y, z - x]
    bound = most_under(goal, least, passes=2)
    values, met = a + b * c, (a * b >= 0) & (c - a >= 0)
    assert (np.where(met, values, -np.inf) <= bound + 1e-12).all()
    assert (bound <= goal.high + 1e-12).all()


def test_a_condition_cuts_the_bound_exactly_where_all_is_linear():
    # The largest x + y with x + 2y <= 1 in the square |x|, |y| <= 1: at (1, 0).
    middle, half = np.zeros((2, 1)), np.ones((2, 1))
    x, y = (Expansion.variable(i, middle, half) for i in range(2))
    assert most_under(x + y, [-(x + y * 2.0) + 1.0])[0] == pytest.approx(1.0)
    assert most_under(x + y, [])[0] == 2.0
