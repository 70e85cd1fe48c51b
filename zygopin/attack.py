"""An owl's attack as a flight: clenched and level, opening, then down on the target."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from zygopin import checks, kinds
from zygopin.flight import Flight
from zygopin.foot import Foot
from zygopin.motion import Law, Motion

SPEED = 3.0
"""Speed of the foot, unless said otherwise [m/s]: illustrative."""

SLOPE = math.radians(60)
"""Angle of its way down below the horizontal, unless said otherwise [rad]:
illustrative."""

OPEN = 0.1
"""Controls of the opened toes, unless said otherwise: a little bent."""

CLENCHED = 0.6
"""Controls of the toes in level flight."""

LEVEL, DESCENT, BEYOND = 2.0, 3.0, 1.0
"""Lengths of the level flight, of the way down to the target and of the way on where
nothing is met, over the foot's size."""


@dataclass(frozen=True)
class Attack:
    """How a foot comes down on a target.

    Toes open, and reversible ones turn, while the foot still flies level.

    Attributes:
        speed: Speed along the way > 0 [m/s].
        slope: Angle of the way down below the horizontal, in (0, π/2] [rad].
        opened: Controls of the opened toes, in [0, 1].
        reversal: Turn of the reversible toes when they have opened: 0 leaves them in
            the zygodactyl pose, 1 takes them to the spread one.
    """

    speed: float = SPEED
    slope: float = SLOPE
    opened: float = OPEN
    reversal: float = 1.0

    def __post_init__(self) -> None:
        for name, (allowed, where, remedy) in _RANGES.items():
            value = checks.number(
                name, getattr(self, name), allowed=allowed, where=where, remedy=remedy
            )
            object.__setattr__(self, name, value)

    def flight(
        self, foot: Foot, target: ArrayLike = (0.0, 0.0, 0.0), *, radius: float = 0.0
    ) -> Flight:
        """The flight on which the base of a foot comes straight down on a point.

        Args:
            foot: The foot.
            target: The point, in the world's frame [m], shape (3,).
            radius: Radius ≥ 0 of a ball around it that holds the target [m]: the way
                is longer by that before and behind.

        Returns:
            The flight, from time 0.

        Raises:
            ParameterError: A value is out of range.
        """
        kinds.instance("foot", foot, Foot)
        place = checks.places("target", target)
        checks.shaped("target", place, (3,))
        radius = checks.number(
            "radius",
            radius,
            allowed=f"a length from 0 to {checks.LARGEST:g}",
            where=lambda x: 0 <= x <= checks.LARGEST,
            remedy="give metres, such as 0.015",
        )
        down = np.array([math.cos(self.slope), 0.0, -math.sin(self.slope)])
        ways = np.array([LEVEL, DESCENT, BEYOND]) * foot.size + (0, radius, radius)
        turn = place - ways[1] * down
        places = [turn - (ways[0], 0.0, 0.0), turn, place + ways[2] * down]
        times = np.array([0.0, ways[0], ways.sum()]) / self.speed
        bent = np.array([CLENCHED, self.opened, self.opened])
        return Flight(
            Motion.through(times, places),
            Law.through(times, np.repeat(bent[:, None], foot.phalanx_count, axis=1)),
            Law.through(times, [0.0, self.reversal, self.reversal]),
        )


_UNIT = ("in [0, 1]", lambda x: 0 <= x <= 1, "give a share, such as 0.1")
_RANGES: dict[str, Any] = {
    "speed": (
        "a speed from 1e-12 to 1e12",
        lambda x: 1e-12 <= x <= 1e12,
        "give m/s, such as 3",
    ),
    "slope": (
        "above 0, up to π/2",
        lambda x: 0 < x <= math.pi / 2 + 1e-12,
        "give radians, such as 1.05",
    ),
    "opened": _UNIT,
    "reversal": _UNIT,
}
