"""Proof that a finger has no pose on a branch: branch and bound over controls.

A box holds ranges of heights, of radii and of controls up to the tangent phalanx. What
tangency asks is expanded over it: the line at the skin's distance from the axis, the
contact inside the bone, the phalanges before outside the branch, the contact as far
round as is asked for. A box that cannot have all of it is gone; of the others the range
of radii is cut to what is possible, and they are halved.
"""

from __future__ import annotations

import itertools
from collections import deque
from collections.abc import Iterable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, fields, replace

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.contact_hull import Circles, Criterion, contact_possible
from zygopin.expansion import Expansion, most_under
from zygopin.projection import (
    BACK,
    BEHIND,
    PALM,
    Floats,
    ProjectedFinger,
    wrap_angle,
)

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]

BATCH = 4096
"""Boxes that are bounded at once: their arrays stay in the cache."""

MOST_BOXES = 1_000_000
"""Boxes looked at for one phalanx and side: about ten seconds of one core."""

FIRST_LOOK, NEGLIGIBLE = 20_000, 5e-4
"""Boxes after which it is first asked whether the branches they hold are only so
small a share of the grid that the search may end."""

RESOLVED = 1e-4
"""How far a box of one branch may move the line, over the finger's length, below
which it is given up as undecided."""

TINY = 1e-300
"""Keeps a division by a length of zero finite [m]."""

VAGUE = 1e3
"""Slack of a condition of which nothing is known [rad]."""


@dataclass(frozen=True)
class _Question:
    """Which phalanx, which of its sides, and what counts."""

    rank: int
    side: int
    criterion: Criterion

    @property
    def tolerance(self) -> float:
        """Clearance that counts as contact [m]."""
        return self.criterion.tolerance


def unproved(
    finger: ProjectedFinger,
    grid: BranchGrid,
    asked: Booleans,
    criterion: Criterion,
    beyond: Floats,
    *,
    most_boxes: int = MOST_BOXES,
) -> Booleans:
    """Branches on which a finger may yet have a tangent phalanx.

    Args:
        finger: The finger, seen along the branches.
        grid: The branches.
        asked: The branches in question, for each phalanx, shape (K, H, R).
        criterion: What counts as a tangent phalanx.
        beyond: Only contacts count whose wrap, times the criterion's sense, is more
            than this [rad], for each phalanx, shape (K, H, R); −∞ for any.
        most_boxes: Boxes looked at for each phalanx and side.

    Returns:
        Those of the branches for which no proof was found, shape (K, H, R): on the
        others no pose exists.
    """
    if finger.edgewise:
        return np.array(asked)
    sides = (PALM,) if criterion.palmar else (PALM, BACK)
    cases = list(itertools.product(reversed(range(len(finger.lengths))), sides))

    def left(case: tuple[int, int]) -> Booleans:
        index, side = case
        question, least = _Question(index + 1, side, criterion), beyond[index]
        near = asked[index] & ~_out_of_reach(finger, grid, question, least)
        cells = np.nonzero(near)
        circles = Circles(
            grid.centres(finger)[cells[0]], grid.radii[cells[1]], least[cells]
        )
        near[cells] = contact_possible(finger, circles, index + 1, side, criterion)
        return _Proof(finger, grid, near, question, least, most_boxes).run()

    result = np.zeros_like(asked)
    with ThreadPoolExecutor() as pool:
        for (index, _), found in zip(cases, pool.map(left, cases), strict=True):
            result[index] |= found
    return result


def farthest_wrap(
    finger: ProjectedFinger, grid: BranchGrid, rank: int, tolerance: float
) -> Floats:
    """Bound on how far round a phalanx can touch without any entering the branch.

    The bones before the contact lie outside the disc of radius r + εₖ, so they are no
    shorter than the way to it: straight where the base sees it, and else the tangent
    from the base and the arc behind it.

    Args:
        finger: The finger.
        grid: The branches.
        rank: Number k of the phalanx.
        tolerance: Clearance that counts as contact [m].

    Returns:
        Bounds on |wrap| [rad], shape (H, R); −∞ where it cannot touch at all.
    """
    distance = grid.base_distance[:, None]
    skin = np.maximum(grid.radii + finger.radii[rank - 1] - tolerance, tolerance)
    reach = finger.lengths[:rank].sum() + tolerance
    tangent = np.sqrt(np.maximum(distance**2 - skin**2, 0.0))
    behind = np.arccos(skin / np.maximum(distance, skin)) + (reach - tangent) / skin
    scale = 2 * np.maximum(distance, skin) * skin
    seen = np.arccos(np.clip((distance**2 + skin**2 - reach**2) / scale, -1.0, 1.0))
    away = distance > reach + skin
    entered = distance < grid.radii + finger.radii[0] - tolerance
    most = np.where(tangent > reach, seen, behind)
    return np.where(away | entered, -np.inf, most)


