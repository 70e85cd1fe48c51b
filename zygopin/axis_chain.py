"""A finger seen along axes: its bones in the plane across each of them.

Across an axis, phalanx k is the step ℓₖ(u·cos θₖ − w·sin θₖ), θₖ = v₀ + ω(v₁ + … + vₖ),
with u and w the projections of the directions ahead and up (MODEL.md, section 4). The
plane's points are complex numbers, the axis is 0, and the finger's length is 1.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.foot import Foot

Floats = NDArray[np.float64]
Points = NDArray[np.complex128]
Indices = NDArray[np.intp]

ROUNDING = 64 * np.finfo(float).eps
"""Rounding of a distance, over the lengths of which it is the difference: a dozen
phalanges add a few units in the last place each."""

TINY = 1e-300
"""Keeps a division by a length of zero finite."""


@dataclass(frozen=True, eq=False)
class Contact:
    """Where the bones of chains are nearest to their axes.

    Attributes:
        gap: Distance of each bone from the axis, less its skin's radius, shape (K, m).
        normal: Unit directions from the axis to the nearest points, shape (K, m).
        t: Where those are on the bones, in [0, 1], shape (K, m).
        steps: The bones, from start to end, shape (K, m).
        rates: What each angle θ moves the junctions by together, shape (K + 1, m):
            junction j moves by rates[j] − rates[i − 1] as joint i turns.
    """

    gap: Floats
    normal: Points
    t: Floats
    steps: Points
    rates: Points

    @property
    def ends(self) -> Points:
        """Rates of the nearest points, shape (K, m)."""
        return np.asarray((1 - self.t) * self.rates[:-1] + self.t * self.rates[1:])


@dataclass(frozen=True, eq=False)
class AxisChain:
    """One finger before each of n axes; lengths are over the finger's length.

    Attributes:
        base: The base, seen from the axis, shape (n,).
        ahead: Projection u of the straight finger's direction, shape (n,).
        up: Projection w of the direction up, shape (n,).
        rounding: What rounding may change a distance by, shape (n,).
        lengths: Lengths of the phalanges, shape (K,).
        radii: Radii of their skin, shape (K,).
        orientation: The initial orientation v₀ [rad].
        omega: Largest joint angle ω [rad].
    """

    base: Points
    ahead: Points
    up: Points
    rounding: Floats
    lengths: Floats
    radii: Floats
    orientation: float
    omega: float

    @classmethod
    def of(cls, foot: Foot, index: int, axes: Branch) -> AxisChain:
        """A finger of a foot before the axes of branches.

        Args:
            foot: The foot.
            index: Index of the finger.
            axes: The branches, batch shape (n,).

        Returns:
            The chains, over the finger's length.
        """
        finger = foot.fingers[index]
        part = foot.finger_slices[finger.name]
        length = foot.lengths[part].sum()
        across = axes.frame()[..., :2]
        along = np.einsum("ni,ni->n", axes.centre, axes.axis)
        nearest = along[:, None] * axes.axis - axes.centre
        forward = np.array([np.cos(finger.azimuth), np.sin(finger.azimuth), 0.0])
        return cls(
            _complex(np.einsum("nij,ni->nj", across, nearest) / length),
            _complex(forward @ across),
            _complex(across[:, 2]),
            ROUNDING * (1 + np.linalg.norm(axes.centre, axis=-1) / length),
            foot.lengths[part] / length,
            foot.radii[part] / length,
            finger.orientation,
            foot.omega,
        )

    @property
    def count(self) -> int:
        """Number of phalanges K."""
        return len(self.lengths)

    @cached_property
    def stretch(self) -> Floats:
        """Greatest length of a unit step's projection, shape (n,)."""
        mean = (np.abs(self.ahead) ** 2 + np.abs(self.up) ** 2) / 2
        return np.asarray(np.sqrt(mean + np.abs(self.ahead**2 + self.up**2) / 2))

    @cached_property
    def narrow(self) -> Points:
        """Unit direction along which the steps' projections are shortest, (n,)."""
        longest = np.sqrt(self.ahead**2 + self.up**2)
        size = np.abs(longest)
        along = np.where(size > 0, longest / np.maximum(size, TINY), 1.0)
        return np.asarray(1j * along)

    @cached_property
    def off_plane(self) -> Floats:
        """Lower bounds of the bones' distances from the axis, shape (K, n).

        Along one direction steps reach least, and the base may lie farther off: the
        bounds are zero but where the finger's plane is seen nearly edge-on.
        """
        aside = np.abs(project(self.narrow, self.base))
        reach = self.height(self.narrow, np.arange(len(aside)))
        return np.maximum(aside - reach * np.cumsum(self.lengths)[:, None], 0.0)

    def height(self, normal: Points, which: Indices) -> Floats:
        """Greatest coordinate of a unit step along directions.

        Args:
            normal: Unit directions, shape (…, m).
            which: Index of the axis of each, shape (m,).

        Returns:
            √((n·u)² + (n·w)²), shape (…, m).
        """
        ahead, up = self.ahead[which], self.up[which]
        return np.asarray(np.hypot(project(normal, ahead), project(normal, up)))

    def steps(self, controls: Floats, which: Indices) -> tuple[Points, Points]:
        """Steps of the phalanges, and what they change by as their angles grow.

        Args:
            controls: Controls, shape (K, m).
            which: Index of the axis of each, shape (m,).

        Returns:
            Steps and rates, shape (K, m) each.
        """
        angle = self.orientation + self.omega * np.cumsum(controls, axis=0)
        cosine = self.lengths[:, None] * np.cos(angle)
        sine = self.lengths[:, None] * np.sin(angle)
        ahead, up = self.ahead[which], self.up[which]
        return ahead * cosine - up * sine, -ahead * sine - up * cosine

    def contact(self, controls: Floats, which: Indices) -> Contact:
        """Where the bones are nearest to the axes.

        Args:
            controls: Controls, shape (K, m).
            which: Index of the axis of each, shape (m,).

        Returns:
            The record.
        """
        steps, rates = self.steps(controls, which)
        starts = junctions(self.base[which], steps)[:-1]
        t, points = nearest_on(starts, steps)
        distance = np.abs(points)
        normal = np.where(distance > 0, points / np.maximum(distance, TINY), 1.0)
        gap = distance - self.radii[:, None]
        return Contact(gap, normal, t, steps, junctions(np.zeros(len(which)), rates))

    def distance(self, controls: Floats, which: Indices) -> Floats:
        """D: least distance of a bone from the axis less its skin's radius.

        Args:
            controls: Controls, shape (K, m).
            which: Index of the axis of each, shape (m,).

        Returns:
            The values, shape (m,).
        """
        steps, _ = self.steps(controls, which)
        _, points = nearest_on(junctions(self.base[which], steps)[:-1], steps)
        return np.asarray(np.min(np.abs(points) - self.radii[:, None], axis=0))

    def slopes(self, contact: Contact) -> Floats:
        """What the controls change each bone's distance by.

        Args:
            contact: Where the bones are nearest.

        Returns:
            Slopes of phalanx k's gap along control i, shape (K, K, m).
        """
        return self.turned(contact.normal, contact.ends, contact.rates)

    def turned(self, normal: Points, ends: Points, rates: Points) -> Floats:
        """Slopes of the coordinates of points of the bones along directions.

        Args:
            normal: A direction for each bone, shape (K, m).
            ends: Rates of a point of each bone, shape (K, m).
            rates: Rates of the junctions, shape (K + 1, m).

        Returns:
            Slopes along control i, zero for those beyond k, shape (K, K, m).
        """
        moved = self.omega * project(normal[:, None], ends[:, None] - rates[None, :-1])
        return np.where(self.bearing[..., None], moved, 0.0)

    @cached_property
    def bearing(self) -> NDArray[np.bool_]:
        """Whether control i moves phalanx k, shape (K, K)."""
        return np.tri(self.count, dtype=bool)


