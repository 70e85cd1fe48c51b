"""Reachable sets and attractors as images, off by less than a pixel by construction.

Two steps, neither of which lists nᵏ words:

Push (`cells`). Generation by generation, one true point is kept in each cell of a
grid. Marked cells hold true points; `spread` bounds how far a point of R_g may be from
a true point in a marked cell.

Pull. An unmarked pixel within the spread of a marked one is in question. Whether R_g
comes within τ of y is whether R_{g−1} comes within ρτ of some f_v⁻¹(y). The allowance
grows ρ-fold and soon exceeds the cells, whose marks then answer; R₀ = {0} answers in
any case. A pixel is marked if the set comes within `ACCEPT` of its centre, and only
left out if the set does not meet its square: so every marked centre is within a pixel
of the set, and every point of the set within a pixel of a marked centre.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.cells import OUTLINE, Generation, Grid, push
from zygopin.control_system import (
    ControlSystem,
    as_depth,
    depth_bound,
    depth_within,
    frozen,
)

HALF_DIAGONAL = math.sqrt(0.5) * (1 + 1e-6)
"""From a pixel's centre to its corner, and a little for rounding [pixels]."""

ACCEPT = 0.98
"""Distance of the set from a marked pixel's centre, at most [pixels]."""

ATTRACTOR = 0.01
"""Distance between the attractor and the depth drawn in its place, at most [pixels]."""

MAX_PIXELS = 2**14
"""Most pixels along a side."""

DIAGONAL = math.sqrt(2) * (1 + 1e-6)
"""Diagonal of a cell, and a little for rounding [cells]."""

BLOCK = 2**15
"""Pixels that are decided at once."""

MOST_PULLED = 2**21
"""Points pulled back in all before the pixels left in question stay unmarked."""

CHUNK = 2**16
"""Points pulled back at once."""

_NO, _MAYBE, _YES = np.arange(3, dtype=np.uint8)
"""Whether a set comes near a point."""


_Judge = Callable[[NDArray[np.complex128]], NDArray[np.uint8]]
"""Whether a set comes near each of some points."""


@dataclass(frozen=True)
class Raster:
    """An image of a reachable set or an attractor.

    Attributes:
        image: Marked pixels, row 0 at the lowest z, read-only, shape (rows, columns).
        extent: Outer edges (x least, x most, z least, z most).
        pixel: Side of a pixel.
        depth: Number of phalanges of the set that was drawn.
        error_bound: Bound on the Hausdorff distance between the centres of the marked
            pixels and the set: less than `pixel`, unless ρ is near 1 and pixels had to
            be left in question (see `MOST_PULLED`).
    """

    image: NDArray[np.bool_]
    extent: tuple[float, float, float, float]
    pixel: float
    depth: int
    error_bound: float

    @property
    def centres(self) -> NDArray[np.complex128]:
        """Centres x + iz of the marked pixels, shape (m,)."""
        row, column = np.nonzero(self.image)
        corner = complex(self.extent[0], self.extent[2])
        centres: NDArray[np.complex128] = (column + 0.5) + 1j * (row + 0.5)
        centres *= self.pixel
        centres += corner
        return centres


def raster(
    system: ControlSystem, depth: int | None = None, *, pixels: int = 1024
) -> Raster:
    """Draw a reachable set, or the attractor, at pixel resolution.

    Args:
        system: The contractions, of a finite control set.
        depth: Number of phalanges k ≥ 1; None: the attractor.
        pixels: Pixels along each side of the square image, from 8.

    Returns:
        The image, around the whole set.

    Raises:
        ParameterError: A parameter is out of range, or a grid would be too large.
    """
    pixels = checks.integer("pixels", pixels, 8, MAX_PIXELS)
    drawn = 0 if depth is None else as_depth(depth)
    reach = 2 * system.tail(0)
    outline = push(system, drawn or depth_within(system.rho, reach / OUTLINE), None)
    window = outline[-1].window(system.turn, pixels)
    if depth is None:
        drawn = depth_within(system.rho, ATTRACTOR * window.size)
    generations = push(system, drawn, window)
    image, decided = _resolved(system, generations)
    rest = depth_bound(system.rho, drawn) if depth is None else 0.0
    low = window.corner
    side = pixels * window.size
    extent = (low.real, low.real + side, low.imag, low.imag + side)
    error = ACCEPT * window.size
    if not decided:
        error = max(error, generations[-1].spread + HALF_DIAGONAL * window.size)
    bound = error + rest
    return Raster(frozen(image), extent, window.size, drawn, bound)


