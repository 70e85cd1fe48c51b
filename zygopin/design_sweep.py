"""Sweeps over foot designs and branches: a plan for every cell of a grid."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from zygopin import checks
from zygopin.foot import Foot
from zygopin.perch import LEVELS
from zygopin.sweep_cell import Arrays, Chunk, chunks
from zygopin.sweep_dataset import Dataset, question_digest, to_dataset
from zygopin.sweep_files import check_output, save_dataset, saved_dataset
from zygopin.sweep_grid import SweepGrid
from zygopin.sweep_parts import Parts
from zygopin.sweep_run import Runner


def sweep(
    foot: Foot,
    grid: Mapping[str, Any],
    *,
    output: Path | str | None = None,
    levels: int = LEVELS,
    scheduler: str = "processes",
    workers: int | None = None,
) -> Dataset:
    """Plan a perch for every combination of given feet and branches.

    With an output, finished chunks are kept in a folder beside it, `OUTPUT.parts`, and
    a second run does what is missing; the folder goes when the output is complete. A
    script that uses `processes` needs the guard `if __name__ == "__main__":`.

    Args:
        foot: The foot that the sweep starts from.
        grid: Quantities by name [SI]: `rho`, `omega`, `splay`, `scale`, `thickness`,
            `phalanges` (labels such as `2-3-4-5`), `radius`, `height`, `yaw`, `pitch`.
            A sequence is a dimension, in the order given; a single value an attribute.
            The height may be `rest`, the base on the bark (the default), or `found`,
            where the branch is grasped best.
        output: A file `.nc` (netCDF) or a folder `.zarr`; None: nothing is written.
        levels: Angles that the planner tries at each joint, 2 to 33.
        scheduler: `processes`, `threads` or `sync` on this machine, or the address of
            a Dask cluster, such as `tcp://10.0.0.1:8786`.
        workers: Number of local processes or threads; None: one for each processor.

    Returns:
        Verdicts, wrap, controls and more for each cell, with units; a foot or a branch
        that cannot be has −1 and NaN, and its `reason`.

    Raises:
        ParameterError: A value of the grid is no finite number, or occurs twice.
        UnknownNameError: A quantity or scheduler does not exist.
        FileError: The output cannot be written.
        MissingExtraError: Xarray, Dask or what writes the output is not installed.
        WorkerError: The workers were lost, or a cluster does not answer.
    """
    runner = Runner(scheduler, workers)
    return Sweep(SweepGrid.of(foot, grid), levels, output).run(runner).dataset


def _silent(_total: int, _kept: int) -> Callable[[], None]:
    """Progress that nobody watches."""
    return lambda: None


@dataclass(frozen=True, eq=False)
class SweepResult:
    """A finished sweep.

    Attributes:
        dataset: Its results.
        chunks: Number of its chunks.
        kept: How many of them were there already.
    """

    dataset: Dataset
    chunks: int
    kept: int


@dataclass(frozen=True, eq=False)
class Sweep:
    """A sweep that is still to be run.

    Attributes:
        grid: Its grid.
        levels: Angles that the planner tries at each joint.
        output: Where it is saved, or None.
    """

    grid: SweepGrid
    levels: int = LEVELS
    output: Path | str | None = None

    def __post_init__(self) -> None:
        object.__setattr__(self, "levels", checks.integer("levels", self.levels, 2, 33))
        if self.output is not None:
            check_output(self.output)

    def run(
        self, runner: Runner, began: Callable[[int, int], Callable[[], None]] = _silent
    ) -> SweepResult:
        """Do what is missing, and save the whole.

        Args:
            runner: Who works.
            began: Called with the number of chunks and of those that were there
                already; what it returns is called for each that gets finished.

        Returns:
            The results.

        Raises:
            FileError: The output cannot be written.
            WorkerError: The workers were lost.
        """
        if self.output is None:
            return self._done(runner, began)
        with Parts.beside(self.output).shared():
            return self._done(runner, began)

    def _done(
        self, runner: Runner, began: Callable[[int, int], Callable[[], None]]
    ) -> SweepResult:
        """The sweep, its parts being nobody else's to remove."""
        every = list(chunks(self.grid, self.levels))
        if self.output is not None:
            done = saved_dataset(self.output, question_digest(every))
            if done is not None:
                began(len(every), len(every))
                return SweepResult(done, len(every), len(every))
        found = self._kept(every)
        kept = len(found)
        step = began(len(every), kept)

        def keep(chunk: Chunk, arrays: Arrays) -> None:
            if self.output is not None:
                Parts.beside(self.output).write(chunk, arrays)
            found[chunk.digest] = arrays
            step()

        missing = [chunk for chunk in every if chunk.digest not in found]
        if missing:
            runner.run(missing, keep)
        dataset = to_dataset(self.grid, every, [found[each.digest] for each in every])
        if self.output is not None:
            save_dataset(dataset, self.output)
        return SweepResult(dataset, len(every), kept)

    def _kept(self, every: list[Chunk]) -> dict[str, Arrays]:
        """Chunks that an earlier run has finished, by digest."""
        if self.output is None:
            return {}
        parts = Parts.beside(self.output)
        read = {chunk.digest: parts.read(chunk) for chunk in every}
        return {key: arrays for key, arrays in read.items() if arrays is not None}
