"""Branches to which two phalanges are tangent: where two tangent lines cross.

Each pair of tangent lines is a system of two linear equations in height and radius. It
has one solution; or, where the lines are parallel, none; or, where they are the same
line, a one-parameter family of branches. Solutions count where both phalanges touch
inside the bone and the radius is positive.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import BASE_SLACK
from zygopin.clearance import Floats
from zygopin.foot import Foot
from zygopin.grasp import FARTHEST, THINNEST, TOLERANCE
from zygopin.placement import Placement
from zygopin.records import taken
from zygopin.tangent_lines import TangentLines

Indices = NDArray[np.intp]

PARALLEL_LINES = 1e-12
"""Difference of two normals' z, and of two offsets over the foot's size, below which
they are equal: a hundred times the rounding of sums of angles and lengths."""

CELLS = 2**15
"""Systems solved at once: intermediate arrays stay in the cache."""

NARROW = TOLERANCE
"""Length of a family, over the foot's size, below which it counts as one branch: two
bones that share a junction meet on one line at its end."""

FAR = FARTHEST / 4
"""Height over the foot's size beyond which a family counts as endless."""


@dataclass(frozen=True)
class SystemCounts:
    """What became of the 2×2 systems, one for each pair of tangent lines.

    Attributes:
        systems: Number of systems.
        parallel: Of them those of parallel lines, without a solution.
        same_line: Those of one line twice: every branch of it solves the system.
        along_axis: Those not set up, since a phalanx lies along the axis and has no
            tangent line of its own.
        base_inside: Solutions, or pieces of families, that are left out because the
            branch would hold the foot's base inside it.
        out_of_range: Solutions left out because the branch is too far or too thin for
            the foot: `grasp.FARTHEST`, `grasp.THINNEST`.
    """

    systems: int = 0
    parallel: int = 0
    same_line: int = 0
    along_axis: int = 0
    base_inside: int = 0
    out_of_range: int = 0

    @property
    def singular(self) -> int:
        """Systems without one solution: parallel lines, and the same line twice."""
        return self.parallel + self.same_line

    def __add__(self, other: SystemCounts) -> SystemCounts:
        return SystemCounts(
            *(getattr(self, f.name) + getattr(other, f.name) for f in fields(self))
        )


class Crossings(NamedTuple):
    """Solutions of the systems of two sets of tangent lines.

    Attributes:
        one: Index of the first set's line, shape (N,).
        other: Index of the second set's line, shape (N,).
        height: z of the branch's centre [m], shape (N,); of a family, a branch midway.
        heights: Ends of the family, equal for a single branch [m], shape (N, 2).
    """

    one: Indices
    other: Indices
    height: Floats
    heights: Floats

    def take(self, which: Indices | NDArray[np.bool_]) -> Crossings:
        """Some of the solutions."""
        return Crossings(
            self.one[which], self.other[which], self.height[which], self.heights[which]
        )


