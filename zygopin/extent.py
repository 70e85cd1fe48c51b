"""How large a reachable set is: convex hull and area, box-counting dimension."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.control_system import as_points, frozen
from zygopin.errors import ParameterError
from zygopin.ifs import ReachableSet

MAX_BOXES = 2**13
"""Most boxes along a side."""

DIRECTIONS = (8, 32, 128)
"""Directions whose farthest points cut away the inside, before a hull is taken."""

BLOCK = 2**18
"""Points whose inside is cut away at once."""

FINEST, COARSEST = 256, 8
"""Boxes along the set's longer side, from fine to coarse, unless said otherwise."""


@dataclass(frozen=True)
class Hull:
    """The convex hull of points.

    Attributes:
        indices: Indices of the vertices, counter-clockwise, read-only, shape (m,).
        points: The vertices x + iz, read-only, shape (m,).
    """

    indices: NDArray[np.intp]
    points: NDArray[np.complex128]

    @property
    def area(self) -> float:
        """Area, in squares of the unit of length."""
        following = np.roll(self.points, -1)
        return float(np.sum(np.conj(self.points) * following).imag) / 2

    def words(self, reachable: ReachableSet) -> NDArray[np.float64]:
        """The control sequences of the vertices.

        Args:
            reachable: The set whose points the hull was taken of.

        Returns:
            Controls in [0, 1], shape (m, k).
        """
        return reachable.words(self.indices)


@dataclass(frozen=True)
class BoxDimension:
    """A box-counting dimension, with the range it was fitted over.

    Attributes:
        dimension: Slope of log N against log(1/side), by least squares.
        sides: Sides of the boxes, read-only, shape (m,): the fit range.
        counts: Boxes that hold a point, read-only, shape (m,).
        residual: Largest deviation of log N from the line.
    """

    dimension: float
    sides: NDArray[np.float64]
    counts: NDArray[np.int64]
    residual: float


def convex_hull(points: NDArray[np.complex128]) -> Hull:
    """The convex hull of points in the plane, by Andrew's monotone chain.

    Args:
        points: Points x + iz, shape (m,).

    Returns:
        Its strict vertices; one or two where the points are all on one spot or line.

    Raises:
        ParameterError: There are no points, or one is not finite.
    """
    points = _cloud(points)
    outer = _outer(points)
    order = outer[np.lexsort((points.imag[outer], points.real[outer]))]
    values = points[order]
    order = order[np.append(True, values[1:] != values[:-1])]
    lower, upper = _chain(points, order), _chain(points, order[::-1])
    indices = np.array([*lower[:-1], *upper[:-1]] or lower, dtype=np.intp)
    return Hull(frozen(indices), frozen(points[indices]))


def box_dimension(
    points: NDArray[np.complex128], *, boxes: Sequence[int] | None = None
) -> BoxDimension:
    """The box-counting dimension of points, over a stated range of boxes.

    A finite set has dimension 0 in the limit: keep the boxes larger than its bound.

    Args:
        points: Points x + iz, shape (m,).
        boxes: Numbers of boxes along the longer side, at least two different ones;
            None: powers of two from `COARSEST` to `FINEST`.

    Returns:
        The slope with its fit range.

    Raises:
        ParameterError: All points are one, or fewer than two numbers are given.
    """
    points = _cloud(points)
    low = complex(points.real.min(), points.imag.min())
    span = float(max(np.ptp(points.real), np.ptp(points.imag)))
    if span == 0:
        remedy = "give a set of more than one point"
        raise ParameterError("span of the points", span, "a length > 0", remedy)
    numbers = _numbers(boxes)
    sides = span / numbers
    places = (points - low) / span
    counts = np.array([_count(places, int(number)) for number in numbers])
    scale, filled = np.log(1 / sides), np.log(counts)
    slope, level = np.polyfit(scale, filled, 1)
    residual = float(np.abs(slope * scale + level - filled).max())
    return BoxDimension(float(slope), frozen(sides), frozen(counts), residual)


def _cloud(points: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """Checked points, at least one, shape (m,)."""
    values = as_points("points", points).ravel()
    if not values.size:
        raise ParameterError("number of points", 0, "at least 1", "give points")
    return values


def _numbers(boxes: Sequence[int] | None) -> NDArray[np.float64]:
    """Checked numbers of boxes, ascending."""
    if boxes is None:
        octaves = range(COARSEST.bit_length() - 1, FINEST.bit_length())
        return 2.0 ** np.array(octaves)
    numbers = {checks.integer("boxes", number, 1, MAX_BOXES) for number in boxes}
    if len(numbers) < 2:
        remedy = "give at least two, to fit a slope"
        raise ParameterError("boxes", boxes, "two different numbers", remedy)
    return np.array(sorted(numbers), dtype=float)


def _count(places: NDArray[np.complex128], number: int) -> int:
    """Number of boxes that hold a point, of number² in the unit square."""
    row = np.minimum((places.imag * number).astype(np.intp), number - 1)
    column = np.minimum((places.real * number).astype(np.intp), number - 1)
    filled = np.zeros((number, number), bool)
    filled[row, column] = True
    return int(filled.sum())


def _outer(points: NDArray[np.complex128]) -> NDArray[np.intp]:
    """Indices of points that no polygon of extreme points holds inside.

    Block by block, so that a large set is not copied, and then all that is left.
    """
    starts = range(0, len(points), BLOCK)
    parts = [start + _cut(points[start : start + BLOCK]) for start in starts]
    outer = np.concatenate(parts)
    return outer[_cut(points[outer])]


def _cut(points: NDArray[np.complex128]) -> NDArray[np.intp]:
    """Indices of points that polygons of ever more extreme points do not hold."""
    outer = np.arange(len(points))
    for count in DIRECTIONS:
        outer = outer[_outside(points[outer], count)]
    return outer


def _outside(points: NDArray[np.complex128], count: int) -> NDArray[np.bool_]:
    """Which points are not strictly inside the polygon of the farthest ones."""
    if len(points) <= count:
        return np.ones(len(points), bool)
    directions = np.exp(2j * math.pi * np.arange(count) / count)
    heights = (np.argmax((points * turn).real) for turn in np.conj(directions))
    corners = points[list(heights)]
    edges = np.roll(corners, -1) - corners
    outside = np.zeros(len(points), bool)
    for corner, edge in zip(corners, edges, strict=True):
        if edge:
            outside |= (np.conj(edge) * (points - corner)).imag <= 0
    return outside if np.any(edges) else np.ones(len(points), bool)


def _chain(points: NDArray[np.complex128], order: NDArray[np.intp]) -> list[int]:
    """The chain of left turns through points in order of x."""
    chain: list[int] = []
    for index in order.tolist():
        while len(chain) > 1 and _turn(points, chain[-2], chain[-1], index) <= 0:
            chain.pop()
        chain.append(index)
    return chain


def _turn(points: NDArray[np.complex128], first: int, second: int, third: int) -> float:
    """Twice the area of the triangle of three points; > 0 for a left turn."""
    edge, other = points[second] - points[first], points[third] - points[first]
    return float((np.conj(edge) * other).imag)
