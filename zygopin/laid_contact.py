"""A phalanx laid on a circle: the joint before it turned until it is tangent."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from zygopin.projection import Complexes, Floats, ProjectedFinger, wrap_angle

STRAIGHT = 1e-12
"""Turn back of a joint that is rounding [rad]."""


class Contact(NamedTuple):
    """Phalanges laid on their circles: the closing joint and what it makes.

    Attributes:
        control: Control of the joint, above 1 where it cannot turn that far.
        wrap: How far round the contact lies [rad].
        excess: By how much the pose fails to fit [m]; 0: it fits.
    """

    control: Floats
    wrap: Floats
    excess: Floats


def lay_on(
    finger: ProjectedFinger,
    free: Floats,
    centre: Complexes,
    radius: Floats,
    side: ArrayLike,
    solid: bool,
) -> Contact:
    """Lay a phalanx on its circle, by the joint before it.

    Args:
        finger: The finger.
        free: Controls of the joints before that one, shape (…, k − 1).
        centre: Centres of the circles [m], shape (…).
        radius: Their radii without skin [m], shape (…).
        side: `PALM` or `BACK`, the side of the toe that touches; or one for each.
        solid: Whether the phalanges before stay out of the circle.

    Returns:
        The contact, shape (…).
    """
    rank = free.shape[-1] + 1
    junction, pitch = -centre, np.full(free.shape[:-1], finger.orientation)
    excess = np.zeros(free.shape[:-1])
    for earlier in range(rank - 1):
        pitch = pitch + finger.omega * free[..., earlier]
        step = finger.lengths[earlier] * finger.direction(pitch)
        if solid:
            depth = radius + finger.radii[earlier] - segment_gap(junction, step)
            excess += np.maximum(depth, 0.0)
        junction = junction + step
    side, skin = np.asarray(side), radius + finger.radii[rank - 1]
    square = junction.real**2 + junction.imag**2
    inside = square < skin**2
    tangent = np.sqrt(np.where(inside, 0.0, square - skin**2))
    # Turned from the centre's direction by the angle whose sine is skin over reach.
    direction = -junction * (tangent + 1j * side * skin)
    wanted, stretch = finger.pitch(direction)
    turn = np.mod(wanted - pitch, 2 * np.pi)
    turn = np.where(turn > 2 * np.pi - STRAIGHT, 0.0, turn)
    length = finger.lengths[rank - 1]
    over = np.minimum(np.maximum(turn - finger.omega, 0.0), 2 * np.pi - turn)
    excess += np.where(inside, skin - np.sqrt(square), 0.0) + length * over
    excess += np.maximum(tangent / stretch - length, 0.0)
    wrap = wrap_angle(1j * side * direction, centre)
    return Contact(turn / finger.omega, wrap, excess)


def segment_gap(start: Complexes, step: Complexes) -> Floats:
    """Distance of segments from the origin.

    Args:
        start: Their starts, shape (…).
        step: From there to their ends, not 0, shape (…).

    Returns:
        Distances, shape (…).
    """
    square = step.real**2 + step.imag**2
    along = -(start.real * step.real + start.imag * step.imag) / square
    nearest = start + np.minimum(np.maximum(along, 0.0), 1.0) * step
    return np.asarray(np.sqrt(nearest.real**2 + nearest.imag**2))
