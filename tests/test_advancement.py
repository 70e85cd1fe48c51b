"""Conservative advancement: it stops at the first contact, and misses none."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import reals

from zygopin.advancement import first_reached, steps_by_speed

LEVEL = 1e-6


def advanced(function, rate, span, level=LEVEL):
    """First instant at which one distance falls to its level, and it then."""

    def look(time):
        distances = np.array([function(time)])
        return distances, float(steps_by_speed(distances, np.array([rate]))[0])

    time, distances = first_reached(look, span, np.array([level]))
    return time, distances[0]


def test_steps_are_distance_over_rate():
    distances, rates = np.array([2.0, 1.0, 5.0]), np.array([1.0, 2.0, 10.0])
    assert steps_by_speed(distances, rates) == pytest.approx([2.0, 0.5, 0.5])


def test_straight_fall_ends_where_it_meets_its_level():
    time, distance = advanced(lambda t: 1 - t, 1.0, (0.0, 5.0))
    assert -1e-15 <= distance <= LEVEL
    assert time == pytest.approx(1.0, abs=LEVEL)


def test_a_dip_far_shorter_than_the_span_is_not_missed():
    time, distance = advanced(lambda t: abs(t - 0.7) - 1e-9, 1.0, (0.0, 1e3))
    assert -1e-15 <= distance <= LEVEL
    assert time == pytest.approx(0.7, abs=2 * LEVEL)


def test_a_dip_that_stays_above_its_level_is_passed():
    time, distance = advanced(lambda t: abs(t - 0.7) + 2 * LEVEL, 1.0, (0.0, 2.0))
    assert time == 2.0
    assert distance == pytest.approx(1.3 + 2 * LEVEL)


def test_contact_at_the_start_or_at_the_end_counts():
    assert advanced(lambda t: t, 1.0, (0.0, 1.0))[0] == 0.0
    time, distance = advanced(lambda t: 1 - t, 1.0, (0.0, 1.0), level=0.0)
    assert time == 1.0
    assert distance == 0.0


def test_an_empty_span_is_looked_at_once():
    assert advanced(lambda _: 1.0, 1.0, (0.25, 0.25)) == (0.25, 1.0)


def test_steps_below_the_spacing_of_doubles_go_on():
    start = 2.0**40
    time, _ = advanced(lambda _: 1e-5, 1.0, (start, start + 1e-2))
    assert time == start + 1e-2


@given(
    st.lists(st.tuples(reals(0, 1), reals(-0.05, 0.5)), min_size=1, max_size=5),
    reals(0.1, 50.0),
)
def test_valleys_of_known_depth_are_met_in_order_and_none_is_missed(valleys, rate):
    # Least of cones |t − tᵢ|·rate + dᵢ: its rate is known, and so is its first root.
    def function(time):
        return min(rate * abs(time - t) + d for t, d in valleys)

    time, distance = advanced(function, rate, (0.0, 1.0))
    roots = [t + d / rate for t, d in valleys if d < 0]
    first = min((max(root, 0.0) for root in roots), default=None)
    if first is not None and function(0.0) > 0:
        assert distance <= LEVEL
        assert time <= first + 1e-12
        assert distance >= -1e-12
    if min(d for _, d in valleys) > LEVEL:
        assert time == 1.0
    if distance > LEVEL:
        assert time == 1.0
