"""Proof that a finger has no pose on a branch: by its reach, then by search."""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.contact_hull import STAGES, Circles, Criterion, contact_possible
from zygopin.projection import BACK, BEHIND, PALM, Floats, ProjectedFinger

Booleans = NDArray[np.bool_]


def unproved(
    finger: ProjectedFinger,
    grid: BranchGrid,
    asked: Booleans,
    criterion: Criterion,
    *,
    beyond: Floats | None = None,
    stages: int = len(STAGES),
) -> Booleans:
    """Branches on which a finger may yet have a tangent phalanx.

    Args:
        finger: The finger, seen along the branches.
        grid: The branches.
        asked: The branches in question, for each phalanx, shape (K, H, R).
        criterion: What counts as a tangent phalanx.
        beyond: Only contacts count whose wrap, times the criterion's sense, is more
            than this [rad], broadcast to shape (K, H, R); None: any.
        stages: How many of the search's `STAGES` are gone through.

    Returns:
        Those of the branches for which no proof was found, shape (K, H, R): on the
        others no pose exists.
    """
    if finger.edgewise:
        return np.array(asked, dtype=bool)
    bounds = np.broadcast_to(-np.inf if beyond is None else beyond, asked.shape)
    sides = (PALM,) if criterion.palmar else (PALM, BACK)
    result = np.zeros_like(asked)
    for index, side in itertools.product(reversed(range(len(asked))), sides):
        least = bounds[index]
        near = asked[index] & ~_out_of_reach(finger, grid, index + 1, criterion, least)
        cells = np.nonzero(near)
        centre, radius = grid.centres(finger)[cells[0]], grid.radii[cells[1]]
        circles = Circles(centre, radius, least[cells])
        left = contact_possible(
            finger, circles, index + 1, side, criterion, stages=stages
        )
        result[index][cells] |= left
    return result


def farthest_wrap(
    finger: ProjectedFinger, grid: BranchGrid, rank: int, tolerance: float
) -> Floats:
    """Bound on how far round a phalanx can touch without any entering the branch.

    The bones before the contact lie outside the disc of radius r + εₖ, so they are no
    shorter than the way to it: straight where the base sees it, and else the tangent
    from the base and the arc behind it.

    Args:
        finger: The finger.
        grid: The branches.
        rank: Number k of the phalanx.
        tolerance: Clearance that counts as contact [m].

    Returns:
        Bounds on |wrap| [rad], shape (H, R); −∞ where it cannot touch at all.
    """
    distance = grid.base_distance[:, None]
    skin = np.maximum(grid.radii + finger.radii[rank - 1] - tolerance, tolerance)
    reach = finger.lengths[:rank].sum() + tolerance
    tangent = np.sqrt(np.maximum(distance**2 - skin**2, 0.0))
    behind = np.arccos(skin / np.maximum(distance, skin)) + (reach - tangent) / skin
    scale = 2 * np.maximum(distance, skin) * skin
    seen = np.arccos(np.clip((distance**2 + skin**2 - reach**2) / scale, -1.0, 1.0))
    away = distance > reach + skin
    entered = distance < grid.radii + finger.radii[0] - tolerance
    most = np.where(tangent > reach, seen, behind)
    return np.where(away | entered, -np.inf, most)


def _out_of_reach(
    finger: ProjectedFinger,
    grid: BranchGrid,
    rank: int,
    criterion: Criterion,
    least: Floats,
) -> Booleans:
    """Branches that a phalanx cannot touch, or not so far round, by its reach alone."""
    tolerance = criterion.tolerance
    if not criterion.solid:
        skin = grid.radii + finger.radii[rank - 1] + tolerance
        away = grid.base_distance[:, None] - skin
        return np.asarray(away > finger.lengths[:rank].sum())
    most = farthest_wrap(finger, grid, rank, tolerance)
    # The other way round, a contact farther than this counts as nearly a full turn.
    short = most < np.minimum(least, -BEHIND)
    return np.asarray(np.isneginf(most) | short)
