"""The paper's sums for the junctions of a toe, term by term as they are printed."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin.foot import GOLDEN_MEAN

PAPER_TURN = math.pi / 6
"""The paper's ω [rad]."""

BACK_TOE = 5
"""Phalanges of finger 4, a back toe."""

POWER = [GOLDEN_MEAN**-k for k in range(BACK_TOE + 1)]
"""Powers ρ^−k of the paper's ρ."""

ROOT = math.sqrt(3) / 2
"""cos(π/6)."""


def junctions(rho: float, turns: ArrayLike) -> NDArray[np.complex128]:
    """Junctions x₀ to x_K: xₖ = Σ_{j≤k} ρ^−j·exp(−i·turnⱼ), scale 1.

    Args:
        rho: Scaling factor ρ.
        turns: Angle of each phalanx below the x-axis [rad], shape (…, K).

    Returns:
        Points x + iz, shape (…, K + 1).
    """
    angles = np.asarray(turns, dtype=float)
    powers = rho ** -np.arange(1.0, angles.shape[-1] + 1)
    ends = np.cumsum(powers * np.exp(-1j * angles), axis=-1)
    return np.concatenate([np.zeros((*angles.shape[:-1], 1)), ends], axis=-1)


def closing_turns(omega: float, values: ArrayLike, count: int) -> NDArray[np.float64]:
    """Angles ωjv of the phalanges of a toe whose controls all equal v.

    Args:
        omega: Largest turn ω of a joint [rad].
        values: Values v, shape (…).
        count: Number of phalanges.

    Returns:
        Angles [rad], shape (…, count).
    """
    stages = np.asarray(values, dtype=float)[..., None]
    return np.asarray(omega * stages * np.arange(1, count + 1))


def placed(points: NDArray[np.complex128], azimuth: float) -> NDArray[np.float64]:
    """Points x + iz of a toe's plane in space, the plane turned about z.

    Args:
        points: Points, shape (…).
        azimuth: The turn [rad].

    Returns:
        Points, shape (…, 3).
    """
    x, z = points.real, points.imag
    return np.stack([x * math.cos(azimuth), x * math.sin(azimuth), z], axis=-1)
