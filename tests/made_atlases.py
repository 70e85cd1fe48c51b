"""Atlases made by hand: two toes wrapped as far as poses are found, checked exactly."""

from __future__ import annotations

from functools import cache

import numpy as np

from zygopin import Answer, Atlas, BranchGrid, Foot, check_grasp
from zygopin.branch_solutions import pair_of_fingers
from zygopin.wrap import finger_poses

LEVELS = 7
TOLERANCE = 1e-8
UNDECIDED_COLUMN = 2
"""The column whose branches without a pose are called undecided."""


def pair_foot():
    """Two toes of the parrot, one forward and one back."""
    return pair_of_fingers(Foot.preset("parrot"), (1, 3))


@cache
def made_atlas(rows=7, columns=9, axis=(0.0, 1.0, 0.0)):
    """A small atlas with all regions; what no pose shows is called disproved."""
    foot = pair_foot()
    heights = np.linspace(-0.9, -0.02, rows) * foot.size
    radii = np.linspace(0.05, 0.7, columns) * foot.size
    grid = BranchGrid(heights, radii, axis)
    cells = np.nonzero(grid.valid)
    controls, wraps = _farthest(foot, grid.at(*cells))
    report = check_grasp(foot, controls, grid.at(*cells))
    met = report.touching | report.tangent
    both = [met[:, part].any(axis=1) for part in foot.finger_slices.values()]
    shown = {
        "touchable": report.feasible & np.all(both, axis=0),
        "stable": report.stable,
        "feasible": report.feasible & report.stable,
        "grasping": report.feasible & report.grasping,
    }
    answers = {}
    for name, verdict in shown.items():
        codes = np.full(grid.shape, Answer.HOLDS_BASE, dtype=np.int8)
        codes[cells] = np.where(verdict, Answer.YES, Answer.NO)
        column = codes[:, UNDECIDED_COLUMN]
        column[column == Answer.NO] = Answer.UNDECIDED
        answers[name] = codes
    return _with_poses(foot, grid, answers, cells, controls, wraps)


def _with_poses(foot, grid, answers, cells, controls, wraps):
    """The atlas of some answers, with poses where they are yes."""
    poses = np.full((*grid.shape, foot.phalanx_count), np.nan)
    poses[cells] = controls
    loose = poses.copy()
    poses[answers["touchable"] != Answer.YES] = np.nan
    unfit = (answers["stable"] != Answer.YES) | (answers["feasible"] == Answer.YES)
    loose[unfit] = np.nan
    some = answers["feasible"] == Answer.YES
    wrap = np.full((*grid.shape, 2), np.nan)
    wrap[cells] = wraps[:, None] + np.array([0.0, 0.1])
    wrap[~some] = np.nan
    toes = np.where(some[..., None], np.array([2, 2]), np.array([0, 1]))
    return Atlas(
        foot, grid, *answers.values(), toes.astype(np.int8), wrap, poses, loose
    )


def _farthest(foot, branches):
    """Each toe wrapped as far as a pose is found, on each branch; angles [rad]."""
    count = branches.batch_shape[0]
    controls = np.zeros((count, foot.phalanx_count))
    wraps = np.zeros(count)
    for index, part in enumerate(foot.finger_slices.values()):
        poses = finger_poses(foot, index, branches, LEVELS, TOLERANCE)
        order = np.argsort(poses.wrap, kind="stable")
        controls[poses.place[order], part] = poses.controls[order]
        farthest = np.full(count, -np.inf)
        farthest[poses.place[order]] = poses.wrap[order]
        wraps = np.maximum(wraps, np.where(np.isfinite(farthest), farthest, 0.0))
    return controls, wraps
