"""Who does the work of a sweep: Dask, in this process, in others, on a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import BrokenExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from typing import Any

from zygopin import checks
from zygopin.errors import MissingExtraError, UnknownNameError, WorkerError
from zygopin.sweep_cell import Arrays, Chunk, plan_chunk
from zygopin.worker_process import MOST_WORKERS, worker_pool

try:
    from dask.base import compute
    from dask.callbacks import Callback
    from dask.delayed import delayed
    from dask.system import CPU_COUNT
except ImportError as error:
    raise MissingExtraError("dask", "sweep") from error

SCHEDULERS = ("processes", "threads", "sync")
"""Dask's own schedulers, on this machine."""

PROTOCOLS = ("tcp://", "tls://", "ws://", "wss://", "ucx://", "inproc://")
"""What the address of a cluster begins with."""

PATIENCE = 10
"""How long a cluster may take to answer [s]."""

AGAIN = "run the same again: what was finished is kept where there is an output"
"""What to do when the workers are gone."""

Keep = Callable[[Chunk, Arrays], None]


@dataclass(frozen=True)
class Runner:
    """Who works.

    Attributes:
        scheduler: `processes`, `threads` or `sync` on this machine, or the address of
            a cluster's scheduler, such as `tcp://10.0.0.1:8786`.
        workers: Number of local processes or threads; None: one for each processor.
    """

    scheduler: str = "processes"
    workers: int | None = None

    def __post_init__(self) -> None:
        if self.scheduler not in SCHEDULERS and not self.remote:
            known = (*SCHEDULERS, "tcp://HOST:PORT")
            raise UnknownNameError("scheduler", self.scheduler, known)
        if self.workers is not None:
            count = checks.integer("workers", self.workers, 1, MOST_WORKERS)
            object.__setattr__(self, "workers", count)

    @property
    def remote(self) -> bool:
        """Whether the scheduler is a cluster's."""
        return str(self.scheduler).startswith(PROTOCOLS)

    def run(self, chunks: Sequence[Chunk], keep: Keep) -> None:
        """Plan chunks, and keep each as soon as it is finished, in any order.

        Args:
            chunks: The chunks, all different.
            keep: Takes a chunk and its arrays, in this process.

        Raises:
            WorkerError: The cluster does not answer, or the workers were lost.
        """
        by_key = {chunk.digest: chunk for chunk in chunks}
        work = delayed(plan_chunk, pure=False)
        tasks = [work(chunk, dask_key_name=key) for key, chunk in by_key.items()]
        if self.remote:
            self._run_remotely(tasks, by_key, keep)
            return
        with _Finished(by_key, keep):
            self._run_here(tasks)

    def _run_here(self, tasks: list[Any]) -> None:
        """The same on this machine."""
        workers = self.workers or CPU_COUNT
        if self.scheduler != "processes":
            compute(*tasks, scheduler=self.scheduler, num_workers=workers)
            return
        try:
            with worker_pool(workers) as pool:
                # One chunk at a time: several would be handed over, and lost, together.
                compute(*tasks, scheduler="processes", pool=pool, chunksize=1)
        except BrokenExecutor as error:
            raise WorkerError("a worker process ended early", AGAIN) from error

    def _run_remotely(
        self, tasks: list[Any], chunks: Mapping[str, Chunk], keep: Keep
    ) -> None:
        """The same on a cluster, which does a lost worker's tasks again elsewhere."""
        from distributed import as_completed

        with _client(self.scheduler) as client:
            futures = client.compute(tasks)
            for future in as_completed(futures, loop=client.loop):
                keep(chunks[future.key], future.result())
                future.release()


class _Finished(Callback):  # type: ignore[misc,unused-ignore]
    """Hands over each chunk as one of Dask's local schedulers finishes it."""

    def __init__(self, chunks: Mapping[str, Chunk], keep: Keep) -> None:
        super().__init__()  # type: ignore[no-untyped-call,unused-ignore]
        self._chunks = chunks
        self._keep = keep

    def _posttask(self, key: Any, result: Any, *_: Any) -> None:  # noqa: ANN401
        if key in self._chunks:  # not another thread's computation
            self._keep(self._chunks[key], result)


@contextmanager
def _client(address: str) -> Iterator[Any]:
    """A connection to a cluster; what goes wrong there is told as ours."""
    try:
        from distributed import CancelledError, Client
        from distributed.comm.core import CommClosedError
        from distributed.scheduler import KilledWorker
    except ImportError as error:
        raise MissingExtraError("distributed", "sweep") from error
    try:
        client = Client(address, timeout=PATIENCE, set_as_default=False)
    except (OSError, ValueError, ImportError) as error:
        remedy = "start `dask scheduler` and workers there, or give its address"
        raise WorkerError(f"no scheduler answers at {address}", remedy) from error
    try:
        with client:
            yield client
    except (KilledWorker, CancelledError, CommClosedError) as error:
        problem = f"the workers at {address} were lost: {type(error).__name__}"
        raise WorkerError(problem, AGAIN) from error
