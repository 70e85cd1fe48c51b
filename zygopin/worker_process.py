"""Work in other processes: how it is given to them, and how they end."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import (
    BrokenExecutor,
    InvalidStateError,
    ProcessPoolExecutor,
)
from contextlib import contextmanager, suppress
from multiprocessing.context import SpawnContext, SpawnProcess
from typing import Any

from zygopin import checks
from zygopin.errors import WorkerError

MOST_WORKERS = 1024


@contextmanager
def mapping(workers: int) -> Iterator[Callable[..., Any]]:
    """What applies a function to many values, in order: here or in other processes.

    Args:
        workers: Number of processes; 1: only this one. With more than one, a script
            must be guarded by `if __name__ == "__main__":`, as for any such pool.

    Raises:
        ParameterError: No such number of workers.
        WorkerError: A process ended early.
    """
    if checks.integer("workers", workers, 1, MOST_WORKERS) == 1:
        yield map
        return
    try:
        with worker_pool(workers) as pool:
            yield pool.map
    except BrokenExecutor as error:
        remedy = "take fewer workers; in a script, guard it by __name__"
        raise WorkerError("a worker process ended early", remedy) from error


@contextmanager
def worker_pool(workers: int) -> Iterator[ProcessPoolExecutor]:
    """Processes that work for this one, and end at once where the work is broken off.

    Args:
        workers: How many.

    Yields:
        What takes the work.
    """
    made = _Workers()
    pool = ProcessPoolExecutor(workers, made, initializer=leave_with_parent)
    try:
        yield pool
    except BaseException:
        with _hushed():
            for worker in made.started:
                worker.terminate()  # the pool would wait for what it has begun
            pool.shutdown()
        raise
    pool.shutdown()


@contextmanager
def _hushed() -> Iterator[None]:
    """Without a pool's complaints of having been broken off.

    Its thread cannot be joined before it has been started, and cannot tell a task that
    is cancelled already that its worker has gone.
    """
    before = threading.excepthook

    def hook(args: threading.ExceptHookArgs) -> None:
        if not issubclass(args.exc_type, InvalidStateError):
            before(args)

    threading.excepthook = hook
    try:
        with suppress(RuntimeError):
            yield
    finally:
        threading.excepthook = before


class _Worker(SpawnProcess):
    """A process that a terminal's interruption does not reach, only its parent."""

    def start(self) -> None:
        """Start it; what this thread has blocked meanwhile, it has blocked for ever."""
        before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
        try:
            super().start()
        finally:
            signal.pthread_sigmask(signal.SIG_SETMASK, before)


class _Workers(SpawnContext):
    """Makes such processes.

    Attributes:
        started: Those that it has made, all of them started.
    """

    def __init__(self) -> None:
        self.started: list[_Worker] = []

    def Process(self, *args: Any, **kwargs: Any) -> _Worker:  # type: ignore[override] # noqa: ANN401
        """Another process, as a pool asks for it."""
        worker = _Worker(*args, **kwargs)
        self.started.append(worker)
        return worker


def leave_with_parent() -> None:
    """See that this process ends when its parent does, even when that is killed.

    A worker that waits for work would otherwise wait for ever: it holds both ends of
    the pipe that it waits on.
    """
    threading.Thread(target=_leave, daemon=True).start()


def _leave() -> None:
    """Wait for the parent's end."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
