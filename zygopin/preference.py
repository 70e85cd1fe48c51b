"""What makes one grasp better than another."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np

from zygopin.closure import closure_quality
from zygopin.contacts import branch_contacts
from zygopin.grasp import GraspReport
from zygopin.load import pull_limit
from zygopin.strength import Strength

Preference = Literal["wrap", "quality", "pull", "margin", "opposition"]
"""What the best grasp has most of."""

SHORTLIST: dict[str, int] = {
    "wrap": 1,
    "quality": 24,
    "pull": 96,
    "margin": 256,
    "opposition": 256,
}
"""How many grasps are compared for each preference: a second or two of work."""


def preference_value(
    prefer: Preference, strength: Strength, report: GraspReport
) -> float:
    """What a grasp is worth to those who prefer it so; wrap has no value of its own.

    Args:
        prefer: What is preferred.
        strength: How hard toes press, for `quality` and `pull`.
        report: The verdicts on one pose.

    Returns:
        The value, the larger the better; −∞ for what is no feasible grasp.
    """
    if not (report.grasping and report.feasible):
        return -math.inf
    if prefer == "wrap":
        return 0.0
    if prefer == "margin":
        return flexion_left(report)
    if prefer == "opposition":
        return -float(report.scalar_product)
    contacts = branch_contacts(report)
    if prefer == "quality":
        return closure_quality(contacts, strength.friction).low
    return pull_limit(contacts, strength, -contacts.origin).force


def flexion_left(report: GraspReport) -> float:
    """Least 1 − v of the joints that hold tangent phalanges on the branch.

    Those are each finger's joints up to its last tangent phalanx. Only the closed end
    of the range counts: a straight joint (v = 0) is a toe's rest, and most grasps have
    one, so that the distance from both ends would be 0 for nearly all of them; a joint
    that is closed (v = 1) can tighten no further.

    Args:
        report: The verdicts on one pose.

    Returns:
        The share of the range that is left, 0 to 1; 1 without a tangent phalanx.
    """
    left = 1.0
    for part in report.foot.finger_slices.values():
        tangent = np.flatnonzero(report.tangent[part])
        if len(tangent):
            closed = report.controls[part][: tangent[-1] + 1].max()
            left = min(left, 1.0 - float(closed))
    return left
