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


def first_reached(
    distances: Callable[[float], Floats],
    rates: Floats,
    span: tuple[float, float],
    levels: Floats,
    floors: Floats,
) -> tuple[float, Floats]:
    """The first instant at which one of some distances has fallen to its level.

    Args:
        distances: The distances at an instant, shape (m,).
        rates: Bounds on how fast each changes within the span, shape (m,).
        span: The first and the last instant.
        levels: The levels, shape (m,); −inf for a distance of no interest.
        floors: Below the levels, shape (m,): steps aim there, so that the levels are
            reached in finitely many.

    Returns:
        The instant and the distances then; the last of the span where none falls to
        its level. None is below its floor at any instant before, but for the first.
    """
    time, last = span
    moving = rates > 0
    while True:
        found = distances(time)
        if time >= last or np.any(found <= levels):
            return time, found
        steps = (found - floors)[moving] / rates[moving]
        step = float(np.min(steps, initial=math.inf))
        time = min(max(time + step, math.nextafter(time, math.inf)), last)
