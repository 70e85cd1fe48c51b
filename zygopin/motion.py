"""Functions of time that bound how fast they change: control laws and base motions.

With such a bound, steps over time can be chosen so that nothing is missed between
them. Waypoints imply their own. A callable is unknown between two calls, so its bound
is given with it, and checked at `PROBES` instants.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.errors import ParameterError
from zygopin.rotations import ORTHONORMAL, angles_between, as_rotations, turns_between

PROBES = 513
"""Instants at which a callable's values and rates are looked at."""

RATE_SLACK = 1e-6
"""Relative excess over its bound that a callable's rate may have: rounding."""

RATE_ROUNDING = 1e-12, 1e-9
"""Excess over its bound that rounding may give to what hardly changes: absolute [1/s],
and relative to the largest bound of the values that are given with it."""

ALWAYS = np.array([-np.inf, np.inf])
"""The span of what never changes [s]."""

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Law:
    """Values over time, made by `constant`, `through` or `of`.

    Attributes:
        at: Values at instants of shape (n,), shape (n, …).
        times: Ends of the m stretches that have a rate each, ascending [s], shape
            (m + 1,): the law is defined from the first to the last.
        rates: Bounds on how fast each value changes [1/s], shape (m, …).
    """

    at: Callable[[Floats], Floats]
    times: Floats
    rates: Floats

    def __post_init__(self) -> None:
        checks.freeze(self)

    @classmethod
    def constant(cls, value: ArrayLike) -> Law:
        """What never changes.

        Args:
            value: The value, shape (…).

        Returns:
            The law.
        """
        values = checks.array("value", value)
        zero = np.zeros((1, *values.shape))
        return cls(lambda times: _repeated(values, len(times)), ALWAYS, zero)

    @classmethod
    def through(cls, times: ArrayLike, values: ArrayLike) -> Law:
        """Straight lines through samples.

        Args:
            times: Instants, ascending [s], shape (n,), n ≥ 2.
            values: Values at them, shape (n, …).

        Returns:
            The law.

        Raises:
            ParameterError: The times do not ascend, or the shapes do not fit.
        """
        instants = _as_times(times)
        samples = _as_samples("values", values, instants)
        steps = _per_step(np.diff(samples, axis=0), instants)
        return cls(_lines(instants, samples), instants, np.abs(steps))

    @classmethod
    def of(
        cls, function: Callable[[float], ArrayLike], *, end: float, rate: ArrayLike
    ) -> Law:
        """A function of time, from 0 to an end.

        Args:
            function: The value at an instant [s], shape (…).
            end: Last instant, > 0 [s].
            rate: Bound on how fast each value changes [1/s], scalar or shape (…).

        Returns:
            The law.

        Raises:
            ParameterError: The function fails within its span, its values have
                different shapes or are not finite, or it breaks its bound.
        """
        instants = _probes(end)
        at = _called("law", function)
        samples = at(instants)
        bound = _as_bound("rate", rate, samples.shape[1:])
        measured = _per_step(np.diff(samples, axis=0), instants)
        _check_rates("rate", np.abs(measured), bound)
        return cls(at, instants[[0, -1]], bound[None] * (1 + RATE_SLACK))

    def rate(self, start: float, end: float) -> Floats:
        """Bound on how fast each value changes between two instants.

        Args:
            start: The earlier one [s].
            end: The later one [s].

        Returns:
            The bound [1/s], shape (…).
        """
        start, end = checks.number("start", start), checks.number("end", end)
        return _largest(self.times, self.rates, start, end)


