"""The area of a union of stadiums: segments of the plane with a radius around each.

The union is cut into vertical slabs at every end of an edge and every crossing of two.
Between two cuts the same edges bound it all along, straight or circular, and each has
its integral in closed form. So the area is exact but for rounding, and shapes that
touch or coincide need no tolerance.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

UPPER, LOWER = 1, -1
"""The two edges of a stadium, as signs of the normal to its left."""

NOTHING = 1e-200
"""Length of a segment that is a point, and width of a side over its length below which
it is upright: no slab is as narrow, and their inverses stay finite."""

SLABS = 4096
"""Slabs that are worked out at once."""

_Cuts = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stadiums:
    """Stadiums in the plane x + iy.

    Attributes:
        first: Their segments' left ends [m], shape (n,).
        last: The right ends [m], shape (n,).
        radius: Radii ≥ 0 [m], shape (n,).
    """

    first: NDArray[np.complex128]
    last: NDArray[np.complex128]
    radius: NDArray[np.float64]

    @classmethod
    def around(
        cls, segments: NDArray[np.complex128], radius: NDArray[np.float64]
    ) -> Stadiums:
        """Stadiums around some segments.

        Args:
            segments: Their ends in any order [m], shape (n, 2).
            radius: Radii ≥ 0 [m], shape (n,).

        Returns:
            The stadiums.
        """
        swapped = segments[:, 0].real > segments[:, 1].real
        first = np.where(swapped, segments[:, 1], segments[:, 0])
        last = np.where(swapped, segments[:, 0], segments[:, 1])
        return cls(first, last, np.asarray(radius, dtype=float))

    @cached_property
    def along(self) -> NDArray[np.complex128]:
        """Unit vectors along the segments, shape (n,); 1 for a point."""
        step = self.last - self.first
        length = np.abs(step)
        unit: NDArray[np.complex128] = np.ones_like(step)
        return np.divide(step, length, out=unit, where=length > NOTHING)

    def side(self, sign: int) -> tuple[NDArray[np.complex128], NDArray[np.complex128]]:
        """Ends of the straight part of each upper or lower edge [m], shape (n,)."""
        normal = sign * 1j * self.radius * self.along
        return self.first + normal, self.last + normal

    def area(self) -> float:
        """Area of the union [m²]."""
        cuts = np.unique(np.concatenate([self._ends(), self._crossings()]))
        blocks = range(0, len(cuts) - 1, SLABS)
        return math.fsum(self._slabs(cuts[k : k + SLABS + 1]) for k in blocks)

    def _ends(self) -> _Cuts:
        """Where each edge begins, bends and ends."""
        bends = [end.real for sign in (UPPER, LOWER) for end in self.side(sign)]
        left, right = self.first.real - self.radius, self.last.real + self.radius
        return np.concatenate([left, right, *bends])

    def _crossings(self) -> _Cuts:
        """Where circles and sides cross each other, and perhaps further places."""
        centre = np.concatenate([self.first, self.last])
        radius = np.tile(self.radius, 2)
        starts, ends = np.concatenate([self.side(UPPER), self.side(LOWER)], axis=1)
        along = np.tile(self.along, 2)
        with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
            found = [
                _of_circles(centre, radius),
                _of_circles_and_lines(centre, radius, starts, along),
                _of_lines(starts, along),
            ]
        on = [(x >= starts.real) & (x <= ends.real) for x in found[1:]]
        cuts = [found[0].ravel(), found[1][on[0]], found[2][on[1]]]
        every, reach = np.concatenate(cuts), self._ends()
        return np.asarray(every[(every >= reach.min()) & (every <= reach.max())])

    def _slabs(self, cuts: _Cuts) -> float:
        """Area between the first and the last of some cuts."""
        low, high = cuts[:-1, None], cuts[1:, None]
        middle = (low + high) / 2
        bottom, below = self._edge(LOWER, low, high)
        top, above = self._edge(UPPER, low, high)
        reach = self.first.real - self.radius, self.last.real + self.radius
        inside = (middle > reach[0]) & (middle < reach[1])
        bottom, top = np.where(inside, bottom, np.inf), np.where(inside, top, -np.inf)
        return _merged(bottom, top, below, above)

    def _edge(
        self, sign: int, low: _Cuts, high: _Cuts
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Edges' heights in the middle of slabs, and areas below, shape (m, n)."""
        start, end = self.side(sign)
        middle, width = (low + high) / 2, high - low
        right = middle > end.real
        curved = right | (middle < start.real)
        centre = np.where(right, self.last, self.first)
        run = self.along.real
        slope = self.along.imag / np.where(run > NOTHING, run, np.inf)
        straight = start.imag + (middle - start.real) * slope
        bow = self._chord(middle - centre.real)
        area = self._cap(high - centre.real) - self._cap(low - centre.real)
        height = np.where(curved, centre.imag + sign * bow, straight)
        below = np.where(curved, centre.imag * width + sign * area, straight * width)
        return height, below

    def _chord(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Height of the circles at x from their centres: √(r² − x²)."""
        return np.sqrt(np.maximum((self.radius - x) * (self.radius + x), 0))

    def _cap(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """The integral of `_chord` from 0: (x·√(r² − x²) + r²·asin(x/r))/2."""
        x = np.clip(x, -self.radius, self.radius)
        turn = np.arctan2(x, self._chord(x))
        return (x * self._chord(x) + self.radius**2 * turn) / 2


def _merged(
    bottom: NDArray[np.float64],
    top: NDArray[np.float64],
    below: NDArray[np.float64],
    above: NDArray[np.float64],
) -> float:
    """Area of the union of n intervals in each of m slabs, all of shape (m, n).

    Intervals in ascending order; a run of overlapping ones begins at a bottom above
    all tops before, and ends at the highest of its tops.
    """
    order = np.argsort(bottom, axis=1)
    bottom, top, below, above = (
        np.take_along_axis(values, order, axis=1)
        for values in (bottom, top, below, above)
    )
    highest = np.maximum.accumulate(top, axis=1)
    places = np.where(top == highest, np.arange(top.shape[1]), 0)
    record = np.maximum.accumulate(places, axis=1)
    ends = np.take_along_axis(above, record, axis=1)
    begins = np.isfinite(bottom)
    begins[:, 1:] &= bottom[:, 1:] > highest[:, :-1]
    closed = ends[:, :-1][begins[:, 1:]].sum()
    last = ends[np.isfinite(highest[:, -1]), -1].sum()
    return float(closed + last - below[begins].sum())


def _of_circles(centre: NDArray[np.complex128], radius: NDArray[np.float64]) -> _Cuts:
    """Where every two circles cross, in x; NaN where they do not."""
    step = centre - centre[:, None]
    apart = np.abs(step)
    foot = (apart**2 + radius[:, None] ** 2 - radius**2) / (2 * apart)
    half = np.sqrt(radius[:, None] ** 2 - foot**2)
    place = centre.real[:, None] + (foot * step.real) / apart
    aside = (half * step.imag) / apart
    return np.stack([place - aside, place + aside])


def _of_circles_and_lines(
    centre: NDArray[np.complex128],
    radius: NDArray[np.float64],
    start: NDArray[np.complex128],
    along: NDArray[np.complex128],
) -> _Cuts:
    """Where every circle and line cross, in x, lines along the last axis."""
    local = np.conj(along) * (centre[:, None] - start)
    half = np.sqrt(radius[:, None] ** 2 - local.imag**2)
    shift = np.stack([local.real - half, local.real + half])
    return start.real + shift * along.real


def _of_lines(start: NDArray[np.complex128], along: NDArray[np.complex128]) -> _Cuts:
    """Where every two lines cross, in x."""
    step = start[:, None] - start
    turn = np.conj(along) * along[:, None]
    shift = (np.conj(step) * along[:, None]).imag / turn.imag
    return start.real + shift * along.real
