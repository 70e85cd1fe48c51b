"""Whether two toes can be a quarter turn apart on a branch: the proof that none are.

Contacts of toes that flex around the branch in opposite senses are a quarter turn apart
only if their wraps add up to one, or to one back. What the farthest poses known lack to
that is shared out: if neither toe can make up its part, both together cannot.
"""

from __future__ import annotations

import numpy as np

from zygopin.contact_hull import Criterion
from zygopin.projection import BEHIND, Floats
from zygopin.toe_contacts import Booleans, ToeSearch

QUARTER = np.pi / 2
"""Least angle between two contacts of a grasp [rad]."""

CLEAR = 1e-6
"""What wraps must lack to a quarter turn for a proof [rad]: more than the rounding
that verdicts allow."""

SHARE = 0.499
"""Share of what two toes lack that each is asked to be unable to make up."""

LITTLE = 0.1
"""What a toe with a pose is asked for [rad] where the other has none: poses are wrapped
nearly as far as they can be, so nearly all is left to the other."""


def grasp_possible(
    search: ToeSearch,
    pairs: tuple[tuple[int, int], ...],
    open_: Booleans,
    tangent: Booleans,
    wrap: Floats,
    tolerance: float,
) -> Booleans:
    """Branches on which a grasp with the toes' palms was not disproved.

    Args:
        search: The foot's fingers, seen along the branches.
        pairs: Opposable fingers.
        open_: Branches in question, shape (H, R).
        tangent: Where a finger's tangency was not disproved, shape (F, H, R).
        wrap: How far round a palm is known to lie [rad], NaN where none is, (F, H, R).
        tolerance: Clearance that counts as contact [m].

    Returns:
        Those of the branches that are left, shape (H, R).
    """
    criterion = Criterion(tolerance, palmar=True)
    opposable = np.isin(np.arange(len(wrap)), pairs)[:, None, None]
    unlaid = open_ & tangent & np.isnan(wrap) & opposable
    palms = np.isfinite(wrap) | search.possible(unlaid, criterion)
    left = np.zeros_like(open_)
    for sense in (1, -1):
        criterion = Criterion(tolerance, palmar=True, sense=sense)
        asked = open_ & ~left
        beyond, unprovable = _lacking(search, pairs, asked & palms, wrap, sense)
        asked = asked & np.isfinite(beyond) & ~unprovable
        found = search.possible(asked, criterion, beyond, enough=True)
        left |= open_ & (unprovable | found.any(axis=0))
    return left


def _lacking(
    search: ToeSearch,
    pairs: tuple[tuple[int, int], ...],
    palms: Booleans,
    wrap: Floats,
    sense: int,
) -> tuple[Floats, Booleans]:
    """How far two toes would have to be wrapped, one of them at least.

    Args:
        search: The fingers.
        pairs: Opposable fingers.
        palms: Branches in question that a finger's palm may touch, shape (F, H, R).
        wrap: How far round it is known to lie [rad], NaN where unknown, (F, H, R).
        sense: 1 for contacts far round, −1 for contacts back.

    Returns:
        Wraps times the sense [rad], shape (F, H, R), infinite where nothing is asked;
        branches for which this proves nothing, shape (H, R).
    """
    known = np.isfinite(wrap)
    most = np.where(known, sense * wrap, BEHIND)
    if sense < 0:
        # Poses are wrapped forward: nothing is known of contacts back.
        most, known = np.maximum(most, BEHIND / 2), np.zeros_like(known)
    beyond = np.full(wrap.shape, np.inf)
    unprovable = np.zeros(wrap.shape[1:], dtype=bool)
    for i, j in pairs:
        both, lack = palms[i] & palms[j], QUARTER - most[i] - most[j]
        provable = both & (lack > CLEAR) & search.opposed(i, j)
        unprovable |= both & ~provable
        little = np.minimum(LITTLE, SHARE * lack)
        for one, other in ((i, j), (j, i)):
            share = np.where(known[one] & ~known[other], little, SHARE * lack)
            alone = known[other] & ~known[one]
            share = np.where(alone, 2 * SHARE * lack - little, share)
            least = np.where(provable, most[one] + share, np.inf)
            beyond[one] = np.minimum(beyond[one], least)
    return beyond, unprovable
