"""The plane of fingers 1 and 3, and what the paper's section 4.1 puts into it.

Points of the plane are complex numbers: the real part goes along finger 3 as it lies
straight, the imaginary part up. Branches lie along y, their axes at x = 0.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin.branch import Branch
from zygopin.foot import Foot
from zygopin.paper.toe_sums import placed

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

PAIR = ("finger1", "finger3")
"""The opposable fingers that the paper takes, which share a plane."""

PLACE = "section 4.1, perching on a branch"

ITERATED = 1e-9
"""The same where a route halves, iterates, or lets t leave [0, 1] by so much."""


def tilt(foot: Foot) -> float:
    """Cos Ω: how long the plane's horizontal unit vector is, seen along y.

    Args:
        foot: The foot.

    Returns:
        The cosine.
    """
    return math.cos(foot.fingers[2].azimuth)


def widths(foot: Foot) -> dict[str, float]:
    """Horizontal half-axis of a branch's section over its radius, reading by reading.

    Args:
        foot: The foot.

    Returns:
        `true`, the two that the paper prints, and the circle that ignores Ω.
    """
    cosine, angle = tilt(foot), abs(foot.fingers[2].azimuth)
    return {"true": 1 / cosine, "printed": cosine, "once": angle, "circle": 1.0}


def in_space(foot: Foot, numbers: ArrayLike) -> Floats:
    """Points of the plane as points of space.

    Args:
        foot: The foot.
        numbers: Complex numbers, shape (…).

    Returns:
        Points, shape (…, 3).
    """
    return placed(np.asarray(numbers), foot.fingers[2].azimuth)


def in_plane(foot: Foot, points: Floats) -> Complexes:
    """Points of space in the plane, what is across it left out.

    Args:
        foot: The foot.
        points: Points, shape (…, 3).

    Returns:
        Complex numbers, shape (…).
    """
    azimuth = foot.fingers[2].azimuth
    ahead = points @ (math.cos(azimuth), math.sin(azimuth), 0.0)
    return np.asarray(ahead + 1j * points[..., 2])


def phalanx_lines(
    foot: Foot, finger: str, controls: Floats
) -> tuple[Complexes, Complexes]:
    """Phalanges as the paper parametrises them: φ(t) is t steps from the start.

    Args:
        foot: The foot.
        finger: A finger of the pair.
        controls: The finger's controls, shape (…, K).

    Returns:
        Starts xₖ₋₁ and steps ρ^−k·exp(−iω(v₁ + … + vₖ)), shape (…, K) each. Finger 1
        is the mirror image: it points backward.
    """
    rank = np.arange(1, controls.shape[-1] + 1)
    turn = foot.omega * np.cumsum(controls, axis=-1)
    step = foot.rho**-rank * np.exp(-1j * turn)
    step = -np.conj(step) if finger == PAIR[0] else step
    return np.cumsum(step, axis=-1) - step, step


def section(
    angle: ArrayLike, height: ArrayLike, radius: ArrayLike, width: float
) -> Complexes:
    """Points γ(θ) = i·c + r(width·cos θ + i·sin θ) of a branch's section.

    Args:
        angle: θ [rad], shape (…).
        height: Height c of the axis, shape (…).
        radius: Radius r, shape (…).
        width: Horizontal half-axis over the radius.

    Returns:
        Complex numbers, shape (…).
    """
    around = width * np.cos(angle) + 1j * np.sin(angle)
    return np.asarray(1j * np.asarray(height) + np.asarray(radius) * around)


def section_tangent(angle: ArrayLike, radius: ArrayLike, width: float) -> Complexes:
    """The derivative of γ by θ.

    Args:
        angle: θ [rad], shape (…).
        radius: Radius r, shape (…).
        width: Horizontal half-axis over the radius.

    Returns:
        Complex numbers, shape (…).
    """
    around = -width * np.sin(angle) + 1j * np.cos(angle)
    return np.asarray(np.asarray(radius) * around)


def bark_gap(points: Floats, branch: Branch) -> Floats:
    """How far points are outside a branch: |(p − c) × a| − r.

    Args:
        points: Points, shape (…, 3).
        branch: The branch, or a batch that broadcasts against them.

    Returns:
        Signed distances to the infinite cylinder, shape (…).
    """
    across = np.cross(points - branch.centre, branch.axis)
    return np.asarray(np.linalg.norm(across, axis=-1) - branch.radius)


def angle_modulo_pi(one: ArrayLike, other: ArrayLike) -> Floats:
    """Angle between two lines.

    Args:
        one: Direction of the one as a complex number, shape (…).
        other: That of the other.

    Returns:
        Angles in [0, π/2] [rad], shape (…).
    """
    quotient = np.asarray(one) * np.conj(other)
    return np.asarray(np.arctan2(np.abs(quotient.imag), np.abs(quotient.real)))