def _resolved(
    system: ControlSystem, generations: list[Generation]
) -> tuple[NDArray[np.bool_], bool]:
    """The last generation's pixels, and whether all in question were decided."""
    last = generations[-1]
    image: NDArray[np.bool_] = last.marked.copy()
    reach = last.spread / last.grid.size + 1
    row, column = np.nonzero((_distance(image) < reach + 1) & ~image)
    points: NDArray[np.complex128] = (column + 0.5) + 1j * (row + 0.5)
    points = (last.grid.corner + last.grid.size * points) / system.turn
    met = np.zeros(len(points), bool)
    judges: list[_Judge] = []
    left = MOST_PULLED
    for start in range(0, len(points), BLOCK):
        block = slice(start, start + BLOCK)
        budget = (left, judges)
        met[block], left = _answers(system, points[block], generations, budget)
    image[row[met], column[met]] = True
    return image, left >= 0


def _answers(
    system: ControlSystem,
    points: NDArray[np.complex128],
    generations: list[Generation],
    budget: tuple[int, list[_Judge]],
) -> tuple[NDArray[np.bool_], int]:
    """Whether the last generation comes near some pixels' centres, shape (m,).

    The budget is how many points may be pulled back, and the judges of the generations
    met so far, from the last but one down. What is left is returned; below 0, pixels
    stayed in question.
    """
    left, judges = budget
    owner = np.arange(len(points))
    met = np.zeros(len(points), bool)
    for back, generation in enumerate(generations[-2::-1], start=1):
        left -= len(points)
        if left < 0 or not len(points):
            break
        if len(judges) < back:
            allowance = generations[-1].grid.size * system.rho**back
            judges.append(_judge(generation, allowance))
        points, owner = _pulled(system, points, owner, judges[back - 1], met)
        keep = ~met[owner]
        points, owner = points[keep], owner[keep]
    return met, left


def _pulled(
    system: ControlSystem,
    points: NDArray[np.complex128],
    owner: NDArray[np.int64],
    judge: _Judge,
    met: NDArray[np.bool_],
) -> tuple[NDArray[np.complex128], NDArray[np.int64]]:
    """Pull points back by every f_v, and keep those that stay in question.

    Pixels whose question is answered by yes are noted in `met`.
    """
    factors = system.factors
    size = max(CHUNK // len(factors), 1)
    kept_points, kept_owners = [points[:0]], [owner[:0]]
    for start in range(0, len(points), size):
        children = (points[start : start + size, None] / factors - 1).ravel()
        parents = np.repeat(owner[start : start + size], len(factors))
        verdict = judge(children)
        met[parents[verdict == _YES]] = True
        left = (verdict == _MAYBE) & ~met[parents]
        kept_points.append(children[left])
        kept_owners.append(parents[left])
    return np.concatenate(kept_points), np.concatenate(kept_owners)


def _judge(generation: Generation, allowance: float) -> _Judge:
    """Whether R_g comes near points: `_YES`, `_NO` or `_MAYBE` for each.

    Cells' distances are between centres, so points may be a diagonal nearer or farther.

    Args:
        generation: What is known of R_g.
        allowance: What a pixel's side has grown to.

    Returns:
        A function of the points: yes is certain within `ACCEPT` allowances, no is
        certain beyond `HALF_DIAGONAL` of them.
    """
    grid = generation.grid
    near, far = ACCEPT * allowance, HALF_DIAGONAL * allowance + generation.spread
    if len(generation.points) == 1 and generation.spread == 0:
        only = generation.points[0]
        return lambda points: np.where(np.abs(points - only) <= near, _YES, _NO)
    reach = far / grid.size + DIAGONAL
    border = math.ceil(reach) + 1
    distance = _distance(np.pad(generation.marked, border))
    table = np.where(distance <= reach, _MAYBE, _NO)
    table[distance <= near / grid.size - DIAGONAL] = _YES
    corner = grid.corner - border * grid.size * (1 + 1j)
    wide = Grid(corner, grid.size, (table.shape[0], table.shape[1]))
    return lambda points: _looked_up(table, wide, points)


def _looked_up(
    table: NDArray[np.uint8], grid: Grid, points: NDArray[np.complex128]
) -> NDArray[np.uint8]:
    """The table's entry at each point; `_NO` outside of it."""
    place = (points - grid.corner) / grid.size
    rows, columns = grid.shape
    inside = (place.real >= 0) & (place.real < columns)
    inside &= (place.imag >= 0) & (place.imag < rows)
    found = np.full(len(points), _NO)
    within = place[inside]
    row, column = within.imag.astype(np.intp), within.real.astype(np.intp)
    found[inside] = table[row, column]
    return found


def _distance(marked: NDArray[np.bool_]) -> NDArray[np.float64]:
    """Distance of each cell's centre from that of the next marked one [cells]."""
    from scipy.ndimage import distance_transform_edt

    distance: NDArray[np.float64] = distance_transform_edt(~marked)
    return distance
