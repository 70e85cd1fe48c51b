"""Reachable sets and their validation as users read them: JSON, tables, arrays."""

from __future__ import annotations

import math
from collections.abc import Sequence
from functools import partial
from pathlib import Path
from typing import IO, TYPE_CHECKING, Any

import numpy as np

from zygopin.archive import Content, write_archive
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.reach import FingerReach

if TYPE_CHECKING:  # the rows come from the caller, and Pinocchio with them
    from zygopin.validation import ValidationRow

MILLIMETRES = 1e3
"""Millimetres in a metre."""


def validation_document(foot: Foot, rows: Sequence[ValidationRow]) -> dict[str, Any]:
    """A validation as plain values, all in SI.

    Args:
        foot: The foot.
        rows: Its rows.

    Returns:
        A mapping for JSON.
    """
    return {
        "foot": foot.to_mapping(),
        "ok": all(row.ok for row in rows),
        "rows": [
            {
                "finger": row.finger,
                "pose": row.pose,
                "check": row.check,
                "levels": row.levels,
                "configurations": row.configurations,
                "value": row.value,
                "bound": row.bound,
                "slack": row.slack,
                "ok": row.ok,
            }
            for row in rows
        ],
    }


def validation_rows(rows: Sequence[ValidationRow]) -> list[tuple[str, ...]]:
    """The table of a validation, lengths in millimetres.

    Args:
        rows: The rows.

    Returns:
        Texts: finger with its pose where it is spread, check, levels, configurations,
            value, relation, bound, verdict.
    """
    return [
        (
            f"{row.finger} spread" if row.pose == "spread" else row.finger,
            row.check,
            str(row.levels),
            str(row.configurations),
            f"{row.value * MILLIMETRES:.4g}",
            "≤" if row.slack is None else "=",
            f"{row.bound * MILLIMETRES:.4g}",
            "yes" if row.ok else "NO",
        )
        for row in rows
    ]


def reach_document(
    reaches: Sequence[FingerReach], *, hull: bool = False
) -> dict[str, Any]:
    """Reachable sets of one finger as plain values, all in SI.

    Args:
        reaches: Sets that differ in the feet's joint limits.
        hull: Whether to list the convex hulls' vertices with their words.

    Returns:
        A mapping for JSON; the points themselves are for `write_arrays`.
    """
    first = reaches[0]
    return {
        "foot": first.foot.to_mapping(),
        "finger": first.finger.name,
        "depth": first.depth,
        "levels": first.plane.levels.tolist(),
        "sets": [_set(reach, hull=hull) for reach in reaches],
    }


def reach_rows(reaches: Sequence[FingerReach]) -> list[tuple[str, ...]]:
    """The table of some sets, lengths in millimetres, angles in degrees.

    Args:
        reaches: The sets.

    Returns:
        Texts: ω, points, range of x, range of z, hull's area, the two bounds.
    """
    return [
        (
            f"{math.degrees(reach.foot.omega):.6g}",
            str(len(reach.plane.points)),
            _range(reach.points.real),
            _range(reach.points.imag),
            f"{reach.hull.area * MILLIMETRES**2:.4g}",
            f"{reach.grid_bound * MILLIMETRES:.4g}",
            f"{reach.depth_bound * MILLIMETRES:.4g}",
        )
        for reach in reaches
    ]


def write_arrays(reaches: Sequence[FingerReach], path: Path | str) -> Path:
    """Write sets of one finger as a NumPy archive.

    Its arrays: `points` x + iz [m], shape (sets, n^k); `levels`, shape (n,); `omega`
    [rad], `depth_bound` and `grid_bound` [m], shape (sets,); `rho`, `scale` [m],
    `depth`, `orientation` and `azimuth` [rad], shape (). The word of point i: the
    levels at the k digits of i in base n, the first control's digit first.

    Points are written set by set, so that one set's copy is all the memory it takes.

    Args:
        reaches: Sets that differ in the feet's joint limits.
        path: The file.

    Returns:
        The path.

    Raises:
        ParameterError: The sets differ in their numbers of points.
        FileError: The file cannot be written.
    """
    _check_sizes(reaches)
    first = reaches[0]
    arrays: dict[str, Content] = {
        "points": partial(_write_points, reaches),
        "levels": first.plane.levels,
        "omega": [reach.foot.omega for reach in reaches],
        "depth_bound": [reach.depth_bound for reach in reaches],
        "grid_bound": [reach.grid_bound for reach in reaches],
        "rho": first.foot.rho,
        "scale": first.foot.scale,
        "depth": first.depth,
        "orientation": first.finger.orientation,
        "azimuth": first.finger.azimuth,
    }
    return write_archive(path, arrays)


def _check_sizes(reaches: Sequence[FingerReach]) -> None:
    """All sets have as many points, so that one array can hold them."""
    sizes = [len(reach.plane.points) for reach in reaches]
    if len(set(sizes)) != 1:
        remedy = "give sets of one depth and one number of levels"
        raise ParameterError("points of the sets", sizes, "one number", remedy)


def _write_points(reaches: Sequence[FingerReach], file: IO[bytes]) -> None:
    """Write the points of all sets as one array, of shape (sets, n^k)."""
    points = reaches[0].plane.points
    header = np.lib.format.header_data_from_array_1_0(points)
    header["shape"] = (len(reaches), *points.shape)
    np.lib.format.write_array_header_1_0(file, header)
    for reach in reaches:
        file.write(reach.points.data)


def _set(reach: FingerReach, *, hull: bool) -> dict[str, Any]:
    """One set as plain values."""
    points = reach.points
    return {
        "omega": reach.foot.omega,
        "points": len(points),
        "x": [float(points.real.min()), float(points.real.max())],
        "z": [float(points.imag.min()), float(points.imag.max())],
        "hull_area": reach.hull.area,
        "hull": _vertices(reach) if hull else None,
        "grid_bound": reach.grid_bound,
        "depth_bound": reach.depth_bound,
    }


def _vertices(reach: FingerReach) -> list[dict[str, Any]]:
    """The hull's vertices and their words."""
    words = reach.hull.words(reach.plane)
    return [
        {"x": float(point.real), "z": float(point.imag), "controls": word.tolist()}
        for point, word in zip(reach.hull.points, words, strict=True)
    ]


def _range(values: np.ndarray) -> str:
    """Least and greatest of some lengths [mm]."""
    low, high = (float(f(values)) * MILLIMETRES + 0.0 for f in (np.min, np.max))
    return f"{low:.4g} … {high:.4g}"
