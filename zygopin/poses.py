"""Named poses of a foot, for the formats that hold some: SRDF, MJCF."""

from __future__ import annotations

import math
from functools import lru_cache
from itertools import chain

import numpy as np

from zygopin import kinds, names
from zygopin.branch import Branch
from zygopin.foot import Foot
from zygopin.perch import PerchPlan, plan_perch

PERCH_RADIUS = 0.25
"""Radius of the branch that the pose `perch` is for, over the foot's size."""

ANGLE_DIGITS = 6
"""Decimals of the perch's angles [rad]: beyond them machines may differ."""

TURNED_POSES = ("zygodactyl", "spread")
"""Poses that differ only in where the toes that turn point."""


def named_poses(foot: Foot) -> dict[str, dict[str, float]]:
    """Poses of a foot by name, each with every joint that moves.

    `rest`: straight; `closed`: every flexion joint at omega; `perch`: the grasp that
    `plan_perch` finds on a branch across the foot with a quarter of its size as
    radius, left out where it finds none; `spread`: straight, toes that turn at their
    reversed azimuth; `zygodactyl`, where two toes point forward and two back: straight,
    all at their own azimuth.

    Args:
        foot: The foot.

    Returns:
        {pose: {joint: angle [rad]}}, joints in the order of `names.moving_joints`.
    """
    kinds.instance("foot", foot, Foot)
    still = dict.fromkeys(names.moving_joints(foot), 0.0)
    joints = [*chain.from_iterable(map(names.flexion_joints, foot.fingers))]
    turning = [*filter(names.is_reversible, foot.fingers)]
    ahead = {names.reversal_joint(finger): finger.reversal for finger in turning}
    poses = {"rest": still, "closed": still | dict.fromkeys(joints, foot.omega)}
    plan = standard_perch(foot)
    if plan.grasping:
        angles = np.round(foot.omega * plan.controls, ANGLE_DIGITS)
        within = np.minimum(angles, foot.omega).tolist()
        poses["perch"] = still | dict(zip(joints, within, strict=True))
    if _is_zygodactyl(foot):
        poses["zygodactyl"] = still
    return poses | {"spread": still | ahead}


def standard_branch(foot: Foot) -> Branch:
    """The branch that the pose `perch` is for, before its height is found.

    Args:
        foot: The foot.

    Returns:
        A branch across the foot, below it, of PERCH_RADIUS times its size [m].
    """
    radius = PERCH_RADIUS * foot.size
    return Branch(radius=radius, centre=(0.0, 0.0, -2 * radius))


@lru_cache(maxsize=16)
def standard_perch(foot: Foot) -> PerchPlan:
    """The plan that the pose `perch` is from; kept, for several formats ask for it.

    Args:
        foot: The foot.

    Returns:
        What `plan_perch` finds on the standard branch, with that branch's height.
    """
    return plan_perch(foot, standard_branch(foot), find_height=True)


def _is_zygodactyl(foot: Foot) -> bool:
    """Whether two toes point forward and two back."""
    ahead = [math.cos(finger.azimuth) > 0 for finger in foot.fingers]
    return ahead.count(True) == ahead.count(False) == 2
