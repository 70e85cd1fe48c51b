"""A branch at some heights, and the heights at which bounds rule a grasp out."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.branch_grid import BranchGrid
from zygopin.clearance import Floats
from zygopin.foot import Foot
from zygopin.grasp import Criteria
from zygopin.perch_height import lowered
from zygopin.quarter_turn import CLEAR, QUARTER
from zygopin.tangent_poses import FARTHEST
from zygopin.tangent_proof import farthest_wrap
from zygopin.toe_contacts import ToeSearch
from zygopin.touch import TouchIntervals, touch_intervals

Booleans = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Column:
    """A branch at some heights: what can be said there for the least work.

    Attributes:
        foot: The foot.
        branch: The branch, at any height.
        heights: z of its centre, strictly rising or falling [m], shape (H,).
    """

    foot: Foot
    branch: Branch
    heights: Floats

    @cached_property
    def grid(self) -> BranchGrid:
        """The branches as endless ones."""
        branch = self.branch
        return BranchGrid(self.heights, [self.radius], branch.axis, branch.centre[:2])

    @cached_property
    def branches(self) -> Branch:
        """The branches, a batch of shape (H,)."""
        return lowered(self.branch, self.heights)

    @cached_property
    def search(self) -> ToeSearch:
        """The fingers as they see the branches."""
        return ToeSearch(self.foot, self.grid)

    @property
    def tolerance(self) -> float:
        """Clearance that counts as contact [m]."""
        return Criteria().metres(self.foot)

    @property
    def radius(self) -> float:
        """Radius of the branches [m]."""
        return float(np.asarray(self.branch.radius))

    @cached_property
    def opposable(self) -> Booleans:
        """Fingers of some opposable pair, shape (F,)."""
        marks = np.zeros(len(self.foot.fingers), dtype=bool)
        marks[[i for pair in self.foot.opposable_pairs for i in pair]] = True
        return marks

    @cached_property
    def reach(self) -> float:
        """How far from the base toes come, with skin and tolerance [m]."""
        foot = self.foot
        parts = foot.finger_slices.values()
        longest = max(float(foot.lengths[part].sum()) for part in parts)
        return longest + float(foot.radii.max()) + self.tolerance

    @cached_property
    def endless(self) -> Booleans:
        """Where the branch's ends are out of reach: it is as good as endless, (H,)."""
        return np.asarray(self._along + self.reach < self.branches.half_length)

    @cached_property
    def open(self) -> Booleans:
        """Heights at which bounds do not rule a grasp out, shape (H,).

        The branch is out of reach as a whole; or its ends are out of reach, and some
        finger enters it whatever it does, or no two opposite toes touch it, or reach
        a quarter turn round it by their lengths.
        """
        left = self.grid.valid[:, 0] & bool(self.foot.opposable_pairs)
        for possible in (self._in_reach, self._long_enough, self._touchable):
            if left.any():
                left = left & possible(left)
        return left

    @property
    def _along(self) -> Floats:
        """Distance of the branch's middle from the base, along the axis [m], (H,)."""
        return np.asarray(np.abs(self.branches.centre @ self.branch.axis))

    def _in_reach(self, _: Booleans) -> Booleans:
        """Where toes may come to the branch, whatever its length."""
        beyond = np.maximum(self._along - self.branches.half_length, 0.0)
        across = np.maximum(self.branches.base_distance() - self.radius, 0.0)
        return np.asarray(np.hypot(beyond, across) <= self.reach)

    def _long_enough(self, _: Booleans) -> Booleans:
        """Where the lengths of some two opposite toes allow a quarter turn."""
        most = []
        for finger in self.search.fingers:
            ranks = range(1, len(finger.lengths) + 1)
            bounds = [
                farthest_wrap(finger, self.grid, k, self.tolerance) for k in ranks
            ]
            most.append(np.max(bounds, axis=0)[:, 0])
        pairs = self.foot.opposable_pairs
        enough = [most[i] + most[j] >= QUARTER - CLEAR for i, j in pairs]
        return np.asarray(np.any(enough, axis=0) | ~self.endless)

    def _touchable(self, asked: Booleans) -> Booleans:
        """Where every finger can keep out, and some two opposite toes can touch."""
        possible, asked = ~asked | ~self.endless, asked & self.endless
        found = self.intervals
        out = (self.radius - self.tolerance <= found.most[..., 1]).all(axis=-1)
        near = self.radius + self.tolerance >= found.least[..., 0]
        pairs = [near[..., i] & near[..., j] for i, j in self.foot.opposable_pairs]
        return np.asarray(possible | (out & np.any(pairs, axis=0)))

    @cached_property
    def intervals(self) -> TouchIntervals:
        """The radii that each finger can touch, for the branches as endless ones."""
        return touch_intervals(self.foot, self.branches)

    @cached_property
    def farthest(self) -> tuple[Floats, tuple[Floats, ...]]:
        """Poses of each finger, wrapped as far as they are found.

        Wrap [rad], shape (F, H), NaN without a pose; controls of each finger, (H, K).
        """
        return self.aimed(FARTHEST, self.open)

    def aimed(self, aim: float, where: Booleans) -> tuple[Floats, tuple[Floats, ...]]:
        """Poses of each finger, wrapped as near to an angle as they are found.

        Only of fingers that have an opposite one.

        Args:
            aim: The angle [rad].
            where: At which heights, shape (H,).

        Returns:
            As for `farthest`.
        """
        wanted = self.opposable[:, None, None] & where[:, None]
        laid = self.search.poses(wanted, aim=aim)
        wrap, controls = laid.wrap, laid.controls
        return wrap[..., 0], tuple(each[:, 0] for each in controls)
