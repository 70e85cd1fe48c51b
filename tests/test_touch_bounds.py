"""Bounds over boxes of controls hold for every control in the box, and are sharp."""

from __future__ import annotations

import numpy as np
import pytest
from axes import axes_around, one_finger

from zygopin.axis_chain import AxisChain
from zygopin.touch_bounds import BoxViews, Goal, lower_bounds, upper_bounds

FEET = [
    one_finger(1, 0.3, omega=3.0),
    one_finger(2, -0.4, 0.5, rho=1.1, omega=1.0, thickness=0.2),
    one_finger(4, 2.0, rho=1.2, omega=1.6, thickness=0.1),
    one_finger(6, 0.0, rho=1.05, omega=5.5),
]


def boxes_of(chain, count, seed):
    """Boxes of all sizes, and the axis of each."""
    rng = np.random.default_rng(seed)
    half = 0.5 * rng.random((chain.count, count)) ** rng.integers(1, 6, count)
    middle = half + (1 - 2 * half) * rng.random((chain.count, count))
    return middle, half, rng.integers(0, len(chain.base), count)


def goal_of(chain, limit, seed):
    """A limit, and directions of some witness."""
    witness = np.random.default_rng(seed).random((chain.count, len(chain.base)))
    nearest = chain.contact(witness, np.arange(len(chain.base)))
    return Goal(np.full(len(chain.base), limit), nearest.normal)


def samples(chain, middle, half, which):
    """D at corners and at random places of each box, shape (S, m)."""
    rng = np.random.default_rng(5)
    inside = [rng.uniform(-1, 1, middle.shape) for _ in range(60)]
    corners = [np.sign(part) for part in inside[:30]]
    return np.array(
        [chain.distance(middle + part * half, which) for part in inside + corners]
    )


@pytest.mark.parametrize("seed", [0, 1])
@pytest.mark.parametrize("foot", FEET)
def test_no_control_in_a_box_goes_beyond_its_bound(foot, seed):
    chain = AxisChain.of(foot, 0, axes_around(foot, 20, seed))
    middle, half, which = boxes_of(chain, 1000, seed)
    found = samples(chain, middle, half, which)
    low = lower_bounds(
        BoxViews.of(chain, middle, half, which), goal_of(chain, np.inf, seed)
    )
    assert np.all(found >= low.bound - 1e-12)
    for limit in (-10.0, 0.3):
        high = upper_bounds(
            BoxViews.of(chain, middle, half, which), goal_of(chain, limit, seed)
        )
        assert np.all(found <= high.bound + 1e-12)
        assert np.all(high.bound >= limit)
    for bounds in (low, high):
        expected = chain.distance(middle, which)
        np.testing.assert_allclose(bounds.value, expected, atol=1e-12)
        assert np.all(bounds.effect >= 0)


@pytest.mark.parametrize("bounds", [lower_bounds, upper_bounds])
def test_bounds_of_small_boxes_are_off_by_their_size_at_most(bounds):
    chain = AxisChain.of(FEET[2], 0, axes_around(FEET[2], 20))
    middle, half, which = boxes_of(chain, 400, 2)
    limit = np.inf if bounds is lower_bounds else -10.0
    for size in (1e-2, 1e-4, 1e-6):
        small = np.full_like(half, size)
        found = bounds(
            BoxViews.of(chain, middle, small, which), goal_of(chain, limit, 0)
        )
        off = np.abs(found.bound - found.value)
        assert off.max() < 4 * chain.omega * chain.count * size


def test_the_error_of_an_upper_bound_shrinks_with_the_square_of_the_box():
    foot = one_finger(1, rho=2.0, scale=2.0, omega=1.0)
    chain = AxisChain.of(foot, 0, axes_around(foot, 8, 4))
    which, middle = np.arange(3, 8), np.full((1, 5), 0.5)
    goal = goal_of(chain, -10.0, 0)

    def error(size):
        half = np.full((1, 5), size)
        ends = [chain.distance(middle + side * half, which) for side in (-1, 1)]
        return upper_bounds(
            BoxViews.of(chain, middle, half, which), goal
        ).bound - np.max(ends, 0)

    np.testing.assert_array_less(error(1e-3), 0.3 * error(2e-3) + 1e-12)


def test_phalanges_that_do_not_matter_give_no_reason_to_halve():
    foot = one_finger(3)
    chain = AxisChain.of(foot, 0, axes_around(foot, 4))
    half = np.full((3, 4), 0.5)
    far = lower_bounds(
        BoxViews.of(chain, half, half, np.arange(4)), goal_of(chain, -10.0, 0)
    )
    assert np.all(far.effect == 0)
