"""Compiled loops from controls to bones: the closed form."""

from __future__ import annotations

from math import cos, sin
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.compiler import compiled
from zygopin.directions import Floats


class Chains(NamedTuple):
    """What a foot's bones are made of; P phalanges.

    Attributes:
        first: Whether a phalanx is its finger's first, shape (P,).
        orientation: Pitch of its finger at the base [rad], shape (P,).
        omega: Largest turn of a joint [rad].
        bone: A phalanx along its finger: x and y [m] for a pitch of 0, and how far it
            goes down [m] for a quarter turn, shape (P, 3).
    """

    first: NDArray[np.bool_]
    orientation: Floats
    omega: float
    bone: Floats


@compiled
def half_pitches(poses: Floats, chains: Chains, half: Floats) -> None:
    """Half the pitch of each phalanx: MODEL.md, section 2.

    Args:
        poses: Controls, shape (n, P).
        chains: The foot.
        half: The angles [rad], shape (P, n): written.
    """
    for p in range(len(chains.first)):
        before, turn = 0.5 * chains.orientation[p], 0.5 * chains.omega
        for k in range(len(poses)):
            start = before if chains.first[p] else half[p - 1, k]
            half[p, k] = start + turn * poses[k, p]


@compiled
def jointed(tangent: Floats, chains: Chains, bones: Floats) -> None:
    """Bones of many poses, as `directions.cosine_and_sine` has their directions.

    Args:
        tangent: Tangents of half the pitches, shape (P, n).
        chains: The foot.
        bones: Bones [m], shape (n, P, 2, 3): written.
    """
    for k in range(len(bones)):
        x = y = z = 0.0
        for p in range(len(chains.first)):
            if chains.first[p]:
                x = y = z = 0.0
            half = tangent[p, k]
            share = 2.0 / (1.0 + half * half)
            bones[k, p, 0, 0], bones[k, p, 0, 1], bones[k, p, 0, 2] = x, y, z
            x += chains.bone[p, 0] * (share - 1.0)
            y += chains.bone[p, 1] * (share - 1.0)
            z -= chains.bone[p, 2] * (half * share)
            bones[k, p, 1, 0], bones[k, p, 1, 1], bones[k, p, 1, 2] = x, y, z


@compiled
def posed(poses: Floats, chains: Chains, bones: Floats) -> None:
    """Bones of few poses, one by one.

    Args:
        poses: Controls, shape (n, P).
        chains: The foot.
        bones: Bones [m], shape (n, P, 2, 3): written.
    """
    for k in range(len(poses)):
        x = y = z = pitch = 0.0
        for p in range(len(chains.first)):
            if chains.first[p]:
                x, y, z, pitch = 0.0, 0.0, 0.0, chains.orientation[p]
            bones[k, p, 0, 0], bones[k, p, 0, 1], bones[k, p, 0, 2] = x, y, z
            pitch += chains.omega * poses[k, p]
            x += chains.bone[p, 0] * cos(pitch)
            y += chains.bone[p, 1] * cos(pitch)
            z -= chains.bone[p, 2] * sin(pitch)
            bones[k, p, 1, 0], bones[k, p, 1, 1], bones[k, p, 1, 2] = x, y, z
