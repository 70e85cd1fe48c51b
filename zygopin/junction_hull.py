"""Where a finger's junctions can be, by the pitch of the phalanx behind them.

The pitches up to there only grow, by ω at most, so a range of the last one bounds each
of them, and with them how far the junction can lie in some directions. That depends on
the finger alone: it is tabulated, and a question about any branch is a look into it.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zygopin.projection import Complexes, Floats, ProjectedFinger

BINS = 1024
"""Parts of the pitch's range: less than 0.02 rad each for most fingers."""

LOGARITHM = np.log2(np.maximum(np.arange(BINS + 1), 1)).astype(np.intp)
"""Of 1, 2, …, BINS, rounded down."""

KEPT = 16
"""Phalanges whose tables are kept, of 1.4 megabytes each: a search needs three."""

COARSE, FINE = 8, 16
"""Directions that are looked into first, and those for what is left."""

Booleans = NDArray[np.bool_]


class JunctionHull:
    """Bounds on the junction before one phalanx, for ranges of its pitch."""

    def __init__(self, finger: ProjectedFinger, rank: int) -> None:
        """Tabulate.

        Args:
            finger: The finger.
            rank: Number k of the phalanx; the junction is x of index k − 1.
        """
        self.first, self.last = (
            finger.orientation,
            finger.orientation + rank * finger.omega,
        )
        self.width = (self.last - self.first) / BINS
        steps = np.arange(0, FINE, FINE // COARSE)
        rest = np.setdiff1d(np.arange(FINE), steps)
        self.tables = [_tables(finger, rank, some) for some in (steps, rest)]

    def holds(
        self, junction: Complexes, margin: Floats, pitch: Floats, spread: Floats
    ) -> Booleans:
        """Which junctions may be there.

        Args:
            junction: Junctions, from the base [m], shape (n,).
            margin: How far off each may be [m], shape (n,).
            pitch: Pitches of the phalanx behind [rad], shape (n,).
            spread: How far off each may be [rad], shape (n,).

        Returns:
            A mask, shape (n,): elsewhere no controls lead there.
        """
        low, high = pitch - spread, pitch + spread
        result = (high >= self.first) & (low <= self.last)
        held = np.flatnonzero(result)
        begin, end = (
            np.clip((x[held] - self.first) / self.width, 0, BINS - 1).astype(np.intp)
            for x in (low, high)
        )
        level = LOGARITHM[end - begin + 1]
        rows = np.stack([begin, end + 1 - (1 << level)]) + BINS * level
        for directions, table in self.tables:
            most = np.maximum(*(table.take(each, axis=0) for each in rows))
            most += margin[held, None]
            place = np.stack([junction.real[held], junction.imag[held]], axis=-1)
            kept = (place @ directions <= most).all(axis=-1)
            held, rows = held[kept], rows[:, kept]
        result[:] = False
        result[held] = True
        return result


@lru_cache(maxsize=KEPT)
def junction_hull(finger: ProjectedFinger, rank: int) -> JunctionHull:
    """The bounds for one finger and phalanx, made once."""
    return JunctionHull(finger, rank)


def _tables(
    finger: ProjectedFinger, rank: int, steps: NDArray[np.intp]
) -> tuple[Floats, Floats]:
    """Directions, (2, d), and how far junctions go there, (levels·BINS, d) [m].

    Row l·BINS + i is for the bins i to i + 2ˡ − 1.
    """
    first, bound = finger.orientation, finger.omega
    ends = first + rank * bound / BINS * np.arange(BINS + 1)
    # Rounding: a hair wider than the bin.
    begin, end = (ends[:-1] - 1e-12)[:, None], (ends[1:] + 1e-12)[:, None]
    way = np.exp(2j * np.pi * steps / FINE)
    even = finger.forward * way.real
    odd = -(finger.shear * way.real + finger.drop * way.imag)
    # A unit vector of pitch θ goes far·cos(θ − peak) that way.
    far, peak = np.hypot(even, odd), np.arctan2(odd, even)
    most = np.zeros((BINS, len(steps)))
    for joint in range(1, rank):
        low = np.maximum(first, begin - (rank - joint) * bound)
        high = np.minimum(first + joint * bound, end)
        off = np.mod(peak - low, 2 * np.pi)
        outside = np.minimum(off - (high - low), 2 * np.pi - off)
        most += finger.lengths[joint - 1] * far * np.cos(np.clip(outside, 0.0, np.pi))
    levels = [most + 1e-12 * finger.lengths.sum()]
    for level in range(int(np.log2(BINS))):
        shift = 1 << level
        later = np.concatenate([levels[-1][shift:], levels[-1][-1:].repeat(shift, 0)])
        levels.append(np.maximum(levels[-1], later))
    return np.stack([way.real, way.imag]), np.concatenate(levels)
