"""Controls that touch a branch: exact, within the limits, told where there are none."""

from __future__ import annotations

import math

import numpy as np
import pytest
from axes import axes_around, distances

from zygopin import Branch, Foot, ParameterError, touch_intervals, touching_controls

BELOW = Branch(1.0, (0.0, 0.0, -0.6))
PAPER = Foot(omega=math.pi / 3)


def test_controls_touch_and_do_not_enter_for_radii_and_axes():
    foot = Foot.preset("parrot")
    axes = axes_around(foot, 5, seed=3)
    found = touch_intervals(foot, axes)
    radii = np.linspace(0.02, 1.2, 12)[:, None] * foot.size
    result = touching_controls(found, radii)
    assert result.controls.shape == (12, 5, 14)
    assert np.all((result.controls >= 0) & (result.controls <= 1))
    clearance = distances(foot, result.controls, axes) - radii[..., None]
    np.testing.assert_allclose(clearance, result.clearance, atol=1e-12 * foot.size)
    assert np.all(np.abs(clearance[result.touching]) <= 1e-12 * foot.size)
    np.testing.assert_array_equal(result.touching, found.touchable(radii))
    assert result.touching.any()
    radii = radii[..., None]
    for where, attained in (
        (radii > found.most[..., 0], found.most[..., 0]),
        (radii < found.least[..., 1], found.least[..., 1]),
    ):
        where &= ~result.touching
        assert where.any()
        off = (attained - radii)[where]
        np.testing.assert_allclose(clearance[where], off, atol=1e-12 * foot.size)


def test_both_fingers_of_a_pair_touch_the_same_branch():
    found = touch_intervals(PAPER, BELOW)
    result = touching_controls(found, 0.4)
    assert result.touching.all()
    assert result.controls.shape == (PAPER.phalanx_count,)
    branch = Branch(0.4, BELOW.centre)
    assert np.all(np.abs(distances(PAPER, result.controls, branch) - 0.4) < 1e-12)


def test_bad_radii_are_named():
    found = touch_intervals(PAPER, Branch(1.0, [(0, 0, -0.6), (0, 0, -0.7)]))
    for radius, message in ((-0.1, "radius"), ([0.1, 0.2, 0.3], "batch shapes")):
        with pytest.raises(ParameterError, match=message):
            touching_controls(found, radius)
    with pytest.raises(ParameterError, match="TouchIntervals"):
        touching_controls(PAPER, 0.1)
