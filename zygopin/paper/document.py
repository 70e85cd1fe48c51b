"""The report's numbers as plain values, for JSON."""

from __future__ import annotations

import math
from typing import Any

from zygopin.paper.entry import Entry, Exhibit, Measurement
from zygopin.paper.report import PaperReport

PAPER = {
    "authors": ["Anna Chiara Lai", "Paola Loreti"],
    "title": "A control model for zygodactyl bird's foot",
}
"""What is recomputed."""


def paper_document(report: PaperReport) -> dict[str, Any]:
    """A report as plain values: lengths in the paper's units, angles in radians.

    Args:
        report: The report.

    Returns:
        A mapping for JSON, the entries by their keys.
    """
    return {
        "paper": PAPER,
        "holds": report.holds,
        "entries": {entry.key: _entry(entry) for entry in report.entries},
    }


def _entry(entry: Entry) -> dict[str, Any]:
    """One entry."""
    return {
        "kind": entry.kind,
        "title": entry.title,
        "place": entry.place,
        "printed": entry.printed,
        "ours": entry.ours,
        "finding": entry.finding,
        "holds": entry.holds,
        "measurements": {each.name: _measurement(each) for each in entry.measurements},
        "figures": [_exhibit(each) for each in entry.figures],
        "scenes": [_exhibit(each) for each in entry.scenes],
    }


def _measurement(found: Measurement) -> dict[str, Any]:
    """One number, and what it is held against."""
    against = found.reference
    return {
        "words": found.words,
        "value": _plain(found.value),
        "unit": found.unit,
        "holds": found.holds,
        "reference": against
        and {
            "relation": against.relation,
            "value": _plain(against.value),
            "tolerance": against.tolerance,
            "route": against.route,
        },
    }


def _exhibit(exhibit: Exhibit) -> dict[str, str]:
    """A picture's or a scene's name and caption."""
    return {"name": exhibit.name, "caption": exhibit.caption}


def _plain(value: float) -> float | None:
    """A number; None where it is none."""
    return float(value) if math.isfinite(value) else None
