"""Bounds over boxes of controls on how near a finger's bones come to axes.

First order, with a bound on the curvature, where boxes are small: a bone is no nearer
than its ends are along the direction of its nearest point at the box's middle, and no
farther than that point goes. Where boxes are large, discs hold the junctions.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.axis_chain import (
    AxisChain,
    Contact,
    Floats,
    Indices,
    Points,
    junctions,
    nearest_on,
    project,
)
from zygopin.expansion import Expansion, most_under

NEAR = 1e-6
"""Distance from the axis, over the finger's length, below which only discs bound how
far a bone gets: directions turn too fast there."""

PASSES = 2
"""How often each multiplier is improved where several bones bound together."""


@dataclass(frozen=True, eq=False)
class BoxBounds:
    """What a search needs to know of m boxes.

    Attributes:
        bound: Bound on D over each box, shape (m,).
        value: D at each middle, shape (m,).
        effect: What halving the box across each control may gain, shape (K, m).
    """

    bound: Floats
    value: Floats
    effect: Floats


@dataclass(frozen=True, eq=False)
class Goal:
    """What a search wants to know of boxes.

    Attributes:
        limit: For each axis, the D beyond which a box does not matter, shape (n,).
        normal: Directions of the witness's nearest points, shape (K, n).
    """

    limit: Floats
    normal: Points


@dataclass(frozen=True, eq=False)
class BoxViews:
    """Boxes of controls, seen along the directions of the nearest points at middles.

    Attributes:
        chain: The chains.
        which: Index of the axis of each box, shape (m,).
        half: Half widths, shape (K, m).
        contact: Where the bones are nearest at the middles.
        spread: Most that the angles θ differ from the middle's [rad], shape (K, m).
    """

    chain: AxisChain
    which: Indices
    half: Floats
    contact: Contact
    spread: Floats

    @classmethod
    def of(
        cls, chain: AxisChain, middle: Floats, half: Floats, which: Indices
    ) -> BoxViews:
        """The views of some boxes.

        Args:
            chain: The chains.
            middle: Middles of the boxes, shape (K, m).
            half: Their half widths, shape (K, m).
            which: Index of the axis of each, shape (m,).

        Returns:
            The views.
        """
        contact = chain.contact(middle, which)
        spread = chain.omega * np.cumsum(half, axis=0)
        return cls(chain, which, half, contact, spread)

    def bend(self, normal: Points, side: float) -> Floats:
        """Most that curvature moves each step along each bone's direction.

        Along a direction a step is a wave A·cos(θ + φ), whose second derivative is
        its negative.

        Args:
            normal: A direction for each bone, shape (K, m).
            side: −1: down, 1: up.

        Returns:
            Bounds of phalanx m's part in bone k's, shape (K, K, m).
        """
        seen = project(normal[:, None], self.contact.steps[None])
        height = self.height(normal)
        bent = np.clip(height * self.spread - side * seen, 0.0, height)
        return np.asarray(bent * (self.spread**2 / 2))

    def height(self, normal: Points) -> Floats:
        """Heights A of the steps' waves along each bone's direction, (K, K, m)."""
        across = self.chain.height(normal, self.which)
        return np.asarray(across[:, None] * self.chain.lengths[:, None])

    def moved(self, slopes: Floats) -> Floats:
        """Most that slopes along the controls change a value by, (…, K, m)."""
        return np.asarray(np.sum(np.abs(slopes) * self.half, axis=-2))

    def discs(self) -> tuple[Points, Floats]:
        """Discs that hold the junctions: centres and radii, shape (K + 1, m)."""
        tilt = np.minimum(self.spread, np.pi / 2)
        centres = junctions(
            self.chain.base[self.which], self.contact.steps * np.cos(tilt)
        )
        grown = np.cumsum(self.chain.lengths[:, None] * np.sin(tilt), axis=0)
        grown = np.concatenate([np.zeros_like(grown[:1]), grown])
        return centres, grown * self.chain.stretch[self.which]

    def point_bend(self, normal: Points, side: float) -> Floats:
        """Most that curvature moves the nearest points of the middle, shape (K, m).

        Args:
            normal: A direction for each bone, shape (K, m).
            side: −1: down, 1: up.
        """
        whole = np.tri(self.chain.count, k=-1)
        bend = self.bend(normal, side)
        last = np.einsum("kkm->km", bend)
        return np.asarray(np.einsum("kj,kjm->km", whole, bend) + self.contact.t * last)

    def aside(self) -> Floats:
        """Most that those points move across their directions, shape (K, m)."""
        contact = self.contact
        across = 1j * contact.normal
        slope = self.chain.turned(across, contact.ends, contact.rates)
        bends = self.point_bend(across, 1), self.point_bend(across, -1)
        return self.moved(slope) + np.maximum(*bends)

    def disc_bounds(self) -> Floats:
        """Upper bounds of the bones' distances from the discs, shape (K, m)."""
        centres, grown = self.discs()
        t, points = nearest_on(centres[:-1], np.diff(centres, axis=0))
        return np.asarray(np.abs(points) + (1 - t) * grown[:-1] + t * grown[1:])

    def least_along(self, normal: Points) -> Floats:
        """Least coordinate of each bone along a direction.

        That of the nearer end. The steps to it are waves: each at its least, or all
        by their slopes together, their curvature bounded.

        Args:
            normal: A direction for each bone, shape (K, m).

        Returns:
            The bounds, shape (K, m).
        """
        chain, rates = self.chain, self.contact.rates
        seen = project(normal[:, None], self.contact.steps[None])
        base = project(normal, chain.base[self.which])
        alone = self.least_waves(normal, seen)
        joint = seen - self.bend(normal, -1.0)
        least = np.full_like(base, np.inf)
        nearer = np.tri(chain.count, k=-1)
        for part, ends in (
            (nearer, rates[:-1]),
            (nearer + np.eye(chain.count), rates[1:]),
        ):
            apart = np.einsum("kj,kjm->km", part, alone)
            together = np.einsum("kj,kjm->km", part, joint)
            together -= self.moved(chain.turned(normal, ends, rates))
            least = np.minimum(least, np.maximum(apart, together))
        return np.asarray(base + least)

    def least_waves(self, normal: Points, seen: Floats) -> Floats:
        """Least coordinate of each step along each bone's direction, (K, K, m).

        Args:
            normal: A direction for each bone, shape (K, m).
            seen: The coordinates at the middle, shape (K, K, m).
        """
        height, turn = self.height(normal), np.minimum(self.spread, np.pi)
        rates = np.diff(self.contact.rates, axis=0)
        slope = np.abs(project(normal[:, None], rates[None]))
        ends = seen * np.cos(turn) - slope * np.sin(turn)
        return np.where(-seen >= height * np.cos(turn), -height, ends)

    def travel(self) -> Floats:
        """Farthest that a point of each bone moves from where it is, shape (K, m)."""
        moved = self.chain.lengths[:, None] * np.minimum(self.spread, 2.0)
        return np.cumsum(moved, axis=0) * self.chain.stretch[self.which]

    def effects(self, relevant: NDArray[np.bool_]) -> Floats:
        """How far each control may move the bones that matter, shape (K, m).

        Args:
            relevant: Which bones matter, shape (K, m).
        """
        last = np.logical_or.accumulate(relevant[::-1], axis=0)[::-1]
        moved = last * self.chain.lengths[:, None]
        return np.asarray(self.half * np.cumsum(moved[::-1], axis=0)[::-1])


