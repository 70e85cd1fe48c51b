"""Grasps from toes laid on branches by the tangent search, where closing finds none."""

from __future__ import annotations

import numpy as np

from zygopin.clearance import Floats
from zygopin.foot import Foot
from zygopin.perch_column import Column
from zygopin.perch_combinations import Combinations, combinations, opposed
from zygopin.records import joined
from zygopin.tangent_poses import FARTHEST
from zygopin.wrap import FingerPoses, given_poses

AIMS = (1.2, 0.8, 1.7, 0.3, 2.4, 1.0, 1.4, 2.0, 0.55)
"""Angles to which toes are wrapped in turn [rad] where toes that are wrapped as far
as can be run into each other."""


def grasp_by_tangents(
    column: Column, poses: list[FingerPoses]
) -> tuple[int, list[FingerPoses], Combinations] | None:
    """The best grasp in a column with toes that the tangent search has laid there.

    Toes are laid as far round as they can be; while those that could grasp run into
    each other or into others on a single branch, they are laid at other angles.

    Args:
        column: The branches.
        poses: Other poses of every finger, for the same branches.

    Returns:
        Index of the height, the poses there, and their combinations; None where no
        grasp is found.
    """
    where, foot = column.open, column.foot
    poses = [joined([each, _aloof(column, i)]) for i, each in enumerate(poses)]
    aims = (FARTHEST, *AIMS) if len(where) == 1 else (FARTHEST,)
    for aim in aims:
        laid = column.farthest if aim == FARTHEST else column.aimed(aim, where)
        poses = [
            joined([each, _laid(column, i, laid[0][i], laid[1][i])])
            for i, each in enumerate(poses)
        ]
        found = []
        for place in np.flatnonzero(where).tolist():
            here = [each.take(each.place == place) for each in poses]
            if _could_grasp(foot, here):
                found.append((place, here, combinations(foot, here)))
        if not found:
            return None
        best = max(found, key=lambda each: float(each[2].worth[0]))
        if best[2].grasps[0]:
            return best
        where = np.isin(np.arange(len(where)), [place for place, _, _ in found])
    return None


def _aloof(column: Column, finger: int) -> FingerPoses:
    """The poses that keep a finger farthest from the branches."""
    part = column.foot.finger_slices[column.foot.fingers[finger].name]
    controls = column.intervals.most_controls[:, part]
    made = np.arange(len(controls)), controls
    return given_poses(column.foot, finger, column.branches, made)


def _laid(column: Column, finger: int, wrap: Floats, controls: Floats) -> FingerPoses:
    """The poses that there are of one finger."""
    places = np.flatnonzero(np.isfinite(wrap))
    made = places, controls[places]
    return given_poses(column.foot, finger, column.branches, made)


def _could_grasp(foot: Foot, poses: list[FingerPoses]) -> bool:
    """Whether some two toes would grasp if all others were away."""
    return all(len(each.place) for each in poses) and any(
        bool(opposed(poses[i], poses[j]).any()) for i, j in foot.opposable_pairs
    )
