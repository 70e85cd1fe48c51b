"""The planes of a foot's fingers, measured from its bones."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics

SPLAY = math.pi / 12
"""The paper's Ω [rad]."""

OPPOSED = ((1, 3), (2, 4))
"""Numbers of fingers that share a plane."""

Floats = NDArray[np.float64]


def first_azimuths(foot: Foot, bones: Floats) -> Floats:
    """Azimuths of the fingers by their first phalanges.

    Args:
        foot: The foot.
        bones: Its bones, shape (…, P, 2, 3).

    Returns:
        Angles [rad], shape (…, F).
    """
    ahead = bones[..., _firsts(foot), 1, :]
    return np.asarray(np.arctan2(ahead[..., 1], ahead[..., 0]))


def between(azimuths: Floats, pair: tuple[int, int]) -> Floats:
    """Unsigned angle between two fingers.

    Args:
        azimuths: Azimuths of all fingers [rad], shape (…, F).
        pair: Numbers of two of them, from 1.

    Returns:
        Angles in [0, π] [rad], shape (…).
    """
    turn = azimuths[..., pair[0] - 1] - azimuths[..., pair[1] - 1]
    return np.asarray(np.abs(np.angle(np.exp(1j * turn))))


def off_plane(foot: Foot, bones: Floats, pair: tuple[int, int]) -> float:
    """Largest distance of two fingers' junctions from the plane they should share.

    Args:
        foot: The foot.
        bones: Its bones, shape (…, P, 2, 3).
        pair: One of `OPPOSED`.

    Returns:
        The distance.
    """
    turn = -SPLAY if pair == (1, 3) else SPLAY
    normal = np.array([-math.sin(turn), math.cos(turn), 0.0])
    parts = [foot.finger_slices[f"finger{number}"] for number in pair]
    return max(float(np.abs(bones[..., part, :, :] @ normal).max()) for part in parts)


def normals(foot: Foot) -> Floats:
    """Unit normals of the fingers' planes, from a straight and a bent pose.

    Args:
        foot: The foot.

    Returns:
        Normals, shape (F, 3).
    """
    ends = np.stack([np.zeros(foot.phalanx_count), np.ones(foot.phalanx_count)])
    straight, bent = forward_kinematics(foot, ends)[:, _firsts(foot), 1]
    across = np.cross(straight, bent)
    return np.asarray(across / np.linalg.norm(across, axis=-1, keepdims=True))


def plane_angle(foot: Foot, pair: tuple[int, int]) -> float:
    """Angle between the planes of two fingers.

    Args:
        foot: The foot.
        pair: Numbers of the fingers, from 1.

    Returns:
        The angle in [0, π/2] [rad].
    """
    first, second = (normals(foot)[number - 1] for number in pair)
    sine = float(np.linalg.norm(np.cross(first, second)))
    return math.atan2(sine, abs(float(first @ second)))


def _firsts(foot: Foot) -> list[int]:
    """Indices of the first phalanges."""
    return [part.start for part in foot.finger_slices.values()]
