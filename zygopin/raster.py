"""Reachable sets and attractors as images, off by less than a pixel by construction.

Two steps, neither of which lists nᵏ words:

Push. R_g = F(R_{g−1}), generation by generation, keeping one true point in each cell
of a grid. Marked cells hold true points. What dropping the others loses is at most a
cell's diagonal, and the next contraction divides it by ρ: `spread` bounds how far a
point of R_g may be from a point in a marked cell.

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
from zygopin.control_system import (
    ControlSystem,
    as_depth,
    depth_bound,
    depth_within,
    frozen,
)
from zygopin.errors import ParameterError

HALF_DIAGONAL = math.sqrt(0.5) * (1 + 1e-6)
"""From a pixel's centre to its corner, and a little for rounding [pixels]."""

ACCEPT = 0.98
"""Distance of the set from a marked pixel's centre, at most [pixels]."""

ATTRACTOR = 0.01
"""Distance between the attractor and the depth drawn in its place, at most [pixels]."""

COARSENING = 0.35
"""Cells of a generation are ρ^0.35 times those of the next: less work, more spread."""

OUTLINE = 256
"""Cells across the first, coarse pass, which finds how large the set is."""

MAX_PIXELS = 2**14
"""Most pixels along a side."""

MAX_CELLS = 2**29
"""Most cells in a grid: half a gigabyte."""

DIAGONAL = math.sqrt(2) * (1 + 1e-6)
"""Diagonal of a cell, and a little for rounding [cells]."""

BLOCK = 2**15
"""Pixels that are decided at once."""

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
            pixels and the set: less than `pixel`.
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
    outline = _push(system, drawn or depth_within(system.rho, reach / OUTLINE), None)
    window = outline[-1].window(system.turn, pixels)
    if depth is None:
        drawn = depth_within(system.rho, ATTRACTOR * window.size)
    generations = _push(system, drawn, window)
    image = _resolved(system, generations)
    rest = depth_bound(system.rho, drawn) if depth is None else 0.0
    low = window.corner
    side = pixels * window.size
    extent = (low.real, low.real + side, low.imag, low.imag + side)
    bound = ACCEPT * window.size + rest
    return Raster(frozen(image), extent, window.size, drawn, bound)


@dataclass(frozen=True)
class _Grid:
    """A rectangle of square cells.

    Attributes:
        corner: Its corner of least x and z.
        size: Side of a cell.
        shape: Rows and columns.
    """

    corner: complex
    size: float
    shape: tuple[int, int]

    def places(
        self, base: NDArray[np.complex128], factor: complex
    ) -> NDArray[np.complex128]:
        """Points factor·base in units of the grid: column + i·row."""
        place: NDArray[np.complex128] = base * (factor / self.size)
        place -= self.corner / self.size
        return place

    def index(self, place: NDArray[np.complex128]) -> NDArray[np.intp]:
        """Flat index of the cell at each place, which must lie in the grid."""
        cell = place.imag.astype(np.intp)
        cell *= self.shape[1]
        cell += place.real.astype(np.intp)
        return cell


@dataclass(frozen=True)
class _Generation:
    """The cells that R_g meets, as far as the push knows.

    Attributes:
        grid: The cells.
        marked: Cells that hold a true point, of the grid's shape.
        points: One true point in each; empty in the last generation.
        spread: How far a point of R_g may be from a true point in a marked cell.
    """

    grid: _Grid
    marked: NDArray[np.bool_]
    points: NDArray[np.complex128]
    spread: float

    def window(self, turn: complex, pixels: int) -> _Grid:
        """A square of pixels around the whole set, after a turn."""
        points = turn * self.points
        slack = self.spread + 3 * self.grid.size
        low = complex(points.real.min(), points.imag.min())
        high = complex(points.real.max(), points.imag.max())
        side = max((high - low).real, (high - low).imag) + 2 * slack
        corner = (low + high) / 2 - side / 2 * (1 + 1j)
        return _Grid(corner, side / pixels, (pixels, pixels))


def _push(system: ControlSystem, depth: int, window: _Grid | None) -> list[_Generation]:
    """Generations 0 to depth, the last drawn into a window if there is one."""
    size = 2 * system.tail(0) / OUTLINE if window is None else window.size
    origin = _Grid(-0.5 - 0.5j, 1.0, (1, 1))
    start = np.zeros(1, complex)
    generations = [_Generation(origin, np.ones((1, 1), bool), start, 0.0)]
    factors, loss = system.factors, 0.0
    for step in range(1, depth + 1):
        cell = size * system.rho ** (COARSENING * (depth - step))
        base = generations[-1].points + 1
        spread = loss / system.rho
        if step == depth and window is not None:
            generations.append(_drawn(base, factors * system.turn, window, spread))
            break
        generations.append(_thinned(base, factors, cell, spread))
        loss = spread + math.sqrt(2) * cell
    return generations


