"""Toes that a tendon closes: where their joints stop as they meet something.

A tendon-driven toe is underactuated: a joint stops once its phalanx, or one beyond it,
meets the obstacle or another toe, and the joints farther out go on (MODEL.md, section
6, the reading `contact`).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.advancement import Look, first_reached, safe_step
from zygopin.clearance import Clearance, skin_distance
from zygopin.grasp import finger_pairs, least_gap
from zygopin.stance import Stance, levers

Floats = NDArray[np.float64]
Near = Callable[[Floats, Floats], Clearance]
"""Clearance to the obstacle of bones, shape (…, M, 2, 3), with skins of radii (M,)."""

CLOSE = 0.25
"""Clearance over a phalanx's length below which it is looked at piece by piece."""

CUTS = np.append(0.0, 4.0 ** np.arange(-12.0, 1.0))
"""Where it is cut, over its length: a phalanx that touches at its joint moves little
there, and may turn all the way while it touches. Fourfold steps, down to 6e-8."""


@dataclass(frozen=True, eq=False)
class Stop:
    """A phalanx that met something.

    Attributes:
        progress: How far the toes had closed, in [0, 1].
        phalanx: Its index among all P.
        clearance: What was left to what it met [m].
        point: The obstacle's point [m], shape (3,); None: it met another toe.
    """

    progress: float
    phalanx: int
    clearance: float
    point: Floats | None


