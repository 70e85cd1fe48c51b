"""Work on large batches in blocks that stay in the cache, over threads."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin import checks

BLOCK = 4096
"""Entries worked on at once: what is in between stays in a core's cache, and threads
have something to do between turns of the interpreter."""

KEPT = 2**22
"""Bytes that the C library is to keep for us. It gives freed memory back to the system
above what it was seen to hand out at once, and new pages cost more than arithmetic."""

WORTH = 4
"""Blocks for each thread below which starting it costs more than it brings."""

MOST_THREADS = 256
"""Threads that may be asked for."""


Part = slice | NDArray[np.intp]
"""Some entries of a flat batch: from one to another, or listed."""


def as_threads(threads: int | None) -> int | None:
    """A checked number of threads, or None.

    Args:
        threads: How many work at once; None: that is left open.

    Returns:
        The number.

    Raises:
        ParameterError: Not a number of threads from 1 to `MOST_THREADS`.
    """
    if threads is None:
        return None
    return checks.integer("threads", threads, 1, MOST_THREADS)


def in_blocks(
    work: Callable[[slice], object],
    count: int,
    threads: int | None = None,
    *,
    size: int = BLOCK,
) -> None:
    """Do a piece of work for all entries of a batch, a block at a time.

    Args:
        work: Told which entries; what it does for one block is independent of others.
        count: Number of entries.
        threads: How many work at once; None: one for each core that the process may
            use, in batches that are worth it.
        size: Entries of a block.

    Raises:
        ParameterError: Not a number of threads from 1 to `MOST_THREADS`.
    """
    threads = as_threads(threads)
    if count <= size and threads is None:
        work(slice(0, count))
        return
    blocks = [slice(i, min(i + size, count)) for i in range(0, count, size)]
    if threads is None:
        threads = min(_cores(), len(blocks) // WORTH)
    np.empty(KEPT, np.uint8)  # freed at once: the thresholds are that high now
    if threads <= 1:
        _do(work, blocks)
        return
    from concurrent.futures import ThreadPoolExecutor  # 10 ms, once

    with ThreadPoolExecutor(threads) as pool:
        shares = [blocks[i::threads] for i in range(threads)]
        for done in [pool.submit(_do, work, share) for share in shares]:
            done.result()


def entries(
    values: NDArray[Any], batch: tuple[int, ...], part: Part, tail: int = 0
) -> NDArray[Any]:
    """Some entries of what broadcasts to a batch, without making all of them.

    Args:
        values: The values, their last `tail` axes not of the batch.
        batch: Shape of the batch.
        part: Which n of its entries, in C order.
        tail: Number of axes of one entry.

    Returns:
        Those entries, shape (n, …); the values themselves where there is only one.
    """
    cut = values.ndim - tail
    leading, one = values.shape[:cut], values.shape[cut:]
    if not leading:
        return values
    if leading == batch:
        return values.reshape(-1, *one)[part]
    if isinstance(part, slice):
        part = np.arange(part.start, part.stop)
    places = np.unravel_index(part, batch)
    return np.broadcast_to(values, (*batch, *one))[places]


def _do(work: Callable[[slice], object], blocks: Iterable[slice]) -> None:
    """Some of the blocks, one after the other."""
    for block in blocks:
        work(block)


def _cores() -> int:
    """Cores that this process may use."""
    if hasattr(os, "sched_getaffinity"):  # where a process may be kept to some
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1
