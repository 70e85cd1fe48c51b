"""Proof that no grasp of a branch exists, at each of some heights.

What bounds rule out (`perch_column`) costs little. The rest is a search for contacts
(`quarter_turn`): no two opposable toes are tangent with their palms, or not a quarter
turn apart.
"""

from __future__ import annotations

from enum import Enum

import numpy as np
from numpy.typing import NDArray

from zygopin.perch_column import Column
from zygopin.quarter_turn import grasp_possible

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
    endless = (left & column.endless)[:, None]
    if not endless.any():
        return ~left
    wrap = column.farthest[0][..., None]
    possible = grasp_possible(
        column.search,
        column.foot.opposable_pairs,
        endless,
        np.ones(wrap.shape, dtype=bool),
        wrap,
        column.tolerance,
    )
    return np.asarray(~left | (endless & ~possible)[:, 0])
