"""Forward kinematics in closed form: controls to bones, batched."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.bones import flat_bones, posed_bones
from zygopin.compiler import BATCHED, BatchName, has_compiler
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
    kinds.instance("foot", foot, Foot)
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
    engine: BatchName = "exact",
    threads: int | None = None,
    out: NDArray[np.float64] | None = None,
) -> NDArray[np.float64]:
    """Bones of every phalanx for given controls: equation (sys), MODEL.md section 2.

    xₖ = xₖ₋₁ + ℓₖ·exp(−i(v₀ + ω(v₁ + … + vₖ))), turned about z by the azimuth.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
        azimuths: Azimuth of each finger [rad], shape (…, F); None: the foot's own.
            A reversible toe is turned this way.
        engine: `fast`: in compiled loops, where Numba is installed and the azimuths
            are the foot's own; see `make_engine`.
        threads: How many work on a large batch; None: one for each core.
        out: A C-ordered array of the result's shape to write to, again and again:
            new memory takes a fifth of the time of a large batch. None: a new one.

    Returns:
        Bones in the foot's frame [m], shape (…, P, 2, 3): start and end junctions.

    Raises:
        ParameterError: A control is outside [0, 1], a shape is wrong, or that is no
            number of threads, or no array to write to.
        UnknownNameError: A finger or an engine does not exist.
    """
    controls = read_controls(foot, controls)
    kinds.one_of("engine", engine, BATCHED)
    if azimuths is None:
        make = posed_bones
        if engine == "fast" and has_compiler():
            from zygopin.fast_bones import fast_bones as make  # with Numba
        return make(foot, controls, threads, _room((*controls.shape, 2, 3), out))
    azimuths = as_azimuths(foot, azimuths)
    shapes = controls.shape[:-1], azimuths.shape[:-1]
    batch = checks.common_batch("controls and azimuths", *shapes)
    bones = _room((*batch, foot.phalanx_count, 2, 3), out)
    flat = flat_bones(foot, controls, threads)
    turn = azimuths[..., foot.finger_of_phalanx, None]
    np.multiply(flat[..., 0], np.cos(turn), out=bones[..., 0])
    np.multiply(flat[..., 0], np.sin(turn), out=bones[..., 1])
    bones[..., 2] = flat[..., 2]
    return bones


def _room(
    shape: tuple[int, ...], out: NDArray[np.float64] | None
) -> NDArray[np.float64]:
    """The array to write to: a new one, or the given one if it will do."""
    if out is None:
        return np.empty(shape)
    kinds.instance("out", out, np.ndarray)
    checks.shaped("out", out, shape)
    if out.dtype != np.float64 or not (out.flags.c_contiguous and out.flags.writeable):
        allowed = "of float64, in C order, and writeable"
        raise ParameterError("out", out.dtype, allowed, "make it with numpy.empty")
    return out


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
    values = checks.array("azimuths", azimuths, last=len(foot.fingers))
    near = np.abs(values) <= checks.MOST_TURNED
    allowed = f"within {checks.MOST_TURNED:g}"
    checks.require("azimuths", values, near, allowed, "give radians")
    return values


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
