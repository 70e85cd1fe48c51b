"""Branches on which the base of the foot rests: the source's one-parameter family.

The centre is tied to the radius r: the base is on the bark, the branch below it; for a
level axis its height is −r. So one phalanx and its controls make one linear equation,
share·r = offset, in place of a line in the plane of heights and radii.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds, memory
from zygopin.branch_solutions import (
    BranchSolutions,
    Found,
    Pair,
    Search,
    with_verdicts,
)
from zygopin.clearance import Floats
from zygopin.control_system import Levels, words
from zygopin.crossings import FAR, PARALLEL_LINES, SystemCounts
from zygopin.foot import Foot
from zygopin.grasp import PARAMETER_SLACK, THINNEST, Criteria
from zygopin.placement import Placement
from zygopin.reach import find_finger
from zygopin.records import joined, taken
from zygopin.resting_equations import (
    RestingEquations,
    Section,
    check_section,
    resting_equations,
)
from zygopin.tangent_lines import (
    Integers,
    control_set,
    line_count,
    whole_controls,
)

SAME_RADIUS = 1e-9
"""Difference of two radii over the foot's size that is rounding."""

ROOT_BYTES = 128
"""Memory of one equation and its root, and of its controls at most."""

BLOCK = 4096
"""Solutions judged at once: some megabytes."""

Y_AXIS = (0.0, 1.0, 0.0)


@dataclass(frozen=True)
class RestingRadii:
    """Radii of the branches under the base to which a finger's phalanges are tangent.

    Nothing is left out but what has no radius r > 0: also the branches that touch the
    line of the bone beyond its ends.

    Attributes:
        controls: The finger's controls, 0 after the tangent phalanx, shape (N, K).
        phalanx: Number k of the tangent phalanx, shape (N,).
        word: Index of v₁ … vₖ among the words of the levels, shape (N,).
        side: 1: on its palm's side; −1: on its back; shape (N,).
        radius: Radius [m], shape (N,); NaN where every radius will do.
        t: Where on the line of the bone the branch touches, from 0 at its start to 1 at
            its end, shape (N,).
        impossible: Number of equations without a solution.
        along_axis: Number of phalanges' sides without an equation: they lie along the
            axis.
    """

    controls: Floats
    phalanx: Integers
    word: Integers
    side: Integers
    radius: Floats
    t: Floats
    impossible: int
    along_axis: int

    def __post_init__(self) -> None:
        checks.freeze(self)

    @property
    def on_bone(self) -> NDArray[np.bool_]:
        """Which branches touch inside the bone, shape (N,)."""
        return np.asarray(np.abs(self.t - 0.5) <= 0.5 + PARAMETER_SLACK)


def resting_radii(
    foot: Foot,
    finger: str | int,
    levels: Levels,
    *,
    section: Section = "geometric",
    axis: ArrayLike = Y_AXIS,
) -> RestingRadii:
    """All radii at which a phalanx is tangent to a branch under the base.

    The section of the branch in the finger's plane is an ellipse with half-axes
    r/cos Ω and r, Ω the angle of the finger to the xz-plane: `geometric`, the truth,
    here for any axis. The source prints r·cos Ω and r; `circle` is r and r.

    Args:
        foot: The foot.
        finger: Name, or number from 1.
        levels: The control set, 0 and 1 in it.
        section: `geometric`, or for an axis along y `printed` or `circle`.
        axis: Direction of the branches, not vertical.

    Returns:
        The radii, those of the phalanges nearest the base first.

    Raises:
        ParameterError: The levels are no control set, the section does not apply to
            the axis, or the equations need more memory than half of the machine's.
        UnknownNameError: There is no such finger or section.
    """
    kinds.instance("foot", foot, Foot)
    placement = Placement(axis)
    check_section(section, placement)
    index = foot.fingers.index(find_finger(foot, finger))
    values, count = control_set(levels), line_count(foot, index, levels)
    remedy = "take fewer levels"
    most = memory.limit()
    memory.require(f"{count} equations", count * ROOT_BYTES, most, remedy)
    parts = []
    phalanges = foot.fingers[index].phalanges
    for rank in range(1, phalanges + 1):
        word = np.arange(len(values) ** rank, dtype=np.int64)
        controls = words(values, rank, word)
        parts.append(resting_equations(foot, index, controls, section, placement))
    equations = joined(parts)
    solved, impossible = _solved(foot, equations)
    return RestingRadii(
        controls=whole_controls(values, phalanges, solved.rank, solved.word),
        phalanx=solved.rank,
        word=solved.word,
        side=solved.side,
        radius=solved.offset,
        t=solved.t_start,
        impossible=impossible,
        along_axis=count - len(equations.rank),
    )


