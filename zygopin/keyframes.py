"""Poses that a simulation can start from: toes that do not run into each other."""

from __future__ import annotations

from itertools import chain

import numpy as np

from zygopin import names
from zygopin.adjacency import touching_links
from zygopin.clearance import Floats, skin_distance
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.poses import ANGLE_DIGITS, named_poses

PARTS = 100
"""Parts in which a toe closes towards a pose until it meets another."""


def keyframes(foot: Foot, radii: Floats) -> dict[str, dict[str, float]]:
    """The named poses of a foot, closed no further than solid toes can.

    A joint at omega everywhere, the pose `closed`, drives most feet's toes through one
    another. A pose in which phalanges overlap is replaced by the last before they do,
    on the way to it from straight toes, all joints in proportion.

    Args:
        foot: The foot.
        radii: Radii of the phalanges as they are simulated [m], shape (P,).

    Returns:
        {pose: {joint: angle [rad]}}, joints in the order of `names.moving_joints`.
    """
    return {
        pose: _apart(foot, radii, angles) for pose, angles in named_poses(foot).items()
    }


def _apart(foot: Foot, radii: Floats, angles: dict[str, float]) -> dict[str, float]:
    """The pose itself, or as much of it as keeps the phalanges apart."""
    joints = [*chain.from_iterable(map(names.flexion_joints, foot.fingers))]
    controls = np.array([angles[joint] for joint in joints]) / foot.omega
    parts = np.arange(PARTS + 1) / PARTS
    bones = forward_kinematics(foot, parts[:, None] * np.minimum(controls, 1.0))
    pairs = _meeting_phalanges(foot)
    overlap = skin_distance(bones, radii, pairs).min(axis=-1, initial=np.inf) < 0
    if not overlap[-1]:
        return angles
    share = float(parts[max(int(np.argmax(overlap)) - 1, 0)])
    closed = {joint: round(share * angles[joint], ANGLE_DIGITS) for joint in joints}
    return angles | closed


def _meeting_phalanges(foot: Foot) -> tuple[np.ndarray, np.ndarray]:
    """Indices of the phalanges that do not touch by construction, in pairs."""
    links = [*chain.from_iterable(map(names.phalanx_links, foot.fingers))]
    touching = {frozenset(pair) for pair in touching_links(foot)}
    i, j = np.triu_indices(len(links), 1)
    apart = [
        frozenset((links[a], links[b])) not in touching
        for a, b in zip(i, j, strict=True)
    ]
    return i[apart], j[apart]
