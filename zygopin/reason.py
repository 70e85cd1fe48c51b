"""Why a pose is no feasible grasp: the facts, in words."""

from __future__ import annotations

import math

from zygopin.grasp import PARAMETER_SLACK, GraspReport

MILLIMETRES = 1e3
"""Millimetres in a metre: sentences about toes are told in them."""


def why_not(report: GraspReport) -> str | None:
    """What keeps a pose from being a feasible grasp, the gravest first.

    Args:
        report: The report, not batched.

    Returns:
        One line; None for a feasible grasp.
    """
    for found in (_entering, _colliding, _apart, _unstable, _not_around):
        text = found(report)
        if text is not None:
            return text
    return None


def touching_fingers(report: GraspReport) -> set[int]:
    """Indices of the fingers that touch the branch.

    Args:
        report: The report, not batched.

    Returns:
        The indices.
    """
    return set(report.foot.finger_of_phalanx[report.touching].tolist())


def _entering(report: GraspReport) -> str | None:
    """Phalanges inside the branch."""
    if not report.penetrating.any():
        return None
    names = _names(report, set(report.foot.finger_of_phalanx[report.penetrating]))
    depth = -float(report.clearance.min()) * MILLIMETRES
    return f"{names} enter the branch, by up to {depth:.3g} mm"


def _colliding(report: GraspReport) -> str | None:
    """Fingers inside each other: what is left of infeasible poses."""
    if report.feasible:
        return None
    depth = max(-float(report.finger_clearance) * MILLIMETRES, 0.0)
    return f"fingers run into each other, by {depth:.3g} mm"


def _apart(report: GraspReport) -> str | None:
    """Nothing touches."""
    if report.touching.any():
        return None
    gap = float(report.clearance.min()) * MILLIMETRES
    return f"no toe reaches the branch, the nearest stays {gap:.4g} mm away"


def _unstable(report: GraspReport) -> str | None:
    """No two opposable fingers are tangent."""
    if report.stable:
        return None
    foot, toes = report.foot, touching_fingers(report)
    names = _names(report, toes)
    if not foot.opposable_pairs:
        return f"{names} touch the branch, but no two fingers of this foot are opposite"
    if any(toes.issuperset(pair) for pair in foot.opposable_pairs):
        return f"{names} touch the branch, but opposite ones not along a phalanx"
    return f"only {names} touch the branch, and no toe opposite"


def _not_around(report: GraspReport) -> str | None:
    """The decisive scalar product is positive."""
    if report.grasping:
        return None
    if report.scalar_product <= PARAMETER_SLACK:
        return (
            "no two opposite toes' base-to-tip directions have a product of 0 or less"
        )
    angle = math.degrees(math.acos(min(1.0, float(report.scalar_product))))
    return (
        f"contacts of opposing toes reach {angle:.0f}° around the branch of radius "
        f"{float(report.branch.radius) * MILLIMETRES:.4g} mm, a grasp needs 90°"
    )


def _names(report: GraspReport, fingers: set[int]) -> str:
    """Names of fingers, in the foot's order."""
    return ", ".join(report.foot.fingers[i].name for i in sorted(fingers))
