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


def steps_by_speed(distances: Floats, speeds: Floats) -> Floats:
    """Steps within which distances that change no faster than a bound are not gone.

    Args:
        distances: The distances, shape (…).
        speeds: Bounds on how fast they change, shape (…).

    Returns:
        The steps, infinite where nothing changes, shape (…).
    """
    still = np.full(np.broadcast(distances, speeds).shape, np.inf)
    return np.asarray(np.divide(distances, speeds, still, where=speeds > 0))


def steps_by_bend(distances: Floats, slopes: Floats, bends: Floats) -> Floats:
    """Steps within which distances of bounded acceleration are not gone.

    The first root of distance + slope·t − bend·t²/2.

    Args:
        distances: The distances, shape (…).
        slopes: How fast they grow now, shape (…).
        bends: Bounds on how fast that changes, ≥ 0, shape (…).

    Returns:
        The steps, 0 where a distance is gone already, shape (…).
    """
    left = np.maximum(distances, 0.0)
    with np.errstate(invalid="ignore", divide="ignore"):
        swing = np.sqrt(slopes**2 + 2 * bends * left)
        # Two forms of one root, each without a difference of like numbers.
        falling, rising = 2 * left / (swing - slopes), (swing + slopes) / bends
    steps = np.where(slopes < 0, falling, np.where(bends > 0, rising, np.inf))
    return np.where(np.isfinite(left), steps, np.inf)


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