def _out_of_reach(
    finger: ProjectedFinger, grid: BranchGrid, question: _Question, least: Floats
) -> Booleans:
    """Branches that a phalanx cannot touch, or not so far round, by its reach alone."""
    rank, tolerance = question.rank, question.tolerance
    if not question.criterion.solid:
        skin = grid.radii + finger.radii[rank - 1] + tolerance
        away = grid.base_distance[:, None] - skin
        return np.asarray(away > finger.lengths[:rank].sum())
    most = farthest_wrap(finger, grid, rank, tolerance)
    # The other way round, a contact farther than this counts as nearly a full turn.
    short = most < np.minimum(least, -BEHIND)
    return np.asarray(np.isneginf(most) | short)


@dataclass(frozen=True, eq=False)
class _Boxes:
    """Boxes: rows and columns of the grid from one to below another, and controls.

    Attributes:
        rows: First row and the row after the last, shape (2, m).
        columns: The same of the columns, shape (2, m).
        middle: Middles of the controls, shape (k, m).
        half: Their half widths, shape (k, m).
    """

    rows: Indices
    columns: Indices
    middle: Floats
    half: Floats

    def take(self, which: slice | Booleans | Indices) -> _Boxes:
        """Some of the boxes."""
        return _Boxes(*(getattr(self, f.name)[:, which] for f in fields(self)))

    def joined(self, other: _Boxes) -> _Boxes:
        """These boxes and others."""
        pairs = ((getattr(self, f.name), getattr(other, f.name)) for f in fields(self))
        return _Boxes(*(np.concatenate(pair, axis=1) for pair in pairs))

    @property
    def count(self) -> int:
        """Number of boxes."""
        return int(self.rows.shape[1])


@dataclass(frozen=True, eq=False)
class _Expanded:
    """What tangency asks, expanded over boxes of (height, radius, controls).

    Attributes:
        radius: The branch's radius.
        line: Distance of the bone's line from the circle, times the bone's stretch.
        along: Where it touches along the bone, times the stretch.
        conditions: What must be ≥ 0.
    """

    radius: Expansion
    line: Expansion
    along: Expansion
    conditions: tuple[Expansion, ...]

    def take(self, which: Booleans) -> _Expanded:
        """The expansions over some of the boxes."""
        return _Expanded(
            _some(self.radius, which),
            _some(self.line, which),
            _some(self.along, which),
            tuple(_some(each, which) for each in self.conditions),
        )


def _cut(conditions: tuple[Expansion, ...], half: Floats) -> tuple[Floats, Floats]:
    """Ranges of the variables, about the middle, that single conditions leave.

    Where a condition is ≥ 0, slopeᵢ·δᵢ is no less than what all else can make up for.

    Args:
        conditions: What must be ≥ 0.
        half: Half widths of the boxes, shape (d, m).

    Returns:
        Lower and upper ends, shape (d, m) each; crossed where nothing is left.
    """
    low, high = -half, half.copy()
    for condition in conditions:
        slope = condition.slope
        spare = condition.high - np.abs(slope) * half
        steep = np.abs(slope) > TINY
        limit = np.divide(-spare, slope, np.full_like(half, np.inf), where=steep)
        low = np.where(steep & (slope > 0), np.maximum(low, limit), low)
        high = np.where(steep & (slope < 0), np.minimum(high, limit), high)
    return low, high


def _some(expansion: Expansion, which: Booleans) -> Expansion:
    """An expansion over some of its boxes."""
    return Expansion(
        expansion.value[which],
        expansion.slope[:, which],
        expansion.slack[which],
        expansion.half[:, which],
    )


