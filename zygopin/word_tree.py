"""Exact search of the word tree of a finite control set.

A word v₁…vⱼ pins all that follows to a disc, which prunes it. The last two joints are
not searched: which levels bring the last junction to within reach of the target is
two-link inverse kinematics, and the last level is the nearest one on a circle.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from zygopin.control_system import ControlSystem
from zygopin.word_answer import ROUNDING, Goal, WordAnswer, answer, arc_discs

BEAM = 64
"""Most promising nodes that are followed first, to have a distance to prune by."""

CHUNK = 4096
"""Nodes that are expanded at once."""

ANGLE_MARGIN = 1e-9
"""What an interval of joint angles is widened by, against rounding [rad]."""


@dataclass(frozen=True)
class Nodes:
    """Words of one length.

    Attributes:
        length: Number of controls j of each.
        place: The junctions xⱼ, shape (m,).
        step: The vectors xⱼ − xⱼ₋₁ of the last phalanges, shape (m,).
        digits: The words, as indices of levels, shape (m, j).
        bound: Least distance from the target that what follows can have, shape (m,).
        offset: Distance of the target from the disc's centre, shape (m,).
    """

    length: int
    place: NDArray[np.complex128]
    step: NDArray[np.complex128]
    digits: NDArray[np.int32]
    bound: NDArray[np.float64]
    offset: NDArray[np.float64]

    def take(self, which: NDArray[np.intp] | slice) -> Nodes:
        """Some of the nodes."""
        return Nodes(
            self.length,
            self.place[which],
            self.step[which],
            self.digits[which],
            self.bound[which],
            self.offset[which],
        )


def search_words(system: ControlSystem, goal: Goal) -> WordAnswer:
    """Search the word tree of a finite control set.

    Args:
        system: The contractions, of a finite control set.
        goal: The query.

    Returns:
        The answer; with the tree exhausted it is exact.
    """
    search = _Search(system, goal)
    search.dive()
    search.sweep()
    controls = system.finite_levels[search.best_word]
    return answer(system, goal, controls, search.open_bound, search.visited)


@dataclass
class _Search:
    """One search: the best word so far, and what has been left out."""

    system: ControlSystem
    goal: Goal
    best: float = np.inf
    open_bound: float = np.inf
    visited: int = 0
    best_word: NDArray[np.intp] = field(default_factory=lambda: np.zeros(0, np.intp))

    def __post_init__(self) -> None:
        self.factors = self.system.factors
        self.angles = self.system.omega * self.system.finite_levels
        self.centres, self.radii = arc_discs(self.system, self.goal.depth)
        reach = self.system.tail(0, self.goal.depth) + abs(self.goal.target)
        self.margin = ROUNDING * reach
        self.branches = max(self.goal.depth - 2, 0)

    @property
    def limit(self) -> float:
        """Distance beyond which a word is of no use."""
        if self.goal.nearest:
            return self.best
        return self.goal.tolerance + 2 * self.margin

    @property
    def done(self) -> bool:
        """Whether the goal is met, or may not be pursued further."""
        met = not self.goal.nearest and self.best <= self.goal.tolerance
        return met or self.visited >= self.goal.max_nodes

    def dive(self) -> None:
        """Follow the most promising nodes only, down to a first word."""
        nodes = self.root()
        while nodes.length < self.branches:
            nodes = self.children(nodes)
            if len(nodes.place) > BEAM:
                nodes = nodes.take(np.argpartition(nodes.offset, BEAM)[:BEAM])
        self.finish(nodes, np.inf)

    def sweep(self) -> None:
        """Go through the whole tree, but for what the bounds rule out."""
        stack = [self.root()]
        while stack and not self.done:
            nodes = self.pruned(stack.pop())
            if nodes.length == self.branches:
                self.finish(nodes, self.limit)
            else:
                stack.extend(self.chunks(self.pruned(self.children(nodes))))
        for nodes in stack:
            self.leave(nodes.bound)

    def root(self) -> Nodes:
        """The empty word."""
        start = np.array([self.system.turn])
        return self.bounded(0, np.zeros(1, complex), start, np.zeros((1, 0), np.int32))

    def children(self, nodes: Nodes) -> Nodes:
        """Every node's words with one more control."""
        count = len(self.factors)
        step = np.multiply.outer(nodes.step, self.factors)
        place = (nodes.place[:, None] + step).ravel()
        digits = np.empty((len(place), nodes.length + 1), np.int32)
        digits[:, :-1] = np.repeat(nodes.digits, count, axis=0)
        digits[:, -1] = np.tile(np.arange(count, dtype=np.int32), len(nodes.place))
        return self.bounded(nodes.length + 1, place, step.ravel(), digits)

    def bounded(
        self,
        length: int,
        place: NDArray[np.complex128],
        step: NDArray[np.complex128],
        digits: NDArray[np.int32],
    ) -> Nodes:
        """Nodes with their bounds."""
        self.visited += len(place)
        centre = place + self.centres[length] * step
        offset = np.abs(self.goal.target - centre)
        bound = offset - self.radii[length] - self.margin
        return Nodes(length, place, step, digits, bound, offset)

    def pruned(self, nodes: Nodes) -> Nodes:
        """The nodes that may still be of use."""
        useful = nodes.bound <= self.limit
        self.leave(nodes.bound[~useful])
        return nodes.take(np.flatnonzero(useful))

    def leave(self, bounds: NDArray[np.float64]) -> None:
        """Account for words that are left out, from bounds on their distance."""
        self.open_bound = min(self.open_bound, float(bounds.min(initial=np.inf)))

    def chunks(self, nodes: Nodes) -> Iterator[Nodes]:
        """The nodes in pieces, the most promising last."""
        nodes = nodes.take(np.argsort(-nodes.offset))
        size = CHUNK if nodes.length == self.branches else CHUNK // len(self.factors)
        for start in range(0, len(nodes.place), max(size, 1)):
            yield nodes.take(slice(start, start + max(size, 1)))

    def finish(self, nodes: Nodes, limit: float) -> None:
        """Close the last two joints of nodes, leaving out words beyond a limit."""
        if not len(nodes.place):
            return
        if self.goal.depth > 1:
            nodes = self.elbows(nodes, limit)
            self.leave(np.array([limit]))
        if len(nodes.place):
            self.close(nodes)

    def elbows(self, nodes: Nodes, limit: float) -> Nodes:
        """The last but one control: each level from which the target is in reach.

        In units of the last phalanx, with the target at w: the elbow must be at a
        distance from w that differs from the last length by no more than the limit,
        which the law of cosines turns into intervals of the joint angle.
        """
        rho = self.system.rho
        wanted = (self.goal.target - nodes.place) / nodes.step
        slack = (limit + self.margin) / np.abs(nodes.step)
        reach = np.abs(wanted)
        near = np.maximum(rho**-2 - slack, 0)
        with np.errstate(over="ignore"):
            cosines = [
                (reach**2 + rho**-2 - length**2) / np.maximum(2 * reach / rho, 1e-300)
                for length in (rho**-2 + slack, near)
            ]
        most, least = np.arccos(np.clip(cosines, -1, 1))
        empty = (cosines[0] > 1 + ROUNDING) | (cosines[1] < -1 - ROUNDING)
        owner, level = self.levels_between(-np.angle(wanted), least, most, ~empty)
        step = nodes.step[owner] * self.factors[level]
        digits = np.column_stack([nodes.digits[owner], level]).astype(np.int32)
        return self.bounded(nodes.length + 1, nodes.place[owner] + step, step, digits)

    def levels_between(
        self,
        middle: NDArray[np.float64],
        least: NDArray[np.float64],
        most: NDArray[np.float64],
        good: NDArray[np.bool_],
    ) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
        """Pairs (node, level) whose angle is from least to most off the middle."""
        turns = np.array([0.0, 2 * np.pi])[:, None]
        low = np.concatenate([middle + least + turns, middle - most + turns])
        high = np.concatenate([middle + most + turns, middle - least + turns])
        first = np.searchsorted(self.angles, low - ANGLE_MARGIN, "left")
        last = np.searchsorted(self.angles, high + ANGLE_MARGIN, "right")
        count = np.where(good, np.maximum(last - first, 0), 0)
        owner = np.broadcast_to(np.arange(len(middle)), count.shape)
        total = np.cumsum(count) - count.ravel()
        inside = np.arange(count.sum()) - np.repeat(total, count.ravel())
        level = np.repeat(first.ravel(), count.ravel()) + inside
        return np.repeat(owner.ravel(), count.ravel()), level

    def close(self, nodes: Nodes) -> None:
        """The last control: the level next to the target's direction, on a circle."""
        wanted = (self.goal.target - nodes.place) / nodes.step
        angle = np.mod(-np.angle(wanted), 2 * np.pi)
        after = np.searchsorted(self.angles, angle)
        level = np.stack([after - 1, after]) % len(self.angles)
        distance = np.abs(wanted - self.factors[level]) * np.abs(nodes.step)
        row, column = np.unravel_index(np.argmin(distance), distance.shape)
        if distance[row, column] < self.best:
            self.best = float(distance[row, column])
            word = [*nodes.digits[column], level[row, column]]
            self.best_word = np.array(word, dtype=np.intp)
