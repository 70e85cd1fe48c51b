"""Solutions for branches as users read them: a table, JSON, and lines of a CSV file."""

from __future__ import annotations

import csv
import io
import math
from typing import Any

import numpy as np

from zygopin.branch_solutions import BranchSolutions
from zygopin.clearance import Floats
from zygopin.crossings import SystemCounts
from zygopin.kinematics import by_finger
from zygopin.reason import MILLIMETRES

HEADINGS = (
    "height [mm]",
    "radius [mm]",
    "phalanx",
    "t",
    "grasping in",
    "feasible",
)
"""The columns of `solution_rows`."""

_READINGS = {
    (False, False): "none",
    (True, False): "section",
    (False, True): "base_to_tip",
    (True, True): "both",
}
"""In which readings a branch is grasped: the section's, base to tip."""


def solution_rows(found: BranchSolutions) -> list[tuple[str, ...]]:
    """The table of some solutions, lengths in millimetres.

    Args:
        found: The solutions.

    Returns:
        Texts: height and radius, of a family from end to end; the tangent phalanges,
            starred where on their back; t; in which readings it grasps; feasible.
    """
    return [
        (
            _range(found.heights[k]),
            _range(found.radii[k]),
            ", ".join(map(_phalanx, found.phalanx[k], found.side[k])),
            ", ".join(f"{t + 0.0:.2f}" for t in np.round(found.t[k], 2)),
            _READINGS[bool(found.grasping[k]), bool(found.grasping_base_to_tip[k])],
            "yes" if found.feasible[k] else "no",
        )
        for k in range(len(found))
    ]


def summary_lines(
    counts: SystemCounts, numbers: dict[str, Any], *, tied: bool
) -> list[str]:
    """What was solved and found, for a terminal.

    Args:
        counts: What became of the systems.
        numbers: Numbers of all solutions, of those that match, of the stable ones and
            the families among these; and what FCL says, or None.
        tied: Whether the branches are those under the base.

    Returns:
        The lines.
    """
    free = "for every radius" if tied else "the same line twice"
    lines = [
        f"singular: {counts.parallel} without a solution, {counts.same_line} {free}",
    ]
    left_out = [
        f"{count} {words}"
        for count, words in (
            (counts.along_axis, "along the axis"),
            (counts.base_inside, "with the base inside"),
            (counts.out_of_range, "too far or too thin"),
        )
        if count
    ]
    if left_out:
        lines.append(f"left out: {', '.join(left_out)}")
    lines.append(
        f"{numbers['solutions']} solutions; listed: {numbers['matching']}, of them "
        f"{numbers['stable']} stable, {numbers['families']} families"
    )
    if numbers["fcl"] is not None:
        apart = numbers["fcl"]["max_difference"] * MILLIMETRES
        failed = numbers["fcl"]["disagreeing"]
        lines.append(f"FCL: contacts within {apart:.1e} mm; {failed} disagree")
    return lines


def solutions_document(
    found: BranchSolutions, counts: SystemCounts, numbers: dict[str, Any]
) -> dict[str, Any]:
    """Solutions as plain values, all in SI.

    Args:
        found: The solutions that are listed.
        counts: What became of the systems.
        numbers: Further fields, beside those of the solutions.

    Returns:
        A mapping for JSON; an end that is endless, and a scalar product that does not
        exist, are None.
    """
    placement = found.placement
    return {
        "foot": found.foot.to_mapping(),
        "pair": [finger.name for finger in found.foot.fingers],
        "placement": {
            "axis": np.asarray(placement.axis).tolist(),
            "x": placement.x,
            "y": placement.y,
        },
        "tolerance": found.tolerance,
        "counts": {
            "systems": counts.systems,
            "parallel": counts.parallel,
            "same_line": counts.same_line,
            "along_axis": counts.along_axis,
            "base_inside": counts.base_inside,
            "out_of_range": counts.out_of_range,
        },
        **numbers,
        "listed": len(found),
        "branches": [_solution(found, k) for k in range(len(found))],
    }


def csv_header(found: BranchSolutions) -> str:
    """The first line of the CSV file.

    Args:
        found: Some solutions.

    Returns:
        The line: lengths in metres; a column for each control.
    """
    names = [finger.name for finger in found.foot.fingers]
    columns = ["height_m", "radius_m"]
    columns += [f"{what}_{end}_m" for what in ("height", "radius") for end in "01"]
    columns += [f"{name}_{what}" for what in ("phalanx", "side", "t") for name in names]
    columns += ["stable", "grasping_section", "grasping_base_to_tip", "feasible"]
    columns += ["product_section", "product_base_to_tip", "residual_m"]
    for finger in found.foot.fingers:
        columns += [f"{finger.name}_control{k + 1}" for k in range(finger.phalanges)]
    return ",".join(columns) + "\n"


def csv_lines(found: BranchSolutions) -> str:
    """Solutions as lines of the CSV file.

    Args:
        found: The solutions.

    Returns:
        One line each; numbers as Python writes them, exact.
    """
    columns = [
        *(found.height, found.radius, *found.heights.T, *found.radii.T),
        *(*found.phalanx.T, *found.side.T, *found.t.T),
        *(
            verdict.astype(int)
            for verdict in (
                found.stable,
                found.grasping,
                found.grasping_base_to_tip,
                found.feasible,
            )
        ),
        *(found.scalar_product, found.scalar_product_base_to_tip, found.residual),
        *found.controls.T,
    ]
    text = io.StringIO()
    rows = zip(*(column.tolist() for column in columns), strict=True)
    csv.writer(text, lineterminator="\n").writerows(rows)
    return text.getvalue()


def _solution(found: BranchSolutions, k: int) -> dict[str, Any]:
    """One solution as plain values."""
    return {
        "height": float(found.height[k]),
        "radius": float(found.radius[k]),
        "heights": _plain(found.heights[k]),
        "radii": _plain(found.radii[k]),
        "controls": by_finger(found.foot, found.controls[k]),
        "phalanges": found.phalanx[k].tolist(),
        "sides": found.side[k].tolist(),
        "t": found.t[k].tolist(),
        "residual": float(found.residual[k]),
        "stable": bool(found.stable[k]),
        "grasping": {
            "section": bool(found.grasping[k]),
            "base_to_tip": bool(found.grasping_base_to_tip[k]),
        },
        "feasible": bool(found.feasible[k]),
        "scalar_product": dict(
            zip(
                ("section", "base_to_tip"),
                _plain(
                    np.array(
                        [found.scalar_product[k], found.scalar_product_base_to_tip[k]]
                    )
                ),
                strict=True,
            )
        ),
    }


def _plain(values: Floats) -> list[float | None]:
    """Numbers, or None where there is none."""
    return [x if math.isfinite(x) else None for x in values.tolist()]


def _phalanx(rank: int, side: int) -> str:
    """Number of a phalanx, with a star where it is on its back."""
    return f"{rank}" if side > 0 else f"{rank}*"


def _range(ends: Floats) -> str:
    """Length [mm], or the ends of a family."""
    low, high = sorted(ends.tolist(), key=abs)
    first, last = (_short(end * MILLIMETRES) for end in (low, high))
    return first if low == high else f"{first}…{last}"


def _short(length: float) -> str:
    """Four digits of a length."""
    if not math.isfinite(length):
        return "∞" if length > 0 else "-∞"
    return f"{round(length, 6) + 0.0:.4g}"
