"""The tendon's map v: how far toes are closed at a time after it engaged.

MODEL.md, section 6: continuous, non-decreasing, from [0, T] to [0, 1].
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.errors import ParameterError

Reading = Literal["paper", "contact"]
"""`paper`: all controls equal v, through the obstacle. `contact`: controls start from
where they are, never open, and joints stop as their toes meet something. A control u
becomes u + (1 − u)·(v − v(0))/(1 − v(0)), so that it does not jump; v(0) = 1 closes
nothing."""

READINGS: tuple[Reading, ...] = ("paper", "contact")

DURATION = 0.04
"""Closing time T, unless said otherwise [s]: illustrative."""

SAMPLES = 1025
"""Instants at which a caller's map is looked at."""

HALVINGS = 60
"""Halvings that bring a time below the spacing of doubles."""

JUMP = 1e-6
"""Largest step of a continuous map between two neighbouring doubles."""

Floats = NDArray[np.float64]
Shape = Literal["linear", "smooth"] | Callable[[float], float] | ArrayLike
"""A map: `linear`; `smooth`, 3x² − 2x³; a function of the time in [0, T]; or samples
at equal steps from 0 to T, joined by straight lines."""


@dataclass(frozen=True, eq=False)
class Closing:
    """How toes close once the tendon engages.

    Attributes:
        reading: `paper` or `contact`.
        duration: Closing time T > 0 [s].
        shape: The map v.
    """

    reading: Reading = "contact"
    duration: float = DURATION
    shape: Shape = "smooth"
    _map: Callable[[Floats], Floats] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        kinds.one_of("reading", self.reading, READINGS)
        duration = checks.number(
            "closing.duration",
            self.duration,
            allowed=f"a time > 0, up to {checks.LARGEST:g}",
            where=lambda x: 0 < x <= checks.LARGEST,
            remedy="give seconds, such as 0.04",
        )
        object.__setattr__(self, "duration", duration)
        object.__setattr__(self, "_map", _map(self.shape, duration))
        _check(self.at, np.linspace(0, duration, _looks(self.shape)))

    def at(self, times: ArrayLike) -> Floats:
        """The map at times after the tendon engaged.

        Args:
            times: Times [s], shape (n,); before 0 and after T it stays what it is.

        Returns:
            Values v in [0, 1], shape (n,).
        """
        inside = np.clip(checks.array("times", times), 0, self.duration)
        return self._map(inside)

    def when(self, value: float) -> float:
        """The first time at which the map has reached a value.

        Args:
            value: A value up to v(T).

        Returns:
            The time [s].
        """
        value = checks.number("value", value)
        low, high = 0.0, self.duration
        if self.at([low])[0] >= value:
            return low
        for _ in range(HALVINGS):
            middle = (low + high) / 2
            reached = self.at([middle])[0] >= value
            low, high = (low, middle) if reached else (middle, high)
        return high


def _looks(shape: Shape) -> int:
    """At how many instants a map is looked at: at each of its samples."""
    if isinstance(shape, str) or callable(shape):
        return SAMPLES
    steps = len(np.asarray(shape)) - 1
    return steps * max(1, (SAMPLES - 1) // steps) + 1


def _map(shape: Shape, duration: float) -> Callable[[Floats], Floats]:
    """The map as a function of times in [0, T]."""
    if isinstance(shape, str):
        kinds.one_of("closing.shape", shape, ("linear", "smooth"))
        if shape == "linear":
            return lambda times: times / duration
        return lambda times: (times / duration) ** 2 * (3 - 2 * times / duration)
    if callable(shape):
        function = shape
        return lambda times: np.array([_called(function, time) for time in times])
    samples = checks.array("closing.shape", shape)
    if samples.ndim != 1 or len(samples) < 2:
        remedy = "give at least two samples, or a function"
        raise ParameterError("closing.shape.shape", samples.shape, "(n,)", remedy)
    instants = np.linspace(0, duration, len(samples))
    return lambda times: np.interp(times, instants, samples)


def _called(function: Callable[[float], float], time: float) -> float:
    """A caller's map at one time, its failures named."""
    name = f"v({time:g})"
    try:
        return checks.number(name, function(float(time)))
    except ParameterError:
        raise
    except Exception as error:
        problem = f"{type(error).__name__}: {error}"
        remedy = "define v from 0 to T"
        raise ParameterError(name, problem, "defined", remedy) from error


def _check(at: Callable[[ArrayLike], Floats], times: Floats) -> None:
    """The map is in [0, 1], does not fall, and has no step."""
    values = at(times)
    remedy = "0 is the straight joint, 1 the fully closed one"
    good = (values >= 0) & (values <= 1)
    checks.require("v", values, good, "in [0, 1]", remedy)
    rises = np.append(True, np.diff(values) >= 0)
    name, remedy = "v at equal steps", "a tendon only closes: let v never fall"
    checks.require(name, values, rises, "non-decreasing", remedy)
    steepest = int(np.argmax(np.diff(values)))
    low, high = times[steepest], times[steepest + 1]
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        below, between, above = at([low, middle, high])
        first = between - below > above - between
        low, high = (low, middle) if first else (middle, high)
    below, above = at([low, high])
    if above - below > JUMP:
        allowed = "continuous"
        remedy = f"it steps by {above - below:.3g}: let v rise without a step"
        raise ParameterError(f"v at {high:g} s", above, allowed, remedy)
