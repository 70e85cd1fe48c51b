"""Rounds of seeds, each route one in turn, here or in other processes."""

from __future__ import annotations

import multiprocessing
import signal
import time
from collections import deque
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from dataclasses import dataclass

from differ.route import Outcome, outcome
from differ.routes import BY_NAME
from differ.tally import Tally
from zygopin.worker_process import leave_with_parent

AHEAD = 3
"""Seeds that wait for each worker: enough that none is idle, few when time is up."""

Task = tuple[str, int]


@dataclass(frozen=True)
class Bounds:
    """How long a run goes on.

    Attributes:
        seconds: Until so long has passed; None: no matter how long.
        cases: Until so many cases were compared, of all routes; None: no matter.
    """

    seconds: float | None = None
    cases: int | None = None

    def over(self, tally: Tally, started: float) -> bool:
        """Whether it is time to stop."""
        late = self.seconds is not None and time.monotonic() - started >= self.seconds
        return late or (self.cases is not None and tally.cases >= self.cases)


def tasks(routes: Sequence[str], seed: int) -> Iterator[Task]:
    """Routes in turn, each with one seed after the other, without an end."""
    while True:
        yield from ((route, seed) for route in routes)
        seed += 1


def run(tally: Tally, seed: int, bounds: Bounds, workers: int = 1) -> None:
    """Compare until the bounds are met, and add all to the tally as it comes.

    Args:
        tally: Where outcomes are added, in the order of the tasks.
        seed: The first seed of each route.
        bounds: When to stop.
        workers: Number of processes; 1: only this one.
    """
    started, todo = time.monotonic(), tasks([*tally.rows], seed)
    if workers == 1:
        while not bounds.over(tally, started):
            tally.add(judged(next(todo)))
        return
    with ProcessPoolExecutor(
        workers, multiprocessing.get_context("spawn"), initializer=_begin
    ) as pool:
        try:
            _shared(
                lambda: pool.submit(judged, next(todo)),
                lambda: bounds.over(tally, started),
                tally,
                AHEAD * workers,
            )
        finally:
            pool.shutdown(cancel_futures=True)


def judged(task: Task) -> Outcome:
    """What becomes of a seed of a route."""
    name, seed = task
    return outcome(BY_NAME[name], seed)


def _shared(
    submit: Callable[[], Future[Outcome]],
    over: Callable[[], bool],
    tally: Tally,
    ahead: int,
) -> None:
    """Keep some tasks waiting, and take their outcomes in order."""
    waiting: deque[Future[Outcome]] = deque()
    while not over():
        while len(waiting) < ahead:
            waiting.append(submit())
        tally.add(waiting.popleft().result())


def _begin() -> None:
    """A worker leaves with its parent, who alone is told of Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    leave_with_parent()
