"""Designs as users read them: JSON, tables, a foot's file."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

from zygopin.design import Design
from zygopin.foot import Foot
from zygopin.graspable import GraspableRadii
from zygopin.presets import write_parameters

MILLIMETRES = 1e3
"""Millimetres in a metre."""

SHOWN: dict[str, tuple[str, Callable[[float], float]]] = {
    "rho": ("ρ", float),
    "omega": ("ω [°]", math.degrees),
    "splay": ("splay [°]", math.degrees),
    "scale": ("scale [mm]", lambda x: x * MILLIMETRES),
    "thickness": ("skin [mm]", lambda x: x * MILLIMETRES),
}
"""Parameters of a table: what they are called, and in which unit they are shown."""


def design_document(design: Design) -> dict[str, Any]:
    """A design as plain values, all in SI.

    Args:
        design: The design.

    Returns:
        A mapping for JSON.
    """
    return {
        "range": [design.before.low, design.before.high],
        "tolerance": [design.before.tolerance, design.after.tolerance],
        "bounds": {name: list(ends) for name, ends in design.bounds.items()},
        "trials": design.trials,
        "improved": design.improved,
        "before": _perches(design.before),
        "after": _perches(design.after),
    }


def design_rows(design: Design) -> list[tuple[str, ...]]:
    """The table of a design: the foot before and after.

    Args:
        design: The design.

    Returns:
        Texts: what it is, before, after, and the bounds of what was free.
    """
    both = (design.before, design.after)
    rows = []
    for name, (words, shown) in SHOWN.items():
        ends = design.bounds.get(name)
        free = "" if ends is None else " to ".join(f"{shown(x):.4g}" for x in ends)
        values = [f"{shown(getattr(each.foot, name)):.4g}" for each in both]
        rows.append((words, *values, free))
    rows.append(("graspable radii [mm]", *map(intervals_text, both), ""))
    rows.append(("share of the range", *(f"{each.share:.1%}" for each in both), ""))
    wraps = (f"{math.degrees(each.wrap):.4g}" for each in both)
    rows.append(("mean wrap [°]", *wraps, ""))
    return rows


def intervals_text(perches: GraspableRadii) -> str:
    """Intervals in millimetres, one to a line.

    Args:
        perches: The graspable radii.

    Returns:
        Their ends, or `none`.
    """
    lines = [
        f"{low * MILLIMETRES:.4g} to {high * MILLIMETRES:.4g}"
        for low, high in perches.intervals
    ]
    return "\n".join(lines) or "none"


def write_design(design: Design, path: Path | str) -> Path:
    """Write the foot that was found as a file for `Foot.load` and `--foot`.

    Args:
        design: The design.
        path: The YAML file.

    Returns:
        The path.

    Raises:
        FileError: The file cannot be written.
    """
    low, high = (
        f"{end * MILLIMETRES:g}" for end in (design.after.low, design.after.high)
    )
    start: Foot = design.before.foot
    words = f"Designed from {start.name} for perches of radius {low} to {high} mm"
    return write_parameters(path, {"description": words, **design.foot.to_mapping()})


def _perches(perches: GraspableRadii) -> dict[str, Any]:
    """A foot and its graspable radii as plain values."""
    return {
        "foot": perches.foot.to_mapping(),
        "intervals": [list(ends) for ends in perches.intervals],
        "length": perches.length,
        "log_length": perches.log_length,
        "share": perches.share,
        "wrap": perches.wrap,
    }
