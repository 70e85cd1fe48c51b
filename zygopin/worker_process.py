"""Work in other processes: how it is given to them, and how they end."""

from __future__ import annotations

import multiprocessing
import os
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, ProcessPoolExecutor
from contextlib import contextmanager
from threading import Thread
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
        with ProcessPoolExecutor(
            workers,
            multiprocessing.get_context("spawn"),
            initializer=leave_with_parent,
        ) as pool:
            yield pool.map
    except BrokenExecutor as error:
        remedy = "take fewer workers; in a script, guard it by __name__"
        raise WorkerError("a worker process ended early", remedy) from error


def leave_with_parent() -> None:
    """See that this process ends when its parent does, even when that is killed.

    A worker that waits for work would otherwise wait for ever: it holds both ends of
    the pipe that it waits on.
    """
    Thread(target=_leave, daemon=True).start()


def _leave() -> None:
    """Wait for the parent's end."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
