"""Poses with which one finger lies on many branches, found by search.

Of the controls up to a phalanx all but the last are free; the last is closed form: its
joint turns until the phalanx lies on a tangent from its junction to the circle.
Branches next to one another take poses from each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.laid_contact import lay_on
from zygopin.projection import PALM, Floats, ProjectedFinger

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]

STRIDES = (8, 4, 2, 1)
"""Every how many rows and columns are searched, one grid after the other."""

FEW = 1000
"""Branches up to which no coarser grid is searched first."""

SAMPLES = 700
"""Poses of a regular grid that are tried on each branch of the coarsest search."""

TOGETHER = 8192
"""Poses that are tried in one call."""

STEPS = (0.2, 0.1, 0.05, 0.02, 0.01, 0.003)
"""Sizes of the random steps by which poses are improved, in controls."""

BESIDE = ((-1, 0), (1, 0), (0, -1), (0, 1))
"""Rows and columns to the next branches."""

EDGE_STEPS = 48
"""Steps at the edge of the branches with a pose: it moves on by one in each."""

FEWER = 0.4
"""Share of the joints that some of these steps turn."""

ROUNDING = 1e-12
"""Excess of a pose that fits, over the length of the first phalanx."""

FARTHEST = 2 * np.pi
"""More than how far round any contact lies [rad]."""

NOWHERE = 10.0
"""More than any angle is missed by: poses that do not fit score below −NOWHERE."""


@dataclass(frozen=True, eq=False)
class TangentPoses:
    """Poses of one finger on the branches of a grid, for each phalanx the best one.

    Attributes:
        wrap: How far round the contact lies [rad], shape (K, H, R); NaN without.
        controls: Controls, shape (K, H, R, K): joints behind the tangent phalanx are
            straight, so that nothing beyond it enters the branch.
    """

    wrap: Floats
    controls: Floats

    def best(self, count: int, aim: float) -> tuple[Floats, Floats]:
        """The pose wrapped nearest to an angle, if the finger had so many phalanges.

        Args:
            count: Number of phalanges.
            aim: The angle [rad].

        Returns:
            Wrap, shape (H, R), NaN without; controls, shape (H, R, count).
        """
        missed = np.abs(self.wrap[:count] - aim)
        rank = np.argmin(np.where(np.isnan(missed), np.inf, missed), axis=0)[None]
        wrap = np.take_along_axis(self.wrap[:count], rank, axis=0)[0]
        chosen = np.take_along_axis(self.controls[:count], rank[..., None], axis=0)
        return wrap, chosen[0, ..., :count]


def tangent_poses(
    finger: ProjectedFinger,
    grid: BranchGrid,
    wanted: Booleans,
    *,
    side: int = PALM,
    solid: bool = True,
    aim: float = FARTHEST,
) -> TangentPoses:
    """Poses of a finger on each branch, wrapped as near to an angle as can be found.

    Args:
        finger: The finger, seen along the branches.
        grid: The branches.
        wanted: Branches for which poses are sought, for each phalanx as the tangent
            one, shape (K, H, R).
        side: `PALM` or `BACK`, the side of the toe that touches.
        solid: Keep the phalanges before the tangent one out of the branch.
        aim: The angle [rad].

    Returns:
        The poses; those found are exact up to rounding, none found proves nothing.
    """
    count = len(finger.lengths)
    wrap = np.full((count, *grid.shape), np.nan)
    controls = np.zeros((count, *grid.shape, count))
    ranks = () if finger.edgewise else reversed(range(count))
    sought = [i for i in ranks if wanted[i].any()]
    quest = _Quest(side, solid, aim)
    for i in sought:
        table = _Search(finger, grid, wanted[i], i + 1, quest).run()
        wrap[i] = np.where(table.score > -NOWHERE, table.wrap, np.nan)
        controls[i, ..., :i] = table.free
        controls[i, ..., i] = np.minimum(table.closing, 1.0)  # but for rounding
    return TangentPoses(wrap, controls)


class _Table(NamedTuple):
    """The best pose so far of each branch of a grid."""

    score: Floats
    wrap: Floats
    free: Floats
    closing: Floats

    @classmethod
    def empty(cls, shape: tuple[int, int], rank: int) -> _Table:
        return cls(
            np.full(shape, -np.inf),
            np.zeros(shape),
            np.zeros((*shape, rank - 1)),
            np.zeros(shape),
        )


class _Quest(NamedTuple):
    """What poses are sought."""

    side: int
    solid: bool
    aim: float


@dataclass(frozen=True, eq=False)
class _Search:
    """The search for poses in which one phalanx touches with one side."""

    finger: ProjectedFinger
    grid: BranchGrid
    wanted: Booleans
    rank: int
    quest: _Quest

    def run(self) -> _Table:
        """From the coarse grid to the fine one, each from the poses of the last."""
        # A generator for each search: none depends on what else is searched.
        rng = np.random.default_rng((self.rank, self.quest.side + 1))
        few = self.wanted.sum() <= FEW
        strides = [
            s
            for s in STRIDES
            if s == 1 or (s <= min(self.wanted.shape) // 4 and not few)
        ]
        table, places = self._sampled(strides[0])
        self._improve(table, places, rng)
        for stride in strides[1:]:
            table, places = self._refined(table, places, stride)
            self._improve(table, places, rng)
        self._extend(table, places, rng)
        return table

    def _sampled(self, stride: int) -> tuple[_Table, tuple[Indices, Indices]]:
        """The best of a regular grid of poses."""
        places = self._places(stride)
        table = _Table.empty((len(places[0]), len(places[1])), self.rank)
        where = self._where(places)
        grid = _regular(self.rank - 1)
        # So many at once that the arrays stay in the cache and calls cost little.
        at_once = max(1, TOGETHER // max(len(where[0]), 1))
        for start in range(0, len(grid), at_once):
            self._offer(table, places, where, grid[start : start + at_once, None])
        return table, places

    def _refined(
        self, old: _Table, places: tuple[Indices, Indices], stride: int
    ) -> tuple[_Table, tuple[Indices, Indices]]:
        """A finer grid, each branch with the best of its neighbours' poses."""
        new = self._places(stride)
        table = _Table.empty((len(new[0]), len(new[1])), self.rank)
        where = self._where(new)
        sides: tuple[tuple[Indices, Indices], ...] = tuple(
            (
                np.searchsorted(coarse, fine, side="right") - 1,
                np.searchsorted(coarse, fine, side="left"),
            )
            for coarse, fine in zip(places, new, strict=True)
        )
        for rows, columns in product(*sides):
            self._offer(table, new, where, old.free[rows[where[0]], columns[where[1]]])
        return table, new

    def _improve(
        self,
        table: _Table,
        places: tuple[Indices, Indices],
        rng: np.random.Generator,
    ) -> None:
        """Random steps, and the neighbours' poses."""
        if self.rank == 1:
            return
        where = self._where(places)
        for size in STEPS:
            for _ in range(2):
                free = table.free[where]
                step = size * rng.standard_normal(free.shape)
                self._offer(table, places, where, np.clip(free + step, 0.0, 1.0))
            self._offer_near(table, places, where)

    def _extend(
        self,
        table: _Table,
        places: tuple[Indices, Indices],
        rng: np.random.Generator,
    ) -> None:
        """More steps where there is no pose but one next to it, of all joints or some.

        At the edge of what is possible joints are at their limits: steps of the others
        alone are what leads on. Of few branches each may be at the edge.
        """
        few = self.wanted.sum() <= FEW
        for _ in range(EDGE_STEPS if self.rank > 1 else 0):
            found = table.score > -NOWHERE
            where = np.nonzero(self.wanted & ~found & (_beside(found) | few))
            if not len(where[0]):
                return
            self._offer_near(table, places, where)
            free = table.free[where]
            size = 10 ** rng.uniform(-3, -0.7, (len(free), 1))
            step = size * rng.standard_normal(free.shape)
            step *= rng.random(free.shape) < rng.choice([FEWER, 1.0], (len(free), 1))
            self._offer(table, places, where, np.clip(free + step, 0.0, 1.0))

    def _offer_near(
        self,
        table: _Table,
        places: tuple[Indices, Indices],
        where: tuple[Indices, ...],
    ) -> None:
        """Offer the poses of the branches next to some."""
        for rows, columns in BESIDE:
            near = (
                np.clip(where[0] + rows, 0, len(places[0]) - 1),
                np.clip(where[1] + columns, 0, len(places[1]) - 1),
            )
            self._offer(table, places, where, table.free[near])

    def _places(self, stride: int) -> tuple[Indices, Indices]:
        """Rows and columns of a coarser grid, the last ones included."""
        rows, columns = (
            np.unique(np.append(np.arange(0, n, stride), n - 1))
            for n in self.grid.shape
        )
        return rows, columns

    def _where(self, places: tuple[Indices, Indices]) -> tuple[Indices, ...]:
        """Branches of a coarser grid for which poses are wanted, or near one is."""
        return np.nonzero(self.wanted[np.ix_(*places)])

    def _offer(
        self,
        table: _Table,
        places: tuple[Indices, Indices],
        where: tuple[Indices, ...],
        free: Floats,
    ) -> None:
        """Keep the poses that are better than what the table has.

        Args:
            table: The table.
            places: Rows and columns of the grid that it is for.
            where: Its entries that poses are for, shape (n,) each.
            free: Controls before the closing joint, shape (n, k − 1), or a number of
                sets of them for all entries, shape (s, 1, k − 1).
        """
        rows, columns = places[0][where[0]], places[1][where[1]]
        centre = self.grid.centres(self.finger)[rows]
        radius = self.grid.radii[columns]
        side, solid = self.quest.side, self.quest.solid
        free = np.broadcast_to(free, (*free.shape[:-2], len(rows), free.shape[-1]))
        made = lay_on(self.finger, free, centre, radius, side, solid)
        excess = made.excess / self.finger.lengths[0]
        missed = np.abs(made.wrap - self.quest.aim)
        score = np.where(excess <= ROUNDING, -missed, -NOWHERE - excess)
        wrap, closing = (
            np.broadcast_to(x, score.shape) for x in (made.wrap, made.control)
        )
        if score.ndim == 2:
            best = np.argmax(score, axis=0), np.arange(len(rows))
            score, wrap, closing, free = (
                each[best] for each in (score, wrap, closing, free)
            )
        better = score > table.score[where]
        kept = tuple(axis[better] for axis in where)
        table.score[kept] = score[better]
        table.wrap[kept] = wrap[better]
        table.free[kept] = free[better]
        table.closing[kept] = closing[better]


def _beside(marks: Booleans) -> Booleans:
    """Branches next to marked ones."""
    near = np.zeros_like(marks)
    near[1:] |= marks[:-1]
    near[:-1] |= marks[1:]
    near[:, 1:] |= marks[:, :-1]
    near[:, :-1] |= marks[:, 1:]
    return near


def _regular(count: int) -> Floats:
    """A regular grid of controls, of at most about `SAMPLES` points, (s, count)."""
    if count == 0:
        return np.zeros((1, 0))
    most = int(min(max(SAMPLES ** (1 / count) + 1e-9, 2), 33))
    return np.array(list(product(np.linspace(0.0, 1.0, most), repeat=count)))
