"""Conservative advancement: when some distances first fall to their levels.

A distance that changes no faster than a bound cannot be gone sooner than the distance
over the bound. Steps of that length miss nothing, however thin or fast it is.
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
        look: The distances, and a safe step to floors below the levels: those make
            that the levels are reached in finitely many steps.
        span: The first and the last instant.
        levels: The levels, shape (m,); −inf for a distance of no interest.

    Returns:
        The instant and the distances then; the last of the span where none falls to
        its level. None is below its floor at any instant before, but for the first.
    """
    time, last = span
    while True:
        found, step = look(time)
        if time >= last or np.any(found <= levels):
            return time, found
        time = min(max(time + step, math.nextafter(time, math.inf)), last)
