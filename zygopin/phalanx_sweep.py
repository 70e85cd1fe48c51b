"""A first phalanx that turns about the base: for which v it meets an obstacle."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.clearance import Clearance, dot
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.obstacle import Obstacle
from zygopin.solid_clearance import obstacle_clearance
from zygopin.toe_stops import CUTS

POINT = 1e-9
"""Length over the foot's size of the bone that stands for the base's point."""

Floats = NDArray[np.float64]
Interval = tuple[float, float]
"""First and last value of v."""


@dataclass(frozen=True, eq=False)
class Sweep:
    """The first phalanx of a finger, as v turns it by ωv about the base.

    Attributes:
        foot: The foot.
        finger: The finger.
        pose: Pose in the world of the finger's plane: x along the straight toe, z up.
        solid: The convex solid that it may meet.
    """

    foot: Foot
    finger: Finger
    pose: Floats
    solid: Obstacle

    @property
    def phalanx(self) -> int:
        """The phalanx's index among all."""
        return int(self.foot.finger_slices[self.finger.name].start)

    def clearances(self, values: Floats) -> Floats:
        """Clearance of the phalanx.

        Args:
            values: Values of v, shape (n,).

        Returns:
            Signed clearances [m], shape (n,).
        """
        return np.asarray(self._near(values)[0].distance.min(axis=1))

    def base_clearance(self) -> float:
        """Clearance of the skin around the base [m]."""
        tip = POINT * self.foot.size * self.pose[:3, 0]
        bone = self.pose[:3, 3] + np.stack([np.zeros(3), tip])
        return float(self._clearance(bone[None]).distance[0])

    def contacts(self, tolerance: float) -> tuple[Interval, ...]:
        """Values of v in [0, 1] at which the phalanx meets the solid.

        A range of v is clear where every piece stays off, and touching where one
        cannot leave or where contacts enclose it; else it is halved.

        Args:
            tolerance: Clearance that counts as contact [m].

        Returns:
            Disjoint intervals, ascending: the clearance is at most twice the tolerance
            in them, and more than the tolerance outside.
        """
        if self.base_clearance() <= tolerance:
            return ((0.0, 1.0),)
        ends = np.array([0.0, 1.0])
        met = ends[self.clearances(ends) <= 2 * tolerance]
        low, high = ends[:1], ends[1:]
        held: list[Interval] = []
        while len(low):
            middle = (low + high) / 2
            found, least, most = self._bounds(
                middle, self.foot.omega * (high - low) / 2
            )
            met = np.union1d(met, middle[found <= 2 * tolerance])
            clear = least > tolerance
            touching = (most <= 2 * tolerance) | self._enclosed(low, high, met)
            held += zip(low[touching].tolist(), high[touching].tolist(), strict=True)
            left = ~(clear | touching)
            low, middle, high = low[left], middle[left], high[left]
            low, high = np.append(low, middle), np.append(middle, high)
        return merged(held)

    def _bounds(self, values: Floats, turns: Floats) -> tuple[Floats, Floats, Floats]:
        """Clearances [m], and their bounds while turned by less either way.

        A piece's clearance changes no more than its far end moves. And it is no less
        than that to the plane between it and the solid, which is convex.

        Args:
            values: Values of v, shape (n,).
            turns: Angles [rad], shape (n,).

        Returns:
            The clearance, the lower and the upper bound, shape (n,) each.
        """
        near, along, down = self._near(values)
        radius, start = self.foot.radii[self.phalanx], self.pose[:3, 3]
        reach, turns = self.foot.lengths[self.phalanx] * CUTS, turns[:, None]
        moves = reach[1:] * turns
        quarter = np.minimum(turns, math.pi / 2)
        out, side = dot(near.normal, along), np.abs(dot(near.normal, down))
        slope = np.minimum(out * np.cos(quarter), out) - side * np.sin(quarter)
        slope = np.where(turns < math.pi / 2, slope, -1.0)
        lower = np.minimum(slope * reach[:-1], slope * reach[1:])
        planes = dot(near.normal, start - near.point) - radius + lower
        planes = np.where(near.distance > 0, planes, -np.inf)
        least = np.maximum(near.distance - moves, planes).min(axis=1)
        most = (near.distance + moves).min(axis=1)
        return near.distance.min(axis=1), least, most

    def _near(self, values: Floats) -> tuple[Clearance, Floats, Floats]:
        """Clearances of the phalanx's pieces, and the directions along and across it.

        Args:
            values: Values of v, shape (n,).

        Returns:
            The record, of shape (n, M), and unit vectors, shape (n, 1, 3) each.
        """
        angle = (self.finger.orientation + self.foot.omega * values)[:, None, None]
        ahead, up = self.pose[:3, 0], self.pose[:3, 2]
        along = np.cos(angle) * ahead - np.sin(angle) * up
        down = -np.sin(angle) * ahead - np.cos(angle) * up
        places = self.foot.lengths[self.phalanx] * CUTS[:, None] * along
        cuts = self.pose[:3, 3] + places
        pieces = np.stack([cuts[:, :-1], cuts[:, 1:]], axis=-2)
        return self._clearance(pieces), along, down

    def _enclosed(self, low: Floats, high: Floats, met: Floats) -> NDArray[np.bool_]:
        """Whether ranges of v lie between contacts less than π apart.

        The contacts' directions fill one arc, narrower than π: `zygopin.remark`, 2.
        """
        if not len(met):
            return np.zeros(len(low), bool)
        before = np.searchsorted(met, low, "right") - 1
        after = np.searchsorted(met, high, "left")
        inside = (before >= 0) & (after < len(met))
        last = met[np.minimum(after, len(met) - 1)]
        turn = self.foot.omega * (last - met[np.maximum(before, 0)])
        return np.asarray(inside & (turn < math.pi))

    def _clearance(self, bones: Floats) -> Clearance:
        """Clearances of bones in this phalanx's skin, shape (…, M, 2, 3)."""
        skins = np.full(bones.shape[-3], self.foot.radii[self.phalanx])
        return obstacle_clearance(bones, skins, self.solid)


def merged(intervals: Iterable[Interval]) -> tuple[Interval, ...]:
    """The union of some intervals.

    Args:
        intervals: Closed intervals, in any order.

    Returns:
        Disjoint closed intervals, ascending.
    """
    union: list[Interval] = []
    for low, high in sorted(intervals):
        if union and low <= union[-1][1]:
            union[-1] = union[-1][0], max(high, union[-1][1])
        else:
            union.append((low, high))
    return tuple(union)


def about_z(angle: float) -> Floats:
    """The pose of a frame turned about z.

    Args:
        angle: The turn [rad].

    Returns:
        The pose, shape (4, 4).
    """
    pose = np.eye(4)
    pose[:2, :2] = [
        [math.cos(angle), -math.sin(angle)],
        [math.sin(angle), math.cos(angle)],
    ]
    return pose
