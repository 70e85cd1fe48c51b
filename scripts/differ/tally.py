"""What a run has found so far: counts, worst cases, what failed; as text and JSON."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Any

from differ.route import Outcome, Route

KEPT = 20
"""Failures that are told with a line to replay each."""


@dataclass
class Row:
    """Sums over the seeds of one route.

    Attributes:
        cases: Cases compared.
        cornered: Of them those that stood in a corner.
        undecided: Those within rounding of a threshold, or told as undecided.
        failures: Those in which the routes disagree.
        worst: The seed with the largest difference over its tolerance.
    """

    cases: int = 0
    cornered: int = 0
    undecided: int = 0
    failures: int = 0
    worst: Outcome | None = None

    def add(self, found: Outcome) -> None:
        """Take in one seed."""
        self.cases += found.cases
        self.cornered += found.cases * bool(found.corners)
        self.undecided += found.undecided
        self.failures += found.failures
        if self.worst is None or found.worst > self.worst.worst:
            self.worst = found


@dataclass
class Tally:
    """The sums of a run.

    Attributes:
        rows: Those of each route, by name.
        corners: Cases in each corner.
        failed: Seeds in which routes disagree.
    """

    rows: dict[str, Row]
    corners: Counter[str] = field(default_factory=Counter)
    failed: list[Outcome] = field(default_factory=list)

    @classmethod
    def of(cls, routes: Iterable[Route]) -> Tally:
        """A tally of nothing yet."""
        return cls({route.name: Row() for route in routes})

    def add(self, found: Outcome) -> None:
        """Take in one seed."""
        self.rows[found.route].add(found)
        self.corners.update(dict.fromkeys(found.corners, found.cases))
        if found.failures:
            self.failed.append(found)

    @property
    def cases(self) -> int:
        """Cases of all routes together."""
        return sum(row.cases for row in self.rows.values())

    def text(self) -> str:
        """The table, the corners and the failures, at most 80 columns wide."""
        lines = [
            _line("route", "cases", "corners", "undecided", "worst", "seed", "fail")
        ]
        lines += [_of_row(name, row) for name, row in self.rows.items()]
        lines += ["worst: largest difference over its tolerance, and its seed", ""]
        told = [f"{name:<20}{self.corners[name]:>10}" for name in sorted(self.corners)]
        lines += ["   ".join(told[i : i + 2]).rstrip() for i in range(0, len(told), 2)]
        total = sum(row.failures for row in self.rows.values())
        if total:
            lines += ["", *_replays(self.failed)]
        said = f"{total} of {self.cases} cases DISAGREE" if total else "all agree"
        return "\n".join([*lines, "", f"{self.cases} cases: {said}"])

    def plain(self) -> dict[str, Any]:
        """The same for JSON."""
        return {
            "cases": self.cases,
            "corners": dict(self.corners),
            "routes": {name: _plain_row(row) for name, row in self.rows.items()},
            "failed": [_plain(each) for each in self.failed],
        }


def _line(name: str, *columns: object) -> str:
    """One line of the table."""
    widths = (9, 9, 10, 9, 8, 7)
    cells = (f"{each:>{width}}" for each, width in zip(columns, widths, strict=True))
    return f"{name:<17}{' '.join(cells)}"


def _of_row(name: str, row: Row) -> str:
    """The line of a route."""
    worst, seed = (row.worst.worst, row.worst.seed) if row.worst else (0.0, "-")
    counts = row.cases, row.cornered, row.undecided
    return _line(name, *counts, f"{worst:.1e}", seed, row.failures)


def _replays(failed: list[Outcome]) -> list[str]:
    """How to see each failure again."""
    lines = []
    for each in failed[:KEPT]:
        lines.append(f"scripts/differential --replay {each.label}")
        lines.append(f"  {each.quantity}"[:80])
    left = len(failed) - KEPT
    return [*lines, f"and {left} more seeds"] if left > 0 else lines


def _plain_row(row: Row) -> dict[str, Any]:
    """A row for JSON."""
    counts = {name: value for name, value in vars(row).items() if name != "worst"}
    return {**counts, "worst": row.worst and _plain(row.worst)}


def _plain(found: Outcome) -> dict[str, Any]:
    """An outcome for JSON, which knows no infinity."""
    values = dict(vars(found))
    if not math.isfinite(found.worst):
        values["worst"] = "infinite"
    return values
