"""Atlas: what a foot can do with every branch of a range of heights and radii.

Each branch of a grid is answered with a pose that shows it, checked as any other; or
with the proof that there is none; or it stays undecided, and is counted.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.atlas_parts import interleaved, share_poses
from zygopin.branch import Branch
from zygopin.branch_grid import BranchGrid
from zygopin.foot import Foot
from zygopin.grasp import GraspReport, check_branch, check_grasp
from zygopin.survey import Survey
from zygopin.toe_contacts import Answer, Codes
from zygopin.worker_process import MOST_WORKERS, mapping

Floats = NDArray[np.float64]
Progress = Callable[[str], None]

ROWS = 100
"""Least heights that are surveyed together. Of more than twice as many every second is,
then the others, and so on: such parts are alike, and processes share them."""

VERDICTS = ("touchable", "stable", "feasible", "grasping")
"""The questions that are answered with yes, no or undecided."""


@dataclass(frozen=True, eq=False)
class Atlas:
    """What a foot can do with the branches of a grid (MODEL.md, sections 4 and 5).

    Attributes:
        foot: The foot.
        grid: The branches, H heights by R radii.
        touchable: Two opposable fingers touch at once, nothing enters, shape (H, R).
            This and the next three hold `Answer` codes: 1 yes, 0 no, −1 undecided,
            −2 for a branch that holds the foot's base.
        stable: Two opposable fingers are tangent, whatever enters (the source's).
        feasible: The same, and nothing enters.
        grasping: The same with the toes' palms, their contacts a quarter turn apart: a
            perch. Contacts of a toe's back, which the source does not exclude, make no
            grasp here.
        toes: Fewest and most fingers that can be tangent at once with nothing
            entering: what a pose shows, and what is not disproved, shape (H, R, 2).
        wrap: The largest wrap angle of a finger by itself: that of a pose of the palm,
            and an upper bound [rad], shape (H, R, 2); NaN without a pose, and without
            a bound where no finger can be tangent with nothing entering.
        controls: The pose that shows most, shape (H, R, P); NaN without one.
        stable_controls: A pose that is stable, where none is also feasible; else NaN.
    """

    foot: Foot
    grid: BranchGrid
    touchable: Codes
    stable: Codes
    feasible: Codes
    grasping: Codes
    toes: NDArray[np.int8]
    wrap: Floats
    controls: Floats
    stable_controls: Floats

    def __post_init__(self) -> None:
        checks.freeze(self)

    def answer(self, verdict: str) -> Codes:
        """The answers to one question.

        Args:
            verdict: One of `VERDICTS`.

        Returns:
            `Answer` codes, shape (H, R).

        Raises:
            UnknownNameError: There is no such question.
        """
        kinds.one_of("verdict", verdict, VERDICTS)
        codes: Codes = getattr(self, verdict)
        return codes

    def undecided(self, verdict: str) -> float:
        """Share of all branches of the grid for which a question stays open.

        Args:
            verdict: One of `VERDICTS`.

        Returns:
            The share, 0 to 1.

        Raises:
            UnknownNameError: There is no such question.
        """
        return float(np.mean(self.answer(verdict) == Answer.UNDECIDED))

    def branch(self, row: int, column: int) -> Branch:
        """One of the branches.

        Args:
            row: Index of its height.
            column: Index of its radius.

        Returns:
            The branch.
        """
        return self.grid.at(*self._cell(row, column))

    def _cell(self, row: int, column: int) -> tuple[int, int]:
        """Checked indices of one of the branches, from the end where negative."""
        (rows, columns), number = self.grid.shape, checks.integer
        return (
            number("row", row, -rows, rows - 1),
            number("column", column, -columns, columns - 1),
        )

    def report(self, row: int, column: int) -> GraspReport:
        """The verdicts on the pose for one branch, by the exact engine.

        Args:
            row: Index of the height.
            column: Index of the radius.

        Returns:
            The report on `controls`, or on `stable_controls` where only those exist.

        Raises:
            ParameterError: There is no pose for that branch.
        """
        cell = self._cell(row, column)
        controls = self.controls[cell]
        if np.isnan(controls).any():
            controls = self.stable_controls[cell]
        return check_grasp(self.foot, controls, self.branch(*cell))


def branch_atlas(
    foot: Foot,
    grid: BranchGrid,
    *,
    workers: int = 1,
    progress: Progress | None = None,
) -> Atlas:
    """What a foot can do with every branch of a grid.

    Poses are found by search, checked by the exact engine and again through Pinocchio
    and FCL. For a pair of fingers, give a foot of these two.

    Args:
        foot: The foot.
        grid: The branches.
        workers: Number of processes; the answer is the same. With more than one, a
            script needs the guard `if __name__ == "__main__":`.
        progress: Called with a line on how far the work is.

    Returns:
        The atlas.

    Raises:
        ParameterError: An argument is of the wrong type, or a branch is too thin or too
            far for this foot.
        WorkerError: A process ended early.
    """
    kinds.instance("foot", foot, Foot)
    kinds.instance("grid", grid, BranchGrid)
    if progress is not None:
        kinds.callable_given("progress", progress)
    workers = checks.integer("workers", workers, 1, MOST_WORKERS)
    check_branch(foot, grid.at(*np.nonzero(grid.valid)))
    count = max(len(grid.heights) // ROWS, 1)
    grids = [grid.rows(slice(first, None, count)) for first in range(count)]
    tell, parts = progress or (lambda _: None), []
    with mapping(min(workers, count)) as spread:
        tell(f"0 of {len(grid.heights)} heights")
        for part in spread(partial(_findings, foot), grids):
            parts.append(part)
            done = sum(len(each["toes"]) for each in parts)
            tell(f"{done} of {len(grid.heights)} heights")
    arrays = interleaved(parts)
    if count > 1:
        share_poses(foot, grid, arrays)
    return Atlas(foot, grid, **arrays)


def _findings(foot: Foot, grid: BranchGrid) -> dict[str, NDArray[Any]]:
    """The arrays of the atlas of some of the heights."""
    found = Survey(foot, grid)
    return {
        **{name: getattr(found, name) for name in VERDICTS},
        "toes": found.toe_counts,
        "wrap": found.wraps,
        "controls": found.witnesses.controls,
        "stable_controls": found.loose_controls,
    }