def resting_branches(
    foot: Foot,
    pair: Pair,
    levels: Levels,
    *,
    section: Section = "geometric",
    axis: ArrayLike = Y_AXIS,
    criteria: Criteria | None = None,
) -> BranchSolutions:
    """All branches under the base on which a pair of fingers is stable.

    A phalanx of each finger is tangent to the same branch; in the section's reading,
    whereas the verdicts are always on the true cylinder. Straight first phalanges touch
    any branch under the base: of two of them the branches are a family.

    Args:
        foot: The foot.
        pair: Two opposable fingers, by name or by number from 1.
        levels: The control set, 0 and 1 in it.
        section: `geometric`, or for an axis along y `printed` or `circle`.
        axis: Direction of the branches, not vertical.
        criteria: What counts as contact; None: the default for the two fingers.

    Returns:
        The solutions. Its counts are of the equations, one for each side of each
        phalanx: `parallel` have no solution, `same_line` hold for every radius, and
        `out_of_range` have a radius that is too small or too large for the foot.

    Raises:
        ParameterError: The fingers are not opposable, the levels no control set, the
            section does not apply to the axis, or there are too many solutions.
        UnknownNameError: There is no such finger or section.
    """
    search = Search.of(foot, pair, levels, Placement(axis), criteria)
    two, counts = search.foot, SystemCounts()
    sides: list[RestingRadii] = []
    for finger in two.fingers:
        radii = resting_radii(two, finger.name, levels, section=section, axis=axis)
        whole = taken(radii, radii.on_bone)
        near = _in_range(two, whole.radius)
        counts += _counts(search.lines[len(sides)], radii, near)
        sides.append(taken(whole, near))
    one, other = _matched(search, sides[0].radius, sides[1].radius)
    found = _found(search, taken(sides[0], one), taken(sides[1], other))
    blocks = [
        with_verdicts(search, [taken(found, slice(start, start + BLOCK))], counts)
        for start in range(0, max(1, len(one)), BLOCK)
    ]
    return joined(blocks)


def _solved(foot: Foot, equations: RestingEquations) -> tuple[RestingEquations, int]:
    """Equations with radii as offsets, and t as t_start; how many have no solution."""
    share, offset = equations.share, equations.offset
    void = np.abs(share) <= PARALLEL_LINES
    # The line of the bone passes through the base.
    none = np.abs(offset) <= PARALLEL_LINES * foot.size
    free = void & none
    radius = np.where(void, np.nan, np.where(none, 0.0, offset))
    radius = radius / np.where(void, 1.0, share)
    t = equations.t_start + equations.t_rate * np.where(void, 0.0, radius)
    with_radius = RestingEquations(
        equations.rank, equations.word, equations.side, share, radius, t, t
    )
    return taken(with_radius, free | (radius > 0)), int(np.count_nonzero(void & ~free))


def _in_range(foot: Foot, radius: Floats) -> NDArray[np.bool_]:
    """Radii that mean something for a foot, and those left open."""
    low, high = THINNEST * foot.size, FAR * foot.size
    return np.isnan(radius) | ((radius >= low) & (radius <= high))


def _counts(
    equations: int, radii: RestingRadii, near: NDArray[np.bool_]
) -> SystemCounts:
    """What became of one finger's equations."""
    return SystemCounts(
        systems=equations,
        parallel=radii.impossible,
        same_line=int(np.count_nonzero(np.isnan(radii.radius))),
        along_axis=radii.along_axis,
        out_of_range=int(np.count_nonzero(~near)),
    )


def _matched(
    search: Search, one: Floats, other: Floats
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of equal radii, one left open being equal to any; indices of both."""
    order = np.argsort(other, kind="stable")  # what is left open, NaN, comes last
    sized = order[: np.count_nonzero(~np.isnan(other))]
    slack, free = SAME_RADIUS * search.foot.size, np.isnan(one)
    first = np.searchsorted(other[sized], one - slack, side="left")
    last = np.searchsorted(other[sized], one + slack, side="right")
    first, last = np.where(free, 0, first), np.where(free, len(sized), last)
    open_ended = order[len(sized) :]
    count = int((last - first).sum()) + len(one) * len(open_ended)
    each, remedy = 2 * search.bytes_each, "take fewer levels"
    memory.require(f"{count} solutions", count * each, memory.limit(), remedy)
    number = last - first
    row = np.repeat(np.arange(len(one)), number)
    place = np.arange(len(row)) - np.repeat(np.cumsum(number) - number, number)
    found = sized[np.repeat(first, number) + place]
    rows = np.repeat(np.arange(len(one)), len(open_ended))
    columns = np.tile(open_ended, len(one))
    return np.concatenate([row, rows]), np.concatenate([found, columns])


def _found(search: Search, one: RestingRadii, other: RestingRadii) -> Found:
    """Branches under the base, of matched radii."""
    radii = np.stack([one.radius, other.radius], axis=1)
    free = np.isnan(radii).all(axis=1)
    known = np.where(np.isnan(radii), radii[:, ::-1], radii).mean(axis=1)
    size, level = search.foot.size, search.placement.level
    ends = np.stack([known, known], axis=1)
    ends[free] = THINNEST * size, np.inf
    radius = np.where(free, size, known)
    return Found(
        rank=np.stack([one.phalanx, other.phalanx], axis=1),
        word=np.stack([one.word, other.word], axis=1),
        side=np.stack([one.side, other.side], axis=1),
        t=np.stack([one.t, other.t], axis=1),
        height=-radius / level,
        radius=radius,
        heights=-ends / level,
        radii=ends,
    )
