"""Branch and bound for how near to axes a finger can come, and how far it can keep.

Boxes of controls of all axes are bounded together, so that many axes cost little more
than one; what is done for one axis does not depend on the others.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from zygopin.axis_chain import AxisChain, Floats, Indices
from zygopin.touch_bounds import BoxBounds, BoxViews, Goal, lower_bounds, upper_bounds
from zygopin.touch_witness import first_witnesses, improved

CACHED = 100_000
"""Numbers of the largest arrays that boxes are bounded with: they stay in the cache."""

Bounder = Callable[[BoxViews, Goal], BoxBounds]


@dataclass(frozen=True, eq=False)
class Extreme:
    """The least or the greatest D before each of n axes, over the finger's length.

    Attributes:
        bound: No controls go beyond this, shape (n,).
        value: What the witness attains, shape (n,).
        controls: The witness, shape (K, n).
        boxes: Boxes that were bounded, shape (n,).
    """

    bound: Floats
    value: Floats
    controls: Floats
    boxes: Indices


@dataclass(frozen=True, eq=False)
class _Boxes:
    """Open boxes of controls; costs are D, or −D where the greatest is sought.

    Attributes:
        middle: Middles, shape (K, m).
        half: Half widths, shape (K, m).
        which: Index of the axis of each, shape (m,).
        cost: Least cost that each can have, shape (m,).
        effect: What halving across each control may gain, shape (K, m).
    """

    middle: Floats
    half: Floats
    which: Indices
    cost: Floats
    effect: Floats

    def take(self, kept: NDArray[np.bool_] | Indices) -> _Boxes:
        """Some of the boxes."""
        return _Boxes(*(getattr(self, field.name)[..., kept] for field in fields(self)))


def least_distance(chain: AxisChain, tolerance: float, max_boxes: int) -> Extreme:
    """The least D over all controls.

    Args:
        chain: The chains before n axes.
        tolerance: Difference of bound and value, over the finger's length.
        max_boxes: Boxes after which an axis is left as it is.

    Returns:
        Lower bounds, and what witnesses attain.
    """
    floor = np.min(chain.off_plane - chain.radii[:, None], axis=0)
    return _Search(chain, 1.0, lower_bounds, floor, tolerance).run(max_boxes)


def greatest_distance(chain: AxisChain, tolerance: float, max_boxes: int) -> Extreme:
    """The greatest D over all controls.

    Args:
        chain: The chains before n axes.
        tolerance: Difference of bound and value, over the finger's length.
        max_boxes: Boxes after which an axis is left as it is.

    Returns:
        Upper bounds, and what witnesses attain.
    """
    floor = chain.radii[0] - np.abs(chain.base)
    return _Search(chain, -1.0, upper_bounds, floor, tolerance).run(max_boxes)


class _Search:
    """One search over all axes at once."""

    def __init__(
        self,
        chain: AxisChain,
        sign: float,
        bounder: Bounder,
        floor: Floats,
        tolerance: float,
    ) -> None:
        self.chain, self.sign, self.bounder = chain, sign, bounder
        self.floor = floor
        self.tolerance = tolerance - 2 * chain.rounding
        value, self.controls = first_witnesses(chain, sign, floor)
        self.best = sign * value
        self.left = np.full(len(floor), np.inf)
        self.boxes = np.zeros(len(floor), dtype=np.intp)

    def run(self, max_boxes: int) -> Extreme:
        """Halve boxes until each axis is settled or has had its boxes."""
        open_boxes, turn = self.pruned(self.whole(), max_boxes), 0
        while open_boxes.which.size:
            turn += 1
            open_boxes = self.pruned(self.halved(open_boxes), max_boxes)
            if turn & (turn - 1) == 0 and open_boxes.which.size:
                self.descend(open_boxes)
        bound = np.maximum(np.minimum(self.left, self.best), self.floor)
        bound, sign = bound - self.chain.rounding, self.sign
        return Extreme(sign * bound, sign * self.best, self.controls, self.boxes)

    def whole(self) -> _Boxes:
        """All controls, before each axis."""
        half = np.full((self.chain.count, len(self.floor)), 0.5)
        return self.bounded(half.copy(), half, np.arange(len(self.floor)))

    def bounded(self, middle: Floats, half: Floats, which: Indices) -> _Boxes:
        """Boxes with their bounds; their middles may be better witnesses."""
        size = max(256, CACHED // self.chain.count**2)
        nearest = self.chain.contact(self.controls, np.arange(len(self.floor)))
        goal = Goal(self.sign * (self.best - self.tolerance), nearest.normal)
        parts = []
        for start in range(0, max(len(which), 1), size):
            part = slice(start, start + size)
            cut = middle[:, part], half[:, part], which[part]
            found = self.bounder(BoxViews.of(self.chain, *cut), goal)
            parts.append(
                (self.sign * found.bound, self.sign * found.value, found.effect)
            )
        cost, value, effect = (
            np.concatenate(x, axis=-1) for x in zip(*parts, strict=True)
        )
        self.boxes += np.bincount(which, minlength=len(self.floor))
        self.take_witnesses(value, middle, which)
        return _Boxes(middle, half, which, cost, effect)

    def take_witnesses(self, value: Floats, controls: Floats, which: Indices) -> None:
        """Keep the controls that are better than what each axis has."""
        order = np.lexsort((value, which))
        first = order[np.unique(which[order], return_index=True)[1]]
        better = first[value[first] < self.best[which[first]]]
        self.best[which[better]] = value[better]
        self.controls[:, which[better]] = controls[:, better]

    def pruned(self, boxes: _Boxes, max_boxes: int) -> _Boxes:
        """Without boxes that cannot matter, nor those of axes that are settled."""
        goal = self.best - self.tolerance
        settled = (self.floor >= goal) | (self.boxes >= max_boxes)
        closed = (boxes.cost >= goal[boxes.which]) | settled[boxes.which]
        np.minimum.at(self.left, boxes.which[closed], boxes.cost[closed])
        return boxes.take(~closed)

    def halved(self, boxes: _Boxes) -> _Boxes:
        """Both halves of each box, across the control with the largest effect."""
        row, widest = np.arange(len(boxes.which)), np.argmax(boxes.effect, axis=0)
        half, shift = boxes.half.copy(), np.zeros_like(boxes.half)
        half[widest, row] /= 2
        shift[widest, row] = half[widest, row]
        middle = np.concatenate([boxes.middle - shift, boxes.middle + shift], axis=1)
        twice = np.concatenate([half, half], axis=1)
        halves = self.bounded(middle, twice, np.tile(boxes.which, 2))
        cost = np.maximum(halves.cost, np.tile(boxes.cost, 2))
        return _Boxes(middle, twice, halves.which, cost, halves.effect)

    def descend(self, boxes: _Boxes) -> None:
        """Look for better witnesses from the most promising box of each axis."""
        order = np.lexsort((boxes.cost, boxes.which))
        first = order[np.unique(boxes.which[order], return_index=True)[1]]
        which = boxes.which[first]
        controls, value = improved(self.chain, boxes.middle[:, first], which, self.sign)
        self.take_witnesses(self.sign * value, controls, which)