@dataclass(frozen=True, eq=False)
class Motion:
    """Poses of the foot's base over time, made by `resting`, `through` or `of`.

    Attributes:
        at: T_world_base at instants of shape (n,), shape (n, 4, 4).
        times: Ends of the m stretches that have a bound each, ascending [s].
        speeds: Bounds on the base's speed [m/s], shape (m,).
        turn_rates: Bounds on its angular speed [rad/s], shape (m,).
    """

    at: Callable[[Floats], Floats]
    times: Floats
    speeds: Floats
    turn_rates: Floats

    def __post_init__(self) -> None:
        checks.freeze(self)

    @classmethod
    def through(
        cls,
        times: ArrayLike,
        positions: ArrayLike,
        rotations: ArrayLike | None = None,
    ) -> Motion:
        """Straight lines through positions, and turns of constant speed.

        Args:
            times: Instants, ascending [s], shape (n,), n ≥ 2.
            positions: Positions of the base [m], shape (n, 3).
            rotations: R_world_base, shape (n, 3, 3); None: the world's axes. Each
                turn goes the shorter way round.

        Returns:
            The motion.

        Raises:
            ParameterError: The times do not ascend, or the values do not fit.
        """
        instants = _as_times(times)
        places = _as_samples("positions", positions, instants, (3,))
        moves = np.linalg.norm(np.diff(places, axis=0), axis=1)
        line, angles = _lines(instants, places), np.zeros(len(moves))
        turn: Callable[[Floats], Floats] = _level
        if rotations is not None:
            frames = _as_samples("rotations", rotations, instants, (3, 3))
            frames = as_rotations("rotations", frames)
            turn, angles = turns_between(instants, frames), angles_between(frames)
        return cls(
            lambda moments: _poses(line(moments), turn(moments)),
            instants,
            _per_step(moves, instants),
            _per_step(angles, instants),
        )

    @classmethod
    def of(
        cls,
        function: Callable[[float], ArrayLike],
        *,
        end: float,
        speed: float,
        turn_rate: float = 0.0,
    ) -> Motion:
        """A function of time, from 0 to an end.

        Args:
            function: T_world_base at an instant [s], shape (4, 4).
            end: Last instant, > 0 [s].
            speed: Bound on the base's speed [m/s].
            turn_rate: Bound on its angular speed [rad/s].

        Returns:
            The motion.

        Raises:
            ParameterError: The function fails within its span, returns no pose, or
                moves faster than its bounds.
        """
        instants = _probes(end)
        at = _called("motion", function)
        poses = at(instants)
        _check_poses("motion", poses)
        bounds = [_as_bound("speed", speed, ()), _as_bound("turn_rate", turn_rate, ())]
        moves = np.linalg.norm(np.diff(poses[:, :3, 3], axis=0), axis=1)
        angles = angles_between(poses[:, :3, :3])
        for name, steps, bound in zip(
            ("speed", "turn_rate"), (moves, angles), bounds, strict=True
        ):
            _check_rates(name, _per_step(steps, instants), bound)
        allowed = np.array(bounds)[:, None] * (1 + RATE_SLACK)
        return cls(at, instants[[0, -1]], *allowed)

    @classmethod
    def resting(cls, pose: ArrayLike | None = None) -> Motion:
        """A base that never moves.

        Args:
            pose: T_world_base, shape (4, 4); None: the world's frame.

        Returns:
            The motion.

        Raises:
            ParameterError: It is no pose.
        """
        place = checks.array("pose", np.eye(4) if pose is None else pose)
        _check_poses("pose", place[None])
        zero = np.zeros(1)
        return cls(lambda times: _repeated(place, len(times)), ALWAYS, zero, zero)

    def bounds(self, start: float, end: float) -> tuple[float, float]:
        """Bounds on the base's speeds between two instants.

        Args:
            start: The earlier one [s].
            end: The later one [s].

        Returns:
            Speed [m/s] and angular speed [rad/s].
        """
        start, end = checks.number("start", start), checks.number("end", end)
        speed = _largest(self.times, self.speeds, start, end)
        turn = _largest(self.times, self.turn_rates, start, end)
        return float(speed), float(turn)


def _largest(times: Floats, rates: Floats, start: float, end: float) -> Floats:
    """The largest rate of the stretches that two instants lie in or between."""
    first = np.clip(np.searchsorted(times, start, "right") - 1, 0, len(rates) - 1)
    last = np.clip(np.searchsorted(times, end, "left"), first + 1, len(rates))
    return np.asarray(rates[first:last].max(axis=0))


def _lines(times: Floats, values: Floats) -> Callable[[Floats], Floats]:
    """Linear interpolation of samples, along their first axis."""

    def at(moments: Floats) -> Floats:
        step = np.clip(np.searchsorted(times, moments, "right") - 1, 0, len(times) - 2)
        share = (moments - times[step]) / (times[step + 1] - times[step])
        share = share.reshape(-1, *[1] * (values.ndim - 1))
        return np.asarray((1 - share) * values[step] + share * values[step + 1])

    return at


def _called(name: str, function: Callable[[float], ArrayLike]) -> Callable[..., Floats]:
    """A function of one instant as one of several, with its failures named."""
    kinds.callable_given(name, function)

    def value(time: float) -> Floats:
        try:
            return checks.array(f"{name}({time:g})", function(time))
        except ParameterError:
            raise
        except Exception as error:
            allowed, remedy = "defined", "define it over its whole span"
            problem = f"{type(error).__name__}: {error}"
            raise ParameterError(
                f"{name}({time:g})", problem, allowed, remedy
            ) from error

    shape = value(0.0).shape

    def at(times: Floats) -> Floats:
        values = [value(float(time)) for time in times]
        for time, each in zip(times, values, strict=True):
            if each.shape != shape:
                allowed, remedy = f"{shape} as at 0", "return the same shape always"
                raise ParameterError(
                    f"{name}({time:g}).shape", each.shape, allowed, remedy
                )
        return np.reshape(values, (len(times), *shape))

    return at


