"""One finger: how many phalanges it has, and where it points."""

from __future__ import annotations

import math
from dataclasses import dataclass

from zygopin import checks, kinds

MAX_PHALANGES = 12
"""Phalanges a finger may have: more than twice what any bird has."""


@dataclass(frozen=True)
class Finger:
    """One finger: a chain of phalanges in a vertical plane (MODEL.md, section 1).

    Attributes:
        name: Lower-case identifier; links and joints are named after it.
        phalanges: Number of phalanges K.
        azimuth: Direction of the straight finger in the xy-plane, from +x [rad].
        orientation: Fixed initial orientation v₀, downward from horizontal [rad].
        splay_gain: What the azimuth gains per unit of splay: -1, 0 or 1.
        reversed_azimuth: Azimuth with the toe reversed [rad]; None: no reversal.
    """

    name: str
    phalanges: int
    azimuth: float
    orientation: float = 0.0
    splay_gain: int = 0
    reversed_azimuth: float | None = None

    def __post_init__(self) -> None:
        name = kinds.identifier("finger.name", self.name)
        set_field = object.__setattr__
        count = checks.integer(f"{name}.phalanges", self.phalanges, 1, MAX_PHALANGES)
        set_field(self, "phalanges", count)
        for field in ("azimuth", "orientation"):
            set_field(self, field, _angle(f"{name}.{field}", getattr(self, field)))
        gain = checks.integer(f"{name}.splay_gain", self.splay_gain, -1, 1)
        set_field(self, "splay_gain", gain)
        if self.reversed_azimuth is not None:
            turned = _angle(f"{name}.reversed_azimuth", self.reversed_azimuth)
            set_field(self, "reversed_azimuth", turned)

    @property
    def reversal(self) -> float:
        """Turn about z from the azimuth to the reversed one [rad]; 0 without."""
        if self.reversed_azimuth is None:
            return 0.0
        return self.reversed_azimuth - self.azimuth


def zygodactyl_fingers(splay: float) -> tuple[Finger, ...]:
    """The four fingers of the zygodactyl foot (MODEL.md, section 1).

    Args:
        splay: The angle Ω between each finger's plane and the xz-plane [rad].

    Returns:
        Fingers 1 to 4 with 2, 3, 4 and 5 phalanges; 2 and 3 point forward.

    Raises:
        ParameterError: The angle is none, or makes none that a finger may have.
    """
    splay = checks.angle("splay", splay)
    return (
        Finger("finger1", 2, math.pi - splay, splay_gain=-1),
        Finger("finger2", 3, splay, splay_gain=1),
        Finger("finger3", 4, -splay, splay_gain=-1),
        Finger("finger4", 5, math.pi + splay, splay_gain=1),
    )


def _angle(name: str, value: object) -> float:
    """An angle within a full turn either way."""
    return checks.number(
        name,
        value,
        allowed="in [-2π, 2π]",
        where=lambda x: abs(x) <= 2 * math.pi,
        remedy="give radians",
    )
