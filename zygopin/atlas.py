"""Atlas: what a foot can do with every branch of a range of heights and radii.

Each branch of a grid is answered with a pose that shows it, checked as any other; or
with the proof that there is none; or it stays undecided, and is counted.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.branch import Branch
from zygopin.branch_grid import BranchGrid
from zygopin.errors import UnknownNameError
from zygopin.foot import Foot
from zygopin.grasp import GraspReport, check_grasp
from zygopin.survey import Progress, Survey
from zygopin.toe_contacts import Answer, Codes
from zygopin.witnesses import opposing, touched

Floats = NDArray[np.float64]

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
        if verdict not in VERDICTS:
            raise UnknownNameError("verdict", verdict, VERDICTS)
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

    def unconfirmed(self, verdict: str) -> int:
        """How many poses another engine, by Pinocchio and FCL, does not confirm.

        Args:
            verdict: One of `VERDICTS`.

        Returns:
            The number of branches answered yes whose pose fails, of all: 0 is wanted.

        Raises:
            UnknownNameError: There is no such question.
        """
        cells = np.nonzero(self.answer(verdict) == Answer.YES)
        if not len(cells[0]):
            return 0
        controls = self.controls[cells]
        if verdict == "stable":
            known = np.isfinite(controls)
            controls = np.where(known, controls, self.stable_controls[cells])
        branches = self.grid.at(*cells)
        report = check_grasp(self.foot, controls, branches, engine="fcl")
        touching = opposing(self.foot, touched(self.foot, report.touching))
        holds = {
            "touchable": touching & report.feasible,
            "stable": report.stable,
            "feasible": report.stable & report.feasible,
            "grasping": report.grasping & report.feasible,
        }
        return int((~holds[verdict]).sum())

    def branch(self, row: int, column: int) -> Branch:
        """One of the branches.

        Args:
            row: Index of its height.
            column: Index of its radius.

        Returns:
            The branch.
        """
        return self.grid.at(row, column)

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
        controls = self.controls[row, column]
        if np.isnan(controls).any():
            controls = self.stable_controls[row, column]
        return check_grasp(self.foot, controls, self.branch(row, column))


def branch_atlas(
    foot: Foot, grid: BranchGrid, *, progress: Progress | None = None
) -> Atlas:
    """What a foot can do with every branch of a grid.

    For a pair of fingers, give a foot of these two.

    Args:
        foot: The foot.
        grid: The branches.
        progress: Called with the name of each part of the work as it begins.

    Returns:
        The atlas.

    Raises:
        ParameterError: An argument is of the wrong type.
    """
    checks.instance("foot", foot, Foot)
    checks.instance("grid", grid, BranchGrid)
    found = Survey(foot, grid, progress or (lambda _: None))
    return Atlas(
        foot,
        grid,
        found.touchable,
        found.stable,
        found.feasible,
        found.grasping,
        found.toe_counts,
        found.wraps,
        found.witnesses.controls,
        found.loose_controls,
    )
