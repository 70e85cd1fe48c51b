"""The parts of an atlas put together: every so manieth height is from the same one."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.engine import make_engine
from zygopin.foot import Foot
from zygopin.grasp import Criteria
from zygopin.propagation import STRIDES, propagate
from zygopin.relaid import Indices
from zygopin.toe_contacts import Answer, Booleans, ToeSearch
from zygopin.witnesses import MERITS, Witnesses

Arrays = dict[str, NDArray[Any]]


def interleaved(parts: list[Arrays]) -> Arrays:
    """The arrays of all heights.

    Args:
        parts: Those of every so manieth height, from the first, the second and so on.
    """
    rows = sum(len(part["toes"]) for part in parts)
    whole = {
        name: np.empty((rows, *array.shape[1:]), array.dtype)
        for name, array in parts[0].items()
    }
    for first, part in enumerate(parts):
        for name, array in part.items():
            whole[name][first :: len(parts)] = array
    return whole


def share_poses(foot: Foot, grid: BranchGrid, arrays: Arrays) -> None:
    """Move poses from branches of one part to undecided ones of another.

    Args:
        foot: The foot.
        grid: The branches of all parts.
        arrays: The arrays of all heights; those of the atlas, changed in place.
    """
    goal = np.where(arrays["feasible"] == Answer.UNDECIDED, MERITS["feasible"], 0)
    goal[arrays["grasping"] == Answer.UNDECIDED] = MERITS["grasping"]
    if not goal.any():
        return
    found = Witnesses(foot, grid, Criteria())
    posed = np.isfinite(arrays["controls"]).all(axis=-1)
    cells = np.nonzero(posed & _around(goal > 0, max(STRIDES)))
    found.offer(cells, arrays["controls"][cells])
    before = found.merit.copy()
    propagate(found, ToeSearch(foot, grid).fingers, goal)
    _enter(arrays, found, np.nonzero(found.merit > before))


def _enter(arrays: Arrays, found: Witnesses, cells: tuple[Indices, ...]) -> None:
    """Enter what new poses show, once the other engine has confirmed them."""
    new = Witnesses(found.foot, found.grid, found.criteria)
    new.offer(cells, found.controls[cells])
    new.confirm(make_engine("fcl", found.foot))
    # Less than both engines show could be less than what there was.
    whole = new.merit == found.merit
    for verdict, others in (
        ("touching", ("touchable",)),
        ("feasible", ("feasible", "stable")),
        ("grasping", ("grasping",)),
    ):
        shown = new.shows(verdict) & whole
        for name in others:
            arrays[name][shown] = Answer.YES
    shown = (new.merit > 0) & whole
    arrays["controls"][shown] = new.controls[shown]
    arrays["toes"][shown, 0] = new.toes[shown]
    arrays["stable_controls"][new.shows("feasible") & whole] = np.nan


def _around(marks: Booleans, reach: int) -> Booleans:
    """Branches at most so many rows and columns from marked ones."""
    for axis in (0, 1):
        near = marks.copy()
        for step in range(1, reach + 1):
            ahead, behind = np.roll(marks, step, axis), np.roll(marks, -step, axis)
            near |= ahead | behind
        marks = near
    return marks
