"""A toe whose tendon closes it: all controls equal v, in closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.errors import ParameterError
from zygopin.finger import Finger
from zygopin.foot import Foot

MOST_STAGES = 10_000
"""Values of v that may be asked for at once."""


def checked_stages(name: str, values: ArrayLike) -> NDArray[np.float64]:
    """Values of the tendon's map v.

    Args:
        name: Name of the parameter, for the message.
        values: What was given, shape (n,), n ≥ 1.

    Returns:
        A new array.

    Raises:
        ParameterError: They are no sequence of numbers in [0, 1].
    """
    stages = checks.array(name, values)
    checks.shaped(name, stages, (None,))
    if stages.size > MOST_STAGES:
        remedy = "draw fewer"
        allowed = f"at most {MOST_STAGES}"
        raise ParameterError(f"number of {name}", stages.size, allowed, remedy)
    if not stages.size:
        remedy = "give values of v, such as 0, 0.5 and 1"
        raise ParameterError(f"number of {name}", 0, "at least 1", remedy)
    inside = (stages >= 0) & (stages <= 1)
    remedy = "v is a control; the joint's angle is ω·v"
    checks.require(name, stages, inside, "in [0, 1]", remedy)
    return stages


def engaged_junctions(
    foot: Foot, finger: Finger, values: ArrayLike
) -> NDArray[np.complex128]:
    """Junctions of a finger whose controls all equal v.

    xₖ(v) = Σ_{j≤k} ℓⱼ·exp(−i(v₀ + ωjv)): equation (TLM) of the source, summed to k
    (MODEL.md, section 7, row 10).

    Args:
        foot: The foot.
        finger: One of its fingers.
        values: Values v in [0, 1], shape (n,).

    Returns:
        Points x + iz of x₀ to x_K in the finger's plane [m], shape (n, K + 1).

    Raises:
        ParameterError: A value is outside [0, 1].
    """
    stages = checked_stages("v", values)
    ranks = np.arange(1, finger.phalanges + 1)
    pitch = finger.orientation + foot.omega * np.outer(stages, ranks)
    steps = foot.lengths[foot.finger_slices[finger.name]] * np.exp(-1j * pitch)
    ends = np.cumsum(steps, axis=1)
    return np.concatenate([np.zeros((len(stages), 1)), ends], axis=1)
