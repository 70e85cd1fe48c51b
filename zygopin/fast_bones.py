"""Bones by compiled loops: `bones.posed_bones`, for few poses and for many."""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from zygopin.blocks import in_blocks
from zygopin.bone_kernels import Chains, half_pitches, jointed, posed
from zygopin.directions import FEET, Floats
from zygopin.foot import Foot

FEW = 16
"""Poses up to which calls of NumPy cost more than its tangents save."""

BLOCK = 1024
"""Poses of a block: their tangents stay in the cache."""


def fast_bones(
    foot: Foot,
    controls: Floats,
    threads: int | None = None,
    out: Floats | None = None,
) -> Floats:
    """`posed_bones`, to the last places.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P).
        threads: How many work on a large batch; None: one for each core.
        out: Where they are written, in C order; None: a new array.

    Returns:
        Bones [m], shape (…, P, 2, 3): start and end junctions.
    """
    count, made = foot.phalanx_count, chains(foot)
    bones = np.empty((*controls.shape, 2, 3)) if out is None else out
    poses, rows = controls.reshape(-1, count), bones.reshape(-1, count, 2, 3)
    if len(poses) <= FEW:
        posed(np.array(poses), made, rows)
        return bones

    def block(part: slice) -> None:
        jointed(half_tangents(poses[part], made), made, rows[part])

    in_blocks(block, len(poses), threads, size=BLOCK)
    return bones


def half_tangents(poses: Floats, made: Chains) -> Floats:
    """Tangents of half the pitch of each phalanx.

    Args:
        poses: Controls, shape (n, P).
        made: The foot.

    Returns:
        The tangents, shape (P, n).
    """
    half = np.empty(poses.shape[::-1])
    # The loops take arrays of one kind: in C order, and writeable.
    half_pitches(np.array(poses), made, half)
    return np.tan(half, out=half)  # NumPy's works on several numbers at once


@lru_cache(FEET)
def chains(foot: Foot) -> Chains:
    """What a foot's bones are made of.

    Args:
        foot: The foot.

    Returns:
        The constants, which are not to be changed.
    """
    toes = np.array([(x.orientation, x.azimuth) for x in foot.fingers])
    orientation, azimuth = toes[foot.finger_of_phalanx].T
    ways = np.cos(azimuth), np.sin(azimuth), np.ones(len(azimuth))
    return Chains(
        first=np.array(foot.rank_of_phalanx == 1),
        orientation=np.array(orientation),
        omega=foot.omega,
        bone=np.stack(ways, axis=1) * foot.lengths[:, None],
    )
