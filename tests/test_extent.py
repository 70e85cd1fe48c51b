"""Hulls and dimensions: hand-worked shapes, and the reference areas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import ConvexHull
from strategies import planar_points

from zygopin.errors import ParameterError
from zygopin.extent import box_dimension, convex_hull
from zygopin.ifs import reachable_set

PHI = (1 + math.sqrt(5)) / 2


@pytest.mark.parametrize(
    ("omega", "area"), [(math.pi / 6, 0.226553), (math.pi / 2, 2.102884)]
)
def test_the_reference_areas(omega, area):
    reachable = reachable_set(PHI, omega, 33, 4)
    hull = convex_hull(reachable.points)
    assert hull.area == pytest.approx(area, abs=1e-6)
    pitch = omega * np.cumsum(hull.words(reachable), axis=1)
    tips = np.sum(PHI ** -np.arange(1.0, 5) * np.exp(-1j * pitch), axis=1)
    assert np.abs(tips - hull.points).max() < 1e-14


@settings(max_examples=60, deadline=None, derandomize=True)
@given(st.lists(planar_points(), min_size=1, max_size=60))
def test_hulls_hold_all_points(points):
    points = np.array(points)
    hull = convex_hull(points)
    assert (points[hull.indices] == hull.points).all()
    edges = np.roll(hull.points, -1) - hull.points
    for corner, edge in zip(hull.points, edges, strict=True):
        assert ((np.conj(edge) * (points - corner)).imag > -1e-9).all()


def test_many_random_points_as_qhull_has_them():
    values = np.random.default_rng(7).normal(size=(5000, 2))
    hull = convex_hull(values[:, 0] + 1j * values[:, 1])
    other = ConvexHull(values)
    assert hull.area == pytest.approx(other.volume)
    assert set(hull.indices.tolist()) == set(other.vertices.tolist())


def test_degenerate_hulls():
    assert convex_hull(np.full(500, 2 + 1j)).points.tolist() == [2 + 1j]
    line = convex_hull(np.arange(500.0) + 0j)
    assert line.points.tolist() == [0, 499]
    assert line.area == 0


def test_dimensions_of_a_line_a_square_and_a_cantor_set():
    line = np.linspace(0, 1, 4097) * (1 + 0.3j)
    assert box_dimension(line).dimension == pytest.approx(1, abs=0.02)
    side = np.linspace(0, 1, 513)
    square = np.add.outer(side, 1j * side).ravel()
    assert box_dimension(square).dimension == pytest.approx(2, abs=0.02)
    cantor = np.zeros(1)
    for _ in range(9):
        cantor = np.concatenate([cantor / 3, cantor / 3 + 2 / 3])
    measured = box_dimension(cantor * (1 - 1e-6), boxes=[3, 9, 27, 81, 243])
    assert measured.dimension == pytest.approx(math.log(2) / math.log(3), abs=0.05)
    assert len(measured.counts) == len(measured.sides) == 5
    assert measured.residual < 0.2


def test_bad_input_is_named():
    with pytest.raises(ParameterError, match="number of points = 0"):
        convex_hull(np.zeros(0, complex))
    with pytest.raises(ParameterError, match=r"points\[0\] = .*nan"):
        convex_hull(np.array([complex(0, math.nan)]))
    with pytest.raises(ParameterError, match=r"span of the points = 0.0"):
        box_dimension(np.ones(3, complex))
    with pytest.raises(ParameterError, match=r"boxes = .*two different numbers"):
        box_dimension(np.arange(3) + 0j, boxes=[4])
