"""Seconds for each branch of a map, against trying poses at random."""

from __future__ import annotations

import time

import numpy as np

from zygopin import (
    Answer,
    BranchGrid,
    Criteria,
    Foot,
    branch_atlas,
    check_grasp,
    make_engine,
)


def rows(cells: int, poses: int) -> tuple[dict[str, float], float]:
    """Seconds for each branch of a grid, and what trying random poses finds.

    Tried through FCL, each pose counts for a branch that its toes meet to half a step
    of the grid: the resolution of the map. Returns the share found of the branches that
    the atlas grasps.
    """
    foot = Foot.preset("parrot")
    heights = np.linspace(-1.2, 0.0, cells) * foot.size
    radii = np.linspace(0.02, 0.8, cells) * foot.size
    grid = BranchGrid(heights, radii)
    start = time.perf_counter()
    found = branch_atlas(foot, grid)
    mapped = time.perf_counter() - start
    rows, columns = np.nonzero(grid.valid)
    branches, fcl = grid.at(rows, columns), make_engine("fcl", foot)
    criteria = Criteria(tolerance=(radii[1] - radii[0]) / 2)
    hit, rng = np.zeros(len(rows), dtype=bool), np.random.default_rng(0)
    start = time.perf_counter()
    for _ in range(poses):
        controls = rng.random((len(rows), foot.phalanx_count))
        report = check_grasp(foot, controls, branches, engine=fcl, criteria=criteria)
        hit |= report.grasping & report.feasible
    tried = time.perf_counter() - start
    grasped = found.grasping[rows, columns] == Answer.YES
    times = {
        f"branch_atlas, {cells} x {cells}": mapped / len(rows),
        f"{poses} random poses each, by FCL": tried / len(rows),
    }
    return times, float(hit[grasped].mean())