class ToeStops:
    """Toes closing from a stance, all at once, until each has met something.

    At a progress w the control of joint j is uⱼ + (1 − uⱼ)·min(w, wⱼ): it starts from
    where it is, never opens, and stays where it was when it stopped, at wⱼ.

    Attributes:
        stance: Where the toes start.
        near: The clearance to the obstacle.
        pairs: Phalanges of different fingers that can meet, M of them.
        levers: Bounds on the speed of bone k as joint j closes, over the progress [m],
            shape (P, P).
        turning: The same for the bone's angular speed [rad], shape (P, P).
        depth: How far below its level a clearance may fall before a joint stops [m].
        contact: Clearances that count as a meeting, to the obstacle and between pairs
            of toes [m], shape (P + M,).
        stopped_at: Progress wⱼ of each joint, infinite until it stops, shape (P,).
        stops: What was met, in order.
    """

    def __init__(self, stance: Stance, near: Near, tolerance: float) -> None:
        """Toes before they close.

        Args:
            stance: Where they start.
            near: The clearance to the obstacle.
            tolerance: Deepest that a toe may enter anything anew [m].
        """
        foot = stance.foot
        self.stance, self.near = stance, near
        self.pairs = finger_pairs(foot)
        self.levers = foot.omega * (1 - stance.controls) * levers(foot)
        self.turning = foot.omega * (1 - stance.controls) * (levers(foot) > 0)
        self.stopped_at = np.full(foot.phalanx_count, np.inf)
        self.stops: list[Stop] = []
        # A toe may sink in by one such depth with each phalanx that stops.
        deepest = 2 * int(foot.rank_of_phalanx.max()) + 2
        self.depth = tolerance / (2 * deepest)
        gap = max(least_gap(foot, 2 * tolerance), 0.0)
        self.contact = np.zeros(foot.phalanx_count + len(self.pairs[0]))
        self.contact[foot.phalanx_count :] = gap

    def controls(self, progress: Floats) -> Floats:
        """Controls at a progress, shape (…) to shape (…, P)."""
        start = self.stance.controls
        share = np.minimum(np.asarray(progress)[..., None], self.stopped_at)
        return np.asarray(start + (1 - start) * share)

    def close(self, end: float) -> None:
        """Close the toes.

        Args:
            end: Progress at the end, in [0, 1].
        """
        progress = 0.0
        distances = self.distances(progress)
        level = np.minimum(distances, self.contact) - self.depth
        while progress < end:
            wanted = np.where(self.rates() > 0, level, -np.inf)
            look = self.look(wanted - self.depth / 2)
            progress, distances = first_reached(look, (progress, end), wanted)
            met = distances <= wanted
            if not met.any():
                return
            self.stop(progress, met, distances)
            # A phalanx beyond a joint that stopped goes on, and may touch at its joint.
            level = np.where(met, distances - self.depth, level)

    def bones(self, progress: float) -> Floats:
        """Bones at a progress [m], shape (P, 2, 3)."""
        stance, controls = self.stance, self.controls(np.asarray(progress))
        return Stance(stance.foot, stance.base, stance.azimuths, controls).bones

    def distances(self, progress: float) -> Floats:
        """Clearances to the obstacle, then between pairs of toes, shape (P + M,)."""
        bones = self.bones(progress)
        between = skin_distance(bones, self.stance.foot.radii, self.pairs)
        return np.concatenate(
            [self.near(bones, self.stance.foot.radii).distance, between]
        )

    def look(self, floors: Floats) -> Look:
        """Clearances at a progress, and a step in which none falls to its floor."""
        rates, count = self.rates(), len(self.stopped_at)
        length = self.stance.foot.lengths

        def look(progress: float) -> tuple[Floats, float]:
            distances = self.distances(progress)
            close = (rates[:count] > 0) & (distances[:count] < CLOSE * length)
            far = np.append(~close, np.ones(len(rates) - count, bool))
            step = safe_step(distances[far], floors[far], rates[far])
            pieces = self.step_in_pieces(progress, np.flatnonzero(close), floors)
            return distances, min(step, pieces)

        return look

    def step_in_pieces(
        self, progress: float, phalanges: NDArray[np.intp], floors: Floats
    ) -> float:
        """The safe step of some phalanges, whose points near the joint move less."""
        if not len(phalanges):
            return math.inf
        foot, moving = self.stance.foot, np.isinf(self.stopped_at)
        bones = self.bones(progress)[phalanges]
        along = (bones[:, 1] - bones[:, 0])[:, None]
        cuts = bones[:, :1] + CUTS[:, None] * along
        # A bone has two ends: far from the origin those of a piece may be as one.
        shortest = 8 * np.spacing(np.abs(bones).max()) / foot.lengths[phalanges]
        ends = np.maximum(CUTS[1:], CUTS[:-1] + shortest[:, None])[..., None]
        pieces = np.stack([cuts[:, :-1], bones[:, :1] + ends * along], axis=-2)
        pieces = pieces.reshape(-1, 2, 3)
        count = len(CUTS) - 1
        near = self.near(pieces, np.repeat(foot.radii[phalanges], count))
        turning = self.turning[phalanges] @ moving * foot.lengths[phalanges]
        far_end = self.levers[phalanges] @ moving
        rates = far_end[:, None] - np.outer(turning, 1 - CUTS[1:])
        under = np.repeat(floors[phalanges], count)
        return safe_step(near.distance, under, rates.ravel())

    def rates(self) -> Floats:
        """Bounds on how fast these change with the progress, shape (P + M,)."""
        speeds = self.levers @ np.isinf(self.stopped_at)
        return np.concatenate([speeds, speeds[self.pairs[0]] + speeds[self.pairs[1]]])

    def stop(self, progress: float, met: NDArray[np.bool_], distances: Floats) -> None:
        """Stop the joints that drive what has met something: the innermost phalanx."""
        foot, count = self.stance.foot, len(self.stopped_at)
        moving = self.rates()[:count] > 0
        to_toe = np.full(count, np.inf)
        for ends in self.pairs:
            np.minimum.at(to_toe, ends[met[count:]], distances[count:][met[count:]])
        hit = (met[:count] | np.isfinite(to_toe)) & moving
        points = self.near(self.bones(progress), foot.radii).point
        for part in foot.finger_slices.values():
            if not hit[part].any():
                continue
            phalanx = part.start + int(np.argmax(hit[part]))
            driving = slice(part.start, phalanx + 1)
            stopped = np.minimum(self.stopped_at[driving], progress)
            self.stopped_at[driving] = stopped
            left, point = float(to_toe[phalanx]), None
            if met[phalanx]:
                left, point = float(distances[phalanx]), points[phalanx]
            self.stops.append(Stop(progress, phalanx, left, point))