def crossings(
    foot: Foot, placement: Placement, one: TangentLines, other: TangentLines
) -> tuple[Crossings, SystemCounts]:
    """Solve the system of each pair of lines, and keep what is a branch.

    Args:
        foot: The foot.
        placement: Where the branches lie.
        one: Lines of one finger, N of them.
        other: Lines of another, M of them.

    Returns:
        The solutions, single branches before families, and what became of the N·M
        systems.
    """
    unit = PARALLEL_LINES * (foot.size + float(np.linalg.norm(placement.centre)))
    low, high = other.heights()
    step = max(1, CELLS // max(1, len(other)))
    parts = [
        _met(taken(one, slice(start, start + step)), start, (other, low, high), unit)
        for start in range(0, max(1, len(one)), step)
    ]
    met, shared = _joined([part[0] for part in parts]), _joined([p[1] for p in parts])
    single, lost = _single(foot, placement, one, met)
    family, cut = _families(foot, placement, one, shared)
    same = len(shared.one)
    counts = SystemCounts(
        systems=len(one) * len(other),
        parallel=sum(part[2] for part in parts) - same,
        same_line=same,
    )
    return _joined([single, family]), counts + lost + cut


def _met(
    one: TangentLines,
    start: int,
    others: tuple[TangentLines, Floats, Floats],
    unit: float,
) -> tuple[Crossings, Crossings, int]:
    """Where some lines meet all others, at heights at which both touch the bone.

    Args:
        one: The lines.
        start: Index of the first of them.
        others: The other lines, and the heights between which each touches.
        unit: Difference of offsets that is rounding [m].

    Returns:
        Crossings; lines that are the same; how many are parallel, those included.
    """
    other = others[0]
    ends = one.heights()
    low = np.maximum(ends[0][:, None], others[1])
    high = np.minimum(ends[1][:, None], others[2])
    steepness = one.normal_z[:, None] - other.normal_z
    apart = one.offset[:, None] - other.offset
    flat = np.abs(steepness) <= PARALLEL_LINES
    steepness[flat] = np.nan
    height = apart / steepness
    met = np.flatnonzero((height >= low) & (height <= high))
    parallel = np.flatnonzero(flat)
    same = parallel[np.abs(apart.ravel()[parallel]) <= unit]
    row, column = np.divmod(met, len(other))
    at = height.ravel()[met]
    crossed = Crossings(row + start, column, at, np.stack([at, at], axis=1))
    row, column = np.divmod(same, len(other))
    between = np.stack([low.ravel()[same], high.ravel()[same]], axis=1)
    shared = Crossings(row + start, column, between[:, 0], between)
    return crossed, shared, len(parallel)


def _single(
    foot: Foot, placement: Placement, one: TangentLines, found: Crossings
) -> tuple[Crossings, SystemCounts]:
    """Crossings that are branches of a size that means something."""
    radius = _radius(one, found)
    thick = radius > PARALLEL_LINES * foot.size  # lines through the base: rounding
    found, radius = found.take(thick), radius[thick]
    extent = radius + np.hypot(np.linalg.norm(placement.centre), found.height)
    thin = radius < THINNEST * foot.size
    good = ~thin & (extent <= FARTHEST * foot.size)
    found, radius = found.take(good), radius[good]
    outside = _base_gap(placement, found.height, radius) >= 0
    return found.take(outside), SystemCounts(
        out_of_range=int(np.count_nonzero(~good)),
        base_inside=int(np.count_nonzero(~outside)),
    )


def _families(
    foot: Foot, placement: Placement, one: TangentLines, found: Crossings
) -> tuple[Crossings, SystemCounts]:
    """Pieces of common lines whose branches leave the base outside."""
    found = _thick(foot, one, found)
    pieces = _near(foot, _without_base(placement, one, found))
    middle = _midway(foot, pieces.heights)
    narrow = np.ptp(pieces.heights, axis=1) <= NARROW * foot.size
    ends = np.where(narrow[:, None], middle[:, None], pieces.heights)
    pieces = pieces._replace(height=middle, heights=ends)
    outside = _base_gap(placement, pieces.height, _radius(one, pieces)) >= 0
    inside = int(np.count_nonzero(~outside))
    return pieces.take(outside), SystemCounts(base_inside=inside)


def _thick(foot: Foot, one: TangentLines, found: Crossings) -> Crossings:
    """Families cut where the radius, linear in the height, gets too small."""
    normal_z, spare = one.normal_z[found.one], one.offset[found.one]
    spare = spare - THINNEST * foot.size
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        limit = spare / normal_z
    upright = normal_z == 0
    low = np.where(
        normal_z < 0, limit, np.where(upright & (spare < 0), np.inf, -np.inf)
    )
    high = np.where(normal_z > 0, limit, np.inf)
    low = np.maximum(found.heights[:, 0], low)
    high = np.minimum(found.heights[:, 1], high)
    kept = low <= high
    return found._replace(heights=np.stack([low, high], axis=1)).take(kept)


def _without_base(
    placement: Placement, one: TangentLines, found: Crossings
) -> Crossings:
    """Families cut where the base passes through the bark: a quadratic in the height.

    The base's distance from the axis, squared, less the radius squared.
    """
    axis = np.asarray(placement.axis)
    across = np.eye(3) - np.outer(axis, axis)
    place, rise = across @ placement.centre, across[:, 2]
    shrunk = 1 - BASE_SLACK
    normal_z = shrunk * one.normal_z[found.one]
    offset = shrunk * one.offset[found.one]
    square = rise @ rise - normal_z**2
    linear = 2 * (place @ rise + normal_z * offset)
    constant = place @ place - offset**2
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        root = np.sqrt(linear**2 - 4 * square * constant)
        stem = -(linear + np.copysign(root, linear)) / 2
        roots = np.stack([stem / square, constant / stem], axis=1)
    low, high = found.heights[:, :1], found.heights[:, 1:]
    # Without roots nothing is cut; the pieces beyond an end have no length.
    cuts = np.sort(np.clip(np.where(np.isnan(roots), low, roots), low, high), axis=1)
    marks = np.concatenate([low, cuts, high], axis=1)
    pieces = np.stack([marks[:, :-1], marks[:, 1:]], axis=2)
    first, last = pieces[..., 0], pieces[..., 1]
    point = (low == high) & (np.arange(3) == 0)
    row, piece = np.nonzero((first < last) | point)
    return found.take(row)._replace(heights=pieces[row, piece])


def _near(foot: Foot, found: Crossings) -> Crossings:
    """Families less far ones, and endless where an end is far."""
    low, high = found.heights.T
    far = FAR * foot.size
    kept = (low < far) & (high > -far)
    low, high = np.where(low < -far, -np.inf, low), np.where(high > far, np.inf, high)
    return found._replace(heights=np.stack([low, high], axis=1)).take(kept)


def _joined(parts: list[Crossings]) -> Crossings:
    """Several lists of solutions as one."""
    return Crossings(*map(np.concatenate, zip(*parts, strict=True)))


def _midway(foot: Foot, heights: Floats) -> Floats:
    """Height in the middle of each family; near the end of an endless one."""
    low, high = heights[:, 0], heights[:, 1]
    low = np.where(np.isfinite(low), low, high - 2 * foot.size)
    return np.asarray(
        (low + np.where(np.isfinite(high), high, low + 2 * foot.size)) / 2
    )


def _radius(one: TangentLines, found: Crossings) -> Floats:
    """Radii of the branches [m], from the first line's equation."""
    return np.asarray(one.offset[found.one] - one.normal_z[found.one] * found.height)


def _base_gap(placement: Placement, height: Floats, radius: Floats) -> Floats:
    """How far outside the branch the base lies [m]: `branch.check_base`."""
    axis = np.asarray(placement.axis)
    centre = placement.centre + height[:, None] * (0.0, 0.0, 1.0)
    distance = np.linalg.norm(centre - (centre @ axis)[:, None] * axis, axis=1)
    return np.asarray(distance - radius * (1 - BASE_SLACK))
