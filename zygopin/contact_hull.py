"""Where a phalanx can touch at all: bounds on its first junction.

A contact at wrap ψ, s along phalanx k, places the junction before it: xₖ₋₁. The
phalanges up to there have pitches that only grow, by ω at most: xₖ₋₁ lies in the hull
of what each of them can do. And where they stay outside the branch, they are no shorter
than the way around it. Two numbers are searched in place of k.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from zygopin.projection import BEHIND, Complexes, Floats, ProjectedFinger

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]

DIRECTIONS = np.exp(1j * np.pi / 4 * np.arange(8))
"""Directions, relative to that of the junction, in which the hull is bounded."""

STARTS = 48
"""Ranges of wrap that are looked at first."""

FINEST = 0.02
"""How far a range may move the junction, over the finger's length, below which it is
left as possible."""

BATCH = 16_384
"""Ranges that are looked at at once: their arrays stay in the cache."""


@dataclass(frozen=True, eq=False)
class Circles:
    """Branches as a finger sees them, and what is asked of contacts with them.

    Attributes:
        centre: Their centres [m], shape (n,).
        radius: Their radii [m], shape (n,).
        beyond: Only contacts count whose wrap, times the criterion's sense, is more
            than this [rad], shape (n,).
    """

    centre: Complexes
    radius: Floats
    beyond: Floats


@dataclass(frozen=True)
class Criterion:
    """What counts as a tangent phalanx.

    Attributes:
        tolerance: Clearance up to which it is tangent, and down to which others are
            outside the branch [m].
        solid: Whether the phalanges before it stay out of the branch.
        palmar: Whether only the toe's palm counts, the side to which it flexes.
        sense: 1 to ask for contacts that are wrapped far, −1 for those wrapped back.
    """

    tolerance: float
    solid: bool = True
    palmar: bool = False
    sense: int = 1


def contact_possible(
    finger: ProjectedFinger,
    circles: Circles,
    rank: int,
    side: int,
    criterion: Criterion,
) -> Booleans:
    """Branches on which a contact was not ruled out.

    Args:
        finger: The finger.
        circles: The branches.
        rank: Number k of the phalanx.
        side: `PALM` or `BACK`, the side of the toe that touches.
        criterion: What counts as tangent.

    Returns:
        A mask, shape (n,); elsewhere no contact is possible.
    """
    search = _Search(finger, circles, rank, side, criterion)
    possible = np.zeros(len(circles.radius), dtype=bool)
    for start in range(0, len(possible), BATCH // STARTS):
        search.run(
            np.arange(start, min(start + BATCH // STARTS, len(possible))), possible
        )
    return possible


@dataclass(frozen=True, eq=False)
class _Ranges:
    """Ranges of wrap and of the place along the phalanx, each for one branch.

    Attributes:
        branch: Index of the branch, shape (m,).
        turns: Full turns of the pitch, beyond the one that begins in (−π, π] at
            the least wrap, shape (m,).
        wrap: Middle and half width [rad], shape (2, m).
        along: The same of the place along the phalanx as projected, over its length,
            0 to 1, shape (2, m).
    """

    branch: Indices
    turns: Floats
    wrap: Floats
    along: Floats

    def take(self, which: Booleans) -> _Ranges:
        """Some of the ranges."""
        return _Ranges(*(getattr(self, f.name)[..., which] for f in fields(self)))

    def halved(self, by_wrap: Booleans) -> _Ranges:
        """Both halves of each, in wrap or along the phalanx."""
        wrap, along = self.wrap.copy(), self.along.copy()
        wrap[1] = np.where(by_wrap, wrap[1] / 2, wrap[1])
        along[1] = np.where(by_wrap, along[1], along[1] / 2)
        sides = []
        for sign in (-1, 1):
            shift = np.stack([np.where(by_wrap, wrap[1], 0.0), np.zeros(len(by_wrap))])
            slide = np.stack([np.where(by_wrap, 0.0, along[1]), np.zeros(len(by_wrap))])
            sides.append((wrap + sign * shift, along + sign * slide))
        twice = np.concatenate
        return _Ranges(
            twice([self.branch] * 2),
            twice([self.turns] * 2),
            twice([each[0] for each in sides], axis=1),
            twice([each[1] for each in sides], axis=1),
        )


@dataclass(frozen=True, eq=False)
class _Search:
    """The search for contacts of one phalanx and one side of it."""

    finger: ProjectedFinger
    circles: Circles
    rank: int
    side: int
    criterion: Criterion

    def run(self, branches: Indices, possible: Booleans) -> None:
        """Mark those of some branches on which a contact is possible."""
        ranges, fine = self._starts(branches), FINEST * self.finger.lengths.sum()
        while len(ranges.branch):
            left, moves = self._left(ranges)
            ranges, moves = ranges.take(left), moves[:, left]
            small = moves.sum(axis=0) < fine
            possible[ranges.branch[small]] = True
            # A branch with one contact needs no further search.
            open_ = ~small & ~possible[ranges.branch]
            ranges = ranges.take(open_).halved((moves[0] >= moves[1])[open_])

    def _starts(self, branches: Indices) -> _Ranges:
        """All of the wrap and the phalanx, for every number of turns."""
        finger = self.finger
        low, high = finger.orientation, finger.orientation + self.rank * finger.omega
        first = int(np.floor((low - np.pi) / (2 * np.pi)))
        last = int(np.floor((high + np.pi) / (2 * np.pi)))
        turns, middles = np.arange(first, last + 1.0), np.arange(STARTS) + 0.5
        half = np.pi / STARTS
        branch, turn, middle = (
            each.ravel()
            for each in np.meshgrid(branches, turns, middles, indexing="ij")
        )
        wrap = np.stack([BEHIND + 2 * half * middle, np.full(len(branch), half)])
        ranges = _Ranges(branch, turn, wrap, np.full((2, len(branch)), 0.5))
        return ranges.take(self._counts(ranges))

    def _left(self, ranges: _Ranges) -> tuple[Booleans, Floats]:
        """Which ranges may hold a contact, and how far each moves the junction [m]."""
        finger, tolerance = self.finger, self.criterion.tolerance
        centre = self.circles.centre[ranges.branch]
        radius = self.circles.radius[ranges.branch]
        skin = radius + finger.radii[self.rank - 1]
        backmost = -centre / np.abs(centre) * np.exp(-1j * BEHIND)
        normal = backmost * np.exp(-1j * (ranges.wrap[0] - BEHIND))
        pitch, stretch = finger.pitch(-1j * self.side * normal)
        # Counted from where wraps begin: the halves of a range keep its turn.
        begin, _ = finger.pitch(-1j * self.side * backmost)
        pitch = begin + np.mod(pitch - begin, 2 * np.pi) + 2 * np.pi * ranges.turns
        least = finger.least_stretch
        spread = ranges.wrap[1] / least
        length = finger.lengths[self.rank - 1] * np.minimum(stretch + spread, 1.0)
        along = ranges.along * finger.lengths[self.rank - 1]
        junction = centre + normal * (skin + 1j * self.side * along[0])
        moves = np.stack([ranges.wrap[1] * (skin + along[0] + along[1]), along[1]])
        margin = moves.sum(axis=0) + tolerance
        left = self._within(junction, margin, pitch, spread)
        left &= along[0] - along[1] <= length + tolerance
        if self.criterion.solid:
            left &= self._around(junction, margin, centre, radius)
        return left & self._counts(ranges), moves

    def _counts(self, ranges: _Ranges) -> Booleans:
        """Which ranges hold contacts that are wrapped as is asked for."""
        most = self.criterion.sense * ranges.wrap[0] + ranges.wrap[1]
        return np.asarray(most > self.circles.beyond[ranges.branch])

    def _within(
        self, junction: Complexes, margin: Floats, pitch: Floats, spread: Floats
    ) -> Booleans:
        """Whether junctions are in the hull of what the phalanges before can do."""
        finger, rank = self.finger, self.rank
        first, bound = finger.orientation, finger.omega
        left = (pitch + spread >= first) & (pitch - spread <= first + rank * bound)
        size = np.abs(junction)
        toward = np.where(size > 0, junction / np.where(size > 0, size, 1.0), 1.0)
        ranges = []
        for joint in range(1, rank):
            low = np.maximum(first, pitch - spread - (rank - joint) * bound)
            high = np.minimum(first + joint * bound, pitch + spread)
            left &= low <= high
            ranges.append((low, high, finger.lengths[joint - 1]))
        for direction in DIRECTIONS:
            way = toward * direction
            most = margin.copy()
            for low, high, length in ranges:
                most += length * self._farthest(way, low, high)
            left &= size * direction.real <= most
        return left

    def _farthest(self, way: Complexes, low: Floats, high: Floats) -> Floats:
        """Farthest that unit vectors of a range of pitches go in a direction."""
        finger = self.finger
        even = finger.forward * way.real
        odd = -(finger.shear * way.real + finger.drop * way.imag)
        size, peak = np.hypot(even, odd), np.arctan2(odd, even)
        off = np.mod(peak - low, 2 * np.pi)
        outside = np.minimum(off - (high - low), 2 * np.pi - off)
        return np.asarray(size * np.cos(np.clip(outside, 0.0, np.pi)))

    def _around(
        self, junction: Complexes, margin: Floats, centre: Complexes, radius: Floats
    ) -> Booleans:
        """Whether the phalanges before are long enough to go around the branch."""
        finger, tolerance = self.finger, self.criterion.tolerance
        before = max(self.rank - 2, 0)
        disc = np.maximum(radius + finger.radii[before] - tolerance, tolerance)
        start, end = np.abs(centre), np.abs(junction - centre)
        clear = (end + margin >= disc) & (start >= disc)
        start, end = np.maximum(start, disc), np.maximum(end, disc)
        turn = np.abs(np.angle((junction - centre) * np.conj(-centre)))
        arc = turn - np.arccos(disc / start) - np.arccos(disc / end)
        tangents = np.sqrt(start**2 - disc**2) + np.sqrt(end**2 - disc**2)
        way = np.where(arc > 0, tangents + disc * arc, np.abs(junction))
        reach = finger.lengths[: self.rank - 1].sum()
        return np.asarray(clear & (way <= reach + np.pi / 2 * margin))
