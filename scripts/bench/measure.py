"""One run: the parts that are wanted, as one document of plain values."""

from __future__ import annotations

import dataclasses
import sys
from collections.abc import Callable, Iterable, Sequence
from dataclasses import asdict, dataclass
from itertools import chain
from pathlib import Path
from typing import Any

from bench import (
    calls,
    grasp_peers,
    kinematics_peers,
    limits,
    machine,
    maps,
    scaling,
    suites,
)
from bench.aims import aims
from bench.peer import cores
from bench.suite import Row, Suite
from zygopin import Foot

PARTS = ("kinematics", "checks", "scaling", "calls", "maps")


@dataclass(frozen=True)
class Sizes:
    """How much is measured.

    Attributes:
        configurations: Of kinematics and checks; slow peers get a part of them.
        runs: Rounds in which all take turns.
        calls: Runs of single calls after the first, which does not count.
        most: The largest number of configurations against which scaling is measured.
        longest: The same of phalanges in each finger.
        levels: Levels of controls of the reachable sets.
        cells: Cells along each side of the map.
        poses: Random poses tried for each branch of the map.
        compiling: 1 if Pinocchio's loop in C++ may be compiled, else 0.
    """

    configurations: int = 163_840
    runs: int = 9
    calls: int = 5
    most: int = 10_000_000
    longest: int = 12
    levels: int = 64
    cells: int = 32
    poses: int = 100
    compiling: int = 1

    @classmethod
    def quick(cls) -> Sizes:
        """Just enough to run everything."""
        return cls(200, 2, 0, 1000, 2, 8, 5, 3, 0)

    @classmethod
    def names(cls) -> list[str]:
        """The names of all sizes."""
        return [field.name for field in dataclasses.fields(cls)]

    def replace(self, **changes: int) -> Sizes:
        """These with some changed."""
        return dataclasses.replace(self, **changes)


def measure(
    parts: Iterable[str], sizes: Sizes, png: Path | None = None
) -> dict[str, Any]:
    """Measure some parts.

    Args:
        parts: Some of PARTS.
        sizes: How much.
        png: Where the figure of scaling is drawn, if anywhere.

    Returns:
        The machine, the versions, and what was found, for JSON.
    """
    wanted = list(parts)
    found: dict[str, Any] = {"machine": machine.description(), "sizes": asdict(sizes)}
    groups = _suites(wanted, sizes)
    rows = [row for suite in groups for row in _told(suite).measure(sizes.runs)]
    packages = chain.from_iterable(row.packages for row in rows)
    found["versions"] = machine.versions(packages)
    found["missing"] = {k: v for suite in groups for k, v in suite.missing().items()}
    found["rows"] = [row.plain() for row in rows]
    found["aims"] = [aim.plain() for aim in aims(rows)]
    found["limits"] = _limits(rows) if rows else []
    others: dict[str, Callable[[], Any]] = {
        "scaling": lambda: _scaling(sizes, png),
        "calls": lambda: _calls(sizes),
        "maps": lambda: _maps(sizes),
    }
    for part in others:
        if part in wanted:
            print(part, file=sys.stderr)
            found[part] = others[part]()
    return found


def _suites(parts: Sequence[str], sizes: Sizes) -> list[Suite[Any, Any]]:
    """The jobs that zygopin shares with peers."""
    count, compiling = sizes.configurations, bool(sizes.compiling)
    chosen = []
    if "kinematics" in parts:
        chosen += suites.kinematics(count, compiling=compiling)
    return chosen + (suites.checks(count) if "checks" in parts else [])


def _told(suite: Suite[Any, Any]) -> Suite[Any, Any]:
    """The suite, its name told to whom waits."""
    print(suite.part, file=sys.stderr)
    return suite


def _limits(rows: Sequence[Row]) -> list[dict[str, Any]]:
    """How far zygopin's own rows are from what the machine can do."""
    foot = Foot.preset(suites.PRESET)
    needs = {
        suites.KINEMATICS: limits.of_kinematics(foot),
        suites.RANDOM: limits.of_check(foot),
        suites.TOUCHING: limits.of_check(foot),
    }
    names = {peer.name for peer in kinematics_peers.OWN}
    names |= {peer.name for peer in grasp_peers.VERDICTS}
    rates = {threads: limits.measured_rates(threads) for threads in {1, cores()}}
    return [
        {
            **limits.distance(
                f"{row.part}: {row.name}",
                needs[row.part],
                rates[row.threads],
                row.microseconds.median,
            ),
            "rates": asdict(rates[row.threads]),
        }
        for row in rows
        if row.part in needs and row.name in names
    ]


def _scaling(sizes: Sizes, png: Path | None) -> dict[str, Any]:
    """Time and memory against sizes."""
    powers = [10**k for k in range(2, len(str(sizes.most)))]
    runs = max(sizes.runs // 3, 1)
    counts = scaling.against_count(powers, runs)
    number = min(20_000, sizes.most)
    phalanges = scaling.against_phalanges(number, sizes.longest, runs)
    if png is not None:
        from bench.scaling_plot import draw

        draw(counts, phalanges, png)
    done = {point.configurations for point in counts}
    return {
        "configurations": [asdict(point) for point in counts],
        "phalanges": [asdict(point) for point in phalanges],
        "left_out_for_memory": [count for count in powers if count not in done],
    }


def _calls(sizes: Sizes) -> dict[str, Any]:
    """What users wait for [s]."""
    return {
        "pieces": calls.piece_rows(sizes.configurations, sizes.calls),
        "calls": calls.rows(sizes.calls, sizes.levels),
    }


def _maps(sizes: Sizes) -> dict[str, Any]:
    """Seconds for each branch, and what random poses find."""
    times, share = maps.rows(sizes.cells, sizes.poses)
    return {"branches": times, "found_at_random": share}
