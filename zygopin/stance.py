"""Where a foot stands in the world, and how fast its toes can move."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Stance:
    """A foot's pose in the world, or a batch of n of them.

    Attributes:
        foot: The foot.
        base: T_world_base, shape (…, 4, 4).
        azimuths: Azimuth of each finger in the base's frame [rad], shape (…, F).
        controls: Controls in [0, 1], shape (…, P).
    """

    foot: Foot
    base: Floats
    azimuths: Floats
    controls: Floats

    @property
    def bones(self) -> Floats:
        """Bones in the world's frame [m], shape (…, P, 2, 3)."""
        local = forward_kinematics(self.foot, self.controls, azimuths=self.azimuths)
        turn = self.base[..., None, :3, :3].swapaxes(-1, -2)
        return np.asarray(local @ turn + self.base[..., None, None, :3, 3])


def azimuths_at(foot: Foot, reversal: Floats) -> Floats:
    """Azimuths with the reversible toes part of the way round.

    Args:
        foot: The foot.
        reversal: 0 for the azimuths, 1 for the reversed ones, shape (…).

    Returns:
        Azimuths [rad], shape (…, F).
    """
    azimuths = np.array([finger.azimuth for finger in foot.fingers])
    turns = np.array([finger.reversal for finger in foot.fingers])
    return np.asarray(azimuths + np.asarray(reversal)[..., None] * turns)


def levers(foot: Foot) -> Floats:
    """Farthest that a joint can be from points of a bone that it turns.

    Args:
        foot: The foot.

    Returns:
        Lengths [m], shape (P, P): of phalanx k from joint j, the sum of phalanges j to
        k; 0 where the joint does not turn the phalanx.
    """
    rank, finger = foot.rank_of_phalanx, foot.finger_of_phalanx
    turned = (finger[:, None] == finger) & (rank[:, None] >= rank)
    reach = turned @ foot.lengths
    return np.where(turned, reach[:, None] - reach + foot.lengths, 0.0)
