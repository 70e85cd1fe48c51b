"""Whole-foot poses on the branches of a grid: the best of those that were tried."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.cases import Cases
from zygopin.clearance import dot
from zygopin.contact_products import least_products
from zygopin.engine import Engine
from zygopin.foot import Foot
from zygopin.grasp import (
    PARAMETER_SLACK,
    Criteria,
    GraspReport,
    check_grasp,
)
from zygopin.projection import BACK, PALM
from zygopin.sieve import Sieve

Floats = NDArray[np.float64]
Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]

MERITS = {"touching": 1, "feasible": 100, "grasping": 10_000}
"""What a pose shows: opposable fingers touch, are tangent, and grasp with their palms.
Each with nothing entering; each shows those before it. Tangent toes count one each."""


@dataclass(eq=False)
class Witnesses:
    """The best pose so far for each branch of a grid.

    Attributes:
        foot: The foot.
        grid: The branches.
        criteria: What counts as contact and as a grasp.
        merit: What each pose shows, see `MERITS`; 0 without one, shape (H, R).
        controls: The poses, shape (H, R, P); NaN without one.
        toes: Tangent fingers of the poses, shape (H, R).
        sides: Sides of their phalanges that are tangent, `PALM` or `BACK`; 0: neither,
            shape (H, R, P).
    """

    foot: Foot
    grid: BranchGrid
    criteria: Criteria
    merit: Indices = field(init=False)
    controls: Floats = field(init=False)
    toes: Indices = field(init=False)
    sides: NDArray[np.int8] = field(init=False)

    def __post_init__(self) -> None:
        self.merit = np.zeros(self.grid.shape, dtype=np.intp)
        self.toes = np.zeros(self.grid.shape, dtype=np.intp)
        shape = (*self.grid.shape, self.foot.phalanx_count)
        self.controls = np.full(shape, np.nan)
        self.sides = np.zeros(shape, dtype=np.int8)

    def offer(self, cells: tuple[Indices, ...], controls: Floats) -> None:
        """Keep poses that enter nothing and show more than those there are.

        Args:
            cells: Rows and columns of the branches, shape (n,) each.
            controls: A pose for each, shape (n, P).
        """
        cells, controls = self._promising(cells, controls)
        if not len(cells[0]):
            return
        branches = self.grid.at(*cells)
        report = check_grasp(self.foot, controls, branches, criteria=self.criteria)
        toes = touched(self.foot, report.tangent)
        merit = self._merit(report, toes.sum(axis=-1))
        # The best last: of several for one branch it is what stays.
        better = np.argsort(merit, kind="stable")
        better = better[(merit > self.merit[cells])[better]]
        kept = tuple(axis[better] for axis in cells)
        self.merit[kept] = merit[better]
        self.toes[kept] = toes.sum(axis=-1)[better]
        self.controls[kept] = controls[better]
        self.sides[kept] = tangent_sides(report)[better]

    def _promising(
        self, cells: tuple[Indices, ...], controls: Floats
    ) -> tuple[tuple[Indices, ...], Floats]:
        """Poses that may touch their branch and do not enter it for certain."""
        branches, batch = self.grid.at(*cells), (len(controls),)
        sieve = Sieve(Cases(self.foot, controls, branches, batch, self.criteria))
        touched, entered = sieve.met(slice(0, len(controls)))
        some = touched & ~entered
        return tuple(axis[some] for axis in cells), controls[some]

    def confirm(self, engine: Engine) -> None:
        """Check all poses by another engine: what both show remains.

        Args:
            engine: The engine.
        """
        cells = np.nonzero(self.merit)
        if not len(cells[0]):
            return
        branches = self.grid.at(*cells)
        report = check_grasp(
            self.foot,
            self.controls[cells],
            branches,
            engine=engine,
            criteria=self.criteria,
        )
        toes = touched(self.foot, report.tangent).sum(axis=-1)
        merit = np.minimum(self.merit[cells], self._merit(report, toes))
        self.merit[cells], self.toes[cells] = merit, np.minimum(self.toes[cells], toes)
        lost = tuple(axis[merit == 0] for axis in cells)
        self.controls[lost], self.sides[lost], self.toes[lost] = np.nan, 0, 0

    def shows(self, verdict: str) -> Booleans:
        """Branches whose pose shows a verdict.

        Args:
            verdict: A key of `MERITS`.

        Returns:
            A mask, shape (H, R).
        """
        return np.asarray(self.merit >= MERITS[verdict])

    def _merit(self, report: GraspReport, toes: Indices) -> Indices:
        """What poses show, shape (n,)."""
        opposed = opposing(self.foot, touched(self.foot, report.touching))
        merit = np.where(opposed, MERITS["touching"], 0)
        merit = np.where(report.stable, MERITS["feasible"], merit)
        tangent = report.tangent & palmar(report)
        (held,) = least_products(self.foot, tangent, report.normal)
        grasps = np.nan_to_num(held, nan=np.inf) <= PARAMETER_SLACK
        merit = np.where(report.grasping & grasps, MERITS["grasping"], merit)
        return np.where(report.feasible & (merit > 0), merit + toes, 0)


def palmar(report: GraspReport) -> Booleans:
    """Phalanges whose contact is on the palm, the side to which they flex.

    Args:
        report: The report.

    Returns:
        A mask, shape (…, P).
    """
    foot = report.foot
    azimuths = np.array([finger.azimuth for finger in foot.fingers])
    across = np.stack([-np.sin(azimuths), np.cos(azimuths), 0 * azimuths], axis=-1)
    lines = report.bones[..., 1, :] - report.bones[..., 0, :]
    # A bone moves toward its palm as it turns about the flexion's axis.
    toward = np.cross(across[foot.finger_of_phalanx], lines)
    return np.asarray(dot(report.normal, toward) < 0)


def tangent_sides(report: GraspReport) -> NDArray[np.int8]:
    """Sides with which phalanges are tangent.

    Args:
        report: The report.

    Returns:
        `PALM` or `BACK`; 0 where a phalanx is not tangent, shape (…, P).
    """
    sides = np.where(palmar(report), PALM, BACK)
    return np.where(report.tangent, sides, 0).astype(np.int8)


def touched(foot: Foot, phalanges: Booleans) -> Booleans:
    """Fingers of which some phalanx is marked.

    Args:
        foot: The foot.
        phalanges: Marks, shape (…, P).

    Returns:
        Marks of fingers, shape (…, F).
    """
    parts = foot.finger_slices.values()
    return np.stack([phalanges[..., part].any(axis=-1) for part in parts], axis=-1)


def opposing(foot: Foot, fingers: Booleans) -> Booleans:
    """Whether both fingers of some opposable pair are marked.

    Args:
        foot: The foot.
        fingers: Marks, shape (…, F).

    Returns:
        Whether a pair is, shape (…).
    """
    found = np.zeros(fingers.shape[:-1], dtype=bool)
    for i, j in foot.opposable_pairs:
        found |= fingers[..., i] & fingers[..., j]
    return found
