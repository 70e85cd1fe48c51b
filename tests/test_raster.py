"""Images of sets: within a pixel of full enumeration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import level_sets, omegas, reals
from test_ifs import hausdorff, one_sided

from zygopin.control_system import ControlSystem
from zygopin.errors import ParameterError
from zygopin.ifs import reachable_set
from zygopin.raster import raster

PHI = (1 + math.sqrt(5)) / 2


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.data())
def test_images_are_within_a_pixel_of_all_points(data):
    rho, omega = data.draw(reals(1.2, 4)), data.draw(omegas())
    levels, depth = data.draw(level_sets()), data.draw(st.integers(1, 5))
    turn, pixels = data.draw(reals(-4, 4)), data.draw(st.integers(8, 150))
    reachable = reachable_set(rho, omega, levels, depth, orientation=turn)
    drawn = raster(reachable.system, depth, pixels=pixels)
    distance = hausdorff(drawn.centres, reachable.points)
    assert distance <= drawn.error_bound + 1e-12 < drawn.pixel


def test_33_levels_are_within_a_pixel_of_all_points():
    reachable = reachable_set(PHI, math.pi / 6, 33, 4)
    drawn = raster(reachable.system, 4, pixels=300)
    assert hausdorff(drawn.centres, reachable.points) <= drawn.error_bound


@pytest.mark.parametrize("omega", [math.pi / 6, 2.0])
def test_the_attractor_is_within_a_pixel_of_a_deep_set(omega):
    system = ControlSystem(PHI, omega, 3)
    drawn = raster(system, pixels=100)
    deep = reachable_set(PHI, omega, 3, 12)
    assert drawn.error_bound < drawn.pixel
    error = hausdorff(drawn.centres, deep.points)
    assert error <= drawn.error_bound + deep.depth_bound


def test_the_attractor_is_its_own_image():
    system = ControlSystem(1.6, 1.0, 5)
    drawn = raster(system, pixels=200)
    for factor in system.factors:
        image = factor * (drawn.centres + 1)
        assert one_sided(image, drawn.centres) <= 2 * drawn.error_bound


def test_the_image_holds_the_set_in_its_extent():
    drawn = raster(ControlSystem(PHI, 1.0, 9), 3, pixels=64)
    left, right, low, high = drawn.extent
    assert drawn.image.shape == (64, 64)
    assert right - left == pytest.approx(64 * drawn.pixel)
    assert high - low == pytest.approx(64 * drawn.pixel)
    points = reachable_set(PHI, 1.0, 9, 3).points
    assert left < points.real.min() < points.real.max() < right
    assert low < points.imag.min() < points.imag.max() < high
    assert drawn.image[-8:].any()
    assert np.argwhere(drawn.image)[0][0] < 8


def test_pixels_left_in_question_widen_the_bound(monkeypatch):
    monkeypatch.setattr("zygopin.raster.MOST_PULLED", 10)
    reachable = reachable_set(1.3, 1.0, 9, 4)
    drawn = raster(reachable.system, 4, pixels=64)
    assert drawn.error_bound > drawn.pixel
    assert hausdorff(drawn.centres, reachable.points) <= drawn.error_bound


def test_bad_input_is_named():
    with pytest.raises(ParameterError, match="pixels = 2 is not an integer from 8"):
        raster(ControlSystem(PHI, 1.0, 3), pixels=2)
    with pytest.raises(ParameterError, match="depth = 0"):
        raster(ControlSystem(PHI, 1.0, 3), 0)
    with pytest.raises(ParameterError, match="levels = None is not a finite control"):
        raster(ControlSystem(PHI, 1.0), 3)
