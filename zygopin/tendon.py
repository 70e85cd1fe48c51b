"""The owl's tendon locking mechanism as a hybrid automaton: MODEL.md, section 6.

           engaged               locked
    FREE ──────────▶ CLOSING ──────────▶ LOCKED
      ▲                                     │
      └────────────── released ─────────────┘

FREE: base, toe reversal and controls are given in time. A sensing phalanx that meets
the obstacle engages the tendon: the base and the toe's turn stay as they are. CLOSING:
the controls follow the tendon's map, whatever they are told. After its time T, LOCKED:
nothing moves. Only `release` leads out of it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.advancement import Look, first_reached, steps_by_speed
from zygopin.clearance import Clearance
from zygopin.closing import Closing
from zygopin.engine import ENGINES, EngineName
from zygopin.errors import ParameterError
from zygopin.flight import Flight, FreeFlow
from zygopin.foot import Foot
from zygopin.grasp import Criteria
from zygopin.obstacle import Obstacle, as_obstacle
from zygopin.solid_clearance import obstacle_clearance
from zygopin.stance import Stance
from zygopin.toe_stops import Stop, ToeStops
from zygopin.trajectory import EventKind, Mode, StrikeEvent

TRANSITIONS: dict[tuple[Mode, EventKind], Mode] = {
    ("free", "engaged"): "closing",
    ("closing", "locked"): "locked",
    ("locked", "released"): "free",
}
"""The edges of the automaton: the mode and the event that lead to a mode."""

TINY = 1e-300
"""Keeps the share of a map that starts at 1 finite."""

POINT = 1e-9
"""Length over the foot's size of the bone that stands for the base's point."""

CLEAR = 0.01
"""Clearance over the foot's size with which a phalanx that touched at a release has
come clear of the obstacle; no excursion to twice that is overlooked."""

Floats = NDArray[np.float64]
Sensing = Literal["first", "any"]
"""Which phalanges engage the tendon: the `first` ones, at the foot's base, as in the
source; or `any`."""

SENSING: tuple[Sensing, ...] = ("first", "any")


@dataclass(frozen=True)
class Contact:
    """What counts as contact.

    Attributes:
        sensing: Which phalanges engage the tendon; None: `first` in the reading
            `paper`, `any` in `contact`, where no toe passes through the obstacle.
        tolerance: Clearance that is contact [m]; None: 1e-6 of the foot's size.
        engine: `exact` or `fcl`; None: `exact`.
    """

    sensing: Sensing | None = None
    tolerance: float | None = None
    engine: EngineName | None = None

    def __post_init__(self) -> None:
        if self.sensing is not None:
            kinds.one_of("sensing", self.sensing, SENSING)
        if self.engine is not None:
            kinds.one_of("engine", self.engine, ENGINES)
        Criteria(tolerance=self.tolerance)


@dataclass(frozen=True, eq=False)
class Phase:
    """A stretch of time in one mode.

    Attributes:
        mode: The mode.
        start: When it began [s].
        end: When it ended [s].
        stances: The foot's stances at instants of shape (n,).
    """

    mode: Mode
    start: float
    end: float
    stances: Callable[[Floats], Stance]


class TendonFoot:
    """A foot with tendon locking, near an obstacle.

    Attributes:
        foot: The foot.
        obstacle: What it may meet.
        closing: How its toes close.
        contact: What counts as contact.
        flow: Its motion while it is free.
        tolerance: Clearance that is contact [m].
        clear: Clearance with which a phalanx has come clear after a release [m].
        senses: Which phalanges engage the tendon, shape (P,).
        armed: Which of them have come clear since the last release, shape (P,).
        mode: The mode that it is in.
        time: The time it has come to [s].
        phases: What it went through.
        events: What happened to it.
    """

    def __init__(
        self,
        foot: Foot,
        obstacle: Obstacle,
        flight: Flight,
        *,
        closing: Closing | None = None,
        contact: Contact | None = None,
    ) -> None:
        """A free foot at the start of its flight.

        Args:
            foot: The foot.
            obstacle: What it may meet, in the world's frame [m].
            flight: What it does while it is free.
            closing: How its toes close; None: smoothly, in the reading `contact`.
            contact: What counts as contact; None: the defaults.

        Raises:
            ParameterError: A value is out of range, or the obstacle already holds
                the base.
        """
        kinds.instance("foot", foot, Foot)
        self.foot, self.obstacle = foot, as_obstacle(obstacle)
        self.closing = kinds.optional("closing", closing, Closing)
        self.contact = kinds.optional("contact", contact, Contact)
        self.flow = FreeFlow(foot, flight)
        self.tolerance = Criteria(tolerance=self.contact.tolerance).metres(foot)
        self.clear = max(CLEAR * foot.size, 2 * self.tolerance)
        self.senses = _senses(foot, self.closing, self.contact)
        self.armed = np.ones(foot.phalanx_count, bool)
        self.mode: Mode = "free"
        self.time = self.flow.start
        self.phases: list[Phase] = []
        self.events: list[StrikeEvent] = []
        self._check_base()

    def run(self, until: float) -> None:
        """Go on through the modes; a closing that has begun is finished.

        Args:
            until: The time to come to [s].

        Raises:
            ParameterError: The flight is not defined until then.
        """
        until = checks.number("until", until)
        flows = {"free": self._fly, "closing": self._close, "locked": self._hold}
        while self.time < until or self.mode == "closing":
            flows[self.mode](until)

    def release(self) -> None:
        """Let go: the only way out of LOCKED.

        Base, turn and controls are again what the flight says for that instant.
        Phalanges that touch the obstacle then engage the tendon only after they have
        come clear of it, by 1 % of the foot's size.

        Raises:
            ParameterError: The tendon is not locked.
        """
        if self.mode != "locked":
            remedy = "release a locked foot only"
            raise ParameterError("mode", self.mode, "locked", remedy)
        self.flow.check_defined(self.time, self.time)
        self.armed = self._distances(self.time) > self.tolerance
        self._enter(StrikeEvent("released", self.time))

    def near(self, bones: Floats, radii: Floats | None = None) -> Clearance:
        """Clearance of bones to the obstacle.

        Args:
            bones: Bones in the world's frame [m], shape (…, M, 2, 3).
            radii: Their skins' radii [m], shape (M,); None: the foot's.

        Returns:
            The record of all of them.
        """
        skins, engine = self.foot.radii if radii is None else radii, self.contact.engine
        return obstacle_clearance(bones, skins, self.obstacle, engine=engine)

    def _fly(self, until: float) -> None:
        """FREE, until a sensing phalanx meets the obstacle."""
        start, met = self.time, np.zeros(self.foot.phalanx_count, bool)
        self.flow.check_defined(start, until)
        while self.time < until and not met.any():
            span = self.time, self._stop(until)
            levels = np.where(self.senses & self.armed, self.tolerance, -np.inf)
            look = self._look(np.minimum(levels, 0.0), self.flow.speeds(*span))
            self.time, distances = first_reached(look, span, levels)
            met = distances <= levels
            self.armed |= distances > self.clear
        self._end_phase(start, self.flow.stances)
        if met.any():
            self._enter(
                self._engagement(int(np.argmin(np.where(met, distances, np.inf))))
            )

    def _close(self, _: float) -> None:
        """CLOSING, for the time T; a closing that has begun is finished."""
        start, closing = self.time, self.closing
        stance = _single(self.phases[-1].stances(np.array([start])))
        toes = ToeStops(stance, self.near, self.tolerance)
        first, last = closing.at([0.0, closing.duration])
        rest = max(1 - first, TINY)
        if closing.reading == "contact":
            toes.close((last - first) / rest)
        for stop in toes.stops:
            time = start + closing.when(first + stop.progress * rest)
            self.events.append(_stopped(self.foot, stop, time))

        def stances(times: Floats) -> Stance:
            values = closing.at(times - start)
            controls = toes.controls((values - first) / rest)
            if closing.reading == "paper":
                controls = np.repeat(values[:, None], self.foot.phalanx_count, axis=1)
            return _held(stance, controls)

        self.time = start + closing.duration
        self._end_phase(start, stances)
        self._enter(StrikeEvent("locked", self.time))

    def _hold(self, until: float) -> None:
        """LOCKED, whatever the controls say."""
        start = self.time
        stance = _single(self.phases[-1].stances(np.array([start])))
        self.time = until
        self._end_phase(
            start,
            lambda times: _held(stance, np.tile(stance.controls, (len(times), 1))),
        )

    def _enter(self, event: StrikeEvent) -> None:
        """Follow the edge of an event."""
        self.events.append(event)
        self.mode = TRANSITIONS[self.mode, event.kind]

    def _end_phase(self, start: float, stances: Callable[[Floats], Stance]) -> None:
        """Note the stretch of time that ends now, as one with the same mode's."""
        if self.phases and self.phases[-1].mode == self.mode:
            start = self.phases.pop().start
        self.phases.append(Phase(self.mode, start, self.time, stances))

    def _distances(self, time: float) -> Floats:
        """Clearances of the free foot at an instant [m], shape (P,)."""
        return self.near(self.flow.stances(np.array([time])).bones[0]).distance

    def _look(self, floors: Floats, speeds: Floats) -> Look:
        """Clearances of the free foot, and a step in which none falls to its floor."""

        def look(time: float) -> tuple[Floats, float]:
            distances = self._distances(time)
            steps = steps_by_speed(distances - floors, speeds)
            return distances, float(steps.min())

        return look

    def _stop(self, until: float) -> float:
        """Where a step of the flight ends at the latest [s].

        Before phalanges that touched at a release can have come to twice the clearance
        at which they count as clear.
        """
        stop = self.flow.next_break(self.time, until)
        waiting = self.senses & ~self.armed
        if not waiting.any():
            return stop
        distances = self._distances(self.time)[waiting]
        speeds = self.flow.speeds(self.time, stop)[waiting]
        step = float(steps_by_speed(2 * self.clear - distances, speeds).min())
        return min(stop, max(self.time + step, math.nextafter(self.time, math.inf)))

    def _engagement(self, phalanx: int) -> StrikeEvent:
        """The event of a phalanx that has just met the obstacle."""
        near = self.near(self.flow.stances(np.array([self.time])).bones[0])
        place = near.point[phalanx], float(near.distance[phalanx])
        return StrikeEvent("engaged", self.time, *_named(self.foot, phalanx), *place)

    def _check_base(self) -> None:
        """The obstacle does not hold the base where the flight starts."""
        self.flow.check_defined(self.time, self.time)
        base = self.flow.stances(np.array([self.time])).base[0]
        # Long enough to have two ends where the base is far from the origin.
        length = POINT * self.foot.size + 8 * np.spacing(np.abs(base[:3, 3]).max())
        step = length * base[:3, 0]
        bone = np.stack([base[:3, 3], base[:3, 3] + step])[None]
        near = obstacle_clearance(bone, np.zeros(1), self.obstacle)
        if near.distance[0] < -self.tolerance:
            depth = float(-near.distance[0])
            allowed = "at most 0 m: the obstacle already holds the base"
            remedy = "start the flight outside of it"
            raise ParameterError("depth of the base", depth, allowed, remedy)


