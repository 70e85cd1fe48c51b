"""First-order expansions of functions over boxes, with a bound on what they leave out.

Over a box of variables xᵢ = mᵢ + δᵢ, |δᵢ| ≤ hᵢ, a function lies in
value + Σ slopeᵢ·δᵢ ± slack. Sums, products and smooth functions of expansions are
expansions again, and their slack shrinks with the square of the box: such bounds stay
sharp at a smooth extreme, where bounds that only know a speed do not (Makino and Berz
2003 call them Taylor models).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Expansion:
    """One function over each of m boxes of d variables.

    Attributes:
        value: At the boxes' middles, shape (m,).
        slope: Slope along each variable, shape (d, m).
        slack: Most that the first-order form is off, shape (m,).
        half: Half widths of the boxes, shape (d, m).
    """

    value: Floats
    slope: Floats
    slack: Floats
    half: Floats

    @classmethod
    def variable(cls, index: int, middle: Floats, half: Floats) -> Expansion:
        """One of the variables themselves.

        Args:
            index: Which one.
            middle: Middles of the boxes, shape (d, m).
            half: Their half widths, shape (d, m).
        """
        slope = np.zeros_like(half)
        slope[index] = 1.0
        return cls(middle[index], slope, np.zeros(half.shape[1]), half)

    @property
    def reach(self) -> Floats:
        """Most that the function is off its value, shape (m,)."""
        return np.asarray(np.sum(np.abs(self.slope) * self.half, axis=0) + self.slack)

    @property
    def low(self) -> Floats:
        """Lower bound over each box, shape (m,)."""
        return np.asarray(self.value - self.reach)

    @property
    def high(self) -> Floats:
        """Upper bound over each box, shape (m,)."""
        return np.asarray(self.value + self.reach)

    def __add__(self, other: Expansion | Floats | float) -> Expansion:
        if isinstance(other, Expansion):
            return Expansion(
                self.value + other.value,
                self.slope + other.slope,
                self.slack + other.slack,
                self.half,
            )
        return Expansion(self.value + other, self.slope, self.slack, self.half)

    def __neg__(self) -> Expansion:
        return Expansion(-self.value, -self.slope, self.slack, self.half)

    def __sub__(self, other: Expansion | Floats | float) -> Expansion:
        return self + -other

    def __mul__(self, other: Expansion | Floats | float) -> Expansion:
        if not isinstance(other, Expansion):
            slack = self.slack * np.abs(other)
            return Expansion(self.value * other, self.slope * other, slack, self.half)
        slack = (
            self.reach * other.reach
            + np.abs(self.value) * other.slack
            + np.abs(other.value) * self.slack
        )
        slope = self.slope * other.value + other.slope * self.value
        return Expansion(self.value * other.value, slope, slack, self.half)

    def squared(self) -> Expansion:
        """The function times itself."""
        slack = self.reach**2 + 2 * np.abs(self.value) * self.slack
        return Expansion(self.value**2, 2 * self.value * self.slope, slack, self.half)

    def wave(self) -> tuple[Expansion, Expansion]:
        """Cosine and sine of the function, an angle [rad]."""
        cosine, sine, reach = np.cos(self.value), np.sin(self.value), self.reach
        return self._bent(cosine, -sine, cosine, reach), self._bent(
            sine, cosine, sine, reach
        )

    def _bent(
        self, value: Floats, rate: Floats, bend: Floats, reach: Floats
    ) -> Expansion:
        """A cosine of the function; its curvature changes no faster than the angle."""
        curvature = np.minimum(np.abs(bend) + reach, 1.0)
        slack = np.abs(rate) * self.slack + curvature * reach**2 / 2
        return Expansion(value, rate * self.slope, slack, self.half)

    def root(self, least: float) -> Expansion:
        """Square root, of a function that is at least `least` > 0 everywhere."""
        low = np.maximum(self.low, least)
        value = np.sqrt(np.maximum(self.value, least))
        return self._smooth(value, 0.5 / value, 0.25 * low**-1.5)

    def inverse(self, least: float) -> Expansion:
        """One over a function that is at least `least` > 0 everywhere."""
        low = np.maximum(self.low, least)
        value = 1 / np.maximum(self.value, least)
        return self._smooth(value, -(value**2), 2 * low**-3)

    def _smooth(self, value: Floats, rate: Floats, bend: Floats) -> Expansion:
        """A function of this one, from its slope and a bound on its curvature."""
        slack = np.abs(rate) * self.slack + bend * self.reach**2 / 2
        return Expansion(value, rate * self.slope, slack, self.half)


def most_under(
    goal: Expansion, conditions: Sequence[Expansion], passes: int = 1
) -> Floats:
    """Upper bound of a function over the parts of boxes where others are ≥ 0.

    For any multipliers λ ≥ 0, goal ≤ goal + Σ λᵢ·conditionᵢ there, and the right
    side's largest value over a box is plain. Each λᵢ in turn is made the best for
    the others as they are: the bound is piecewise linear in it.

    Args:
        goal: The function.
        conditions: The others.
        passes: How often each multiplier is improved.

    Returns:
        Bounds, shape (m,); anything where no part of a box meets the conditions.
    """
    half = goal.half
    value, slope = goal.value + goal.slack, goal.slope
    bound = np.asarray(value + np.sum(np.abs(slope) * half, axis=0))
    factors = [np.zeros_like(value) for _ in conditions]
    for _ in range(passes):
        for place, condition in enumerate(conditions):
            offset, rise = condition.value + condition.slack, condition.slope
            value, slope = (
                value - factors[place] * offset,
                slope - factors[place] * rise,
            )
            least = np.asarray(value + np.sum(np.abs(slope) * half, axis=0))
            factor = np.zeros_like(value)
            steep = np.where(rise == 0, np.inf, rise)
            for kink in np.maximum(-slope / steep, 0.0):
                moved = np.sum(np.abs(slope + kink * rise) * half, axis=0)
                moved += value + kink * offset
                factor, least = (
                    np.where(moved < least, new, old)
                    for new, old in ((kink, factor), (moved, least))
                )
            factors[place] = factor
            value, slope = value + factor * offset, slope + factor * rise
            bound = np.minimum(bound, least)
    return bound
