"""Descent from starts: within the limits, never worse, and good."""

from __future__ import annotations

import numpy as np
import pytest
from axes import axes_around, one_finger

from zygopin.axis_chain import AxisChain
from zygopin.touch_witness import STARTS, first_witnesses, improved, start_controls


@pytest.mark.parametrize("count", [1, 2, 5, 12])
def test_starts_are_distinct_and_hold_the_straight_and_the_closed_finger(count):
    starts = start_controls(count)
    assert starts.shape[0] == count
    assert starts.shape[1] >= min(STARTS, 2**count)
    assert np.all((starts >= 0) & (starts <= 1))
    assert len(np.unique(starts, axis=1).T) == starts.shape[1]
    for word in (0.0, 1.0):
        assert np.any(np.all(starts == word, axis=0))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_descent_keeps_within_the_limits_and_is_never_worse(sign):
    foot = one_finger(4, 0.4, rho=1.2, omega=1.5, thickness=0.1)
    chain = AxisChain.of(foot, 0, axes_around(foot, 30))
    which = np.arange(30)
    start = np.random.default_rng(1).random((4, 30))
    found, value = improved(chain, start, which, sign)
    assert np.all((found >= 0) & (found <= 1))
    np.testing.assert_allclose(chain.distance(found, which), value, atol=1e-14)
    assert np.all(sign * value <= sign * chain.distance(start, which))


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_random_controls_are_hardly_better_than_a_witness(sign):
    foot = one_finger(3, 0.4, rho=1.2, omega=1.5, thickness=0.1)
    chain = AxisChain.of(foot, 0, axes_around(foot, 30))
    value, controls = first_witnesses(chain, sign, np.full(30, -np.inf))
    assert controls.shape == (3, 30)
    tried = np.random.default_rng(0).random((3, 4000))
    for axis in range(30):
        best = (sign * chain.distance(tried, np.full(4000, axis))).min()
        assert sign * value[axis] <= best + 1e-3