def _senses(foot: Foot, closing: Closing, contact: Contact) -> NDArray[np.bool_]:
    """Which phalanges engage the tendon, shape (P,)."""
    default = "first" if closing.reading == "paper" else "any"
    if (contact.sensing or default) == "first":
        return np.asarray(foot.rank_of_phalanx == 1)
    return np.ones(foot.phalanx_count, bool)


def _stopped(foot: Foot, stop: Stop, time: float) -> StrikeEvent:
    """The event of a phalanx that met something while closing."""
    name, number = _named(foot, stop.phalanx)
    kind: EventKind = "stopped" if stop.point is not None else "crossed"
    return StrikeEvent(kind, time, name, number, stop.point, stop.clearance)


def _named(foot: Foot, phalanx: int) -> tuple[str, int]:
    """A phalanx's finger and its number there, from its index among all."""
    finger = foot.fingers[foot.finger_of_phalanx[phalanx]]
    return finger.name, int(foot.rank_of_phalanx[phalanx])


def _single(stances: Stance) -> Stance:
    """The first of some stances."""
    first = stances.base[0], stances.azimuths[0], stances.controls[0]
    return Stance(stances.foot, *first)


def _held(stance: Stance, controls: Floats) -> Stance:
    """A stance that keeps its base and turn, with controls of shape (n, P)."""
    count = len(controls)
    base = np.broadcast_to(stance.base, (count, 4, 4))
    azimuths = np.broadcast_to(stance.azimuths, (count, *stance.azimuths.shape))
    return Stance(stance.foot, base, azimuths, controls)
