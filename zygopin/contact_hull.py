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

from zygopin.junction_hull import junction_hull
from zygopin.laid_contact import segment_gap
from zygopin.projection import BEHIND, Complexes, Floats, ProjectedFinger

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]

STARTS = 16
"""Ranges of wrap that are looked at first."""

STAGES = ((0, 0.02), (1, 0.02), (2, 0.02), (2, 0.005))
"""How many joints before the contact are searched, and how far a range may move the
junction, over the finger's length, below which it is left as possible: each only where
the ones before rule nothing out."""

MOST_RANGES, ENOUGH = 1000, 100_000
"""Ranges for each branch that are looked at before it is left as possible; and for all
together, where they are few."""

BATCH = 16_384
"""Ranges that are looked at at once: their arrays stay in the cache."""

WORTHWHILE = 2048
"""Ranges below which a call costs more than what it looks at."""


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
    *,
    stages: int = len(STAGES),
) -> Booleans:
    """Branches on which a contact was not ruled out.

    Args:
        finger: The finger.
        circles: The branches.
        rank: Number k of the phalanx.
        side: `PALM` or `BACK`, the side of the toe that touches.
        criterion: What counts as tangent.
        stages: How many of `STAGES` are gone through, the first ones.

    Returns:
        A mask, shape (n,); elsewhere no contact is possible.
    """
    possible = np.zeros(len(circles.radius), dtype=bool)
    open_ = np.arange(len(possible))
    # A phalanx with few joints before it has stages that are alike.
    chosen = [(min(bends, rank - 1), fine) for bends, fine in STAGES[:stages]]
    for bends, fine in dict.fromkeys(chosen):
        search = _Search(finger, circles, rank, side, criterion, bends, fine)
        left, given_up = search.possible(open_)
        possible[open_[given_up]] = True
        open_ = open_[left & ~given_up]
    possible[open_] = True
    return possible


@dataclass(frozen=True, eq=False)
class _Ranges:
    """Ranges of what places a contact, each for one branch.

    Attributes:
        branch: Index of the branch, shape (m,).
        turns: Full turns of the pitch beyond the least one, shape (m,).
        middle: Wrap [rad], place along the phalanx from 0 to 1, and the controls of
            the last joints, the very last first, shape (2 + b, m).
        half: Half widths of these, shape (2 + b, m).
    """

    branch: Indices
    turns: Floats
    middle: Floats
    half: Floats

    def take(self, which: Booleans | slice) -> _Ranges:
        """Some of the ranges."""
        return _Ranges(*(getattr(self, f.name)[..., which] for f in fields(self)))

    def halved(self, widest: Indices) -> list[_Ranges]:
        """The halves of each along one of its dimensions, the first and the second."""
        half, shift = self.half.copy(), np.zeros_like(self.half)
        place = widest, np.arange(len(widest))
        half[place] /= 2
        shift[place] = half[place]
        return [
            _Ranges(self.branch, self.turns, self.middle + move, half)
            for move in (-shift, shift)
        ]


def _top(stack: list[_Ranges]) -> _Ranges:
    """Take ranges off a stack, as many as are worth a call."""
    taken = [stack.pop()]
    while stack and sum(len(each.branch) for each in taken) < WORTHWHILE:
        taken.append(stack.pop())
    return _Ranges(
        *(
            np.concatenate([getattr(each, f.name) for each in taken], axis=-1)
            for f in fields(_Ranges)
        )
    )


