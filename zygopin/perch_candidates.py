"""Candidates for a plan: combinations of the toes' poses on one branch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from zygopin.branch import Branch
from zygopin.clearance import Floats
from zygopin.foot import Foot
from zygopin.perch_column import Column
from zygopin.perch_combinations import (
    Booleans,
    Combinations,
    Indices,
    all_poses,
    combinations,
)
from zygopin.perch_height import best_height
from zygopin.perch_surroundings import surrounding_grasp
from zygopin.perch_tangents import grasp_by_tangents
from zygopin.wrap import FingerPoses, given_poses

FINE_LEVELS = 11
"""Angles tried at each joint of a single branch that seems to have no grasp: a second
or so of work. No multiple of the default's steps."""


@dataclass(frozen=True, eq=False)
class Candidates:
    """Poses of the whole foot on one branch, the best first.

    Attributes:
        foot: The foot.
        branch: The branch in its place.
        poses: Poses of each finger.
        combinations: Which of them go together.
    """

    foot: Foot
    branch: Branch
    poses: list[FingerPoses]
    combinations: Combinations

    @property
    def grasping(self) -> Indices:
        """Which of the combinations grasp, the best first."""
        return np.flatnonzero(self.combinations.grasps)

    def controls(self, rows: Indices) -> Floats:
        """Controls of some of the combinations, shape (n, P)."""
        return np.concatenate(self._each("controls", rows), axis=-1)

    def wrap(self, row: int) -> Floats:
        """Wrap of each finger in one of the combinations [rad], shape (F,)."""
        return np.concatenate(self._each("wrap", np.array([row])))

    def modes(self) -> list[Indices]:
        """The grasps by their sets of tangent phalanges, the best first in each."""
        rows = self.grasping
        if not len(rows):
            return []
        tangent: Booleans = np.concatenate(self._each("tangent", rows), axis=-1)
        _, mode = np.unique(tangent, axis=0, return_inverse=True)
        mode = mode.ravel()
        return [rows[mode == each] for each in range(int(mode.max()) + 1)]

    def _each(self, name: str, rows: Indices) -> list[Floats]:
        """A field of each finger's poses in some of the combinations."""
        chosen = zip(self.poses, self.combinations.poses[rows].T, strict=True)
        return [getattr(poses, name)[index] for poses, index in chosen]


def search_candidates(
    foot: Foot, branch: Branch, levels: int, *, find_height: bool
) -> Candidates:
    """What closing the toes joint by joint finds.

    Args:
        foot: The foot.
        branch: One branch.
        levels: Angles tried at each joint.
        find_height: Move the branch along z first, to where it is grasped best.

    Returns:
        The candidates.

    Raises:
        ParameterError: The branch is vertical and its height to be found.
    """
    if find_height:
        branch = best_height(foot, branch)
    poses = all_poses(foot, branch.broadcast((1,)), levels)
    return Candidates(foot, branch, poses, combinations(foot, poses))


def laid_candidates(
    column: Column, found: Candidates, levels: int
) -> Candidates | None:
    """What further searches find where closing toes found no grasp.

    Toes are laid on the branch by the tangent search; on a single endless branch they
    are then closed again, from a finer grid, and looked for on branches around it.

    Args:
        column: The branch at the heights in question.
        found: What closing toes has found; its poses are used for a single height.
        levels: Angles tried at each joint, for more than one height.

    Returns:
        The candidates at the best height; None without a grasp.
    """
    if not column.open.any():
        return None
    foot, poses, single = column.foot, found.poses, len(column.heights) == 1
    if not single:
        poses = all_poses(foot, column.branches, levels)
    grasp = grasp_by_tangents(column, poses)
    if grasp is not None:
        place, here, combined = grasp
        return Candidates(foot, column.branches[place], here, combined)
    if not (single and column.endless[0]):
        return None
    fine = search_candidates(foot, found.branch, FINE_LEVELS, find_height=False)
    return fine if len(fine.grasping) else _surrounding(foot, found.branch)


def _surrounding(foot: Foot, branch: Branch) -> Candidates | None:
    """The grasp that is found together with those of branches around one."""
    controls = surrounding_grasp(foot, branch)
    if controls is None:
        return None
    one = np.zeros(1, dtype=np.intp)
    poses = [
        given_poses(foot, i, branch.broadcast((1,)), (one, controls[None, part]))
        for i, part in enumerate(foot.finger_slices.values())
    ]
    return Candidates(foot, branch, poses, combinations(foot, poses))
