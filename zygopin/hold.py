"""Does it hold: what friction makes of a stance's contacts, in one record."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from zygopin import kinds
from zygopin.closure import (
    ClosureQuality,
    closure_quality,
    force_closure,
    least_friction,
)
from zygopin.contacts import Contacts, branch_contacts
from zygopin.grasp import GraspReport
from zygopin.load import PullLimit, pull_limit, unit_direction
from zygopin.strength import Strength

UP = (0.0, 0.0, 1.0)
"""Direction of the pull that lifts the foot off a branch below it."""


@dataclass(frozen=True, eq=False)
class Hold:
    """How a stance holds on to its branch: MODEL.md, section 5, "held".

    Attributes:
        contacts: The contacts; None where nothing touches, and nothing is held.
        strength: Largest normal force of each contact, and their friction.
        held: Whether the contacts close: every wrench is balanced, given enough
            normal force.
        quality: Ferrari and Canny's ε, between two pyramids.
        least_friction: Coefficients (low, high) between which the least one lies that
            closes; infinite where none does.
        pull: The largest pull that they bear along the direction asked for.
    """

    contacts: Contacts | None
    strength: Strength
    held: bool
    quality: ClosureQuality
    least_friction: tuple[float, float]
    pull: PullLimit


def check_hold(
    report: GraspReport, strength: Strength, direction: ArrayLike = UP
) -> Hold:
    """How a stance holds, by friction at every phalanx that touches.

    Args:
        report: The verdicts on one stance.
        strength: Largest normal force of each contact, and their friction.
        direction: Direction of the pull on the foot's base, shape (3,).

    Returns:
        The record; nothing is held where nothing touches.

    Raises:
        ParameterError: A batch of stances, or a direction of length 0.
    """
    kinds.instance("report", report, GraspReport)
    kinds.instance("strength", strength, Strength)
    if report.touching.ndim == 1 and not report.touching.any():
        unit = unit_direction(direction)
        nothing = PullLimit(unit, 0.0, 0.0, np.zeros((0, 3)), 0.0)
        none = (np.inf, np.inf)
        return Hold(None, strength, False, ClosureQuality(0.0, 0.0), none, nothing)
    contacts = branch_contacts(report)
    return Hold(
        contacts=contacts,
        strength=strength,
        held=force_closure(contacts, strength.friction),
        quality=closure_quality(contacts, strength.friction),
        least_friction=least_friction(contacts, strength.friction.edges),
        pull=pull_limit(contacts, strength, direction),
    )