@dataclass(frozen=True, eq=False)
class _Search:
    """The search for contacts of one phalanx and one side of it.

    So many joints before the contact are searched as well; what is left of the finger
    is bounded by its hull.
    """

    finger: ProjectedFinger
    circles: Circles
    rank: int
    side: int
    criterion: Criterion
    bends: int
    fine: float

    def possible(self, branches: Indices) -> tuple[Booleans, Booleans]:
        """Which of some branches remain, and for which too much was looked at, (n,)."""
        spent = np.zeros(len(self.circles.radius), dtype=np.intp)
        left = spent > 0
        most = max(MOST_RANGES, ENOUGH // max(len(branches), 1))
        fine = self.fine * self.finger.lengths.sum()
        chunk = max(BATCH // STARTS, 1)
        stack = [
            self._starts(branches[start : start + chunk])
            for start in range(0, len(branches), chunk)
        ]
        while stack:
            # One contact that is left, or too much work, settles a branch.
            ranges = _top(stack)
            ranges = ranges.take(~left[ranges.branch])
            spent += np.bincount(ranges.branch, minlength=len(spent))
            left |= spent > most
            kept, moves = self._left(ranges)
            ranges, moves = ranges.take(kept), moves[:, kept]
            small = moves.sum(axis=0) < fine
            left[ranges.branch[small]] = True
            if not small.all():
                widest = np.argmax(moves[:, ~small], axis=0)
                stack += ranges.take(~small).halved(widest)
        return left[branches], spent[branches] > most

    def _starts(self, branches: Indices) -> _Ranges:
        """All of the wrap and the phalanx, for every number of turns."""
        finger = self.finger
        low, high = finger.orientation, finger.orientation + self.rank * finger.omega
        first = int(np.floor((low - np.pi) / (2 * np.pi)))
        last = int(np.floor((high + np.pi) / (2 * np.pi)))
        turns, places = np.arange(first, last + 1.0), np.arange(STARTS) + 0.5
        width = np.pi / STARTS
        branch, turn, place = (
            each.ravel() for each in np.meshgrid(branches, turns, places, indexing="ij")
        )
        half = np.full((2 + self.bends, len(branch)), 0.5)
        middle = half.copy()
        middle[0], half[0] = BEHIND + 2 * width * place, width
        ranges = _Ranges(branch, turn, middle, half)
        return ranges.take(self._counts(ranges))

    def _left(self, ranges: _Ranges) -> tuple[Booleans, Floats]:
        """Which ranges may hold a contact, and how far each moves the junction [m]."""
        finger, tolerance = self.finger, self.criterion.tolerance
        centre = self.circles.centre[ranges.branch]
        radius = self.circles.radius[ranges.branch]
        skin = radius + finger.radii[self.rank - 1]
        (wrap, along), (width, share) = ranges.middle[:2], ranges.half[:2]
        backmost = -centre / np.abs(centre) * np.exp(-1j * BEHIND)
        normal = backmost * np.exp(-1j * (wrap - BEHIND))
        pitch, stretch = finger.pitch(-1j * self.side * normal)
        # Counted from where wraps begin: the halves of a range keep its turn.
        begin, _ = finger.pitch(-1j * self.side * backmost)
        pitch = begin + np.mod(pitch - begin, 2 * np.pi) + 2 * np.pi * ranges.turns
        spread = width / finger.least_stretch
        length = finger.lengths[self.rank - 1]
        along, share = along * length, share * length
        junction = centre + normal * (skin + 1j * self.side * along)
        moves = np.zeros_like(ranges.half)
        moves[0], moves[1] = width * (skin + along + share), share
        left = along - share <= length * np.minimum(stretch + spread, 1.0) + tolerance
        left &= self._counts(ranges)
        for bend in range(self.bends + 1):
            margin = moves.sum(axis=0) + tolerance
            rank = self.rank - bend
            hull = junction_hull(finger, rank)
            left &= hull.holds(junction, margin, pitch, spread)
            if self.criterion.solid:
                left &= self._around(rank, junction, margin, centre, radius)
            if bend == self.bends:
                break
            turn = finger.omega * ranges.half[2 + bend]
            pitch = pitch - finger.omega * ranges.middle[2 + bend]
            before, step = junction, finger.lengths[rank - 2] * finger.direction(pitch)
            junction = junction - step
            spread = spread + turn
            moves[0] += finger.lengths[rank - 2] * width / finger.least_stretch
            moves[2 : 3 + bend] += (
                finger.lengths[rank - 2] * finger.omega * ranges.half[2 : 3 + bend]
            )
            if self.criterion.solid:
                skin = radius + finger.radii[rank - 2] - tolerance
                left &= segment_gap(before - centre, -step) + moves.sum(axis=0) >= skin
        return left, moves

    def _counts(self, ranges: _Ranges) -> Booleans:
        """Which ranges hold contacts that are wrapped as is asked for."""
        most = self.criterion.sense * ranges.middle[0] + ranges.half[0]
        return np.asarray(most > self.circles.beyond[ranges.branch])

    def _around(
        self,
        rank: int,
        junction: Complexes,
        margin: Floats,
        centre: Complexes,
        radius: Floats,
    ) -> Booleans:
        """Whether the phalanges before are long enough to go around the branch."""
        finger, tolerance = self.finger, self.criterion.tolerance
        before = max(rank - 2, 0)
        disc = np.maximum(radius + finger.radii[before] - tolerance, tolerance)
        start, end = np.abs(centre), np.abs(junction - centre)
        clear = (end + margin >= disc) & (start >= disc)
        # The true junction is outside: the nearest way between two such points is at
        # most π/2 times as long as the straight one.
        detour = np.pi / 2 * (margin + np.maximum(disc - end, 0.0))
        start, end = np.maximum(start, disc), np.maximum(end, disc)
        turn = np.abs(np.angle((junction - centre) * np.conj(-centre)))
        arc = turn - np.arccos(disc / start) - np.arccos(disc / end)
        tangents = np.sqrt(start**2 - disc**2) + np.sqrt(end**2 - disc**2)
        way = np.where(arc > 0, tangents + disc * arc, np.abs(junction))
        reach = finger.lengths[: rank - 1].sum()
        return np.asarray(clear & (way <= reach + detour))
