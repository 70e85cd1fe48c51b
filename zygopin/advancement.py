"""Conservative advancement: when some distances first fall to their levels.

A distance that changes no faster than a bound cannot vanish sooner than after the
distance over the bound. Steps of that length miss nothing, however thin the obstacle or
fast the motion.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Look = Callable[[float], tuple[Floats, float]]
"""Distances at an instant, shape (m,), and a step within which none is used up."""


def safe_step(distances: Floats, floors: Floats, rates: Floats) -> float:
    """A step within which no distance falls to its floor.

    Args:
        distances: The distances, shape (m,).
        floors: What they shall stay above, shape (m,); −inf for one of no interest.
        rates: Bounds on how fast each changes, shape (m,).

    Returns:
        The step; infinite where nothing changes.
    """
    moving = rates > 0
    steps = (distances - floors)[moving] / rates[moving]
    return float(np.min(steps, initial=math.inf))


def first_reached(
    look: Look, span: tuple[float, float], levels: Floats
) -> tuple[float, Floats]:
    """The first instant at which one of some distances has fallen to its level.

    Args:
        look: The distances, and a step that is safe down to floors: these lie below
            the levels, so that the levels are reached in finitely many steps.
        span: The first and the last instant.
        levels: The levels, shape (m,); −inf for a distance of no interest.

    Returns:
        The instant and the distances then; the last of the span where none falls to
        its level. Between the span's first instant and this one none is below its
        floor.
    """
    time, last = span
    while True:
        found, step = look(time)
        if time >= last or np.any(found <= levels):
            return time, found
        time = min(max(time + step, math.nextafter(time, math.inf)), last)
