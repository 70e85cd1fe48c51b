"""A sweep's results as a labelled dataset, with units and names throughout.

Xarray comes from here alone, so that its absence is told once.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from zygopin.errors import MissingExtraError
from zygopin.sweep_cell import (
    REASONS,
    RESULTS,
    VERDICTS,
    Arrays,
    Chunk,
    digest,
    foot_text,
    package_version,
)
from zygopin.sweep_grid import FOOT_QUANTITIES, QUANTITIES, SweepGrid

try:
    import xarray as xarray
    from xarray import Dataset as Dataset
except ImportError as error:
    raise MissingExtraError("xarray", "sweep") from error

VERDICT_NAMES = ("grasping", "feasible", "stable")
"""Results that are −1, 0 or 1."""


def question_digest(chunks: Sequence[Chunk]) -> str:
    """SHA-256 of a whole sweep's question.

    Args:
        chunks: All its chunks.

    Returns:
        64 hexadecimal digits.
    """
    return digest({"chunks": [chunk.digest for chunk in chunks]})


def to_dataset(
    grid: SweepGrid, chunks: Sequence[Chunk], arrays: Sequence[Arrays]
) -> Dataset:
    """Put a sweep's results together.

    Args:
        grid: The grid.
        chunks: All its chunks, in order.
        arrays: The arrays of each.

    Returns:
        A dataset with a dimension for each quantity that varies.
    """
    dims = tuple(grid.axes)
    variables = {}
    for name, result in RESULTS.items():
        flat = np.concatenate([each[name] for each in arrays])
        own = ("finger", "phalanx") if name == "controls" else ()
        values = flat.reshape((*grid.shape, *flat.shape[1:]))
        attributes = {"long_name": result.words, "units": result.unit}
        if name in VERDICT_NAMES:
            attributes |= _flags(values, (-1, 0, 1), VERDICTS)
        elif name == "reason":
            attributes |= _flags(values, range(len(REASONS)), REASONS)
        variables[name] = ((*dims, *own), values, attributes)
    return xarray.Dataset(variables, _coordinates(grid), _attributes(grid, chunks))


def reason_counts(dataset: Dataset) -> dict[str, int]:
    """How many cells came to what.

    Args:
        dataset: A sweep's dataset.

    Returns:
        The number of cells for each of `REASONS`.
    """
    codes = np.asarray(dataset["reason"]).ravel()
    counts = np.bincount(codes, minlength=len(REASONS))
    return dict(zip(REASONS, counts.tolist(), strict=True))


def _flags(values: Any, codes: Sequence[int], words: Sequence[str]) -> dict[str, Any]:  # noqa: ANN401
    """Attributes that say what a variable's codes mean, and how often each occurs."""
    counts = [int(np.count_nonzero(values == code)) for code in codes]
    return {
        "flag_values": np.array(codes, dtype="i1"),
        "flag_meanings": " ".join(words),
        "flag_counts": np.array(counts, dtype="i4"),
    }


def _coordinates(grid: SweepGrid) -> dict[str, Any]:
    """The values along each dimension, with their units."""
    made: dict[str, Any] = {}
    for name, values in grid.axes.items():
        quantity = QUANTITIES[name]
        attributes = {"long_name": quantity.words, "units": quantity.unit or "1"}
        made[name] = (name, np.array(values), attributes)
    names = np.array([finger.name for finger in grid.foot.fingers])
    words = {"long_name": "name of the finger", "units": "1"}
    made["finger"] = ("finger", names, words)
    ranks = np.arange(1, grid.width + 1, dtype="i4")
    words = {"long_name": "number of the phalanx from the base", "units": "1"}
    made["phalanx"] = ("phalanx", ranks, words)
    return made


def _attributes(grid: SweepGrid, chunks: Sequence[Chunk]) -> dict[str, Any]:
    """What is the same in all cells: the foot, the fixed quantities, the version."""
    foot = grid.foot
    own: dict[str, Any] = {
        name: getattr(foot, name) for name in FOOT_QUANTITIES if name != "phalanges"
    }
    own["phalanges"] = "-".join(str(finger.phalanges) for finger in foot.fingers)
    fixed = {name: value for name, value in own.items() if name not in grid.axes}
    return {
        "title": f"perches of {foot.name} over a grid of feet and branches",
        "source": f"zygopin {package_version()}",
        "zygopin_version": package_version(),
        "unit_system": "SI: lengths in m, angles in rad",
        **(fixed | dict(grid.fixed)),
        "levels": chunks[0].levels,
        "foot": foot_text(foot),
        "digest": question_digest(chunks),
    }
