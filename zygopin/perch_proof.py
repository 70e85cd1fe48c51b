"""Proof that no grasp of a branch exists, at each of some heights.

What bounds rule out (`perch_column`) costs little. The rest is a search for contacts
(`tangent_proof`): no two opposable toes are tangent with their palms, or not a quarter
turn apart.
"""

from __future__ import annotations

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from zygopin.clearance import Floats
from zygopin.contact_hull import Criterion
from zygopin.perch_column import CLEAR, QUARTER, Column
from zygopin.projection import BEHIND
from zygopin.survey import SHARE
from zygopin.tangent_proof import unproved

Booleans = NDArray[np.bool_]


class Existence(Enum):
    """What is known of the grasps of a branch."""

    FOUND = "found"
    """There is one: the plan."""

    NONE = "none"
    """There is none with the toes' palms, which is proved, within the tolerance."""

    UNDECIDED = "undecided"
    """None was found, and it is not proved that there is none."""


def disproved(column: Column) -> Booleans:
    """Prove at as many heights of a column as can be that no grasp exists.

    A branch with an end in reach of the toes is not that of the proofs, which is
    endless: it counts as disproved only where it is out of reach as a whole.

    Args:
        column: The branches.

    Returns:
        Where it is proved, shape (H,).
    """
    left = column.open
    if not (left & column.endless).any():
        return ~left
    return ~left | _Proof(column).apart(left & column.endless)


class _Proof:
    """Branch and bound over the controls of a column's toes."""

    def __init__(self, column: Column) -> None:
        self.column = column
        self.pairs = column.foot.opposable_pairs

    def apart(self, open_: Booleans) -> Booleans:
        """No pair is tangent at once, or none a quarter turn apart.

        Two contacts are a quarter turn apart only if their wraps add up to one, where
        toes flex around the branch in opposite senses. What the farthest poses found
        lack is shared out: neither toe of a pair can make up its half.
        """
        wrap = self.column.farthest[0]
        unlaid = np.isnan(wrap) & open_ & self.column.opposable[:, None]
        nowhere = np.full(wrap.shape, -np.inf)
        tangent = ~np.isnan(wrap) | self._possible(unlaid, nowhere)
        left = np.zeros_like(open_)
        for sense in (1, -1):
            left |= self._in_sense(open_ & ~left, tangent, sense)
        return np.asarray(open_ & ~left)

    def _in_sense(self, open_: Booleans, tangent: Booleans, sense: int) -> Booleans:
        """Heights at which two toes may yet be a quarter turn apart, far or back."""
        wrap = np.where(tangent, self.column.farthest[0], np.nan)
        wrap = np.where(np.isnan(wrap), BEHIND, sense * wrap)
        if sense < 0:
            wrap = np.maximum(wrap, BEHIND / 2)
        hopeless = np.zeros_like(open_)
        beyond = np.full(wrap.shape, np.inf)
        for i, j in self.pairs:
            both = open_ & tangent[i] & tangent[j]
            lack = QUARTER - wrap[i] - wrap[j]
            provable = both & (lack > CLEAR) & self._opposed(i, j)
            provable |= both & (sense < 0) & (lack >= 0) & self._opposed(i, j)
            hopeless |= both & ~provable
            for finger in (i, j):
                least = np.where(provable, wrap[finger] + SHARE * lack, np.inf)
                beyond[finger] = np.minimum(beyond[finger], least)
        asked = np.isfinite(beyond) & open_ & ~hopeless
        left = self._possible(asked, beyond, sense=sense)
        return np.asarray(open_ & (hopeless | left.any(axis=0)))

    def _possible(self, asked: Booleans, beyond: Floats, *, sense: int = 0) -> Booleans:
        """Fingers and heights at which such a contact is not disproved, (F, H).

        Args:
            asked: Where it is asked, shape (F, H).
            beyond: How far round, or back, the contact lies at least [rad], (F, H).
            sense: 1 for far round, −1 for back, and no more is asked about a height
                at which one finger is left; 0 for any contact.
        """
        tolerance, grid = self.column.tolerance, self.column.grid
        criterion = Criterion(tolerance, palmar=True, sense=sense or 1)
        fingers = self.column.search.fingers
        left, settled = np.zeros_like(asked), np.zeros(asked.shape[1], dtype=bool)
        # Short ones first: their proofs take a few boxes, and may settle a height.
        for index in sorted(range(len(fingers)), key=lambda i: len(fingers[i].lengths)):
            finger, open_ = fingers[index], asked[index]
            left[index] = open_ & settled
            open_ = (open_ & ~settled)[:, None]
            if not open_.any():
                continue
            ranks = np.broadcast_to(open_, (len(finger.lengths), *open_.shape))
            found = unproved(
                finger, grid, ranks, criterion, beyond=beyond[index][:, None]
            )
            left[index] |= np.asarray(found.any(axis=0))[:, 0]
            if sense:
                settled |= left[index]
        return left

    def _opposed(self, i: int, j: int) -> bool:
        """Whether two fingers flex around the branch in opposite senses."""
        frames = (self.column.search.fingers[k].frame for k in (i, j))
        senses = [
            float(np.linalg.det([*frame, self.column.grid.axis])) for frame in frames
        ]
        return bool(senses[0] * senses[1] < 0)