@dataclass(frozen=True, eq=False)
class _Proof:
    """The search for one phalanx and one of its sides."""

    finger: ProjectedFinger
    grid: BranchGrid
    asked: Booleans
    question: _Question
    least: Floats
    most_boxes: int

    def run(self) -> Booleans:
        """Branches of those asked for that remain in boxes at the end."""
        left = np.zeros_like(self.asked)
        counts = np.zeros(tuple(n + 1 for n in self.asked.shape), dtype=np.intp)
        counts[1:, 1:] = self.asked.cumsum(axis=0).cumsum(axis=1)
        least = _RangeLeast.of(np.where(self.asked, self.least, np.inf))
        # The oldest boxes first: where the search is cut short, all are small.
        queue, seen, look = deque([self._whole(counts)]), 0, FIRST_LOOK
        while queue and seen < self.most_boxes:
            if seen > look:
                look *= 2
                if self._held(queue).mean() < NEGLIGIBLE:
                    break
            batch = queue.popleft()
            seen += batch.count
            batch, expanded = self._narrowed(batch, counts, least)
            small = self._resolved(batch, expanded)
            self._mark(left, batch.take(small))
            batch, expanded = batch.take(~small), expanded.take(~small)
            halves = self._halved(batch, expanded)
            queue.extend(
                halves.take(slice(start, start + BATCH))
                for start in range(0, halves.count, BATCH)
            )
        return (left | self._held(queue)) & self.asked

    def _held(self, queue: Iterable[_Boxes]) -> Booleans:
        """Branches of those asked for that boxes hold."""
        held = np.zeros_like(self.asked)
        for boxes in queue:
            self._mark(held, boxes)
        return held & self.asked

    def _whole(self, counts: Indices) -> _Boxes:
        """One box with everything; none if nothing is asked."""
        rank, some = self.question.rank, int(counts[-1, -1] > 0)
        rows, columns = (np.array([[0], [n]]) for n in self.asked.shape)
        half = np.full((rank, 1), 0.5)
        return _Boxes(rows, columns, half, half).take(slice(0, some))

    def _narrowed(
        self, boxes: _Boxes, counts: Indices, least: _RangeLeast
    ) -> tuple[_Boxes, _Expanded]:
        """The boxes that remain possible, their radii cut, and their expansions."""
        bound = least.over(boxes.rows, boxes.columns)
        expanded = self._expanded(boxes, bound)
        possible = np.all([x.high >= 0 for x in expanded.conditions], axis=0)
        boxes, expanded = boxes.take(possible), expanded.take(possible)
        low, high = _cut(expanded.conditions, expanded.radius.half)
        boxes = self._cut_radii(boxes, expanded)
        boxes = replace(
            boxes,
            middle=boxes.middle + (low + high)[2:] / 2,
            half=np.maximum(high - low, 0.0)[2:] / 2,
        )
        (top, bottom), (start, end) = boxes.rows, boxes.columns
        inside = counts[bottom, end] - counts[top, end]
        inside -= counts[bottom, start] - counts[top, start]
        left = (inside > 0) & np.all(low <= high, axis=0)
        return boxes.take(left), expanded.take(left)

    def _cut_radii(self, boxes: _Boxes, expanded: _Expanded) -> _Boxes:
        """The boxes with only the radii that they may have."""
        radius, conditions = expanded.radius, expanded.conditions
        tolerance, radii = self.question.tolerance, self.grid.radii
        highest = most_under(radius, conditions) + tolerance
        lowest = -most_under(-radius, conditions) - tolerance
        first = np.maximum(boxes.columns[0], np.searchsorted(radii, lowest))
        past = np.searchsorted(radii, highest, side="right")
        past = np.maximum(np.minimum(boxes.columns[1], past), first)
        return replace(boxes, columns=np.stack([first, past]))

    def _resolved(self, boxes: _Boxes, expanded: _Expanded) -> Booleans:
        """Boxes of one branch whose controls hardly move the line any more."""
        single = (np.diff(boxes.rows, axis=0) == 1) & (
            np.diff(boxes.columns, axis=0) == 1
        )
        moves = np.abs(expanded.line.slope[2:]) * boxes.half
        small = moves.sum(axis=0) < RESOLVED * self.finger.lengths.sum()
        return np.asarray(single[0] & small)

    def _mark(self, left: Booleans, boxes: _Boxes) -> None:
        """Mark the branches that boxes hold."""
        for (top, bottom), (start, end) in zip(
            boxes.rows.T, boxes.columns.T, strict=True
        ):
            left[top:bottom, start:end] = True

    def _halved(self, boxes: _Boxes, expanded: _Expanded) -> _Boxes:
        """Both halves of each box, across what moves the phalanx most."""
        moves = np.abs(expanded.line.slope) + np.abs(expanded.along.slope)
        moves = moves * expanded.line.half
        moves[0] = np.where(np.diff(boxes.rows, axis=0)[0] > 1, moves[0], -1.0)
        moves[1] = -1.0  # radii are cut, not halved
        widest, box = np.argmax(moves, axis=0), np.arange(boxes.count)
        turned = widest >= 2
        joint, which = widest[turned] - 2, box[turned]
        half, shift = boxes.half.copy(), np.zeros_like(boxes.half)
        half[joint, which] /= 2
        shift[joint, which] = half[joint, which]
        middle = (boxes.rows[0] + boxes.rows[1]) // 2
        upper, lower = boxes.rows.copy(), boxes.rows.copy()
        upper[1] = np.where(turned, upper[1], middle)
        lower[0] = np.where(turned, lower[0], middle)
        one = _Boxes(upper, boxes.columns, boxes.middle - shift, half)
        return one.joined(_Boxes(lower, boxes.columns, boxes.middle + shift, half))

    def _expanded(self, boxes: _Boxes, bound: Floats) -> _Expanded:
        """The expansions over boxes, of contacts wrapped farther than a bound."""
        heights, radii = self.grid.heights, self.grid.radii
        top, bottom = heights[boxes.rows[0]], heights[boxes.rows[1] - 1]
        thin, thick = radii[boxes.columns[0]], radii[boxes.columns[1] - 1]
        middle = np.vstack([(top + bottom) / 2, (thin + thick) / 2, boxes.middle])
        half = np.vstack([np.abs(top - bottom) / 2, (thick - thin) / 2, boxes.half])
        height, radius = (Expansion.variable(i, middle, half) for i in range(2))
        origin, step = self.grid.line(self.finger)
        centre = (height * step.real + origin.real, height * step.imag + origin.imag)
        chain = _Chain(self.finger, self.question, centre, radius)
        return chain.expanded(middle, half, bound)


