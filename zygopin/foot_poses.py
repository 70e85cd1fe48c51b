"""Poses of the whole foot on the branches of a grid, joined from those of its toes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from zygopin.foot import Foot
from zygopin.grasp import check_grasp
from zygopin.perch_combinations import all_poses, combinations
from zygopin.projection import Floats
from zygopin.propagation import propagate, turned
from zygopin.quarter_turn import QUARTER
from zygopin.relaid import Indices, relaid
from zygopin.toe_contacts import Booleans, ToePoses, ToeSearch
from zygopin.touch import TouchIntervals
from zygopin.touching import touching_controls
from zygopin.witnesses import MERITS, Witnesses, opposing, tangent_sides

MOST_PLANS = 12
"""Branches for which the whole foot's pose is planned, where toes by themselves could
grasp and no pose that was moved there does: about a tenth of a second each."""

LEVELS = 7
"""Angles tried at each joint in such a plan."""

WAYS = 40
"""Ways in which a toe is laid on a branch that another one only touches."""

PLANS = 3
"""Best combinations of the toes' poses that are checked for each plan."""


@dataclass(frozen=True, eq=False)
class FootPoses:
    """What poses of the whole foot are made of.

    Attributes:
        foot: The foot.
        search: Its fingers, seen along the branches.
        toes: A pose of each finger on each branch.
        intervals: The radii that fingers can touch, for each height, batch (H, 1).
        witnesses: Where poses are offered.
    """

    foot: Foot
    search: ToeSearch
    toes: ToePoses
    intervals: TouchIntervals
    witnesses: Witnesses

    def join(self) -> None:
        """Offer poses of the foot until no more is in sight."""
        self._try()
        propagate(self.witnesses, self.search.fingers, self._goal)
        self._plan()
        propagate(self.witnesses, self.search.fingers, self._goal)
        self._join_touching()

    @cached_property
    def _goal(self) -> Indices:
        """What the poses of toes by themselves let hope for, shape (H, R)."""
        wrap = self.toes.wrap
        goal = np.where(self._pairs(self.toes.found), MERITS["feasible"], 0)
        for i, j in self.foot.opposable_pairs:
            # Toes that are wrapped farther than a quarter turn mostly need not be.
            around = (wrap[i] + wrap[j] >= QUARTER) & self.search.opposed(i, j)
            goal = np.where(around, MERITS["grasping"], goal)
        return goal

    @property
    def _unmet(self) -> Booleans:
        """Branches on which toes by themselves show more than the foot so far."""
        return np.asarray(self.witnesses.merit < self._goal)

    def _plan(self) -> None:
        """Plan poses for one unmet branch in each block of them, of few blocks."""
        rows, columns = np.nonzero(self._unmet)
        first, size = np.arange(len(rows)), 1
        while len(first) > MOST_PLANS:
            size *= 2
            blocks = np.stack([rows // size, columns // size])
            _, first = np.unique(blocks, axis=1, return_index=True)
        if not len(first):
            return
        cells = rows[first], columns[first]
        poses = all_poses(self.foot, self.witnesses.grid.at(*cells), LEVELS)
        for place in range(len(first)):
            here = [each.take(each.place == place) for each in poses]
            best = combinations(self.foot, here).poses[:PLANS]
            chosen = zip(here, best.T, strict=True)
            controls = np.concatenate([x.controls[row] for x, row in chosen], axis=-1)
            row, column = (np.full(len(controls), axis[place]) for axis in cells)
            self.witnesses.offer((row, column), controls)

    def _try(self) -> None:
        """All toes that have a pose at once, then pairs of them; the others rest."""
        found, controls = self.toes.found, self.toes.controls
        self._offer(found, controls, self._unmet)
        for i, j in self.foot.opposable_pairs:
            pair = np.zeros_like(found)
            pair[[i, j]] = True
            self._offer(pair, controls, self._unmet & found[i] & found[j])

    def _offer(
        self, used: Booleans, controls: Sequence[Floats], where: Booleans
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
        grid = self.witnesses.grid
        near = np.moveaxis(self.intervals.touchable(grid.radii), -1, 0)
        left = self._pairs(near) & ~self.witnesses.shows("touching") & grid.valid
        if not left.any():
            return
        found = touching_controls(self.intervals, grid.radii)
        parts = self.foot.finger_slices.values()
        touching = [found.controls[..., part] for part in parts]
        self._offer(near, touching, left)
        for i, j in self.foot.opposable_pairs:
            pair = np.zeros_like(near)
            pair[[i, j]] = near[[i, j]]
            left = near[i] & near[j] & ~self.witnesses.shows("touching")
            self._offer(pair, touching, left & grid.valid)
            for one, other in ((i, j), (j, i)):
                left = near[one] & ~self.witnesses.shows("touching") & grid.valid
                self._lay_beside(one, other, touching[one], left)

    def _lay_beside(
        self, one: int, other: int, touching: Floats, where: Booleans
    ) -> None:
        """Where one toe touches, lay an opposite one on the branch, in many ways."""
        grid = self.witnesses.grid
        where = where & self.toes.found[other]
        if not where.any():
            return
        rows, columns = np.nonzero(where)
        cells = rows, columns
        poses = self.intervals.most_controls[rows, 0]
        mine, its = (list(self.foot.finger_slices.values())[k] for k in (one, other))
        poses[:, mine] = touching[cells]
        poses[:, its] = self.toes.controls[other][cells]
        sides = tangent_sides(check_grasp(self.foot, poses, grid.at(*cells)))
        self.witnesses.offer(cells, poses)
        rng, fixed = np.random.default_rng(0), np.ones(poses.shape[1], dtype=bool)
        fixed[its], sides[:, fixed] = False, 0
        for _ in range(WAYS):
            left = np.flatnonzero(~self.witnesses.shows("touching")[cells])
            if not len(left):
                return
            here = rows[left], columns[left]
            tried = np.where(fixed, poses[left], turned(poses[left], rng))
            moved = relaid(self.search.fingers, grid, here, tried, sides[left])
            self.witnesses.offer(here, moved)

    def _pairs(self, fingers: Booleans) -> Booleans:
        """Whether both of some opposable fingers are marked, (F, H, R) to (H, R)."""
        return opposing(self.foot, np.moveaxis(fingers, 0, -1))
