"""Images of sets: within a pixel of full enumeration."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.ndimage import minimum_filter
from strategies import level_sets, omegas, reals
from test_ifs import chain, hausdorff, one_sided

from zygopin.control_system import ControlSystem, depth_bound, depth_within
from zygopin.errors import ParameterError
from zygopin.ifs import reachable_set
from zygopin.inverse import find_word
from zygopin.raster import ACCEPT, SPREAD, _fineness, raster

PHI = (1 + math.sqrt(5)) / 2


@settings(max_examples=40, deadline=None, derandomize=True)
@given(st.data())
def test_images_are_within_a_pixel_of_all_points(data):
    rho, omega = data.draw(reals(1.05, 4)), data.draw(omegas())
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


@pytest.mark.parametrize(
    ("rho", "omega", "levels", "depth"),
    [(1.3, 1.0, 33, None), (1.2, 0.5, 2, None), (1.1, 2.0, 3, 30), (1.2, 1.0, 9, 25)],
)
def test_where_phalanges_hardly_shrink_images_are_as_sharp(rho, omega, levels, depth):
    system = ControlSystem(rho, omega, levels)
    drawn = raster(system, depth, pixels=64)
    assert drawn.error_bound < drawn.pixel
    length = depth or depth_within(rho, drawn.pixel / 1000)
    rest = 0.0 if depth else depth_bound(rho, length)
    rng = np.random.default_rng(7)
    # Tips of random controls are in marked pixels, or beside them ...
    controls = system.finite_levels[rng.integers(levels, size=(20_000, length))]
    ends = rng.integers(2, size=(20_000, length))  # all bent or straight: at the rim
    for word in (controls, np.where(rng.random((20_000, 1)) < 0.5, ends, controls)):
        tips = chain(rho, omega, word)
        assert one_sided(tips, drawn.centres) <= drawn.error_bound + rest
    # ... and each marked pixel, above all those at the rim, is near a tip.
    rim = drawn.image & ~minimum_filter(drawn.image, 3)
    corner = complex(drawn.extent[0], drawn.extent[2])
    row, column = np.nonzero(rim)
    chosen = rng.permutation(len(row))[:40]
    within = drawn.error_bound + rest + 1e-9
    for target in corner + drawn.pixel * (column + 0.5 + 1j * (row + 0.5))[chosen]:
        assert (
            find_word(target, system, length, tolerance=within).verdict == "reachable"
        )


def test_two_points_within_the_spread_are_near_one_pixel_centre():
    # One point is anywhere in a pixel's lower left quarter, the other on a circle
    # around it. Between the samples the distance grows by less than the steps.
    steps, angles = 96, 720
    side = (np.arange(steps) + 0.5) / (2 * steps)
    one = (side[:, None] + 1j * side).reshape(-1, 1)
    corners = np.add.outer(np.arange(-2, 4), 1j * np.arange(-2, 4)).ravel()
    centres = corners + 0.5 + 0.5j
    worst = 0.0
    for angle in 2 * np.pi * np.arange(angles) / angles:
        other = one + SPREAD * np.exp(1j * angle)
        both = np.maximum(np.abs(one - centres), np.abs(other - centres))
        worst = max(worst, both.min(axis=1).max())
    step = math.sqrt(2) / (4 * steps) + SPREAD * math.pi / angles
    assert 0.95 < worst < worst + step < ACCEPT
    # So do nearer points: they lie between two such ones, and discs are convex.


@pytest.mark.parametrize("shrink", [1.001, 1.05, 1.2, 1.618, 2, 5, 100])
def test_cells_are_as_fine_as_the_spread_asks(shrink):
    cells, finer = _fineness(shrink)
    spread = max(1 / shrink + 1 / finer, 1 / finer / (1 - 1 / shrink))
    assert spread * math.sqrt(2) / cells <= SPREAD


def test_a_set_as_deep_as_the_attractor_is_drawn_as_it():
    system = ControlSystem(PHI, 1.0, 5)
    deep, endless = raster(system, 60, pixels=64), raster(system, pixels=64)
    assert deep.depth is None
    assert np.array_equal(deep.image, endless.image)
    assert deep.error_bound == endless.error_bound + depth_bound(PHI, 60)


def test_what_would_take_too_much_memory_is_refused(monkeypatch):
    system = ControlSystem(1.3, 1.0, 9)
    monkeypatch.setattr("zygopin.nets.MAX_POINTS", 1000)
    match = "points of the net = .* is not at most 1000: take fewer pixels"
    for depth in (None, 8):
        with pytest.raises(ParameterError, match=match):
            raster(system, depth)
    monkeypatch.setattr("zygopin.nets.MAX_CELLS", 10_000)
    match = "cells of the grid = .* is not at most 10000: take fewer pixels"
    with pytest.raises(ParameterError, match=match):
        raster(system)


def test_bad_input_is_named():
    with pytest.raises(ParameterError, match="pixels = 2 is not an integer from 8"):
        raster(ControlSystem(PHI, 1.0, 3), pixels=2)
    with pytest.raises(ParameterError, match="depth = 0"):
        raster(ControlSystem(PHI, 1.0, 3), 0)
    with pytest.raises(ParameterError, match="levels = None is not a finite control"):
        raster(ControlSystem(PHI, 1.0), 3)
