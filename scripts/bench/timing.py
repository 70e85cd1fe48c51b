"""Interleaved timing: pieces of work take turns.

So the machine's own speed, and what else runs on it, meets all of them alike.
"""

from __future__ import annotations

import random
import statistics
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass

Clock = Callable[[], float]

SHORTEST = 0.02
"""Least time of one measurement [s]: shorter work is repeated, since a clock's grain
and one interruption would otherwise be a share of it."""

MOST_REPEATS = 1000


@dataclass(frozen=True)
class Spread:
    """Several values of one quantity.

    Attributes:
        median: The middle one.
        low: The least.
        high: The greatest.
    """

    median: float
    low: float
    high: float

    @classmethod
    def of(cls, values: Sequence[float]) -> Spread:
        """The spread of some values, at least one."""
        return cls(statistics.median(values), min(values), max(values))

    def scaled(self, factor: float) -> Spread:
        """The same in another unit."""
        return Spread(*(factor * value for value in asdict(self).values()))


def ratios(times: Sequence[float], reference: Sequence[float]) -> Spread:
    """The spread of ratios, each of two times of the same round.

    Args:
        times: Time in each round [s].
        reference: Time of what it is held against, in the same rounds [s].

    Returns:
        The spread of times over reference.
    """
    return Spread.of([a / b for a, b in zip(times, reference, strict=True)])


def interleaved(
    works: Mapping[str, Callable[[], object]],
    runs: int,
    *,
    clock: Clock = time.perf_counter,
    shortest: float = SHORTEST,
) -> dict[str, list[float]]:
    """Time pieces of work in turns, each round in another order.

    The first run of each does not count: it warms up, and says how often the work is
    to be repeated in one measurement.

    Args:
        works: The pieces of work.
        runs: Number of rounds.
        clock: Seconds since any moment.
        shortest: Least time of one measurement [s].

    Returns:
        Seconds that each work takes once, one number for each round.
    """
    names = list(works)
    repeats = {name: _repeats(works[name], clock, shortest) for name in names}
    times: dict[str, list[float]] = {name: [] for name in names}
    order = random.Random(0)  # noqa: S311
    for _ in range(runs):
        # Shuffled, so that none always comes after the same other one.
        order.shuffle(names)
        for name in names:
            times[name].append(_seconds(works[name], repeats[name], clock))
    return times


def _repeats(work: Callable[[], object], clock: Clock, shortest: float) -> int:
    """How often a piece of work is done to last long enough, once it is warm."""
    work()
    once = _seconds(work, 1, clock)
    return int(min(max(shortest / max(once, 1e-9), 1.0), MOST_REPEATS))


def _seconds(work: Callable[[], object], repeats: int, clock: Clock) -> float:
    """Seconds that a piece of work takes, the mean of repeats in a row."""
    start = clock()
    for _ in range(repeats):
        work()
    return (clock() - start) / repeats
