"""Sweeps as users read them: JSON and tables."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from zygopin.design_sweep import SweepResult
from zygopin.sweep_dataset import reason_counts
from zygopin.sweep_grid import SweepGrid

OUTCOMES = {
    "grasping": "grasped, and nothing is entered",
    "not_around": "opposing toes touch, less than 90° apart",
    "unstable": "no two opposing toes lie on the branch",
    "infeasible": "a toe enters the branch or another toe",
    "invalid_branch": "no such branch for the foot",
    "invalid_foot": "no such foot",
}
"""What became of a cell, in words."""


def sweep_document(
    grid: SweepGrid, result: SweepResult, output: Path | None
) -> dict[str, Any]:
    """A sweep's summary as plain values, all in SI.

    Args:
        grid: The grid.
        result: What was found.
        output: Where it was saved.

    Returns:
        A mapping for JSON.
    """
    return {
        "foot": grid.foot.to_mapping(),
        "fixed": dict(grid.fixed),
        "dimensions": {name: list(values) for name, values in grid.axes.items()},
        "cells": grid.count,
        "chunks": {"total": result.chunks, "kept": result.kept},
        "reasons": reason_counts(result.dataset),
        "output": None if output is None else str(output),
    }


def grid_line(grid: SweepGrid) -> str:
    """What a grid is, in one line.

    Args:
        grid: The grid.

    Returns:
        The foot's name, the dimensions and their lengths, the number of cells.
    """
    sizes = [f"{len(values)} {name}" for name, values in grid.axes.items()]
    product = f"{' × '.join(sizes)} = " if sizes else ""
    return f"{grid.foot.name}: {product}{grid.count} cells"


def reason_rows(result: SweepResult) -> list[tuple[str, ...]]:
    """The table of what became of the cells.

    Args:
        result: What was found.

    Returns:
        Texts: the outcome, the number of cells, their share; none without a cell.
    """
    counts = reason_counts(result.dataset)
    total = sum(counts.values())
    return [
        (OUTCOMES[name], str(count), f"{count / total:.1%}")
        for name, count in counts.items()
        if count
    ]
