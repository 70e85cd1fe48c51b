"""The work behind an atlas: poses where there are some, proofs where there are none."""

from __future__ import annotations

from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.contact_hull import Criterion
from zygopin.engine import make_engine
from zygopin.foot import Foot
from zygopin.foot_poses import FootPoses
from zygopin.grasp import Criteria, check_grasp
from zygopin.projection import BEHIND, Floats
from zygopin.quarter_turn import grasp_possible
from zygopin.tangent_proof import farthest_wrap
from zygopin.toe_contacts import Answer, Booleans, Codes, ToeSearch
from zygopin.touch import TouchIntervals, touch_intervals
from zygopin.witnesses import Witnesses, opposing


class Survey:
    """What is found out about the branches of a grid, in the order of its parts.

    Attributes:
        foot: The foot.
        grid: The branches.
        witnesses: Poses of the whole foot.
        engine: That which confirms poses, through Pinocchio and FCL.
    """

    def __init__(self, foot: Foot, grid: BranchGrid) -> None:
        self.foot, self.grid = foot, grid
        self.witnesses = Witnesses(foot, grid, Criteria())
        self.search = ToeSearch(foot, grid)
        self.criterion = Criterion(Criteria().metres(foot))
        self.every = (len(foot.fingers), *grid.shape)
        valid = np.broadcast_to(grid.valid, self.every)
        self.toes = self.search.poses(valid)
        rows = np.arange(len(grid.heights))[:, None]
        self.intervals: TouchIntervals = touch_intervals(foot, grid.at(rows, 0))
        parts = self.search, self.toes, self.intervals, self.witnesses
        FootPoses(foot, *parts).join()
        self.engine = make_engine("fcl", foot)
        self.witnesses.confirm(self.engine)
        self.loose, self.loose_controls = self._loose()
        self.tangent = self._tangent()
        self.grasps_left = self._grasps_left()

    @property
    def touchable(self) -> Codes:
        """Whether two opposable fingers touch at once and nothing enters."""
        possible = opposing(self.foot, self._touched) & ~self.entered
        return self._answers(self.witnesses.shows("touching"), possible)

    @property
    def feasible(self) -> Codes:
        """Whether two opposable fingers are tangent at once and nothing enters."""
        possible = self._pairs(self.tangent)
        possible &= (self.touchable != Answer.NO) & (self.stable != Answer.NO)
        return self._answers(self.witnesses.shows("feasible"), possible)

    @property
    def grasping(self) -> Codes:
        """Whether the foot grasps and nothing enters."""
        possible = (self.feasible != Answer.NO) & self.grasps_left
        return self._answers(self.witnesses.shows("grasping"), possible)

    @property
    def stable(self) -> Codes:
        """Whether two opposable fingers are tangent at once, whatever enters."""
        shown = self.witnesses.shows("feasible")
        shown |= np.isfinite(self.loose_controls).all(axis=-1)
        return self._answers(shown, self._pairs(self.loose != Answer.NO))

    @property
    def toe_counts(self) -> NDArray[np.int8]:
        """Fewest and most fingers tangent at once with nothing entering, (H, R, 2)."""
        some = self.tangent & ~self.entered
        most = np.where(self.grid.valid, some.sum(axis=0), 0)
        return np.stack([self.witnesses.toes, most], axis=-1).astype(np.int8)

    @property
    def wraps(self) -> Floats:
        """The largest wrap of a finger, and a bound on it [rad], shape (H, R, 2)."""
        bound = np.full(self.grid.shape, -np.inf)
        for finger, possible in zip(self.search.fingers, self.tangent, strict=True):
            for rank in range(1, len(finger.lengths) + 1):
                most = farthest_wrap(finger, self.grid, rank, self.criterion.tolerance)
                bound = np.maximum(bound, np.where(possible, most, -np.inf))
        found = np.fmax.reduce(self.toes.wrap, axis=0)
        bound = np.minimum(bound, 2 * np.pi + BEHIND)
        bound = np.where(np.isfinite(bound) & self.grid.valid, bound, np.nan)
        return np.stack([found, bound], axis=-1)

    @cached_property
    def entered(self) -> Booleans:
        """Branches that some finger enters whatever it does, shape (H, R)."""
        deepest = self.grid.radii[:, None] - self.criterion.tolerance
        return np.asarray((deepest > self.intervals.most[..., 1]).any(axis=-1))

    @property
    def _touched(self) -> Booleans:
        """Fingers that may touch a branch and not enter it, shape (H, R, F)."""
        radii, tolerance = self.grid.radii[:, None], self.criterion.tolerance
        near = radii + tolerance >= self.intervals.least[..., 0]
        return np.asarray(near & (radii - tolerance <= self.intervals.most[..., 1]))

    def _answers(self, shown: Booleans, possible: Booleans) -> Codes:
        """Yes where shown, no where impossible."""
        unknown = np.where(possible, Answer.UNDECIDED, Answer.NO)
        codes = np.where(shown, Answer.YES, unknown)
        codes = np.where(self.grid.valid, codes, Answer.HOLDS_BASE)
        return codes.astype(np.int8)

    def _pairs(self, fingers: Booleans) -> Booleans:
        """Whether both of some opposable fingers are marked, (F, H, R) to (H, R)."""
        return opposing(self.foot, np.moveaxis(fingers, 0, -1))

    def _tangent(self) -> Booleans:
        """Whether each finger may be tangent with nothing entering, shape (F, H, R).

        Where a pose of the foot is known only the number of toes depends on it: the
        proof is then sought with little work.
        """
        found, shown = self.toes.found, self.witnesses.shows("feasible")
        asked = ~found & self.grid.valid & (self.loose != Answer.NO)
        left = self.search.possible(asked & ~shown, self.criterion)
        left |= self.search.possible(asked & shown, self.criterion, stages=1)
        return np.asarray(found | left)

    def _grasps_left(self) -> Booleans:
        """Branches on which a grasp with the palms was not disproved, shape (H, R)."""
        open_ = self.grid.valid & (self.feasible != Answer.NO)
        open_ &= ~self.witnesses.shows("grasping")
        return grasp_possible(
            self.search,
            self.foot.opposable_pairs,
            open_,
            self.tangent,
            self.toes.wrap,
            self.criterion.tolerance,
        )

    def _loose(self) -> tuple[Codes, Floats]:
        """Tangency of toes that may enter, and stable poses of the foot from it."""
        shown = self.witnesses.shows("feasible")
        asked = np.broadcast_to(self.grid.valid & ~shown, self.every)
        asked = asked & ~self.toes.found
        loose = self.search.contacts(asked, Criterion(self.criterion.tolerance, False))
        answer = np.where(self.toes.found, Answer.YES, loose.answer).astype(np.int8)
        controls = np.full((*self.grid.shape, self.foot.phalanx_count), np.nan)
        cells = np.nonzero(self._pairs(answer == Answer.YES) & ~shown & self.grid.valid)
        poses = self.intervals.most_controls[cells[0], 0]
        for index, part in enumerate(self.foot.finger_slices.values()):
            solid, other = self.toes.found[index][cells], loose.found[index][cells]
            mine = np.where(solid[:, None], self.toes.controls[index][cells], np.nan)
            mine[other] = loose.controls[index][cells][other]
            poses[:, part] = np.where(np.isnan(mine), poses[:, part], mine)
        for engine in (make_engine("exact", self.foot), self.engine):
            held = np.isfinite(poses[:, 0])
            branches = self.grid.at(*(axis[held] for axis in cells))
            report = check_grasp(self.foot, poses[held], branches, engine=engine)
            poses[np.flatnonzero(held)[~report.stable]] = np.nan
        controls[cells] = poses
        return answer, controls