def lower_bounds(views: BoxViews, goal: Goal) -> BoxBounds:
    """Lower bounds of D.

    Args:
        views: The boxes.
        goal: What matters to each axis.

    Returns:
        The bounds.
    """
    chain, which = views.chain, views.which
    centres, grown = views.discs()
    _, points = nearest_on(centres[:-1], np.diff(centres, axis=0))
    least = np.maximum(np.abs(points) - grown[1:], chain.off_plane[:, which])
    for normal in (views.contact.normal, goal.normal[:, which]):
        least = np.maximum(least, views.least_along(normal))
    least -= chain.radii[:, None]
    gap = views.contact.gap
    effect = views.effects(least < goal.limit[which])
    return BoxBounds(least.min(axis=0), gap.min(axis=0), effect)


def upper_bounds(views: BoxViews, goal: Goal) -> BoxBounds:
    """Upper bounds of D, or the limit where that is greater.

    Where several bones bound D, their bounds are combined: where one lets D grow,
    another may not.

    Args:
        views: The boxes.
        goal: What matters to each axis.

    Returns:
        The bounds.
    """
    value, slope, slack = _outer_pieces(views)
    reach = views.moved(slope) + slack
    first = np.argmin(value + reach, axis=0)
    half, limit = views.half, goal.limit[views.which]
    least = _piece(value, slope, slack, half, first)
    others = [
        _piece(value - limit, slope, slack, half, np.full_like(first, k))
        for k in range(len(half))
    ]
    bound = np.maximum(most_under(least, others, PASSES), limit)
    gap = views.contact.gap
    low = gap - np.where(reach > 0, np.minimum(reach, views.travel()), views.travel())
    effect = views.effects(low < limit)
    return BoxBounds(bound, gap.min(axis=0), effect)


def _piece(
    value: Floats, slope: Floats, slack: Floats, half: Floats, index: Indices
) -> Expansion:
    """One piece of each box as an expansion."""
    row = np.arange(len(index))
    return Expansion(value[index, row], slope[index, :, row].T, slack[index, row], half)


def _outer_pieces(views: BoxViews) -> tuple[Floats, Floats, Floats]:
    """First-order upper bounds of each bone's distance, less its skin's radius.

    Those of the point that is nearest at the middle: along its direction n, and off
    it by its coordinate across, of which √(a² + b²) ≤ a + b²/2a. Where a disc holds
    the bone nearer, its bound alone.

    Returns:
        Values, shape (K, m), slopes, shape (K, K, m), and slacks, shape (K, m).
    """
    chain, contact = views.chain, views.contact
    value = contact.gap + chain.radii[:, None]
    slope = chain.slopes(contact)
    reach = views.moved(slope)
    low = np.maximum(value - reach - views.point_bend(contact.normal, -1), NEAR)
    aside = views.aside()
    slack = views.point_bend(contact.normal, 1) + aside**2 / (2 * low)
    coarse = views.disc_bounds()
    wide = (coarse < value + reach + slack) | (low <= NEAR)
    value = np.where(wide, coarse, value) - chain.radii[:, None]
    slope = np.where(wide[:, None], 0.0, slope)
    return value, slope, np.where(wide, 0.0, slack)
