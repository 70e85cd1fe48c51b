"""Links that touch by construction, for formats that list what not to collide."""

from __future__ import annotations

from itertools import combinations, pairwise

from zygopin import names
from zygopin.finger import Finger
from zygopin.foot import Foot


def touching_links(foot: Foot) -> dict[tuple[str, str], str]:
    """Pairs of links that touch by construction, and why.

    Neighbours in a chain share a junction, and so do all first phalanges, whatever
    the pose; a fingertip is a frame at the end of its phalanx.

    Args:
        foot: The foot.

    Returns:
        {(link, link): "Adjacent" or "Always"}, the words of an SRDF.
    """
    pairs: dict[tuple[str, str], str] = {}
    for finger in foot.fingers:
        pairs |= dict.fromkeys(pairwise(_chain(finger)), "Adjacent")
        pairs.setdefault((names.BASE, names.phalanx_links(finger)[0]), "Always")
    first = [names.phalanx_links(finger)[0] for finger in foot.fingers]
    return pairs | dict.fromkeys(combinations(first, 2), "Always")


def _chain(finger: Finger) -> tuple[str, ...]:
    """Links of a finger from the foot's base to the tip."""
    between = (names.turning_link(finger),) * names.is_reversible(finger)
    tip = names.tip_link(finger)
    return (names.BASE, *between, *names.phalanx_links(finger), tip)
