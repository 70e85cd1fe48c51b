"""Branches seen along their axes: bones as they lie across a branch.

There a branch is a circle and its axis a point, so how far a bone is from the axis is a
question in the plane.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zygopin.branch import Branch
from zygopin.directions import Floats
from zygopin.foot import Foot
from zygopin.kinematics import as_azimuths


class CrossSection(NamedTuple):
    """The planes across n branches, or 1, for toes that stand upright.

    Attributes:
        across: Share of a toe's horizontal that goes across, shape (P, n).
        rise: Share of it that goes up, shape (P, n).
        level: Share of the vertical that goes up, shape (n,) or (1,).
        centre: The axes, across and up [m], shape (2, 1, n) or (2, 1, 1).
    """

    across: Floats
    rise: Floats
    level: Floats
    centre: Floats

    @classmethod
    def of(cls, foot: Foot, branch: Branch) -> CrossSection:
        """The section of a branch, or of a batch of shape (n,).

        Args:
            foot: The foot.
            branch: The branch, or n of them.
        """
        x, y, z = np.atleast_2d(branch.axis).T
        level = np.hypot(x, y)
        upright = level == 0
        length = np.where(upright, 1.0, level)
        # Across the axis and level; then across both.
        first = np.array([np.where(upright, 1.0, -y / length), x / length])
        second = np.array([-z * first[1], z * first[0]])
        place = np.atleast_2d(branch.centre).T
        centre = (np.array([first, second]) * place[:2]).sum(axis=1, keepdims=True)
        centre[1] = centre[1] + level * place[2]
        azimuth = as_azimuths(foot, None)[foot.finger_of_phalanx, None]
        count = int(np.prod(branch.batch_shape, dtype=int))
        across, rise = (
            np.broadcast_to(
                np.cos(azimuth) * way[0] + np.sin(azimuth) * way[1],
                (foot.phalanx_count, count),
            )
            for way in (first, second)
        )
        return cls(across, rise, level, centre)

    def seen(self, along: Floats, down: Floats) -> Floats:
        """Vectors in the toes' planes as they lie in the section.

        Args:
            along: Their horizontal parts, shape (…, P, m), where m is n or either is 1.
            down: How far they go down, of the same shape.

        Returns:
            Their parts across and up, shape (2, …, P, n or m).
        """
        shape = np.broadcast_shapes(along.shape, self.across.shape)
        bones = np.empty((2, *shape), along.dtype)
        np.multiply(along, self.across, out=bones[0])
        np.multiply(along, self.rise, out=bones[1])
        bones[1] -= down * self.level
        return bones
