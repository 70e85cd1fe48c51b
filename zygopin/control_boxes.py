"""Branch and bound over controls in the interval [0, 1].

A box of the first k−1 controls pins the last junction to a disc (the direction of each
phalanx lies on an arc) and the last phalanx to an arc, whose distance from the target
is closed form. Near the nearest point that bound is loose by the size of the box; the
tip's coordinate away from the target, expanded to second order, is not. Witnesses come
from descent joint by joint, which is closed form too.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from zygopin.control_system import ControlSystem
from zygopin.word_answer import ROUNDING, Goal, WordAnswer, answer, tip

BATCH = 1024
"""Boxes that are halved at once."""

STARTS = 8
"""Most promising boxes of a batch from which a witness is sought."""

SWEEPS = 12
"""Passes over all joints for one witness."""

TINY = 1e-300
"""Keeps a division by a length or determinant of zero finite."""


@dataclass(frozen=True)
class Boxes:
    """Boxes of the first k−1 controls.

    Attributes:
        middle: Middles, shape (m, k−1).
        half: Half widths, shape (m, k−1).
        bound: Least distance from the target that each can have, shape (m,).
    """

    middle: NDArray[np.float64]
    half: NDArray[np.float64]
    bound: NDArray[np.float64]

    def take(self, which: NDArray[np.intp] | NDArray[np.bool_]) -> Boxes:
        """Some of the boxes."""
        return Boxes(self.middle[which], self.half[which], self.bound[which])


def search_boxes(system: ControlSystem, goal: Goal) -> WordAnswer:
    """Search the controls in [0, 1] by branch and bound.

    Args:
        system: The contractions; its levels are not looked at.
        goal: The query.

    Returns:
        The answer; with all boxes ruled out, its lower bound is within the tolerance
        of its distance, or beyond the tolerance.
    """
    search = BoxSearch(system, goal)
    open_bound = search.run()
    return answer(system, goal, search.best_controls, open_bound, search.visited)


def descend(
    system: ControlSystem, target: complex, controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Controls nearer to a target: descent joint by joint, and Newton steps.

    Turning one joint moves the tip on a circle, so its best angle is closed form.
    The Newton step is the shortest one that would close the gap, cut at the limits,
    and is taken where it helps.

    Args:
        system: The contractions.
        target: The point x + iz.
        controls: Starts, in [0, 1], shape (m, k).

    Returns:
        Controls in [0, 1], none farther from the target than its start, shape (m, k).
    """
    controls = controls.copy()
    for _ in range(SWEEPS):
        for joint in reversed(range(controls.shape[1])):
            controls[:, joint] = _turned(system, target, controls, joint)
        stepped = _newton(system, target, controls)
        better = _gap(system, target, stepped) < _gap(system, target, controls)
        controls[better] = stepped[better]
    return controls


