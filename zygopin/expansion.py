"""First-order expansions of functions over boxes, with a bound on what they leave out.

Over a box of variables xᵢ = mᵢ + δᵢ, |δᵢ| ≤ hᵢ, a function lies in
value + Σ slopeᵢ·δᵢ ± slack. The slack shrinks with the square of the box: such bounds
stay sharp at a smooth extreme, where bounds that only know a speed do not (Makino and
Berz 2003 call them Taylor models).
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

    @property
    def high(self) -> Floats:
        """Upper bound over each box, shape (m,)."""
        reach = np.sum(np.abs(self.slope) * self.half, axis=0) + self.slack
        return np.asarray(self.value + reach)


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
    bound = goal.high
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