def _thinned(
    base: NDArray[np.complex128],
    factors: NDArray[np.complex128],
    cell: float,
    spread: float,
) -> _Generation:
    """One true image in each cell, out of all images of some points."""
    grid = _around(base, factors, cell)
    kept = np.empty(grid.shape[0] * grid.shape[1], np.complex128)
    marked = np.zeros(kept.shape, bool)
    for factor in factors:
        place = grid.places(base, factor)
        cells = grid.index(place)
        kept[cells] = place
        marked[cells] = True
    points = kept[marked] * cell + grid.corner
    return _Generation(grid, marked.reshape(grid.shape), points, spread)


def _drawn(
    base: NDArray[np.complex128],
    factors: NDArray[np.complex128],
    window: _Grid,
    spread: float,
) -> _Generation:
    """All images of some points, marked in a window that holds them."""
    marked = np.zeros(window.shape[0] * window.shape[1], bool)
    for factor in factors:
        marked[window.index(window.places(base, factor))] = True
    return _Generation(window, marked.reshape(window.shape), base[:0], spread)


def _around(
    base: NDArray[np.complex128], factors: NDArray[np.complex128], cell: float
) -> _Grid:
    """A grid around all images of some points, two cells wider than need be."""
    corners, slack = _outline(base)
    images: NDArray[np.complex128] = np.multiply.outer(factors, corners)
    slack = slack * float(np.abs(factors).max()) + 2 * cell
    low = complex(images.real.min() - slack, images.imag.min() - slack)
    high = complex(images.real.max() + slack, images.imag.max() + slack)
    span = (high - low) / cell
    shape = (math.ceil(span.imag), math.ceil(span.real))
    if shape[0] * shape[1] > MAX_CELLS:
        remedy = "take fewer pixels"
        cells = shape[0] * shape[1]
        raise ParameterError("cells of the grid", cells, f"at most {MAX_CELLS}", remedy)
    return _Grid(low, cell, shape)


def _outline(
    points: NDArray[np.complex128],
) -> tuple[NDArray[np.complex128], float]:
    """A few points, and how far any of the given ones may be from them."""
    if len(points) <= OUTLINE:
        return points, 0.0
    low = complex(points.real.min(), points.imag.min())
    span = max(np.ptp(points.real), np.ptp(points.imag))
    grid = _Grid(low, span / OUTLINE * (1 + 1e-9), (OUTLINE, OUTLINE))
    marked = np.zeros(OUTLINE**2, bool)
    marked[grid.index(grid.places(points, 1.0))] = True
    row, column = np.divmod(np.flatnonzero(marked), OUTLINE)
    centres: NDArray[np.complex128] = (column + 0.5) + 1j * (row + 0.5)
    return low + grid.size * centres, grid.size


def _resolved(
    system: ControlSystem, generations: list[_Generation]
) -> NDArray[np.bool_]:
    """The last generation's pixels, with those in question decided."""
    last = generations[-1]
    image: NDArray[np.bool_] = last.marked.copy()
    reach = last.spread / last.grid.size + 1
    row, column = np.nonzero((_distance(image) < reach + 1) & ~image)
    points: NDArray[np.complex128] = (column + 0.5) + 1j * (row + 0.5)
    points = (last.grid.corner + last.grid.size * points) / system.turn
    met = np.zeros(len(points), bool)
    judges: list[_Judge] = []
    for start in range(0, len(points), BLOCK):
        block = slice(start, start + BLOCK)
        met[block] = _answers(system, points[block], generations, judges)
    image[row[met], column[met]] = True
    return image


def _answers(
    system: ControlSystem,
    points: NDArray[np.complex128],
    generations: list[_Generation],
    judges: list[_Judge],
) -> NDArray[np.bool_]:
    """Whether the last generation comes near some pixels' centres, shape (m,).

    `judges` holds those of the generations met so far, from the last but one down.
    """
    owner = np.arange(len(points))
    met = np.zeros(len(points), bool)
    for back, generation in enumerate(generations[-2::-1], start=1):
        if not len(points):
            break
        if len(judges) < back:
            allowance = generations[-1].grid.size * system.rho**back
            judges.append(_judge(generation, allowance))
        points, owner = _pulled(system, points, owner, judges[back - 1], met)
        keep = ~met[owner]
        points, owner = points[keep], owner[keep]
    return met


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


def _judge(generation: _Generation, allowance: float) -> _Judge:
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
    wide = _Grid(corner, grid.size, (table.shape[0], table.shape[1]))
    return lambda points: _looked_up(table, wide, points)


def _looked_up(
    table: NDArray[np.uint8], grid: _Grid, points: NDArray[np.complex128]
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
