"""Time and memory against the number of configurations, of phalanges, of threads."""

from __future__ import annotations

import tracemalloc
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from bench.machine import spare_memory
from bench.peer import cores
from bench.suites import CENTRE, PRESET, RADIUS
from bench.timing import Spread, interleaved
from zygopin import Branch, Finger, Foot, forward_kinematics, grasp_verdicts
from zygopin.clearance import Floats

SHARE = 0.4
"""Part of the spare memory that a run may need; others use the machine as well."""

RANKS = (1, 2, 3, 4, 6, 8, 12, 16)
"""Phalanges of each of the four fingers, against whose number is measured."""


@dataclass(frozen=True)
class Point:
    """One measurement.

    Attributes:
        work: `kinematics` or `checks`.
        configurations: Their number N.
        phalanges: Their number P.
        threads: Threads that were asked for.
        microseconds: Time of one configuration [µs].
        result: Size of the result [bytes].
        peak: Largest memory beyond controls and result while it runs [bytes].
    """

    work: str
    configurations: int
    phalanges: int
    threads: int
    microseconds: Spread
    result: int
    peak: int


def against_count(counts: Sequence[int], runs: int) -> list[Point]:
    """Both kinds of work at growing counts, as far as memory is enough."""
    foot, found = Foot.preset(PRESET), list[Point]()
    for count in counts:
        if count * needed(found) > SHARE * spare_memory():
            break
        found += _points(foot, Branch(RADIUS, CENTRE), count, runs)
    return found


def against_phalanges(count: int, longest: int, runs: int) -> list[Point]:
    """Both kinds of work on feet of four fingers of more and more phalanges."""
    return [
        point
        for rank in RANKS
        if rank <= longest
        for point in _points(longer(rank), Branch(RADIUS, CENTRE), count, runs)
    ]


def longer(rank: int) -> Foot:
    """The preset with so many phalanges in every finger."""
    foot = Foot.preset(PRESET)
    fingers = [Finger(f.name, rank, f.azimuth) for f in foot.fingers]
    return foot.replace(fingers=tuple(fingers))


def needed(points: Sequence[Point]) -> float:
    """Memory that each configuration took [bytes], at most, of the largest number."""
    most = max((p.configurations for p in points), default=0)
    return max(
        (
            8 * p.phalanges + (p.result + p.peak) / p.configurations
            for p in points
            if p.configurations == most
        ),
        default=0.0,
    )


def _points(foot: Foot, branch: Branch, count: int, runs: int) -> Iterator[Point]:
    """Measurements at one size, for each number of threads."""
    controls = np.random.default_rng(0).uniform(size=(count, foot.phalanx_count))
    works = {
        (kind, threads): work
        for threads in thread_counts()
        for kind, work in _works(foot, controls, branch, threads).items()
    }
    times = interleaved(
        {f"{kind} {threads}": work for (kind, threads), work in works.items()}, runs
    )
    for (kind, threads), work in works.items():
        result, peak = memory(work)
        spread = Spread.of(times[f"{kind} {threads}"]).scaled(1e6 / count)
        shape = count, foot.phalanx_count, threads
        yield Point(kind, *shape, spread, result, peak)


def thread_counts() -> list[int]:
    """Numbers of threads that can be asked for."""
    return sorted({1, cores()})


def _works(
    foot: Foot, controls: Floats, branch: Branch, threads: int
) -> dict[str, Callable[[], object]]:
    """Both kinds of work."""
    return {
        "kinematics": partial(forward_kinematics, foot, controls, threads=threads),
        "checks": partial(_verdicts, foot, controls, branch, threads),
    }


def _verdicts(
    foot: Foot, controls: Floats, branch: Branch, threads: int
) -> tuple[object, ...]:
    """The verdicts alone: a report that holds them has more."""
    found = grasp_verdicts(foot, controls, branch, threads=threads)
    return found.stable, found.grasping, found.feasible


def memory(work: Callable[[], object]) -> tuple[int, int]:
    """Memory that a piece of work takes.

    Args:
        work: What returns an array, or a tuple of them.

    Returns:
        Size of its result, and its largest memory beyond that [bytes].
    """
    work()
    tracemalloc.start()
    try:
        found = work()
        _, most = tracemalloc.get_traced_memory()
    finally:
        tracemalloc.stop()
    parts = found if isinstance(found, tuple) else (found,)
    result = sum(part.nbytes for part in parts if isinstance(part, np.ndarray))
    return result, max(most - result, 0)
