"""An owl's attack as a flight: clenched and level, opening, then down on the target."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from zygopin import checks
from zygopin.flight import Flight
from zygopin.foot import Foot
from zygopin.motion import Law, Motion

SPEED = 3.0
"""Speed of the foot, unless said otherwise [m/s]: illustrative."""

SLOPE = math.radians(60)
"""Slope of its way down, unless said otherwise [rad]: illustrative."""

OPEN = 0.1
"""Controls of the opened toes, unless said otherwise: a little bent."""

CLENCHED = 0.6
"""Controls of the toes in level flight."""

LEVEL, DESCENT, BEYOND = 2.0, 3.0, 1.0
"""Lengths of the level flight, of the way down to the target and of the way on where
nothing is met, over the foot's size."""


def attack_flight(
    foot: Foot,
    target: ArrayLike = (0.0, 0.0, 0.0),
    *,
    speed: float = SPEED,
    slope: float = SLOPE,
    opened: float = OPEN,
    reversal: float = 1.0,
) -> Flight:
    """A flight on which the base comes straight down on a point.

    Toes open, and reversible ones turn, while the foot still flies level.

    Args:
        foot: The foot.
        target: The point, in the world's frame [m], shape (3,).
        speed: Speed along the way > 0 [m/s].
        slope: Slope of the way down, from above 0 to a right angle [rad].
        opened: Controls of the opened toes, in [0, 1].
        reversal: Turn of the reversible toes when they have opened: 0 leaves them in
            the zygodactyl pose, 1 takes them to the spread one.

    Returns:
        The flight, from time 0.

    Raises:
        ParameterError: A value is out of range.
    """
    place = checks.array("target", target)
    checks.shaped("target", place, (3,))
    speed = checks.number(
        "speed",
        speed,
        allowed="a speed > 0",
        where=lambda x: x > 0,
        remedy="give m/s, such as 3",
    )
    slope = checks.number(
        "slope",
        slope,
        allowed="above 0, up to π/2",
        where=lambda x: 0 < x <= math.pi / 2 + 1e-12,
        remedy="give radians, such as 1.05",
    )
    down = np.array([math.cos(slope), 0.0, -math.sin(slope)])
    ways = np.array([LEVEL, DESCENT, BEYOND]) * foot.size
    turn = place - ways[1] * down
    places = [turn - (ways[0], 0.0, 0.0), turn, place + ways[2] * down]
    times = np.array([0.0, ways[0], ways.sum()]) / speed
    count = foot.phalanx_count
    bent = np.outer([CLENCHED, opened, opened], np.ones(count))
    return Flight(
        Motion.through(times, places),
        Law.through(times, bent),
        Law.through(times, [0.0, reversal, reversal]),
    )
