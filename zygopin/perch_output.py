"""The ways to grasp a branch as users read them: a table, and JSON."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from zygopin.kinematics import by_finger
from zygopin.perch import PerchPlan
from zygopin.preference import flexion_left

LISTED = 20
"""Ways to grasp in the table."""

HEADINGS = ("no.", "tangent phalanges", "wrap [°]", "product", "margin")
"""The columns of `solution_rows`."""


def solution_rows(plans: Sequence[PerchPlan]) -> list[tuple[str, ...]]:
    """The table of some grasps.

    Args:
        plans: The plans.

    Returns:
        Texts: number; the tangent phalanges of each finger in the foot's order, such as
            `2 · 13 · - · 1`; largest wrap; least scalar product; flexion left.
    """
    return [
        (
            str(number),
            " · ".join("".join(map(str, ranks)) or "-" for ranks in _mode(plan)),
            f"{math.degrees(float(plan.wrap.max())):.0f}",
            f"{float(plan.report.scalar_product):.3f}",
            f"{flexion_left(plan.report):.3f}",
        )
        for number, plan in enumerate(plans, 1)
    ]


def solution_documents(plans: Sequence[PerchPlan]) -> list[dict[str, Any]]:
    """Grasps as plain values, all in SI.

    Args:
        plans: The plans.

    Returns:
        Mappings for JSON: controls and tangent phalanges by finger, wrap [rad], least
        scalar product, margin.
    """
    return [
        {
            "controls": by_finger(plan.report.foot, plan.controls),
            "tangent": dict(
                zip(plan.report.foot.finger_slices, _mode(plan), strict=True)
            ),
            "wrap": float(plan.wrap.max()),
            "scalar_product": float(plan.report.scalar_product),
            "margin": flexion_left(plan.report),
        }
        for plan in plans
    ]


def _mode(plan: PerchPlan) -> list[list[int]]:
    """Numbers of the tangent phalanges of each finger."""
    parts = plan.report.foot.finger_slices.values()
    return [(np.flatnonzero(plan.report.tangent[part]) + 1).tolist() for part in parts]
