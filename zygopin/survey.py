"""The work behind an atlas: poses where there are some, proofs where there are none."""

from __future__ import annotations

import itertools
from collections.abc import Callable
from dataclasses import replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.contact_hull import Criterion
from zygopin.foot import Foot
from zygopin.grasp import Criteria, check_grasp
from zygopin.projection import BEHIND, Floats
from zygopin.tangent_poses import Aim
from zygopin.tangent_proof import farthest_wrap
from zygopin.toe_contacts import (
    EFFORT,
    Answer,
    Booleans,
    Codes,
    ToeContacts,
    ToePoses,
    ToeSearch,
)
from zygopin.touch import TouchIntervals, touch_intervals
from zygopin.touching import touching_controls
from zygopin.witnesses import Witnesses, opposing

AIMS = (1.2, 0.8, 1.7, 0.3, 2.4, 1.0, 1.4, 2.0, 0.55)
"""Angles to which toes are wrapped in turn [rad] where toes that are wrapped as far
as can be run into each other."""

SHARE = 0.499
"""Share of what two toes lack to a grasp that each is asked to be unable to make up."""

Progress = Callable[[str], None]


class Survey:
    """What is found out about the branches of a grid, in the order of its parts.

    Attributes:
        foot: The foot.
        grid: The branches.
        witnesses: Poses of the whole foot.
    """

    def __init__(self, foot: Foot, grid: BranchGrid, progress: Progress) -> None:
        self.foot, self.grid = foot, grid
        self.witnesses = Witnesses(foot, grid, Criteria())
        self.search = ToeSearch(foot, grid)
        self.criterion = Criterion(Criteria().metres(foot))
        self.every = (len(foot.fingers), *grid.shape)
        progress("poses of single toes")
        valid = np.broadcast_to(grid.valid, self.every)
        self.toes = self.search.contacts(valid, self.criterion)
        progress("touch intervals")
        rows = np.arange(len(grid.heights))[:, None]
        self.intervals: TouchIntervals = touch_intervals(foot, grid.at(rows, 0))
        progress("poses of the foot")
        self._join_tangent()
        self._join_touching()
        progress("no grasp: proofs")
        self.grasps_left = self._grasps_left()
        self._try_harder()
        progress("stable poses that enter the branch")
        self.loose, self.loose_controls = self._loose()

    @property
    def touchable(self) -> Codes:
        """Whether two opposable fingers touch at once and nothing enters."""
        near = self._by_finger(self.intervals.out_of_touch(self.grid.radii))
        possible = opposing(self.foot, ~near) & ~self.entered
        return self._answers(self.witnesses.shows("touching"), possible)

    @property
    def feasible(self) -> Codes:
        """Whether two opposable fingers are tangent at once and nothing enters."""
        possible = self._pairs(self.toes.answer != Answer.NO) & ~self.entered
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
        some = (self.toes.answer != Answer.NO) & ~self.entered
        most = np.where(self.grid.valid, some.sum(axis=0), 0)
        return np.stack([self.witnesses.toes, most], axis=-1).astype(np.int8)

    @property
    def wraps(self) -> Floats:
        """The largest wrap of a finger, and a bound on it [rad], shape (H, R, 2)."""
        bound = np.full(self.grid.shape, -np.inf)
        for finger, answer in zip(self.search.fingers, self.toes.answer, strict=True):
            for rank in range(1, len(finger.lengths) + 1):
                most = farthest_wrap(finger, self.grid, rank, self.criterion.tolerance)
                bound = np.maximum(bound, np.where(answer != Answer.NO, most, -np.inf))
        found = np.fmax.reduce(self.toes.wrap, axis=0)
        bound = np.minimum(bound, 2 * np.pi + BEHIND)
        bound = np.where(np.isfinite(bound) & self.grid.valid, bound, np.nan)
        return np.stack([found, bound], axis=-1)

    @cached_property
    def entered(self) -> Booleans:
        """Branches that some finger enters whatever it does, shape (H, R)."""
        radii = self.grid.radii[:, None]
        return np.asarray((radii > self.intervals.most[..., 1]).any(axis=-1))

    def _answers(self, shown: Booleans, possible: Booleans) -> Codes:
        """Yes where shown, no where impossible."""
        unknown = np.where(possible, Answer.UNDECIDED, Answer.NO)
        codes = np.where(shown, Answer.YES, unknown)
        codes = np.where(self.grid.valid, codes, Answer.HOLDS_BASE)
        return codes.astype(np.int8)

    def _pairs(self, fingers: Booleans) -> Booleans:
        """Whether both of some opposable fingers are marked, (F, H, R) to (H, R)."""
        return opposing(self.foot, np.moveaxis(fingers, 0, -1))

    def _join_tangent(self) -> None:
        """Poses of the foot from those of its toes, until no more is in sight."""
        tried: list[ToePoses] = [self.toes]
        self._try(self.toes, self._pairs(self.toes.found))
        for aim in AIMS:
            unmet = self._unmet
            if unmet.any():
                asked = np.broadcast_to(unmet, self.every) & self.toes.found
                tried.append(self.search.poses(asked, aim=Aim(aim)))
                self._try(tried[-1], unmet)
        for one, other in itertools.permutations(tried, 2):
            self._try_pairs(one, other)

    @property
    def _unmet(self) -> Booleans:
        """Branches on which toes by themselves show more than the foot so far."""
        wrap = self.toes.wrap
        grasps = np.zeros(self.grid.shape, dtype=bool)
        for i, j in self.foot.opposable_pairs:
            grasps |= self._between(i, j, wrap[i], wrap[j]) <= 0
        unmet = self._pairs(self.toes.found) & ~self.witnesses.shows("feasible")
        return unmet | (grasps & ~self.witnesses.shows("grasping"))

    def _between(self, i: int, j: int, one: Floats, other: Floats) -> Floats:
        """Cosine of the angle between contacts of two fingers, from their wraps."""
        turned = one + other if self._opposed(i, j) else one - other
        return np.asarray(np.cos(turned))

    def _opposed(self, i: int, j: int) -> bool:
        """Whether two fingers flex around the branch in opposite senses."""
        frames = (self.search.fingers[k].frame for k in (i, j))
        senses = [np.cross(*frame) @ self.grid.axis for frame in frames]
        return bool(senses[0] * senses[1] < 0)

    def _try_harder(self) -> None:
        """More poses where a grasp is in doubt, and the proof again."""
        left = self.grasps_left & ~self.witnesses.shows("grasping")
        if not left.any():
            return
        asked = np.broadcast_to(left, self.every)
        more = self.search.poses(asked, aim=Aim(effort=EFFORT))
        self._try(more, left)
        joined = self.toes.joined(more)
        answer = np.where(joined.found, Answer.YES, self.toes.answer).astype(np.int8)
        self.toes = ToeContacts(joined.found, joined.wrap, joined.controls, answer)
        self.grasps_left = self._grasps_left()

    def _try(self, poses: ToePoses, where: Booleans) -> None:
        """All toes that have a pose at once, then pairs of them; the others rest."""
        self._offer(poses.found, poses.controls, where)
        self._try_pairs(poses, poses)

    def _try_pairs(self, poses: ToePoses, others: ToePoses) -> None:
        """A toe as in some poses and an opposable one as in others; the rest rest."""
        for i, j in self.foot.opposable_pairs:
            where = self._unmet & poses.found[i] & others.found[j]
            pair = np.zeros(self.every, dtype=bool)
            pair[[i, j]] = True
            controls = list(poses.controls)
            controls[j] = others.controls[j]
            self._offer(pair, tuple(controls), where)

    def _offer(
        self, used: Booleans, controls: tuple[Floats, ...], where: Booleans
    ) -> None:
        """Offer poses of the foot: some fingers have poses, the others keep away."""
        cells = np.nonzero(where)
        poses = self.intervals.most_controls[cells[0], 0]
        for index, part in enumerate(self.foot.finger_slices.values()):
            mine = used[index][cells][:, None]
            poses[:, part] = np.where(mine, controls[index][cells], poses[:, part])
        self.witnesses.offer(cells, poses)

    def _join_touching(self) -> None:
        """Poses in which opposable fingers touch, where no tangent ones were found."""
        near = self._by_finger(self.intervals.touchable(self.grid.radii))
        near = np.moveaxis(near, -1, 0)
        left = self._pairs(near) & self.grid.valid & ~self.witnesses.shows("touching")
        if not left.any():
            return
        found = touching_controls(self.intervals, self.grid.radii)
        parts = self.foot.finger_slices.values()
        controls = tuple(found.controls[..., part] for part in parts)
        self._offer(near, controls, left)
        for i, j in self.foot.opposable_pairs:
            pair = np.zeros_like(near)
            pair[[i, j]] = near[[i, j]]
            left = near[i] & near[j] & self.grid.valid
            self._offer(pair, controls, left & ~self.witnesses.shows("touching"))

    def _by_finger(self, marks: Booleans) -> Booleans:
        """Marks of fingers on the whole grid, shape (H, R, F)."""
        return np.broadcast_to(marks, (*self.grid.shape, len(self.foot.fingers)))

    def _grasps_left(self) -> Booleans:
        """Branches on which a grasp with the palms was not disproved, shape (H, R).

        Contacts of toes that flex around the branch in opposite senses are a quarter
        turn apart only if their wraps add up to one, or to one back.
        """
        left = np.zeros(self.grid.shape, dtype=bool)
        open_ = self.grid.valid & (self.feasible != Answer.NO)
        open_ &= ~self.witnesses.shows("grasping")
        for sense in (1, -1):
            criterion = replace(self.criterion, palmar=True, sense=sense)
            beyond, hopeless = self._lacking(open_ & ~left, sense)
            asked = np.isfinite(beyond) & open_ & ~hopeless
            found = self.search.possible(asked, criterion, beyond)
            left |= open_ & (hopeless | found.any(axis=0))
        return left

    def _lacking(self, open_: Booleans, sense: int) -> tuple[Floats, Booleans]:
        """How far two toes would have to be wrapped, one of them at least.

        What the poses found lack to a quarter turn is shared out among the two: if
        neither can make up its part, both together cannot.

        Args:
            open_: Branches in question, shape (H, R).
            sense: 1 for contacts far round, −1 for contacts back.

        Returns:
            Wraps times the sense [rad], shape (F, H, R), infinite where nothing is
            asked; branches for which this proves nothing, shape (H, R).
        """
        possible = self.toes.answer != Answer.NO
        wrap = np.where(np.isnan(self.toes.wrap), BEHIND, sense * self.toes.wrap)
        if sense < 0:
            wrap = np.maximum(wrap, -np.pi / 4)
        beyond = np.full(self.every, np.inf)
        hopeless = np.zeros(self.grid.shape, dtype=bool)
        for i, j in self.foot.opposable_pairs:
            both = open_ & possible[i] & possible[j]
            lack = np.pi / 2 - wrap[i] - wrap[j]
            provable = both & (lack >= 0) & self._opposed(i, j)
            hopeless |= both & ~provable
            for finger in (i, j):
                least = np.where(provable, wrap[finger] + SHARE * lack, np.inf)
                beyond[finger] = np.minimum(beyond[finger], least)
        return beyond, hopeless

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
        report = check_grasp(self.foot, poses, self.grid.at(*cells))
        poses[~report.stable] = np.nan
        controls[cells] = poses
        return answer, controls