def _probes(end: float) -> Floats:
    """Instants at which a callable is looked at, from 0 to its end [s]."""
    last = checks.number(
        "end",
        end,
        allowed=f"a time > 0, up to {checks.LARGEST:g}",
        where=lambda x: 0 < x <= checks.LARGEST,
        remedy="give seconds",
    )
    return np.linspace(0, last, PROBES)


def _per_step(changes: Floats, times: Floats) -> Floats:
    """Changes between instants as rates."""
    steps = np.diff(times).reshape(-1, *[1] * (changes.ndim - 1))
    return np.asarray(changes / steps)


def _check_rates(name: str, measured: Floats, bound: Floats) -> None:
    """A callable keeps to its bound between neighbouring probes."""
    largest = measured.max(axis=0)
    absolute, relative = RATE_ROUNDING
    rounding = absolute + relative * np.abs(bound).max(initial=0.0)
    good = bound >= largest * (1 - RATE_SLACK) - rounding
    worst = f"at least the {largest.max():.4g} that the function has between two probes"
    remedy = "raise the bound, or smooth the function"
    checks.require(name, np.asarray(bound), good, worst, remedy)


def _as_bound(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """Checked bounds ≥ 0 on rates, of a shape; or one for all of them."""
    bound = checks.array(name, value)
    if bound.shape not in ((), shape):
        remedy = "give one bound, or one for each value"
        raise ParameterError(f"{name}.shape", bound.shape, f"{shape}", remedy)
    good = (bound >= 0) & (bound <= checks.LARGEST)
    allowed = f"at least 0 and at most {checks.LARGEST:g}"
    checks.require(name, bound, good, allowed, "give a bound per second")
    return np.broadcast_to(bound, shape)


def _as_times(times: ArrayLike) -> Floats:
    """Checked instants, ascending, shape (n,), n ≥ 2."""
    instants = checks.array("times", times)
    if instants.ndim != 1 or len(instants) < 2:
        remedy = "give at least two instants"
        raise ParameterError("times.shape", instants.shape, "(n,), n ≥ 2", remedy)
    rising = np.append(True, np.diff(instants) > 0)
    checks.require("times", instants, rising, "ascending", "sort them, each once")
    return instants


def _as_samples(
    name: str,
    values: ArrayLike | Sequence[Any],
    times: Floats,
    shape: tuple[int, ...] | None = None,
) -> Floats:
    """Checked values, one for each instant."""
    samples = checks.array(name, values)
    wanted = samples.shape[1:] if shape is None else shape
    if samples.shape != (len(times), *wanted):
        allowed = f"({', '.join(map(str, (len(times), *wanted)))})"
        remedy = "give one value for each instant"
        raise ParameterError(f"{name}.shape", samples.shape, allowed, remedy)
    return samples


def _check_poses(name: str, matrices: Floats) -> None:
    """Matrices are homogeneous transforms, shape (n, 4, 4)."""
    remedy = "give T_world_base: rotation, position at the right, last row 0, 0, 0, 1"
    if matrices.shape[1:] != (4, 4):
        raise ParameterError(f"{name}.shape", matrices.shape[1:], "(4, 4)", remedy)
    as_rotations(name, matrices[:, :3, :3])
    last = matrices[:, 3]
    good = np.abs(last - (0, 0, 0, 1)) <= ORTHONORMAL
    checks.require(f"last row of {name}", last, good, "(0, 0, 0, 1)", remedy)


def _level(moments: Floats) -> Floats:
    """The world's axes at all instants, shape (n, 3, 3)."""
    return _repeated(np.eye(3), len(moments))


def _poses(positions: Floats, rotations: Floats) -> Floats:
    """Homogeneous matrices, shape (n, 4, 4)."""
    poses = np.zeros((len(positions), 4, 4))
    poses[:, 3, 3] = 1.0
    poses[:, :3, :3], poses[:, :3, 3] = rotations, positions
    return poses


def _repeated(value: Floats, count: int) -> Floats:
    """One value, once for each instant."""
    return np.asarray(np.broadcast_to(value, (count, *value.shape)))