@dataclass
class BoxSearch:
    """One search: the best controls so far.

    Attributes:
        system: The contractions; its levels are not looked at.
        goal: The query.
        visited: Boxes that were bounded.
        descended: How many there were when a witness was last sought.
        best: Least distance of a witness.
        best_controls: Its controls, shape (k,).
    """

    system: ControlSystem
    goal: Goal
    visited: int = 0
    descended: int = 0
    best: float = np.inf
    best_controls: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))

    def __post_init__(self) -> None:
        self.rank = np.arange(1.0, self.goal.depth + 1)
        self.lengths = self.system.rho**-self.rank
        self.reaches = np.cumsum(self.lengths[::-1])[::-1]
        self.margin = ROUNDING * (
            self.system.tail(0, self.goal.depth) + abs(self.goal.target)
        )

    @property
    def limit(self) -> float:
        """Distance beyond which a box is of no use."""
        if self.goal.nearest:
            return self.best - self.goal.tolerance
        return self.goal.tolerance + 2 * self.margin

    def run(self) -> float:
        """Halve boxes until the goal is met, none is left, or nodes run out.

        Returns:
            Least distance that what was not searched could have.
        """
        dimensions = self.goal.depth - 1
        half = np.full((1, dimensions), 0.5)
        boxes = self.bounded(half.copy(), half)
        self.witness(boxes)
        left = np.inf
        while dimensions and len(boxes.bound) and not self.done:
            useful = boxes.bound <= self.limit
            left = min(left, float(boxes.bound[~useful].min(initial=np.inf)))
            boxes = self.refined(boxes.take(useful))
        if not dimensions:
            return self.best
        return min(left, float(boxes.bound.min(initial=np.inf)))

    @property
    def done(self) -> bool:
        """Whether the goal is met, or may not be pursued further."""
        met = self.best <= self.goal.tolerance
        return met or self.visited >= self.goal.max_nodes

    def refined(self, boxes: Boxes) -> Boxes:
        """The boxes with the most promising of them halved."""
        order = np.argsort(boxes.bound)
        chosen, rest = boxes.take(order[:BATCH]), boxes.take(order[BATCH:])
        if not len(chosen.bound):
            return chosen
        halves = self.halved(chosen)
        self.witness(halves)
        return Boxes(
            np.concatenate([halves.middle, rest.middle]),
            np.concatenate([halves.half, rest.half]),
            np.concatenate([halves.bound, rest.bound]),
        )

    def halved(self, boxes: Boxes) -> Boxes:
        """Both halves of each box, across the control that moves the tip most."""
        row = np.arange(len(boxes.bound))
        widest = np.argmax(boxes.half * self.reaches[:-1], axis=1)
        half = boxes.half.copy()
        half[row, widest] /= 2
        shift = np.zeros_like(half)
        shift[row, widest] = half[row, widest]
        middle = np.concatenate([boxes.middle - shift, boxes.middle + shift])
        return self.bounded(middle, np.concatenate([half, half]))

    def bounded(self, middle: NDArray[np.float64], half: NDArray[np.float64]) -> Boxes:
        """Boxes with their bounds."""
        self.visited += len(middle)
        omega = self.system.omega
        pitch = omega * np.cumsum(middle, axis=1)
        spread = omega * np.cumsum(half, axis=1)
        tilt = np.minimum(spread, np.pi / 2)
        weight = self.lengths[:-1]
        vectors = weight * np.cos(tilt) * np.exp(-1j * pitch)
        centre = self.system.turn * vectors.sum(axis=1)
        radius = np.sum(weight * np.sin(tilt), axis=1)
        last = (pitch[:, -1], spread[:, -1]) if weight.size else (0.0, 0.0)
        axis = self.system.turn * np.exp(-1j * (last[0] + omega / 2))
        wanted = (self.goal.target - centre) / (axis * self.lengths[-1])
        distance = self.lengths[-1] * _arc_distance(wanted, last[1] + omega / 2)
        bound = distance - radius
        if weight.size:
            bound = np.maximum(bound, self.away(pitch, half))
        return Boxes(middle, half, bound - self.margin)

    def away(
        self, pitch: NDArray[np.float64], half: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Least coordinate of the tip, seen from the target, along one direction.

        The direction is that of the tip with the middle's controls and the best last
        one. Of all last controls the best is 0, or 1, or the one with which the last
        phalanx points along the direction, toward the target.
        """
        omega, lengths = self.system.omega, self.lengths
        target = self.goal.target / self.system.turn
        junction = np.exp(-1j * pitch) @ lengths[:-1]
        arc = np.exp(-1j * (pitch[:, -1] + omega / 2))
        bend = np.clip(np.angle((target - junction) / arc), -omega / 2, omega / 2)
        direction = np.angle(junction + lengths[-1] * arc * np.exp(1j * bend) - target)
        angles = -pitch - direction[:, None]
        sweep = omega * half.sum(axis=1)
        ends = [
            self.least_sum(np.column_stack([angles, angles[:, -1] - turn]), half)
            for turn in (0.0, omega)
        ]
        straight = self.least_sum(angles, half) - lengths[-1]
        off = np.angle(-arc * np.exp(-1j * direction))
        straight[np.abs(off) > omega / 2 + sweep] = np.inf
        least = np.minimum(np.minimum(*ends), straight)
        return np.asarray(least - np.real(target * np.exp(-1j * direction)))

    def least_sum(
        self, angles: NDArray[np.float64], half: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """Bound on Σ ℓⱼ cos θⱼ over boxes of controls, by Taylor's theorem.

        Controls v₁ … vₖ turn phalanx k back by ω(v₁ + … + vₖ): the slopes are
        ωΣ ℓⱼ sin θⱼ over the phalanges from a control on, the curvatures −ℓⱼ cos θⱼ.

        Args:
            angles: θⱼ at the boxes' middles, of all phalanges or all but the last,
                shape (m, k) or (m, k−1).
            half: Half widths, shape (m, k−1); the last control does not move.
        """
        count = angles.shape[1]
        lengths = self.lengths[:count]
        spread = self.system.omega * np.cumsum(half, axis=1)
        spread = np.column_stack([spread, spread[:, -1]])[:, :count]
        cosine = np.cos(angles)
        slopes = np.cumsum((lengths * np.sin(angles))[:, ::-1], axis=1)[:, ::-1]
        moves = self.system.omega * half * np.abs(slopes[:, : half.shape[1]])
        curvature = np.clip(cosine + spread, 0, 1)
        bends = curvature * spread**2 / 2
        return np.asarray((cosine - bends) @ lengths - moves.sum(axis=1))

    def witness(self, boxes: Boxes) -> None:
        """Look for better controls from the middles of the most promising boxes.

        Each time that twice as many boxes were visited: a descent costs more than a
        hundred bounds.
        """
        if self.visited < 2 * self.descended:
            return
        self.descended = self.visited
        rows = np.argsort(boxes.bound)[:STARTS]
        middle = boxes.middle[rows]
        starts = np.column_stack([middle, np.full(len(middle), 0.5)])
        for controls in descend(self.system, self.goal.target, starts):
            distance = abs(tip(self.system, controls) - self.goal.target)
            if distance < self.best:
                self.best, self.best_controls = float(distance), controls


def _arc_distance(
    points: NDArray[np.complex128], half: NDArray[np.float64] | float
) -> NDArray[np.float64]:
    """Distance of points from the arc of the unit circle around 1, of a half angle."""
    off = np.maximum(np.abs(np.angle(points)) - half, 0)
    distance: NDArray[np.float64] = np.abs(np.abs(points) - np.exp(1j * off))
    return distance


def _junctions(
    system: ControlSystem, controls: NDArray[np.float64]
) -> NDArray[np.complex128]:
    """Junctions x₀ … xₖ, shape (m, k+1)."""
    rank = np.arange(1.0, controls.shape[1] + 1)
    pitch = system.omega * np.cumsum(controls, axis=1)
    steps = system.turn * system.rho**-rank * np.exp(-1j * pitch)
    return np.cumsum(np.insert(steps, 0, 0, axis=1), axis=1)


def _gap(
    system: ControlSystem, target: complex, controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Distance of the tips from a target, shape (m,)."""
    gap: NDArray[np.float64] = np.abs(_junctions(system, controls)[:, -1] - target)
    return gap


def _turned(
    system: ControlSystem, target: complex, controls: NDArray[np.float64], joint: int
) -> NDArray[np.float64]:
    """The best control of one joint with the others held, shape (m,)."""
    junctions = _junctions(system, controls)
    pivot = junctions[:, joint]
    turn = np.angle((junctions[:, -1] - pivot) * np.conj(target - pivot))
    angle = np.mod(system.omega * controls[:, joint] + turn, 2 * np.pi)
    nearer_end = angle - system.omega < 2 * np.pi - angle
    end = np.where(nearer_end, 1.0, 0.0)
    return np.where(angle <= system.omega, np.minimum(angle / system.omega, 1), end)


def _newton(
    system: ControlSystem, target: complex, controls: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Controls after the shortest step that would close the gap, cut at the limits."""
    junctions = _junctions(system, controls)
    gap = target - junctions[:, -1]
    rates = -1j * system.omega * (junctions[:, -1:] - junctions[:, :-1])
    along = np.sum(rates.real**2, axis=1)
    across = np.sum(rates.imag**2, axis=1)
    mixed = np.sum(rates.real * rates.imag, axis=1)
    scale = np.maximum(along * across - mixed**2, TINY)
    real = (across * gap.real - mixed * gap.imag) / scale
    imag = (along * gap.imag - mixed * gap.real) / scale
    step = rates.real * real[:, None] + rates.imag * imag[:, None]
    limited: NDArray[np.float64] = np.clip(controls + step, 0, 1)
    return limited
