"""The record of a strike: every mode, pose and event over time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.closing import Reading
from zygopin.foot import Foot
from zygopin.grip import Grip
from zygopin.obstacle import Obstacle

Mode = Literal["free", "closing", "locked"]
"""A mode of the hybrid automaton (MODEL.md, section 6)."""

EventKind = Literal["engaged", "stopped", "crossed", "locked", "released"]
"""The guard was met; a phalanx met the obstacle, or another toe, while closing; the
tendon locked; it was released."""


@dataclass(frozen=True, eq=False)
class StrikeEvent:
    """Something that happened at an instant.

    Attributes:
        kind: What happened.
        time: When [s].
        finger: The finger's name; None where it is of no one finger.
        phalanx: The phalanx's number in its finger, from 1; None likewise.
        point: The obstacle's point that was met [m], shape (3,); None where nothing
            or another toe was.
        clearance: What was left to what was met [m]; None where nothing was.
    """

    kind: EventKind
    time: float
    finger: str | None = None
    phalanx: int | None = None
    point: NDArray[np.float64] | None = None
    clearance: float | None = None

    def __post_init__(self) -> None:
        checks.freeze(self)


@dataclass(frozen=True, eq=False)
class StrikeTrajectory:
    """A strike over time, at n instants; P phalanges, F fingers.

    Attributes:
        foot: The foot.
        obstacle: What it struck at, in the world's frame.
        reading: How it closed: `paper` or `contact` (MODEL.md, section 6).
        tolerance: Clearance that counts as contact [m].
        times: Instants [s], shape (n,), ascending within each mode; an instant at
            which one mode ends and another begins is there for both of them. Events
            have theirs among them.
        modes: The mode at each, shape (n,).
        controls: Controls in [0, 1], shape (n, P).
        azimuths: Azimuth of each finger [rad], shape (n, F).
        base: T_world_base, shape (n, 4, 4).
        bones: Bones in the world's frame [m], shape (n, P, 2, 3).
        clearance: Signed clearance of each phalanx [m], shape (n, P).
        events: What happened, in order.
        grip: The contacts at the end.
    """

    foot: Foot
    obstacle: Obstacle
    reading: Reading
    tolerance: float
    times: NDArray[np.float64]
    modes: NDArray[np.str_]
    controls: NDArray[np.float64]
    azimuths: NDArray[np.float64]
    base: NDArray[np.float64]
    bones: NDArray[np.float64]
    clearance: NDArray[np.float64]
    events: tuple[StrikeEvent, ...]
    grip: Grip

    def __post_init__(self) -> None:
        checks.freeze(self)

    @property
    def mode_starts(self) -> NDArray[np.intp]:
        """Indices of the instants at which a mode begins, ascending from 0."""
        changes = np.flatnonzero(self.modes[1:] != self.modes[:-1]) + 1
        return np.append(0, changes)
