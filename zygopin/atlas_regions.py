"""The regions of an atlas: for each branch the most that a foot can do with it."""

from __future__ import annotations

from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from zygopin import kinds
from zygopin.atlas import VERDICTS, Atlas
from zygopin.errors import ParameterError
from zygopin.grasp import GraspReport
from zygopin.toe_contacts import Answer, Codes

Booleans = NDArray[np.bool_]
Cell = tuple[int, int]

MOST_PICKED = 26
"""Cells that `picked_cells` gives at most: the letters of the alphabet."""


class Region(IntEnum):
    """The most that is shown for a branch; `UNDECIDED`: nothing is."""

    HOLDS_BASE = -2
    UNDECIDED = -1
    NONE = 0
    STABLE = 1
    TOUCHABLE = 2
    FEASIBLE = 3
    GRASPING = 4


REGION_WORDS = {
    Region.GRASPING: "grasping",
    Region.FEASIBLE: "tangent, no grasp",
    Region.TOUCHABLE: "touched only",
    Region.STABLE: "stable if entered",
    Region.NONE: "none of these",
    Region.UNDECIDED: "undecided",
    Region.HOLDS_BASE: "holds the base",
}
"""What the regions are called, the best first."""

_BETTER: dict[Region, tuple[str, ...]] = {
    Region.NONE: VERDICTS,
    Region.STABLE: ("touchable", "feasible", "grasping"),
    Region.TOUCHABLE: ("feasible", "grasping"),
    Region.FEASIBLE: ("grasping",),
}
"""Questions whose yes would put a branch into a better region."""


def region_map(atlas: Atlas) -> Codes:
    """The most that is shown for each branch.

    A branch that can be touched with nothing entering counts as that even where it is
    stable for toes that enter it.

    Args:
        atlas: The atlas.

    Returns:
        `Region` codes, shape (H, R).
    """
    kinds.instance("atlas", atlas, Atlas)
    unknown = np.any([atlas.answer(name) == Answer.UNDECIDED for name in VERDICTS], 0)
    found = np.where(unknown, Region.UNDECIDED, Region.NONE)
    for region in (
        Region.STABLE,
        Region.TOUCHABLE,
        Region.FEASIBLE,
        Region.GRASPING,
    ):
        found[atlas.answer(region.name.lower()) == Answer.YES] = region
    found[~atlas.grid.valid] = Region.HOLDS_BASE
    return found.astype(np.int8)


def open_cells(atlas: Atlas) -> Booleans:
    """Branches for which more may be possible than is shown.

    Args:
        atlas: The atlas.

    Returns:
        Where a question is undecided whose yes would put the branch into a better
        region; shape (H, R).
    """
    regions = region_map(atlas)
    found = regions == Region.UNDECIDED
    for region, better in _BETTER.items():
        asked = np.any([atlas.answer(name) == Answer.UNDECIDED for name in better], 0)
        found |= (regions == region) & asked
    return np.asarray(found)


def region_shares(atlas: Atlas) -> dict[Region, float]:
    """How large the regions are.

    Args:
        atlas: The atlas.

    Returns:
        Shares of the branches that do not hold the base, the best region first; 0
        where there are none.
    """
    regions = region_map(atlas)
    count = max(int(np.sum(regions != Region.HOLDS_BASE)), 1)
    return {
        region: float(np.sum(regions == region)) / count
        for region in REGION_WORDS
        if region != Region.HOLDS_BASE
    }


def open_share(atlas: Atlas) -> float:
    """Share of `open_cells` among the branches that do not hold the base."""
    return float(open_cells(atlas).sum() / max(int(atlas.grid.valid.sum()), 1))


def has_pose(atlas: Atlas) -> Booleans:
    """Branches for which a pose shows something, shape (H, R)."""
    poses = (atlas.controls, atlas.stable_controls)
    found = np.any([np.isfinite(pose).all(axis=-1) for pose in poses], axis=0)
    return np.asarray(found)


def picked_cells(atlas: Atlas, count: int) -> list[Cell]:
    """Cells that show what the foot can do, far from each other on the map.

    Args:
        atlas: The atlas.
        count: How many are wanted, up to `MOST_PICKED`.

    Returns:
        Rows and columns, by growing radius: most from the grasping region, one from
        each other region that has poses; fewer where there are not so many.
    """
    regions, posed = region_map(atlas), has_pose(atlas)
    kinds = [r for r in REGION_WORDS if np.any(posed & (regions == r))]
    chosen: list[Cell] = []
    for place, kind in enumerate(kinds):
        rest = len(kinds) - place - 1
        wanted = max(count - rest, 1) if place == 0 else 1
        where = np.argwhere(posed & (regions == kind))
        chosen += _apart(where, chosen, min(wanted, count - len(chosen)), atlas)
    return sorted(chosen, key=lambda cell: (cell[1], cell[0]))


def pose_report(atlas: Atlas, cell: Cell) -> GraspReport:
    """The verdicts on the pose of one cell.

    Args:
        atlas: The atlas.
        cell: Row and column.

    Returns:
        The report.

    Raises:
        ParameterError: There is no such cell, or it has no pose.
    """
    shape = atlas.grid.shape
    if not _is_cell(cell, shape):
        allowed = f"a row below {shape[0]} and a column below {shape[1]}"
        raise ParameterError("cell", cell, allowed, "count both from 0")
    if not has_pose(atlas)[cell]:
        remedy = "choose one where something is shown"
        raise ParameterError("cell", cell, "a cell with a pose", remedy)
    return atlas.report(*cell)


def _is_cell(cell: object, shape: tuple[int, int]) -> bool:
    """Whether a value is a row and a column of a grid."""
    if not isinstance(cell, tuple) or len(cell) != 2:
        return False
    whole = all(isinstance(k, (int, np.integer)) for k in cell)
    return whole and all(0 <= k < n for k, n in zip(cell, shape, strict=True))


def _apart(
    where: NDArray[np.intp], others: list[Cell], count: int, atlas: Atlas
) -> list[Cell]:
    """Some of a region's cells, each as far as can be from those before it."""
    scale = np.maximum(np.array(atlas.grid.shape) - 1, 1)
    places = where / scale
    middle = np.linalg.norm(places - np.median(places, axis=0), axis=1)
    distance = np.full(len(where), np.inf)
    for cell in others:
        away = np.linalg.norm(places - np.array(cell) / scale, axis=1)
        distance = np.minimum(distance, away)
    chosen: list[Cell] = []
    while len(chosen) < min(count, len(where)):
        first = not np.isfinite(distance).any()
        index = int(np.argmin(middle) if first else np.argmax(distance))
        chosen.append((int(where[index][0]), int(where[index][1])))
        away = np.linalg.norm(places - places[index], axis=1)
        distance = np.minimum(distance, away)
    return chosen
