"""Forward kinematics in closed form: controls to bones, batched."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Foot

Controls = ArrayLike | Mapping[str, Sequence[float]]
"""Controls of all phalanges, shape (…, P), or a sequence for each finger's name."""


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
    if isinstance(controls, Mapping):
        controls = _joined(foot, controls)
    values = checks.array("controls", controls, last=foot.phalanx_count)
    inside = (values >= 0) & (values <= 1)
    remedy = "0 is the straight joint, 1 the fully closed one"
    checks.require("controls", values, inside, "in [0, 1]", remedy)
    return values


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
    foot: Foot, controls: Controls, *, azimuths: ArrayLike | None = None
) -> NDArray[np.float64]:
    """Bones of every phalanx for given controls: equation (sys), MODEL.md section 2.

    xₖ = xₖ₋₁ + ℓₖ·exp(−i(v₀ + ω(v₁ + … + vₖ))), turned about z by the azimuth.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
        azimuths: Azimuth of each finger [rad], shape (…, F); None: the foot's own.
            A reversible toe is turned this way.

    Returns:
        Bones in the foot's frame [m], shape (…, P, 2, 3): start and end junctions.

    Raises:
        ParameterError: A control is outside [0, 1], or a shape is wrong.
        UnknownNameError: A finger does not exist.
    """
    controls = as_controls(foot, controls)
    azimuths = as_azimuths(foot, azimuths)
    shapes = controls.shape[:-1], azimuths.shape[:-1]
    batch = checks.common_batch("controls and azimuths", *shapes)
    bones = np.empty((*batch, foot.phalanx_count, 2, 3))
    for index, (finger, part) in enumerate(
        zip(foot.fingers, foot.finger_slices.values(), strict=True)
    ):
        pitch = finger.orientation + foot.omega * np.cumsum(controls[..., part], -1)
        steps = foot.lengths[part] * np.exp(-1j * pitch)
        ends = np.cumsum(steps, axis=-1)
        azimuth = azimuths[..., index, None]
        for place, junction in ((0, ends - steps), (1, ends)):
            bones[..., part, place, 0] = junction.real * np.cos(azimuth)
            bones[..., part, place, 1] = junction.real * np.sin(azimuth)
            bones[..., part, place, 2] = junction.imag
        # The difference of sums leaves rounding where the base is exactly zero.
        bones[..., part.start, 0, :] = 0.0
    return bones


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
