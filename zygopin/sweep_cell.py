"""The work of a sweep: one plan for each cell, some cells at a time."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cache, cached_property, lru_cache
from importlib.metadata import version
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.errors import ZygopinError
from zygopin.foot import Foot
from zygopin.grasp import GraspReport
from zygopin.perch import PerchPlan, search_perch
from zygopin.sweep_grid import FOUND, SweepGrid, Value, cell_branch, cell_foot

CHUNK = 8
"""Cells of a chunk: a third of a second of work at rest, and as much is lost by a
kill."""

MOST_CHUNKS = 4096
"""Chunks of a sweep: larger grids have larger chunks rather than more files."""

REASONS = (
    "grasping",
    "not_around",
    "unstable",
    "infeasible",
    "invalid_branch",
    "invalid_foot",
)
"""What became of a cell, by code: a feasible grasp; opposing toes too close together
for one; no two opposing toes lie on the branch; something is entered; there is no such
branch for the foot, or no such foot."""

VERDICTS = ("invalid", "no", "yes")
"""What the verdicts' codes −1, 0 and 1 mean."""


class Result(NamedTuple):
    """A number that a sweep finds in each cell.

    Attributes:
        dtype: Its type.
        empty: What an invalid cell has.
        unit: Its unit, as netCDF files have it.
        words: What it is.
    """

    dtype: str
    empty: float
    unit: str
    words: str


RESULTS = {
    "grasping": Result("i1", -1, "1", "whether the plan is a grasp (section reading)"),
    "feasible": Result("i1", -1, "1", "whether nothing enters branch or fingers"),
    "stable": Result("i1", -1, "1", "whether two opposable fingers are tangent"),
    "reason": Result("i1", -1, "1", "what became of the cell"),
    "toes": Result("i1", -1, "1", "number of fingers with a tangent phalanx"),
    "wrap": Result(
        "f8", np.nan, "rad", "largest angle from the base to a toe's last tangent point"
    ),
    "scalar_product": Result(
        "f8", np.nan, "1", "least product of contact normals of opposable fingers"
    ),
    "branch_height": Result("f8", np.nan, "m", "z of the branch's centre in the plan"),
    "controls": Result("f8", np.nan, "1", "controls of the plan, 0 straight, 1 closed"),
}
"""What is found in each cell; controls have a row for each finger."""

Arrays = dict[str, NDArray[Any]]


@dataclass(frozen=True)
class Chunk:
    """Some cells of a sweep, with all that determines their results.

    Attributes:
        foot: The foot that the sweep starts from.
        fixed: Quantities of one value, by name [SI].
        cells: What varies, cell by cell [SI].
        width: Most phalanges that a finger of the sweep has.
        levels: Angles that the planner tries at each joint.
    """

    foot: Foot
    fixed: Mapping[str, Value]
    cells: tuple[Mapping[str, Value], ...]
    width: int
    levels: int

    @cached_property
    def digest(self) -> str:
        """SHA-256 of everything that determines the results."""
        return digest(
            {
                "version": package_version(),
                "results": list(RESULTS),
                "foot": foot_text(self.foot),
                "cells": [dict(self.fixed) | dict(cell) for cell in self.cells],
                "width": self.width,
                "levels": self.levels,
            }
        )

    @property
    def shapes(self) -> dict[str, tuple[int, ...]]:
        """Shape of each result."""
        count = len(self.cells)
        shapes: dict[str, tuple[int, ...]] = dict.fromkeys(RESULTS, (count,))
        shapes["controls"] = (count, len(self.foot.fingers), self.width)
        return shapes


@cache
def package_version() -> str:
    """This package's version; looked up once, for every chunk has it."""
    return version("zygopin")


@lru_cache(maxsize=16)
def foot_text(foot: Foot) -> str:
    """A foot as JSON, kept, for every chunk of a sweep has the same."""
    return json.dumps(foot.to_mapping(), sort_keys=True)


def digest(document: Mapping[str, Any]) -> str:
    """SHA-256 of plain values, whatever the order of their keys.

    Args:
        document: The values.

    Returns:
        64 hexadecimal digits.
    """
    text = json.dumps(document, sort_keys=True)
    return hashlib.sha256(text.encode()).hexdigest()


def chunks(grid: SweepGrid, levels: int) -> Iterator[Chunk]:
    """The cells of a grid, some at a time, in their order.

    Args:
        grid: The grid.
        levels: Angles that the planner tries at each joint.

    Yields:
        The chunks.
    """
    size = max(CHUNK, -(-grid.count // MOST_CHUNKS))
    width = grid.width
    for start in range(0, grid.count, size):
        numbers = range(start, min(start + size, grid.count))
        cells = tuple(map(grid.cell, numbers))
        yield Chunk(grid.foot, grid.fixed, cells, width, levels)


def plan_chunk(chunk: Chunk) -> Arrays:
    """Plan a perch in each cell.

    Args:
        chunk: The cells.

    Returns:
        Arrays by the names of `RESULTS`, a row for each cell.
    """
    arrays = {
        name: np.full(shape, RESULTS[name].empty, dtype=RESULTS[name].dtype)
        for name, shape in chunk.shapes.items()
    }
    for row, cell in enumerate(chunk.cells):
        found = _planned(chunk.foot, dict(chunk.fixed) | dict(cell), chunk.levels)
        if isinstance(found, str):
            arrays["reason"][row] = REASONS.index(found)
        else:
            _fill(arrays, row, found)
    return arrays


def _planned(foot: Foot, values: Mapping[str, Value], levels: int) -> PerchPlan | str:
    """The plan of one cell, or the reason that there is none."""
    try:
        changed = cell_foot(foot, values)
    except ZygopinError:
        return "invalid_foot"
    try:
        branch = cell_branch(changed, values)
        find = values["height"] == FOUND
        return search_perch(changed, branch, find_height=find, levels=levels)
    except ZygopinError:
        return "invalid_branch"


def _fill(arrays: Arrays, row: int, plan: PerchPlan) -> None:
    """Write a plan's numbers into a row."""
    report, foot = plan.report, plan.report.foot
    turned = float(plan.wrap.max())
    numbers = {
        "grasping": report.grasping,
        "feasible": report.feasible,
        "stable": report.stable,
        "reason": REASONS.index(_reason(report)),
        "toes": len(set(foot.finger_of_phalanx[report.tangent].tolist())),
        "wrap": turned if np.isfinite(turned) else np.nan,
        "scalar_product": report.scalar_product,
        "branch_height": plan.branch.centre[2],
    }
    for name, number in numbers.items():
        arrays[name][row] = number
    for place, part in enumerate(foot.finger_slices.values()):
        values = plan.controls[part]
        arrays["controls"][row, place, : len(values)] = values


def _reason(report: GraspReport) -> str:
    """What a verdict comes to, the gravest first."""
    if not report.feasible:
        return "infeasible"
    if not report.stable:
        return "unstable"
    return "grasping" if report.grasping else "not_around"