def project(normal: Points, points: Points) -> Floats:
    """Coordinates of points along directions.

    Args:
        normal: Unit directions, shape (…).
        points: Points, shape (…).

    Returns:
        n·p, shape (…).
    """
    return np.asarray(normal.real * points.real + normal.imag * points.imag)


def junctions(base: Points | Floats, steps: Points) -> Points:
    """Points that steps lead to, one after the other.

    Args:
        base: Where they start, shape (m,).
        steps: The steps, shape (K, m).

    Returns:
        The points, shape (K + 1, m).
    """
    return np.cumsum(np.concatenate([np.asarray(base)[None], steps]), axis=0)


def nearest_on(starts: Points, steps: Points) -> tuple[Floats, Points]:
    """Points of bones that are nearest to 0.

    Args:
        starts: Where the bones start, shape (…).
        steps: From there to their ends, shape (…).

    Returns:
        Where the points are on the bones, in [0, 1], and the points, shape (…) each.
    """
    square = np.maximum(project(steps, steps), TINY)
    t = np.clip(-project(starts, steps) / square, 0.0, 1.0)
    return t, np.asarray(starts + t * steps)


def _complex(pairs: Floats) -> Points:
    """Pairs of coordinates as complex numbers, (n, 2) to (n,)."""
    return np.asarray(pairs[:, 0] + 1j * pairs[:, 1])
