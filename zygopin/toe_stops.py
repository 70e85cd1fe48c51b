"""Toes that a tendon closes: where their joints stop as they meet something.

A tendon-driven toe is underactuated: a joint stops once its phalanx, or one beyond it,
meets the obstacle or another toe, and the joints farther out go on (MODEL.md, section
6, the reading `contact`).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.advancement import Look, first_reached
from zygopin.clearance import Clearance
from zygopin.grasp import finger_pairs, least_gap
from zygopin.stance import Stance, levers
from zygopin.toe_motion import ToeMotion, steps_between, steps_to_solid

Floats = NDArray[np.float64]
Near = Callable[[Floats, Floats], Clearance]
"""Clearance to the obstacle of bones, shape (…, M, 2, 3), with skins of radii (M,)."""

CLOSE = 0.01
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
    where it is, never opens, and stays where it was when it stopped, at wⱼ. Phalanges
    of two toes that overlap from the start do not hold each other up.

    Attributes:
        stance: Where the toes start.
        near: The clearance to the obstacle.
        pairs: Phalanges of different fingers that can meet, M of them.
        driven: Whether joint j turns phalanx k, shape (P, P).
        tolerance: Deepest that a toe may enter anything anew [m].
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
        self.driven = levers(foot) > 0
        self.stopped_at = np.full(foot.phalanx_count, np.inf)
        self.stops: list[Stop] = []
        # A toe may sink in by one such depth with each phalanx that stops.
        deepest = 2 * int(foot.rank_of_phalanx.max()) + 2
        self.tolerance, self.depth = tolerance, tolerance / (2 * deepest)
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
        distances, _ = self.look(np.full(len(self.contact), -np.inf))(progress)
        level = np.minimum(distances, self.contact) - self.depth
        overlap = distances[self.driven.shape[0] :] < -self.tolerance
        level[self.driven.shape[0] :][overlap] = -np.inf
        while progress < end:
            wanted = np.where(self.moving(), level, -np.inf)
            look = self.look(wanted - self.depth / 2)
            progress, distances = first_reached(look, (progress, end), wanted)
            met = distances <= wanted
            if not met.any():
                return
            self.stop(progress, met, distances)
            # A phalanx beyond a joint that stopped goes on, and may touch at its joint.
            level = np.where(met, distances - self.depth, level)

    def motion(self, progress: float) -> ToeMotion:
        """How the phalanges move at a progress."""
        stance, controls = self.stance, self.controls(np.asarray(progress))
        here = Stance(stance.foot, stance.base, stance.azimuths, controls)
        return ToeMotion.of(here, self.rates())

    def look(self, floors: Floats) -> Look:
        """Clearances at a progress, to the obstacle and between toes, and a safe step.

        Phalanges that are close to the obstacle are looked at piece by piece.
        """
        foot, count = self.stance.foot, self.stance.foot.phalanx_count

        def look(progress: float) -> tuple[Floats, float]:
            motion = self.motion(progress)
            near = self.near(motion.bones, foot.radii)
            steps = steps_to_solid(motion, foot.radii, near, floors[:count])
            close = np.isfinite(steps) & (near.distance < CLOSE * foot.lengths)
            which = np.flatnonzero(close)
            if len(which):
                each = self.steps_in_pieces(motion, which, floors[which])
                steps[which] = np.maximum(steps[which], each)
            between, others = steps_between(
                motion, foot.radii, self.pairs, floors[count:]
            )
            step = min(steps.min(initial=np.inf), others.min(initial=np.inf))
            return np.concatenate([near.distance, between]), float(step)

        return look

    def steps_in_pieces(
        self, motion: ToeMotion, which: NDArray[np.intp], floors: Floats
    ) -> Floats:
        """Safe steps of some phalanges, whose points near the joint move less."""
        pieces, count = motion.pieces(which, CUTS), len(CUTS) - 1
        radii = np.repeat(self.stance.foot.radii[which], count)
        near = self.near(pieces.bones, radii)
        steps = steps_to_solid(pieces, radii, near, np.repeat(floors, count))
        return np.asarray(steps.reshape(-1, count).min(axis=-1))

    def rates(self) -> Floats:
        """Rate of each joint's angle, 0 for one that has stopped [rad], shape (P,)."""
        stance = self.stance
        free = np.isinf(self.stopped_at)
        return np.asarray(stance.foot.omega * (1 - stance.controls) * free)

    def moving(self) -> NDArray[np.bool_]:
        """Which phalanges still move, and which pairs of them, shape (P + M,)."""
        alone = self.driven @ self.rates() > 0
        return np.concatenate([alone, alone[self.pairs[0]] | alone[self.pairs[1]]])

    def stop(self, progress: float, met: NDArray[np.bool_], distances: Floats) -> None:
        """Stop the joints that drive what has met something: the innermost phalanx."""
        foot, count = self.stance.foot, len(self.stopped_at)
        moving = self.moving()[:count]
        to_toe = np.full(count, np.inf)
        for ends in self.pairs:
            np.minimum.at(to_toe, ends[met[count:]], distances[count:][met[count:]])
        hit = (met[:count] | np.isfinite(to_toe)) & moving
        points = self.near(self.motion(progress).bones, foot.radii).point
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
