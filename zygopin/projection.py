"""A finger seen along a branch: tangency becomes that of a line and a circle.

Projected along the branch's axis, the branch is a circle and a finger a chain of steps
ℓₖ·(a cos θ − (b + id) sin θ) in the complex plane, θ the pitch of phalanx k: MODEL.md,
section 4, exact for every pose of the branch. The plane is turned, and mirrored, so
that the straight finger points along +1 and flexion turns it clockwise.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.directions import cosine_and_sine
from zygopin.foot import Foot

Floats = NDArray[np.float64]
Complexes = NDArray[np.complex128]

BEHIND = -math.pi / 2
"""Contacts up to this far behind the base's nearest line count as wrapped back, not as
wrapped nearly all the way round: farther back, the base does not see the branch."""

EDGEWISE = 1e-6
"""Least stretch of a finger's plane: below, it is seen edge on, as a line."""

PALM, BACK = 1, -1
"""Sides of a toe: that to which it flexes, and the other."""


@dataclass(frozen=True, eq=False)
class ProjectedFinger:
    """One finger seen along a direction.

    Attributes:
        frame: The plane's two axes in the foot's frame, shape (2, 3).
        forward: a, the length of the projected unit vector along the straight finger.
        shear: b, the share of a step down that goes along +1.
        drop: d, the share of a step down that goes along −i.
        lengths: Lengths of the phalanges [m], shape (K,).
        radii: Their skin radii [m], shape (K,).
        omega: Largest joint angle [rad].
        orientation: Pitch before the first joint [rad].
    """

    frame: Floats
    forward: float
    shear: float
    drop: float
    lengths: Floats
    radii: Floats
    omega: float
    orientation: float

    @classmethod
    def of(cls, foot: Foot, finger: int, axis: Floats) -> ProjectedFinger:
        """The finger of a foot seen along a branch's axis.

        Args:
            foot: The foot.
            finger: Index of the finger.
            axis: Unit axis, shape (3,).
        """
        chosen = foot.fingers[finger]
        part = foot.finger_slices[chosen.name]
        along = np.array([math.cos(chosen.azimuth), math.sin(chosen.azimuth), 0.0])
        flat = along - (along @ axis) * axis
        forward = float(np.linalg.norm(flat))
        if forward < EDGEWISE:
            flat, first = np.eye(3)[np.argmin(np.abs(axis))], 0.0
            flat = flat - (flat @ axis) * axis
        else:
            first = forward
        right = flat / np.linalg.norm(flat)
        up = np.cross(axis, right)
        up = up if up[2] >= 0 else -up
        frame = np.stack([right, up])
        down = frame[:, 2]
        return cls(
            frame,
            first,
            float(down[0]),
            float(down[1]),
            foot.lengths[part],
            foot.radii[part],
            foot.omega,
            chosen.orientation,
        )

    @property
    def least_stretch(self) -> float:
        """Shortest that a unit vector of the finger's plane is projected."""
        matrix = [[self.forward, -self.shear], [0.0, -self.drop]]
        return float(np.linalg.svd(matrix, compute_uv=False)[-1])

    @property
    def edgewise(self) -> bool:
        """Whether the finger's plane holds the axis: no phalanx is tangent alone."""
        return self.least_stretch < EDGEWISE

    def flat(self, points: Floats) -> Complexes:
        """Points of the foot's frame in the plane, shape (…, 3) to (…)."""
        pair = points @ self.frame.T
        return np.asarray(pair[..., 0] + 1j * pair[..., 1])

    def direction(self, pitch: Floats) -> Complexes:
        """Projected unit vectors of pitches [rad]; their length is the stretch."""
        cosine, sine = cosine_and_sine(np.asarray(pitch / 2))
        result = np.empty(np.shape(pitch), dtype=complex)
        result.real = self.forward * cosine - self.shear * sine
        result.imag = -self.drop * sine
        return result

    def pitch(self, direction: Complexes) -> tuple[Floats, Floats]:
        """The pitch whose phalanx points in a direction, and its stretch.

        Args:
            direction: Numbers other than 0, shape (…).

        Returns:
            Pitches in (−π, π] [rad] and stretches, shape (…) each.
        """
        sine = -direction.imag / self.drop
        cosine = (direction.real + self.shear * sine) / self.forward
        length = direction.real**2 + direction.imag**2
        stretch = np.sqrt(length / (sine**2 + cosine**2))
        return np.arctan2(sine, cosine), np.asarray(stretch)

    def same_chain(self, other: ProjectedFinger) -> bool:
        """Whether both are the same chain, up to one having phalanges more."""
        count = min(len(self.lengths), len(other.lengths))
        ours, theirs = (
            [x.forward, x.shear, x.drop, x.omega, x.orientation] for x in (self, other)
        )
        for values, chain in ((ours, self), (theirs, other)):
            values.extend([*chain.lengths[:count], *chain.radii[:count]])
        return bool(np.allclose(ours, theirs, rtol=1e-12, atol=1e-15))


def wrap_angle(normal: Complexes, centre: Complexes) -> Floats:
    """How far around the branch a contact lies from the base's nearest line.

    Args:
        normal: Outward normals of contacts, of any length, shape (…).
        centre: Centres of the branches, shape (…).

    Returns:
        Angles in the sense of flexion, in [`BEHIND`, 2π + `BEHIND`) [rad], shape (…).
    """
    turned = -np.angle(normal * np.conj(-centre))
    return np.asarray((turned - BEHIND) % (2 * np.pi) + BEHIND)
