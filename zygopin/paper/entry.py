"""What the report is made of: entries, each with its numbers and its pictures.

Texts are plain; what stands between two dollar signs is TeX.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

Kind = Literal["figure", "statement", "erratum"]
Relation = Literal["=", "≤", "≥"]
Unit = Literal["", "rad"]

BY_HAND = "worked by hand"
ROUNDING = "rounding"
"""Routes to a reference that several entries take."""

EXACT = 1e-12
"""Difference of two routes to a length of about one that is rounding."""


@dataclass(frozen=True)
class Reference:
    """What a number is held against.

    Attributes:
        relation: How the number must stand to the value.
        value: The value, in the number's unit.
        tolerance: Largest difference that counts as equal.
        route: Where the value comes from, in a few words.
    """

    relation: Relation
    value: float
    tolerance: float
    route: str

    def admits(self, number: float) -> bool:
        """Whether a number stands as it must.

        Args:
            number: The number.

        Returns:
            The verdict; never for NaN.
        """
        if self.relation == "=":
            return abs(number - self.value) <= self.tolerance
        return number <= self.value if self.relation == "≤" else number >= self.value


@dataclass(frozen=True)
class Measurement:
    """A number that the report computes.

    Lengths are in the paper's own units, in which a finger's first phalanx is 1/ρ
    long.

    Attributes:
        name: Its key among the entry's, an identifier.
        words: What it is.
        value: The number.
        reference: What it is held against; None: it is stated, not judged.
        unit: Its unit; none for lengths and pure numbers.
    """

    name: str
    words: str
    value: float
    reference: Reference | None = None
    unit: Unit = ""

    @property
    def holds(self) -> bool:
        """Whether it is as it must be."""
        return self.reference is None or self.reference.admits(self.value)


@dataclass(frozen=True, eq=False)
class Exhibit:
    """A picture or a scene.

    Attributes:
        name: The file's name, `.png` or `.html`.
        caption: What is to be seen.
        write: Writes the file at the path that it is given.
    """

    name: str
    caption: str
    write: Callable[[Path], object]


@dataclass(frozen=True, eq=False)
class Entry:
    """Something that the paper shows, states or misprints, recomputed.

    Attributes:
        key: Its name in links and in JSON, such as `proposition-1`.
        kind: What of the paper it is about.
        title: Its heading.
        place: Where the paper has it.
        printed: What the paper prints there.
        ours: What zygopin computes instead; empty: the same.
        finding: What came of it, and why.
        measurements: The numbers that say so.
        figures: Pictures.
        scenes: Scenes to turn.
    """

    key: str
    kind: Kind
    title: str
    place: str
    printed: str
    ours: str
    finding: str
    measurements: tuple[Measurement, ...]
    figures: tuple[Exhibit, ...] = ()
    scenes: tuple[Exhibit, ...] = ()

    @property
    def label(self) -> str:
        """Its kind and number, such as `Proposition 1`; without one, its kind."""
        words = self.kind if self.number is None else self.key.replace("-", " ")
        return words.capitalize()

    @property
    def number(self) -> int | None:
        """Its number among the paper's figures or propositions, or our errata."""
        last = self.key.rpartition("-")[2]
        return int(last) if last.isdigit() else None

    @property
    def judged(self) -> tuple[Measurement, ...]:
        """The numbers that are held against something."""
        return tuple(each for each in self.measurements if each.reference is not None)

    @property
    def holds(self) -> bool:
        """Whether every number is as it must be."""
        return all(each.holds for each in self.judged)


def equal(value: float, tolerance: float, route: str) -> Reference:
    """A value that the number must have.

    Args:
        value: The value.
        tolerance: Largest difference.
        route: Where it comes from.

    Returns:
        The reference.
    """
    return Reference("=", value, tolerance, route)


def at_most(value: float, route: str) -> Reference:
    """A bound from above.

    Args:
        value: The bound.
        route: Where it comes from.

    Returns:
        The reference.
    """
    return Reference("≤", value, 0.0, route)


def at_least(value: float, route: str) -> Reference:
    """A bound from below.

    Args:
        value: The bound.
        route: Where it comes from.

    Returns:
        The reference.
    """
    return Reference("≥", value, 0.0, route)


def by_hand(
    name: str, words: str, value: float, expected: float, *, unit: Unit = ""
) -> Measurement:
    """A number that a formula worked by hand must give.

    Args:
        name: Its key among the entry's.
        words: What it is.
        value: The number.
        expected: What the formula gives.
        unit: The unit of both.

    Returns:
        The measurement.
    """
    return Measurement(name, words, value, equal(expected, EXACT, BY_HAND), unit)


def rounding(name: str, words: str, value: float, *, unit: Unit = "") -> Measurement:
    """A difference of two routes that must be rounding.

    Args:
        name: Its key among the entry's.
        words: What it is.
        value: The largest difference.
        unit: Its unit.

    Returns:
        The measurement.
    """
    return Measurement(name, words, value, at_most(EXACT, ROUNDING), unit)
