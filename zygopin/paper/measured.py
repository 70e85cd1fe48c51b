"""Measurements that most entries take: against a closed form, and of rounding."""

from __future__ import annotations

from zygopin.paper.entry import BY_HAND, ROUNDING, Measurement, Unit, at_most, equal

EXACT = 1e-12
"""Difference of two routes to a length of about one that is rounding."""


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
