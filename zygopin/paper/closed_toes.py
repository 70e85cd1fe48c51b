"""Fully closed toes on a branch under the base, the section read in three ways."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
from scipy.optimize import root

from zygopin.foot import Foot
from zygopin.paper.entry import EXACT
from zygopin.paper.finger_plane import (
    PAIR,
    Floats,
    phalanx_lines,
    section,
    section_tangent,
)
from zygopin.resting import resting_radii
from zygopin.resting_equations import Section

RANK = 2
"""The phalanx that closed fingers 1 and 3 can lie on a branch with."""

READINGS: dict[str, Section] = {
    "printed": "printed",
    "circle": "circle",
    "true": "geometric",
}
"""Readings of the section, as `widths` names them and as resting_radii does."""

GUESS = (0.6, 0.0, math.pi / 6)
"""Where SciPy starts: radius, t and θ."""


def closed_radius(foot: Foot, reading: str) -> tuple[float, float]:
    """Where the second phalanx of finger 3, closed, is tangent on the palm's side.

    Args:
        foot: The foot.
        reading: A key of `READINGS`.

    Returns:
        The radius of the branch under the base, and t, by resting_radii.
    """
    found = resting_radii(foot, PAIR[1], 2, section=READINGS[reading])
    closed = (found.controls[:, :RANK] == 1).all(axis=1)
    (row,) = np.flatnonzero(closed & (found.phalanx == RANK) & (found.side == 1))
    return float(found.radius[row]), float(found.t[row])


def second_phalanx(foot: Foot) -> tuple[complex, complex]:
    """The second phalanx of finger 3, all controls 1.

    Args:
        foot: The foot.

    Returns:
        Its start and its step in the plane.
    """
    start, step = phalanx_lines(foot, PAIR[1], np.ones(4))
    return complex(start[RANK - 1]), complex(step[RANK - 1])


def by_hand(foot: Foot, width: float) -> tuple[float, float]:
    """The same worked by hand: the pitch of the phalanx is π/3.

    r = 1/(ρ(S − 1)) with S = √(3A² + 1), A the width.

    Args:
        foot: The foot.
        width: Horizontal half-axis over the radius.

    Returns:
        Radius and t.
    """
    root_of = math.sqrt(3 * width**2 + 1)
    radius = 1 / (foot.rho * (root_of - 1))
    share = (1 + (width**2 - 1) / root_of) / (root_of - 1)
    return radius, math.sqrt(3) / 2 * foot.rho * (share - 1)


def by_scipy(foot: Foot, width: float) -> tuple[float, float]:
    """The same from the system's equations, solved for r, t and θ by SciPy.

    Args:
        foot: The foot.
        width: Horizontal half-axis over the radius.

    Returns:
        Radius and t.
    """
    start, step = second_phalanx(foot)

    def equations(unknown: Floats) -> list[float]:
        radius, t, angle = unknown
        apart = start + t * step - section(angle, -radius, radius, width)
        tangent = section_tangent(angle, 1.0, width)
        return [apart.real, apart.imag, float((tangent * np.conj(step)).imag)]

    found = root(equations, GUESS, tol=EXACT)
    return float(found.x[0]), float(found.x[1])


def nearest_radius(foot: Foot, radius: float) -> float:
    """The nearest to a radius of all to which closed toes are tangent.

    Any phalanx of fingers 1 and 3, on either side, inside the bone, in any reading.

    Args:
        foot: The foot.
        radius: The radius.

    Returns:
        The nearest.
    """
    tangent: list[float] = []
    for finger, section_of in product(PAIR, READINGS.values()):
        found = resting_radii(foot, finger, 2, section=section_of)
        placed = np.arange(found.controls.shape[1]) < found.phalanx[:, None]
        closed = (found.controls == placed).all(axis=1) & found.on_bone
        tangent.extend(map(float, found.radius[closed]))
    return min(tangent, key=lambda each: abs(each - radius))
