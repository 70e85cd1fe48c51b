"""What zygopin aims at, held against the rows."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass
from typing import Any

from bench.suite import Row
from bench.suites import KINEMATICS, RANDOM, SINGLE, TOUCHING


@dataclass(frozen=True)
class Aim:
    """One aim.

    Attributes:
        aim: What it says.
        wanted: The number to reach.
        measured: The number that was measured.
        met: Whether it is reached.
    """

    aim: str
    wanted: float
    measured: float
    met: bool

    def plain(self) -> dict[str, Any]:
        """The aim for JSON."""
        return asdict(self)


def aims(rows: Sequence[Row]) -> list[Aim]:
    """All aims that the rows decide.

    Args:
        rows: What was measured.

    Returns:
        The aims whose rows are there.
    """
    found = []
    peers = [row for row in rows if row.part == KINEMATICS and not row.own]
    if peers:
        nearest = min(peers, key=lambda row: row.ratio.median)
        text = f"kinematics: over every peer, the nearest of which is {nearest.name}"
        found.append(_at_least(text, 1.0, nearest.ratio.median))
    for part, name, wanted in (
        (KINEMATICS, "Pinocchio, C++ loop", 3.0),
        (KINEMATICS, "Pinocchio, C++ loop, nothing read", 3.0),
        (KINEMATICS, "Pinocchio, C++ loop, all cores", 3.0),
        *((part, "coal, distances", 50.0) for part in (RANDOM, TOUCHING)),
        *((part, "python-fcl, as written", 300.0) for part in (RANDOM, TOUCHING)),
    ):
        row = _row(rows, part, name)
        if row:
            text = f"{part}: times faster than {name}"
            found.append(_at_least(text, wanted, row.ratio.median))
        if row and row.ratio_alike and row.threads == 1 and part == KINEMATICS:
            text = f"{part}: times faster than {name}, both on one thread"
            found.append(_at_least(text, wanted, row.ratio_alike.median))
    return [*found, *_absolute(rows)]


def _absolute(rows: Sequence[Row]) -> list[Aim]:
    """Aims in checks per second and in microseconds."""
    found = []
    for part in (RANDOM, TOUCHING):
        own = next((row for row in rows if row.part == part and row.own), None)
        if own:
            rate = 1 / own.microseconds.median
            text = f"{part}: millions per second, {own.threads} threads"
            found.append(_at_least(text, 2.0, rate))
    for name, most in (
        ("zygopin, check_grasp, fast", 100.0),
        ("zygopin, check_grasp by FCL", 300.0),
    ):
        row = _row(rows, SINGLE, name)
        if row:
            value = row.microseconds.median
            text = f"{SINGLE}: µs, {name}, at most"
            found.append(Aim(text, most, value, value <= most))
    return found


def _row(rows: Sequence[Row], part: str, name: str) -> Row | None:
    """The row of a name."""
    return next((row for row in rows if (row.part, row.name) == (part, name)), None)


def _at_least(text: str, wanted: float, measured: float) -> Aim:
    """An aim that a number is not below another."""
    return Aim(text, wanted, measured, measured >= wanted)