@dataclass(frozen=True, eq=False)
class _Chain:
    """The expansions of one finger's phalanges over boxes."""

    finger: ProjectedFinger
    question: _Question
    centre: tuple[Expansion, Expansion]
    radius: Expansion

    def expanded(self, middle: Floats, half: Floats, bound: Floats) -> _Expanded:
        """Junctions from the base on, and what tangency asks of the last phalanx."""
        finger, question = self.finger, self.question
        x, z = (-each for each in self.centre)
        pitch = Expansion.variable(0, middle, half) * 0.0 + finger.orientation
        outside = []
        for earlier in range(question.rank - 1):
            pitch = pitch + Expansion.variable(2 + earlier, middle, half) * finger.omega
            right, up = self._step(pitch)
            if question.criterion.solid:
                outside.append(self._outside(earlier, (x, z), (right, up)))
            length = float(finger.lengths[earlier])
            x, z = x + right * length, z + up * length
        last = 1 + question.rank
        pitch = pitch + Expansion.variable(last, middle, half) * finger.omega
        line, along, contact = self._contact((x, z), self._step(pitch))
        around = self._around(pitch, bound)
        return _Expanded(self.radius, line, along, (*contact, around, *outside))

    def _step(self, pitch: Expansion) -> tuple[Expansion, Expansion]:
        """The projected unit vector of a pitch."""
        cosine, sine = pitch.wave()
        finger = self.finger
        right = cosine * finger.forward - sine * finger.shear
        return right, sine * -finger.drop

    def _outside(
        self,
        earlier: int,
        start: tuple[Expansion, Expansion],
        step: tuple[Expansion, Expansion],
    ) -> Expansion:
        """Outside the branch lies the bone's point that is nearest in the middle."""
        (x, z), (right, up) = start, step
        length = self.finger.lengths[earlier]
        square = right.value**2 + up.value**2
        nearest = -(x.value * right.value + z.value * up.value) / square
        share = np.clip(nearest, 0.0, length)
        away = (x + right * share).squared() + (z + up * share).squared()
        skin = self.finger.radii[earlier] - self.question.tolerance
        return away - (self.radius + float(skin)).squared()

    def _contact(
        self,
        start: tuple[Expansion, Expansion],
        step: tuple[Expansion, Expansion],
    ) -> tuple[Expansion, Expansion, tuple[Expansion, ...]]:
        """The bone's line at the skin's distance from the axis, touching inside it."""
        (x, z), (right, up) = start, step
        rank, tolerance = self.question.rank, self.question.tolerance
        square = right.squared() + up.squared()
        stretch = square.root(self.finger.least_stretch**2)
        skin = self.radius + float(self.finger.radii[rank - 1])
        line = (right * z - up * x) * float(self.question.side) - skin * stretch
        along = -(right * x + up * z)
        length = float(self.finger.lengths[rank - 1])
        inside = (along + tolerance, square * length - along + tolerance)
        return line, along, (line + tolerance, -line + tolerance, *inside)

    def _around(self, pitch: Expansion, bound: Floats) -> Expansion:
        """How much farther round than a bound, or back, the contact lies."""
        wrap, sense = self._wrap(pitch), float(self.question.criterion.sense)
        # Across the cut between far round and back, nothing is known.
        cut = wrap.low > BEHIND if sense > 0 else wrap.high < 2 * np.pi + BEHIND
        known = cut & np.isfinite(bound)
        slack = np.where(known, wrap.slack, VAGUE)
        slope = np.where(known, wrap.slope * sense, 0.0)
        value = wrap.value * sense - np.where(known, bound, 0.0)
        return replace(wrap, value=value, slope=slope, slack=slack)

    def _wrap(self, pitch: Expansion) -> Expansion:
        """How far round the contact lies: the phalanx's direction against the base's.

        The direction of a + b turns by ad/|step|² per unit of pitch, the base's by
        the centre's motion across its distance.
        """
        finger = self.finger
        step = finger.direction(pitch.value)
        middle = self.centre[0].value + 1j * self.centre[1].value
        value = wrap_angle(1j * self.question.side * step, middle)
        area, least = finger.forward * finger.drop, finger.least_stretch
        widest = (finger.forward**2 + finger.shear**2 + finger.drop**2) - least**2
        turn = area / (step.real**2 + step.imag**2)
        reach = np.sum(np.abs(pitch.slope) * pitch.half, axis=0)
        bend = area * max(widest - least**2, 0.0) / least**4
        x, z = self.centre
        nearest = np.maximum(np.hypot(x.value, z.value) - np.hypot(x.reach, z.reach), 0)
        square = np.maximum(x.value**2 + z.value**2, TINY)
        swing = (x.value * z.slope - z.value * x.slope) / square
        moves = np.hypot(x.reach, z.reach)
        swept = moves / np.maximum(nearest, moves / VAGUE + TINY)
        slack = bend * reach**2 / 2 + swept**2
        return Expansion(value, turn * pitch.slope + swing, slack, pitch.half)


