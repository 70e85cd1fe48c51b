"""The free foot: its base, its toes' turn and its controls as given in time."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.kinematics import Controls, as_controls
from zygopin.motion import PROBES, Law, Motion
from zygopin.stance import Stance, azimuths_at, levers

STRAIGHT = "0 is the straight joint, 1 the closed one"
"""What a control says, for messages."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Flight:
    """What a foot does while it is free.

    Attributes:
        motion: The base's motion; the flight starts and ends with it.
        controls: Controls over time, of shape (P,); or controls that do not change,
            one number for all of them.
        reversal: Turn of the reversible toes over time, 0 for their azimuths, 1 for
            the reversed ones; or a number.
    """

    motion: Motion
    controls: Law | Controls = 0.0
    reversal: Law | float = 0.0

    def __post_init__(self) -> None:
        kinds.instance("motion", self.motion, Motion)
        if not isinstance(self.reversal, Law):
            checks.unit("reversal", self.reversal)
        if not isinstance(self.controls, (Law, Mapping)):
            given = checks.array("controls", self.controls)
            inside = (given >= 0) & (given <= 1)
            checks.require("controls", given, inside, "in [0, 1]", STRAIGHT)


class FreeFlow:
    """The flow of a free foot.

    Attributes:
        foot: The foot.
        motion: The base's motion.
        controls: Controls over time, of shape (P,).
        reversal: Turn of the reversible toes over time, of shape ().
        start: When the flight starts [s].
        end: When it ends [s]; infinite for what never changes.
    """

    def __init__(self, foot: Foot, flight: Flight) -> None:
        """The flow of a foot in a flight.

        Args:
            foot: The foot.
            flight: The flight.

        Raises:
            ParameterError: A law's values are of a wrong shape or outside [0, 1].
        """
        kinds.instance("flight", flight, Flight)
        self.foot, self.motion = foot, flight.motion
        self.controls = _controls_law(foot, flight.controls)
        self.reversal = _reversal_law(flight.reversal)
        first = float(flight.motion.times[0])
        self.start = first if np.isfinite(first) else 0.0
        self.end = float(flight.motion.times[-1])
        self._parts = (self.motion.times, self.controls.times, self.reversal.times)
        self._breaks = np.unique(np.concatenate(self._parts))
        self._levers = levers(foot)
        self._reach = np.max(self._levers, axis=1)
        turns = np.array([abs(finger.reversal) for finger in foot.fingers])
        self._turns = turns[foot.finger_of_phalanx]

    def stances(self, times: Floats) -> Stance:
        """Stances at instants of shape (n,)."""
        azimuths = azimuths_at(self.foot, self.reversal.at(times))
        controls = self.controls.at(times)
        return Stance(self.foot, self.motion.at(times), azimuths, controls)

    def speeds(self, start: float, end: float) -> Floats:
        """Bounds on the speed of any point of each bone between two instants.

        The base's own speed, the turning rates of base and toe times the bone's reach,
        and each joint's rate times its distance along the toe to the bone's far end. A
        clearance changes no faster: the skin's radius is constant.

        Args:
            start: The earlier instant [s].
            end: The later one [s].

        Returns:
            Speeds [m/s], shape (P,).
        """
        speed, turn_rate = self.motion.bounds(start, end)
        turning = turn_rate + self._turns * float(self.reversal.rate(start, end))
        joints = self.foot.omega * self.controls.rate(start, end)
        return np.asarray(speed + turning * self._reach + self._levers @ joints)

    def next_break(self, time: float, until: float) -> float:
        """The next instant after a time at which a bound changes, or the end.

        Args:
            time: The time [s].
            until: The end [s].

        Returns:
            The instant [s].
        """
        later = self._breaks[np.searchsorted(self._breaks, time, "right") :]
        return float(min(until, later[0])) if len(later) else until

    def check_defined(self, time: float, until: float) -> None:
        """Base, turn and controls are all defined between two instants.

        Args:
            time: The earlier one [s].
            until: The later one [s].

        Raises:
            ParameterError: One of them is not.
        """
        names = ("motion", "controls", "reversal")
        for name, times in zip(names, self._parts, strict=True):
            first, last = float(times[0]), float(times[-1])
            if not first <= time <= until <= last:
                allowed = f"one that holds {time:g} to {until:g} s"
                remedy = "give it for the whole flight, or ask for less time"
                raise ParameterError(f"span of {name}", (first, last), allowed, remedy)


def _controls_law(foot: Foot, controls: Law | Controls) -> Law:
    """Checked controls over time, of shape (P,)."""
    count = foot.phalanx_count
    if not isinstance(controls, Law):
        if not isinstance(controls, Mapping) and not np.ndim(controls):
            controls = np.full(count, checks.number("controls", controls))
        controls = Law.constant(as_controls(foot, controls))
    shape = controls.rates.shape[1:]
    if shape != (count,):
        remedy = "give one control for each phalanx"
        raise ParameterError("controls.shape", shape, f"({count},)", remedy)
    _check_unit("controls", controls, STRAIGHT)
    return controls


def _reversal_law(reversal: Law | float) -> Law:
    """A checked turn over time, of shape ()."""
    if not isinstance(reversal, Law):
        reversal = Law.constant(checks.number("reversal", reversal))
    shape = reversal.rates.shape[1:]
    if shape != ():
        remedy = "give one number for all reversible toes"
        raise ParameterError("reversal.shape", shape, "()", remedy)
    _check_unit("reversal", reversal, "0 leaves a toe as it is, 1 reverses it")
    return reversal


def _check_unit(name: str, law: Law, remedy: str) -> None:
    """A law's values are in [0, 1], at its samples or at evenly spaced instants."""
    first, last = law.times[[0, -1]]
    times = np.zeros(1)
    if np.isfinite(first):
        times = np.unique([*law.times, *np.linspace(first, last, PROBES)])
    values = law.at(times)
    good = (values >= 0) & (values <= 1)
    checks.require(f"{name} over time", values, good, "in [0, 1]", remedy)
