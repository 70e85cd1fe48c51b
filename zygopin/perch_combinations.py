"""Poses of the whole foot: one for each finger, the best combinations first."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.clearance import Floats, segment_distance
from zygopin.foot import Foot
from zygopin.grasp import PARAMETER_SLACK, Criteria
from zygopin.wrap import FingerPoses, finger_poses

BEAM = 4000
"""Combinations of fingers' poses kept while fingers are added one by one."""

PENALTY, GRASP, TOE, TOUCH, CONTACT, NEAR = 1e6, 1e4, 1e3, 1e2, 0.3, 1e-3
"""Ranks of what a combination is worth: nothing that collides, then a grasp, then
toes that are tangent, then toes that touch, then wrap, then how near a toe comes
that does not touch. A tangent phalanx is worth CONTACT radians of wrap: toes conform
to the branch rather than reach on past it."""

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]


class Combinations(NamedTuple):
    """One pose for each finger, the best combination first.

    Attributes:
        poses: Index of each finger's pose, shape (N, F).
        grasps: Which of them grasp, with nothing that collides, shape (N,).
        worth: What they are worth, see `GRASP` and the others, shape (N,).
    """

    poses: Indices
    grasps: Booleans
    worth: Floats


def all_poses(foot: Foot, branches: Branch, levels: int) -> list[FingerPoses]:
    """The poses of every finger, for a batch of branches.

    Args:
        foot: The foot.
        branches: The branches, batch shape (B,).
        levels: Angles tried at each joint.

    Returns:
        Poses of each finger that touch and do not enter.
    """
    tolerance = Criteria().metres(foot)
    fingers = range(len(foot.fingers))
    return [finger_poses(foot, i, branches, levels, tolerance) for i in fingers]


def combinations(foot: Foot, poses: list[FingerPoses]) -> Combinations:
    """The best ways to give each finger one of its poses.

    Fingers are added one by one; the best `BEAM` combinations are kept.

    Args:
        foot: The foot.
        poses: Poses of every finger, all for one branch.

    Returns:
        The combinations.
    """
    combos = np.zeros((1, 0), dtype=np.intp)
    worth, grasps = np.zeros(1), np.zeros(1, dtype=bool)
    for finger, new in enumerate(poses):
        # Every pair of poses is judged once, in a table; combinations look it up.
        total = worth[:, None] + _worth(foot, new)
        grasping = np.repeat(grasps[:, None], len(new.wrap), axis=1)
        for earlier in range(finger):
            row = combos[:, earlier]
            total -= PENALTY * _colliding(foot, poses, earlier, finger)[row]
            if (earlier, finger) in foot.opposable_pairs:
                grasping |= opposed(poses[earlier], new)[row]
        ranked = best_first((total + GRASP * grasping).ravel(), BEAM)
        row, pose = np.unravel_index(ranked, total.shape)
        combos = np.concatenate([combos[row], pose[:, None]], axis=1)
        worth, grasps = total[row, pose], grasping[row, pose]
    free = grasps & (worth > -PENALTY / 2)
    return Combinations(combos, free, worth + GRASP * grasps)


def most_worth(foot: Foot, poses: list[FingerPoses]) -> float:
    """A worth that no combination of poses passes, however they fit together.

    Args:
        foot: The foot.
        poses: Poses of every finger, all for one branch.

    Returns:
        The bound, added up as `combinations` does, so that rounding keeps it one.
    """
    worth = 0.0
    for each in poses:
        worth += float(_worth(foot, each).max())
    return worth + GRASP


def best_first(worth: Floats, most: int) -> Indices:
    """The best of many, the best first.

    Equals keep their order, so that a plan is always the same.

    Args:
        worth: What each is worth, shape (n,).
        most: How many are wanted.

    Returns:
        Their indices, shape (min(n, most),).
    """
    chosen = np.arange(len(worth))
    if len(worth) > most:  # the rest need not be sorted
        chosen = np.flatnonzero(worth >= np.partition(worth, -most)[-most])
    return chosen[np.argsort(-worth[chosen], kind="stable")][:most]


def _worth(foot: Foot, poses: FingerPoses) -> Floats:
    """What each pose of a finger is worth by itself, shape (N,)."""
    entering = (poses.clearance < -Criteria().metres(foot)).any(axis=1)
    touching = poses.touching.any(axis=1)
    gap = np.where(touching, 0.0, poses.clearance.min(axis=1))
    return np.asarray(
        TOE * poses.tangent.any(axis=1)
        + TOUCH * touching
        + np.where(np.isfinite(poses.wrap), poses.wrap, 0.0)
        + CONTACT * poses.tangent.sum(axis=1)
        - NEAR * gap / (foot.size + gap)
        - PENALTY * entering
    )


def _colliding(foot: Foot, poses: list[FingerPoses], i: int, j: int) -> Booleans:
    """Which poses of two fingers run into each other, shape (N_i, N_j)."""
    one, other = poses[i].bones, poses[j].bones
    parts = [foot.finger_slices[foot.fingers[k].name] for k in (i, j)]
    skin = foot.radii[parts[0]][:, None] + foot.radii[parts[1]]
    apart = segment_distance(one[:, None, :, None], other[None, :, None, :]) - skin
    apart[..., 0, 0] = np.inf
    # Bare bones that cross have no depth, and the verdict asks for a gap.
    least = 0.0 if foot.thickness > 0 else Criteria().metres(foot)
    return np.asarray(apart.min(axis=(-2, -1)) < least)


def opposed(one: FingerPoses, other: FingerPoses) -> Booleans:
    """Which poses of two fingers hold the branch between them.

    Args:
        one: N poses of one finger.
        other: M poses of the other.

    Returns:
        Whether two contacts are a quarter turn apart, shape (N, M).
    """
    products = np.einsum("ikx,jlx->ijkl", one.normal, other.normal)
    both = one.tangent[:, None, :, None] & other.tangent[None, :, None, :]
    return np.asarray((both & (products <= PARAMETER_SLACK)).any(axis=(-2, -1)))
