"""Forward kinematics in closed form: controls to bones, batched."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.blocks import in_blocks
from zygopin.directions import FEET, directions, product, running_sum
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Foot

Controls = ArrayLike | Mapping[str, Sequence[float]]
"""Controls of all phalanges, shape (…, P), or a sequence for each finger's name."""


Matrices = tuple[tuple[slice, NDArray[np.float64]], ...]
"""Which phalanges, and what makes their bones of their directions, shape (6K, 2K)."""

TOGETHER = 24
"""Phalanges up to which one product for all is quicker than one for each finger."""


def as_controls(foot: Foot, controls: Controls) -> NDArray[np.float64]:
    """Controls as one checked array.

    Args:
        foot: The foot they are for.
        controls: Values in [0, 1], shape (…, P), or {finger name: shape (…, K)}.

    Returns:
        A new array of shape (…, P).

    Raises:
        ParameterError: A value is outside [0, 1], or the length is wrong.
        UnknownNameError: A finger does not exist.
    """
    values = read_controls(foot, controls)
    return values.copy() if values is controls else values


def read_controls(foot: Foot, controls: Controls) -> NDArray[np.float64]:
    """`as_controls` for who only reads: an array that is fine is not copied.

    Args:
        foot: The foot they are for.
        controls: Values in [0, 1], shape (…, P), or {finger name: shape (…, K)}.

    Returns:
        An array of shape (…, P), which may be the caller's own.

    Raises:
        ParameterError: A value is outside [0, 1], or the length is wrong.
        UnknownNameError: A finger does not exist.
    """
    if type(controls) is np.ndarray and _fine(foot, controls):
        return controls
    if isinstance(controls, Mapping):
        controls = _joined(foot, controls)
    values = checks.array("controls", controls, last=foot.phalanx_count)
    inside = (values >= 0) & (values <= 1)
    remedy = "0 is the straight joint, 1 the fully closed one"
    checks.require("controls", values, inside, "in [0, 1]", remedy)
    return values


def _fine(foot: Foot, controls: NDArray[Any]) -> bool:
    """Whether an array needs no change and holds nothing wrong, NaN least of all."""
    if controls.dtype != np.float64 or controls.shape[-1:] != (foot.phalanx_count,):
        return False
    return bool(controls.size and controls.min() >= 0 and controls.max() <= 1)


def by_finger(foot: Foot, values: NDArray[np.float64]) -> dict[str, list[float]]:
    """Values of all phalanges as a list for each finger.

    Args:
        foot: The foot.
        values: One value for each phalanx, shape (P,).

    Returns:
        {finger name: list of K floats}, in the foot's order.
    """
    return {name: values[part].tolist() for name, part in foot.finger_slices.items()}


def forward_kinematics(
    foot: Foot,
    controls: Controls,
    *,
    azimuths: ArrayLike | None = None,
    threads: int | None = None,
) -> NDArray[np.float64]:
    """Bones of every phalanx for given controls: equation (sys), MODEL.md section 2.

    xₖ = xₖ₋₁ + ℓₖ·exp(−i(v₀ + ω(v₁ + … + vₖ))), turned about z by the azimuth.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
        azimuths: Azimuth of each finger [rad], shape (…, F); None: the foot's own.
            A reversible toe is turned this way.
        threads: How many work on a large batch; None: one for each core.

    Returns:
        Bones in the foot's frame [m], shape (…, P, 2, 3): start and end junctions.

    Raises:
        ParameterError: A control is outside [0, 1], a shape is wrong, or that is no
            number of threads.
        UnknownNameError: A finger does not exist.
    """
    controls = read_controls(foot, controls)
    if azimuths is None:
        return posed_bones(foot, controls, threads)
    azimuths = as_azimuths(foot, azimuths)
    shapes = controls.shape[:-1], azimuths.shape[:-1]
    batch = checks.common_batch("controls and azimuths", *shapes)
    flat = _bones(_flat_matrices(foot), foot, controls, threads)
    turn = azimuths[..., foot.finger_of_phalanx, None]
    bones = np.empty((*batch, *flat.shape[-3:]))
    np.multiply(flat[..., 0], np.cos(turn), out=bones[..., 0])
    np.multiply(flat[..., 0], np.sin(turn), out=bones[..., 1])
    bones[..., 2] = flat[..., 2]
    return bones


def posed_bones(
    foot: Foot, controls: NDArray[np.float64], threads: int | None = None
) -> NDArray[np.float64]:
    """`forward_kinematics` of controls that were checked.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P).
        threads: How many work on a large batch; None: one for each core.

    Returns:
        Bones in the foot's frame [m], shape (…, P, 2, 3): start and end junctions.
    """
    return _bones(_bone_matrices(foot), foot, controls, threads)


def _bones(
    matrices: Matrices,
    foot: Foot,
    controls: NDArray[np.float64],
    threads: int | None,
) -> NDArray[np.float64]:
    """Bones as matrices make them out of the phalanges' directions."""
    bones = np.empty((*controls.shape, 2, 3))
    poses = controls.reshape(-1, foot.phalanx_count)
    columns = bones.reshape(-1, 6 * foot.phalanx_count).T

    def block(cases: slice) -> None:
        pointing = directions(foot, poses[cases])
        for part, matrix in matrices:
            rows = pointing[:, part].reshape(matrix.shape[1], -1)
            out = columns[6 * part.start : 6 * part.stop, cases]
            product(matrix, rows, out=out)

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
    azimuth = as_azimuths(foot, None)[foot.finger_of_phalanx, None, None]
    found = []
    for part, flat in _flat_matrices(foot):
        matrix = flat.reshape(part.stop - part.start, 2, 3, -1).copy()
        matrix[:, :, 1] = matrix[:, :, 0] * np.sin(azimuth[part])
        matrix[:, :, 0] *= np.cos(azimuth[part])
        found.append((part, checks.read_only(matrix.reshape(flat.shape))))
    return tuple(found)


def _alone(matrix: NDArray[np.float64], part: slice) -> NDArray[np.float64]:
    """The part of a matrix that is some phalanges' own, shape (6K, 2K)."""
    own = matrix[part, :, :, :, part]
    return checks.read_only(own.reshape(6 * len(own), -1))


def as_azimuths(foot: Foot, azimuths: ArrayLike | None) -> NDArray[np.float64]:
    """Azimuths as one checked array.

    Args:
        foot: The foot they are for.
        azimuths: Angles [rad], shape (…, F); None: the foot's own.

    Returns:
        A new array of shape (…, F).

    Raises:
        ParameterError: An angle is not finite, or the length is wrong.
    """
    if azimuths is None:
        azimuths = [finger.azimuth for finger in foot.fingers]
    return checks.array("azimuths", azimuths, last=len(foot.fingers))


def _joined(foot: Foot, controls: Mapping[str, Sequence[float]]) -> ArrayLike:
    """One array out of the fingers' sequences, each of its own length."""
    for name in controls:
        if name not in foot.finger_slices:
            raise UnknownNameError("finger", name, foot.finger_slices)
    parts = []
    for finger in foot.fingers:
        if finger.name not in controls:
            remedy = f"give {finger.phalanges} numbers for {finger.name}"
            raise ParameterError(f"controls[{finger.name}]", None, "given", remedy)
        name = f"controls[{finger.name}]"
        parts.append(checks.array(name, controls[finger.name], last=finger.phalanges))
    batch = checks.common_batch("controls", *(part.shape[:-1] for part in parts))
    return np.concatenate(
        [np.broadcast_to(part, (*batch, part.shape[-1])) for part in parts], axis=-1
    )
