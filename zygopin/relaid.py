"""Poses moved to other branches: what was tangent there is laid on again."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.laid_contact import lay_on
from zygopin.projection import Floats, ProjectedFinger

Indices = NDArray[np.intp]
Sides = NDArray[np.int8]


def relaid(
    fingers: list[ProjectedFinger],
    grid: BranchGrid,
    cells: tuple[Indices, Indices],
    controls: Floats,
    sides: Sides,
) -> Floats:
    """Poses with the joints before tangent phalanges turned to lay them on a branch.

    Toe by toe from the base: a joint that closed a contact closes it anew, the others
    keep their angles. Whether the pose holds is for others to check.

    Args:
        fingers: The foot's fingers, seen along the branches.
        grid: The branches.
        cells: Row and column of the branch for each pose, shape (n,) each.
        controls: The poses, shape (n, P).
        sides: Which side of each phalanx was tangent, `PALM` or `BACK`; 0: neither,
            shape (n, P).

    Returns:
        The poses, shape (n, P).
    """
    moved: Floats = controls.copy()
    radius, start = grid.radii[cells[1]], 0
    for finger in fingers:
        centre = grid.centres(finger)[cells[0]]
        for joint in range(start, start + len(finger.lengths)):
            laid = np.flatnonzero(sides[:, joint])
            if len(laid) and not finger.edgewise:
                free, side = moved[laid, start:joint], sides[laid, joint]
                made = lay_on(finger, free, centre[laid], radius[laid], side, False)
                moved[laid, joint] = np.minimum(made.control, 1.0)
        start += len(finger.lengths)
    return moved
