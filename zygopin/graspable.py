"""Which perches a foot can grasp: the radii, as intervals with bisected ends."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from zygopin import checks
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.perch import LEVELS, search_perch
from zygopin.rest import resting_branch

SAMPLES = 33
"""Radii at which a perch is planned before ends are bisected: over 3 to 20 mm they
are 6 % apart."""

TOLERANCE = 1e-5
"""Tolerance of an interval's ends, over the foot's size: a micrometre or less."""

MOST_SAMPLES = 10_001

Interval = tuple[float, float]


@dataclass(frozen=True)
class GraspableRadii:
    """The radii of perches that a foot grasps where its base sits on the bark.

    Attributes:
        foot: The foot.
        low: Least radius asked for [m].
        high: Largest radius asked for [m].
        tolerance: What the intervals' ends may lack [m].
        intervals: The intervals in order; their ends were grasped, and a radius at
            most `tolerance` beyond an end inside (low, high) was not.
        wrap: Mean over the sampled radii of the largest wrap of a grasp, 0 for a
            radius that is not grasped [rad].
        plans: Number of perches that were planned.
    """

    foot: Foot
    low: float
    high: float
    tolerance: float
    intervals: tuple[Interval, ...]
    wrap: float
    plans: int

    @property
    def length(self) -> float:
        """Length of the intervals together [m]."""
        return math.fsum(high - low for low, high in self.intervals)

    @property
    def log_length(self) -> float:
        """∫ dr/r over the intervals: log(high/low) where all radii are graspable."""
        return math.fsum(math.log(high / low) for low, high in self.intervals)

    @property
    def share(self) -> float:
        """Share of the asked range that is graspable, on the logarithmic scale."""
        return self.log_length / math.log(self.high / self.low)


def graspable_radii(
    foot: Foot,
    low: float,
    high: float,
    *,
    levels: int = LEVELS,
    samples: int = SAMPLES,
    tolerance: float | None = None,
) -> GraspableRadii:
    """The radii of perches that a foot at rest grasps, as a union of intervals.

    The foot sits on the perch, which is level, across it, and straight below the base
    (`resting_branch`); a radius counts where `search_perch` finds a feasible grasp.
    Radii at equal ratios are tried, then each change between two neighbours is
    bisected. What changes twice between two neighbours is not seen: take more samples.

    Args:
        foot: The foot.
        low: Least radius [m].
        high: Largest radius [m].
        levels: Angles that the planner tries at each joint, 2 to 33.
        samples: Number of radii tried first, at least 2.
        tolerance: What an interval's end may lack [m]; None: `TOLERANCE` of the foot's
            size.

    Returns:
        The intervals.

    Raises:
        ParameterError: The range is empty, or a number out of range.
    """
    low, high = radius_range(low, high)
    count = checks.integer("samples", samples, 2, MOST_SAMPLES)
    fine = TOLERANCE * foot.size if tolerance is None else _positive(tolerance)
    wraps: dict[float, float] = {}

    def grasped(radius: float) -> bool:
        plan = search_perch(foot, resting_branch(foot, radius), levels=levels)
        wraps[radius] = float(plan.wrap.max()) if plan.grasping else 0.0
        return plan.grasping

    radii = np.geomspace(low, high, count).tolist()
    radii[0], radii[-1] = low, high
    found = true_intervals(grasped, radii, fine)
    wrap = math.fsum(wraps[radius] for radius in radii) / count
    return GraspableRadii(foot, low, high, fine, found, wrap, len(wraps))


def true_intervals(
    holds: Callable[[float], bool], points: Sequence[float], tolerance: float
) -> tuple[Interval, ...]:
    """Where a condition holds, as intervals, from samples and bisection.

    Args:
        holds: The condition.
        points: Samples in ascending order.
        tolerance: Largest distance from an end to where the condition fails.

    Returns:
        Intervals in order, at whose ends the condition holds.
    """
    known = [holds(point) for point in points]
    intervals, start = [], points[0]
    for place, here in enumerate(known):
        if not here:
            continue
        if place == 0 or not known[place - 1]:
            start = (
                points[0]
                if place == 0
                else _end(holds, points[place], points[place - 1], tolerance)
            )
        if place == len(known) - 1:
            intervals.append((start, points[place]))
        elif not known[place + 1]:
            end = _end(holds, points[place], points[place + 1], tolerance)
            intervals.append((start, end))
    return tuple(intervals)


def radius_range(low: float, high: float) -> Interval:
    """A range of radii [m], checked.

    Args:
        low: Least radius.
        high: Largest radius.

    Returns:
        Both as floats.

    Raises:
        ParameterError: Not positive, or not ascending.
    """
    ends = checks.lengths("range of radii", [low, high])
    if not ends[0] < ends[1]:
        remedy = "give the lesser radius first"
        raise ParameterError("range of radii", (low, high), "ascending", remedy)
    return float(ends[0]), float(ends[1])


def _positive(tolerance: object) -> float:
    """A tolerance that bisection can reach."""
    return checks.number(
        "tolerance",
        tolerance,
        allowed="a positive number",
        where=lambda x: x > 0,
        remedy="give metres, such as 1e-6",
    )


def _end(
    holds: Callable[[float], bool], inside: float, outside: float, tolerance: float
) -> float:
    """The last point found to hold between one that does and one that does not."""
    while abs(outside - inside) > tolerance:
        middle = (inside + outside) / 2
        if middle in (inside, outside):  # no double in between
            break
        if holds(middle):
            inside = middle
        else:
            outside = middle
    return inside
