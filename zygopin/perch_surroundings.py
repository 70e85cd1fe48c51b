"""A grasp of one branch from poses that grasp branches like it."""

from __future__ import annotations

import numpy as np

from zygopin.branch import Branch
from zygopin.branch_grid import BranchGrid
from zygopin.clearance import Floats
from zygopin.foot import Foot
from zygopin.foot_poses import FootPoses
from zygopin.grasp import THINNEST, Criteria
from zygopin.toe_contacts import ToeSearch
from zygopin.touch import touch_intervals
from zygopin.witnesses import Witnesses

AROUND = 3
"""Heights and radii on either side of the branch's own."""

HIGHER, THICKER = 0.01, 0.007
"""Steps of height and radius over the foot's size."""


def surrounding_grasp(foot: Foot, branch: Branch) -> Floats | None:
    """Controls that grasp a branch, found together with those for branches like it.

    Args:
        foot: The foot.
        branch: One branch; it counts as endless.

    Returns:
        Controls, shape (P,), of a feasible grasp with the toes' palms; None where none
        was found.
    """
    radius = float(np.asarray(branch.radius))
    if radius < 2 * THINNEST * foot.size:
        return None  # those around would be thinner than means anything
    steps = np.arange(-AROUND, AROUND + 1)
    thicker = min(THICKER * foot.size, radius / (2 * AROUND))
    heights = branch.centre[2] + HIGHER * foot.size * steps
    grid = BranchGrid(heights, radius + thicker * steps, branch.axis, branch.centre[:2])
    search, found = ToeSearch(foot, grid), Witnesses(foot, grid, Criteria())
    toes = search.poses(np.broadcast_to(grid.valid, (len(foot.fingers), *grid.shape)))
    intervals = touch_intervals(foot, grid.at(np.arange(len(heights))[:, None], 0))
    FootPoses(foot, search, toes, intervals, found).join()
    if not found.shows("grasping")[AROUND, AROUND]:
        return None
    return np.asarray(found.controls[AROUND, AROUND])