@dataclass(frozen=True, eq=False)
class _RangeLeast:
    """Least value over rectangles of a grid, from those over powers of two.

    Attributes:
        tables: Least over 2^i by 2^j cells from each cell on, {(i, j): (H, R)}.
    """

    tables: dict[tuple[int, int], Floats]

    @classmethod
    def of(cls, values: Floats) -> _RangeLeast:
        """The tables of a grid's values."""
        tables = {(0, 0): values}
        rows, columns = (int(n).bit_length() for n in values.shape)
        for i, j in itertools.product(range(rows), range(columns)):
            if j:
                tables[i, j] = _doubled(tables[i, j - 1], 2 ** (j - 1), axis=1)
            elif i:
                tables[i, 0] = _doubled(tables[i - 1, 0], 2 ** (i - 1), axis=0)
        return cls(tables)

    def over(self, rows: Indices, columns: Indices) -> Floats:
        """Least values over rectangles.

        Args:
            rows: First row and the row after the last, shape (2, m).
            columns: The same of the columns, shape (2, m).

        Returns:
            Least values, shape (m,).
        """
        result = np.empty(rows.shape[1])
        powers = np.stack(
            [_power(np.diff(each, axis=0)[0]) for each in (rows, columns)]
        )
        for i, j in np.unique(powers, axis=1).T:
            box = np.flatnonzero((powers[0] == i) & (powers[1] == j))
            table = self.tables[int(i), int(j)]
            (top, bottom), (start, end) = rows[:, box], columns[:, box]
            bottom, end = bottom - 2**i, end - 2**j
            corners = [table[r, c] for r in (top, bottom) for c in (start, end)]
            result[box] = np.min(corners, axis=0)
        return result


def _doubled(values: Floats, step: int, axis: int) -> Floats:
    """The lesser of each value and the one a step on."""
    result = values.copy()
    ahead = np.delete(values, np.s_[:step], axis=axis)
    part = (slice(ahead.shape[0]), slice(ahead.shape[1]))
    result[part] = np.minimum(result[part], ahead)
    return np.asarray(result)


def _power(lengths: Indices) -> Indices:
    """Exponent of the largest power of two that is no more than each number."""
    return np.asarray(np.frexp(lengths)[1] - 1)
