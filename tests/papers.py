"""What tests ask of the report's entries."""

from __future__ import annotations

from zygopin.paper.entry import Entry, Measurement


def measured(entry: Entry, name: str) -> Measurement:
    """One of an entry's numbers, by its name."""
    (found,) = (each for each in entry.measurements if each.name == name)
    return found


def value(entry: Entry, name: str) -> float:
    """The value of one of an entry's numbers."""
    return measured(entry, name).value


def failing(entry: Entry) -> set[str]:
    """Names of the numbers that are not as they must be."""
    return {each.name for each in entry.measurements if not each.holds}
