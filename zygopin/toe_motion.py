"""How closing toes move: the velocity of each point, and steps that miss nothing.

All joints of a closing toe turn at constant rates as its progress grows, so that a
point's velocity is known and its acceleration bounded. Two bounds on how soon a
distance may be gone follow from that. One takes the farthest that any point can go.
The other looks from a plane that separates the two solids, and at the ends of the bone
only, since a bone is straight: it lets toes slide along what they touch.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.advancement import steps_by_bend, steps_by_speed
from zygopin.clearance import Clearance, dot, norm, segment_offset
from zygopin.stance import Stance

Floats = NDArray[np.float64]

TINY = 1e-300
"""Keeps the direction between two bones that meet finite."""


SPACING = 8
"""Spacings of doubles that the ends of a piece are apart at least: so it has two."""


@dataclass(frozen=True, eq=False)
class ToeMotion:
    """Bones on their way, in units of the parameter that their joints turn with.

    Attributes:
        bones: Bones [m], shape (M, 2, 3).
        velocities: Velocities of their ends, shape (M, 2, 3).
        turns: Rates at which their directions turn [rad], shape (M,).
        speeds: Bounds on the speed of any of their points from here on, shape (M,).
        bends: Bounds on the acceleration of any of their points, shape (M,).
    """

    bones: Floats
    velocities: Floats
    turns: Floats
    speeds: Floats
    bends: Floats

    @classmethod
    def of(cls, stance: Stance, rates: Floats) -> ToeMotion:
        """The motion of a foot whose base and azimuths stay as they are.

        Args:
            stance: Where it is.
            rates: Rate of each joint's angle, ≥ 0 [rad], shape (P,).

        Returns:
            The motion of its P phalanges.
        """
        foot, bones = stance.foot, stance.bones
        finger, rank = foot.finger_of_phalanx, foot.rank_of_phalanx
        driven = (finger[:, None] == finger) & (rank[:, None] >= rank)
        azimuth, turns = stance.azimuths[finger], driven @ rates
        across = np.stack([-np.sin(azimuth), np.cos(azimuth), 0 * azimuth], axis=-1)
        axes = across @ stance.base[:3, :3].T
        own = turns[:, None] * np.cross(axes, bones[:, 1] - bones[:, 0])
        ends = driven @ own
        return cls(
            bones=bones,
            velocities=np.stack([ends - own, ends], axis=1),
            turns=turns,
            speeds=driven @ (foot.lengths * turns),
            bends=driven @ (foot.lengths * turns**2),
        )

    def pieces(self, which: NDArray[np.intp], cuts: Floats) -> ToeMotion:
        """The motion of pieces of some bones.

        Args:
            which: Indices of C bones.
            cuts: Where each is cut, ascending from 0 to 1, shape (K + 1,).

        Returns:
            The motion of the C·K pieces, bone by bone.
        """
        bones, velocities = self.bones[which], self.velocities[which]
        lengths = np.linalg.norm(bones[:, 1] - bones[:, 0], axis=-1)
        shortest = SPACING * np.spacing(np.abs(bones).max()) / lengths
        starts = np.broadcast_to(cuts[:-1], (len(which), len(cuts) - 1))
        ends = np.maximum(cuts[1:], starts + shortest[:, None])
        at = np.stack([starts, ends], axis=-1)[..., None]
        cut_bones, cut_velocities = (
            (x[:, None, :1] + at * (x[:, 1:] - x[:, :1])[:, None]).reshape(-1, 2, 3)
            for x in (bones, velocities)
        )
        count, turns = len(cuts) - 1, self.turns[which]
        short = (1 - ends) * (lengths * turns)[:, None]
        return ToeMotion(
            bones=cut_bones,
            velocities=cut_velocities,
            turns=np.repeat(turns, count),
            speeds=(self.speeds[which, None] - short).ravel(),
            bends=(self.bends[which, None] - short * turns[:, None]).ravel(),
        )


def steps_to_solid(
    motion: ToeMotion, radii: Floats, near: Clearance, floors: Floats
) -> Floats:
    """Steps within which no bone's clearance to a convex solid falls to its floor.

    Args:
        motion: The bones' motion.
        radii: Their skins' radii [m], shape (M,).
        near: Their nearest points of the solid.
        floors: What their clearances shall stay above [m], shape (M,); −inf for one
            of no interest.

    Returns:
        Steps of the parameter, infinite where nothing comes nearer, shape (M,).
    """
    normal = near.normal[:, None]
    gaps = dot(motion.bones - near.point[:, None], normal) - (radii + floors)[:, None]
    slopes = dot(motion.velocities, normal)
    planes = steps_by_bend(gaps, slopes, motion.bends[:, None]).min(axis=-1)
    thick = steps_by_speed(near.distance - floors, motion.speeds)
    return np.asarray(np.maximum(planes, thick))


def steps_between(
    motion: ToeMotion,
    radii: Floats,
    pairs: tuple[NDArray[np.intp], NDArray[np.intp]],
    floors: Floats,
) -> tuple[Floats, Floats]:
    """Distances of pairs of bones' skins, and steps within which none is gone.

    Args:
        motion: The bones' motion.
        radii: Their skins' radii [m], shape (M,).
        pairs: Indices of the first and of the second bones, shape (N,) each.
        floors: What the distances shall stay above [m], shape (N,).

    Returns:
        The distances [m] and the steps, shape (N,) each.
    """
    i, j = pairs
    _, offset = segment_offset(motion.bones[i], motion.bones[j])
    length, skins = norm(offset), radii[i] + radii[j]
    normal = (offset / np.maximum(length, TINY)[:, None])[:, None]
    gaps, slopes = (
        dot(x[i], normal)[:, :, None] - dot(x[j], normal)[:, None, :]
        for x in (motion.bones, motion.velocities)
    )
    under = (skins + floors)[:, None]
    bends, speeds = (x[i] + x[j] for x in (motion.bends, motion.speeds))
    count = len(length)
    planes = steps_by_bend(
        gaps.reshape(count, 4) - under, slopes.reshape(count, 4), bends[:, None]
    ).min(axis=-1)
    distances = length - skins
    steps = np.maximum(planes, steps_by_speed(distances - floors, speeds))
    # Bones that cross are as near as can be.
    return distances, np.where(floors < -skins, np.inf, steps)
