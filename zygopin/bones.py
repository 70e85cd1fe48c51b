"""The closed form: bones of poses that were checked, by products with matrices.

A bone is linear in the directions of its finger's phalanges (MODEL.md, section 2), so a
matrix of the foot makes all bones of a block of poses at once.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from zygopin import checks
from zygopin.blocks import in_blocks
from zygopin.directions import FEET, Floats, directions, product, running_sum
from zygopin.foot import Foot

Matrices = tuple[tuple[slice, Floats], ...]
"""Which phalanges, and what makes their bones of their directions, shape (6K, 2K)."""

TOGETHER = 32
"""Phalanges up to which one product for all is quicker than one for each finger."""


def posed_bones(
    foot: Foot,
    controls: Floats,
    threads: int | None = None,
    out: Floats | None = None,
) -> Floats:
    """Bones of every phalanx, in the foot's frame.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P).
        threads: How many work on a large batch; None: one for each core.
        out: Where they are written, in C order; None: a new array.

    Returns:
        Bones [m], shape (…, P, 2, 3): start and end junctions.
    """
    return _made(foot, _bone_matrices(foot), controls, threads, out)


def flat_bones(foot: Foot, controls: Floats, threads: int | None = None) -> Floats:
    """Bones of fingers that all lie along x: `posed_bones` before the azimuths.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P).
        threads: How many work on a large batch; None: one for each core.

    Returns:
        Bones [m], shape (…, P, 2, 3), with y = 0.
    """
    return _made(foot, _flat_matrices(foot), controls, threads, None)


def _made(
    foot: Foot,
    matrices: Matrices,
    controls: Floats,
    threads: int | None,
    out: Floats | None,
) -> Floats:
    """Bones as matrices make them."""
    bones = np.empty((*controls.shape, 2, 3)) if out is None else out
    poses = controls.reshape(-1, foot.phalanx_count)
    columns = bones.reshape(-1, 6 * foot.phalanx_count).T

    def block(cases: slice) -> None:
        pointing = directions(foot, poses[cases])
        for part, matrix in matrices:
            rows = pointing[:, part].reshape(matrix.shape[1], -1)
            written = columns[6 * part.start : 6 * part.stop, cases]
            product(matrix, rows, out=written)

    in_blocks(block, len(poses), threads)
    return bones


@lru_cache(FEET)
def _flat_matrices(foot: Foot) -> Matrices:
    """Bones of fingers that all lie along x, for `directions`.

    Of few phalanges all at once: a product more costs more than zeros do.
    """
    count = foot.phalanx_count
    ends = running_sum(foot) * foot.lengths
    junctions = np.stack([ends - np.diag(foot.lengths), ends], axis=1)
    matrix = np.zeros((count, 2, 3, 2, count))
    matrix[:, :, 0, 0], matrix[:, :, 2, 1] = junctions, -junctions
    parts = list(foot.finger_slices.values()) if count > TOGETHER else [slice(0, count)]
    return tuple((part, _alone(matrix, part)) for part in parts)


@lru_cache(FEET)
def _bone_matrices(foot: Foot) -> Matrices:
    """Bones in the foot's frame: `_flat_matrices` turned about z."""
    azimuths = np.array([finger.azimuth for finger in foot.fingers])
    azimuth = azimuths[foot.finger_of_phalanx, None, None]
    found = []
    for part, flat in _flat_matrices(foot):
        matrix = flat.reshape(part.stop - part.start, 2, 3, -1).copy()
        matrix[:, :, 1] = matrix[:, :, 0] * np.sin(azimuth[part])
        matrix[:, :, 0] *= np.cos(azimuth[part])
        found.append((part, checks.read_only(matrix.reshape(flat.shape))))
    return tuple(found)


def _alone(matrix: Floats, part: slice) -> Floats:
    """The part of a matrix that is some phalanges' own, shape (6K, 2K)."""
    own = matrix[part, :, :, :, part]
    return checks.read_only(own.reshape(6 * len(own), -1))
