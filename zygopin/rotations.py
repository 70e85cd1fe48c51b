"""Rotations as matrices: checked, made true ones, and the turns between them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from zygopin import checks

ORTHONORMAL = 1e-6
"""How far the entries may be from a true rotation's: written with six digits."""

Floats = NDArray[np.float64]

_ASIDE = ((2, 1), (0, 2), (1, 0))
"""Entries of a rotation whose differences are twice its axis times the sine."""


def as_rotations(name: str, matrices: Floats) -> Floats:
    """The rotations nearest to matrices that are ones but for rounding.

    Args:
        name: Name of the parameter, for the message.
        matrices: The matrices, shape (…, 3, 3).

    Returns:
        Rotations, shape (…, 3, 3).

    Raises:
        ParameterError: A matrix is not orthonormal, or turns right into left.
    """
    inside = np.clip(matrices, -2, 2)  # so that products do not overflow
    products = inside @ inside.swapaxes(-1, -2)
    off = np.abs(products - np.eye(3)).max(axis=(-2, -1))
    allowed, remedy = f"within {ORTHONORMAL:g} of orthonormal", "give rotations"
    checks.require(f"error of {name}", off, off <= ORTHONORMAL, allowed, remedy)
    sign, remedy = np.linalg.det(inside), "swap two columns"
    checks.require(f"determinant of {name}", sign, sign > 0, "1", remedy)
    left, _, right = np.linalg.svd(matrices)
    return np.asarray(left @ right)


def angles_between(matrices: Floats) -> Floats:
    """Angles between each rotation and the next.

    Args:
        matrices: Rotations, shape (n, 3, 3).

    Returns:
        Angles in [0, π] [rad], shape (n − 1,).
    """
    steps = matrices[:-1].swapaxes(-1, -2) @ matrices[1:]
    # From both sine and cosine: exact for small turns as for half ones.
    sines = np.stack([steps[:, i, j] - steps[:, j, i] for i, j in _ASIDE], axis=-1)
    cosines = np.trace(steps, axis1=-2, axis2=-1) - 1
    return np.asarray(np.arctan2(np.linalg.norm(sines, axis=-1), cosines))


def quaternions(matrices: Floats) -> Floats:
    """Unit quaternions of rotations.

    Without SciPy, which takes half a second to load.

    Args:
        matrices: Rotations, shape (…, 3, 3).

    Returns:
        Quaternions (x, y, z, w), shape (…, 4), whose largest component is positive.
    """
    diagonal = np.diagonal(matrices, axis1=-2, axis2=-1)
    trace = diagonal.sum(axis=-1)
    # Four times the products of each component with all: any row is a multiple.
    products = np.empty((*matrices.shape[:-2], 4, 4))
    products[..., :3, :3] = matrices + matrices.swapaxes(-1, -2)
    for axis, (i, j) in enumerate(_ASIDE):
        products[..., axis, axis] = 1 - trace + 2 * diagonal[..., axis]
        aside = matrices[..., i, j] - matrices[..., j, i]
        products[..., axis, 3] = products[..., 3, axis] = aside
    products[..., 3, 3] = 1 + trace
    largest = np.argmax(np.diagonal(products, axis1=-2, axis2=-1), axis=-1)
    row = np.take_along_axis(products, largest[..., None, None], axis=-2)[..., 0, :]
    return np.asarray(row / np.linalg.norm(row, axis=-1, keepdims=True))


def turns_between(times: Floats, matrices: Floats) -> Callable[[Floats], Floats]:
    """Turns of constant speed from one rotation to the next.

    Args:
        times: Instants, ascending [s], shape (n,).
        matrices: Rotations at them, shape (n, 3, 3).

    Returns:
        The rotation at instants of shape (m,), shape (m, 3, 3).
    """
    from scipy.spatial.transform import Rotation, Slerp  # only turns need SciPy

    slerp = Slerp(times, Rotation.from_matrix(matrices))
    return lambda moments: np.asarray(slerp(moments).as_matrix())
