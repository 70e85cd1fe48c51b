"""A report as users read it: one JSON document, or a table for a terminal."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from zygopin.branch import Branch, yaw_and_pitch
from zygopin.grasp import GraspReport
from zygopin.hold import Hold
from zygopin.kinematics import by_finger
from zygopin.reason import MILLIMETRES

NO_FRICTION = 1e-4
"""Coefficient of friction that is called none."""


def report_document(
    report: GraspReport, difference: float, hold: Hold, reason: str | None = None
) -> dict[str, Any]:
    """A report on one configuration as plain values, all in SI.

    Args:
        report: The report, not batched.
        difference: Largest difference between the two engines [m].
        hold: How it holds.
        reason: Why the pose is no grasp, where a planner says so.

    Returns:
        A mapping for JSON; numbers that do not exist (a scalar product without a
        pair of contacts) are None.
    """
    return {
        "foot": report.foot.to_mapping(),
        "branch": _branch(report.branch),
        "controls": by_finger(report.foot, report.controls),
        "verdict": {
            "stable": bool(report.stable),
            "grasping": bool(report.grasping),
            "feasible": bool(report.feasible),
            "held": hold.held,
            "finger_clearance": _plain(report.finger_clearance),
            "tolerance": report.tolerance,
            "reason": reason,
        },
        "scalar_product": {
            "section": _plain(report.scalar_product),
            "base_to_tip": _plain(report.scalar_product_base_to_tip),
        },
        "hold": _hold(hold),
        "phalanges": [_phalanx(report, k) for k in range(report.foot.phalanx_count)],
        "engines": {"max_difference": difference},
    }


def contact_word(report: GraspReport, phalanx: int) -> str:
    """How a phalanx meets the branch, in one word.

    Args:
        report: The report, not batched.
        phalanx: Index of the phalanx among all P.

    Returns:
        `penetrating`, `tangent`, `touching` or `free`.
    """
    for word in ("penetrating", "tangent", "touching"):
        if getattr(report, word)[phalanx]:
            return word
    return "free"


def branch_line(branch: Branch) -> str:
    """Size and pose of a branch in millimetres and degrees, in one line.

    Args:
        branch: One branch.

    Returns:
        Such as `radius 8 mm, height -14.5 mm, yaw 0°, pitch 0°`.
    """
    yaw, pitch = map(math.degrees, yaw_and_pitch(branch.axis))
    line = (
        f"radius {float(branch.radius) * MILLIMETRES:.6g} mm, "
        f"height {branch.centre[2] * MILLIMETRES:.6g} mm, "
        f"yaw {round(yaw, 4) + 0.0:g}°, pitch {round(pitch, 4) + 0.0:g}°"
    )
    if branch.length is None:
        return line
    return f"{line}, length {float(branch.length) * MILLIMETRES:.6g} mm"


def report_rows(report: GraspReport) -> list[tuple[str, ...]]:
    """The table of phalanges: finger, k, control, clearance [mm], t, contact.

    Args:
        report: The report, not batched.

    Returns:
        One row of texts for each phalanx.
    """
    foot = report.foot
    return [
        (
            foot.fingers[foot.finger_of_phalanx[k]].name,
            str(foot.rank_of_phalanx[k]),
            f"{report.controls[k]:.7f}",
            _signed(report.clearance[k] * MILLIMETRES, 4),
            _signed(report.t[k], 3),
            contact_word(report, k),
        )
        for k in range(foot.phalanx_count)
    ]


def verdict_lines(report: GraspReport, difference: float) -> list[str]:
    """The verdicts and the numbers behind them, for a terminal.

    Args:
        report: The report, not batched.
        difference: Largest difference between the two engines [m].

    Returns:
        Lines of at most 80 characters.
    """
    verdicts = ", ".join(
        f"{name} {'yes' if getattr(report, name) else 'no'}"
        for name in ("stable", "grasping", "feasible")
    )
    products = (report.scalar_product, report.scalar_product_base_to_tip)
    section, base_to_tip = (_shown(product) for product in products)
    apart = float(report.finger_clearance) * MILLIMETRES
    between = f"{apart:.4g} mm" if math.isfinite(apart) else "none: one finger"
    return [
        verdicts,
        f"scalar product {section} (section; a grasp has ≤ 0), "
        f"{base_to_tip} (base to tip)",
        f"least distance between two fingers {between}",
        f"engines (exact, FCL) differ by at most {difference:.1e} m",
    ]


def hold_lines(hold: Hold) -> list[str]:
    """How a stance holds, for a terminal.

    Args:
        hold: The record.

    Returns:
        Lines of at most 80 characters.
    """
    friction, force = hold.strength.friction.coefficient, hold.strength.normal_force
    least = hold.least_friction[1]
    needs = f"{least:.2g} or more would close it"
    if least < NO_FRICTION:
        needs = "any above 0 would close it"
    if not math.isfinite(least):
        needs = "none would close it"
    return [
        f"held {'yes' if hold.held else 'no'} at friction {friction:g} ({needs})",
        f"quality of the hold {hold.quality.low:.3f} to {hold.quality.high:.3f}",
        f"bears a pull up of {hold.pull.force:.3g} N "
        f"where each contact presses {force:g} N at most",
    ]


def _hold(hold: Hold) -> dict[str, Any]:
    """How a stance holds as plain values."""
    low, high = map(_plain, hold.least_friction)
    return {
        "friction": hold.strength.friction.coefficient,
        "toe_force": hold.strength.normal_force,
        "quality": {"low": hold.quality.low, "high": hold.quality.high},
        "least_friction": {"low": low, "high": high},
        "pull_limit": {"low": hold.pull.force, "high": hold.pull.bound},
    }


def _branch(branch: Branch) -> dict[str, Any]:
    """A branch as plain values."""
    return {
        "radius": float(branch.radius),
        "centre": branch.centre.tolist(),
        "axis": branch.axis.tolist(),
        "length": None if branch.length is None else float(branch.length),
    }


def _phalanx(report: GraspReport, index: int) -> dict[str, Any]:
    """One phalanx's contact as plain values."""
    foot = report.foot
    return {
        "finger": foot.fingers[foot.finger_of_phalanx[index]].name,
        "phalanx": int(foot.rank_of_phalanx[index]),
        "clearance": _plain(report.clearance[index]),
        "t": _plain(report.t[index]),
        "tangent": bool(report.tangent[index]),
        "point": report.point[index].tolist(),
        "normal": report.normal[index].tolist(),
    }


def _plain(value: ArrayLike) -> float | None:
    """A float for JSON, None where it is not finite."""
    number = float(np.asarray(value))
    return number if math.isfinite(number) else None


def _shown(value: ArrayLike) -> str:
    """A scalar product for a terminal."""
    number = _plain(value)
    return "none" if number is None else f"{number:.3f}"


def _signed(value: float, decimals: int) -> str:
    """A number in few characters, without a minus sign on zero."""
    rounded = round(float(value), decimals) + 0.0
    return (
        f"{rounded:.{decimals}f}" if abs(rounded) < 1e3 else f"{rounded:.{decimals}g}"
    )
