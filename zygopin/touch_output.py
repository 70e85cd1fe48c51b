"""Touch intervals as users read them: one JSON document, or a table."""

from __future__ import annotations

from typing import Any

import numpy as np

from zygopin.reason import MILLIMETRES
from zygopin.touch import TouchIntervals


def touch_document(intervals: TouchIntervals) -> dict[str, Any]:
    """Intervals as plain values, all in SI.

    Args:
        intervals: The intervals before one axis.

    Returns:
        A mapping for JSON.
    """
    foot, branch = intervals.foot, intervals.branch
    return {
        "foot": foot.to_mapping(),
        "axis": {"centre": branch.centre.tolist(), "direction": branch.axis.tolist()},
        "tolerance": intervals.tolerance,
        "fingers": [_finger(intervals, index) for index in range(len(foot.fingers))],
        "pairs": [
            {
                "fingers": [foot.fingers[index].name for index in pair],
                "radii": common_radii(intervals, pair),
                "proved_none": none_in_common(intervals, pair),
            }
            for pair in foot.opposable_pairs
        ],
    }


def touch_rows(intervals: TouchIntervals) -> list[tuple[str, ...]]:
    """The table of the intervals, radii in millimetres.

    Args:
        intervals: The intervals before one axis.

    Returns:
        Texts: finger, least radius and its bound, greatest radius and its bound,
            boxes.
    """
    rows: list[tuple[str, ...]] = []
    for index, finger in enumerate(intervals.foot.fingers):
        bound, least = intervals.least[index]
        most, cap = intervals.most[index]
        texts = ("none", "", "none", "") if cap <= 0 else None
        texts = texts or (_mm(least), _mm(bound), _mm(most), _mm(cap))
        rows.append((finger.name, *texts, str(intervals.boxes[index])))
    return rows


def touch_lines(intervals: TouchIntervals) -> list[str]:
    """Which radii both fingers of each opposable pair can touch, in words.

    Args:
        intervals: The intervals before one axis.

    Returns:
        One line for each pair; one more where bounds are wider than wanted.
    """
    lines = []
    for pair in intervals.foot.opposable_pairs:
        names = " and ".join(intervals.foot.fingers[index].name for index in pair)
        radii = common_radii(intervals, pair)
        if radii is not None:
            words = f"{_mm(radii[0])} to {_mm(radii[1])} mm"
        elif none_in_common(intervals, pair):
            words = "no radius, proved"
        else:
            words = "no radius was found"
        lines.append(f"{names}: {words}")
    wide = np.nonzero(~intervals.converged)[0]
    if wide.size:
        names = ", ".join(intervals.foot.fingers[index].name for index in wide)
        lines.append(f"wider than {intervals.tolerance:g} of its length: {names}")
    return lines


def common_radii(
    intervals: TouchIntervals, pair: tuple[int, int]
) -> list[float] | None:
    """Radii that two fingers can both touch without entering.

    Args:
        intervals: The intervals before one axis.
        pair: Indices of the fingers.

    Returns:
        Least and greatest of them [m]; None: none was found.
    """
    least = max(0.0, *(float(intervals.least[index, 1]) for index in pair))
    most = min(float(intervals.most[index, 0]) for index in pair)
    return [least, most] if least <= most and most > 0 else None


def none_in_common(intervals: TouchIntervals, pair: tuple[int, int]) -> bool:
    """Whether no branch can be touched by both fingers: proved by the bounds.

    Args:
        intervals: The intervals before one axis.
        pair: Indices of the fingers.

    Returns:
        Whether the certified intervals are disjoint, or hold no positive radius.
    """
    least = np.max(intervals.least[list(pair), 0])
    most = np.min(intervals.most[list(pair), 1])
    return bool(most < max(least, 0.0) or most <= 0)


def _finger(intervals: TouchIntervals, index: int) -> dict[str, Any]:
    """One finger's interval as plain values."""
    finger = intervals.foot.fingers[index]
    part = intervals.foot.finger_slices[finger.name]
    bound, least = intervals.least[index].tolist()
    most, cap = intervals.most[index].tolist()
    nearest, farthest = intervals.least_controls[part], intervals.most_controls[part]
    return {
        "finger": finger.name,
        "least": {"bound": bound, "attained": least, "controls": nearest.tolist()},
        "most": {"bound": cap, "attained": most, "controls": farthest.tolist()},
        "converged": bool(intervals.converged[index]),
        "boxes": int(intervals.boxes[index]),
    }


def _mm(radius: float) -> str:
    """A radius [mm], none below zero."""
    return f"{max(float(radius), 0.0) * MILLIMETRES:.4g}"
