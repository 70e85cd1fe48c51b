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

CHUNK = 2**16
"""Points pulled back at once."""

_NO, _MAYBE, _YES = np.arange(3, dtype=np.uint8)
"""Whether a set comes near a point."""


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
        return corner + self.pixel * ((column + 0.5) + 1j * (row + 0.5))


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

    def index(self, points: NDArray[np.complex128]) -> NDArray[np.int64]:
        """Flat index of the cell of each point, which must lie in the grid."""
        row = ((points.imag - self.corner.imag) / self.size).astype(np.int64)
        row *= self.shape[1]
        row += ((points.real - self.corner.real) / self.size).astype(np.int64)
        return row


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
        image = factor * base
        place = grid.index(image)
        kept[place] = image
        marked[place] = True
    return _Generation(grid, marked.reshape(grid.shape), kept[marked], spread)


def _drawn(
    base: NDArray[np.complex128],
    factors: NDArray[np.complex128],
    window: _Grid,
    spread: float,
) -> _Generation:
    """All images of some points, marked in a window that holds them."""
    marked = np.zeros(window.shape[0] * window.shape[1], bool)
    for factor in factors:
        marked[window.index(factor * base)] = True
    return _Generation(window, marked.reshape(window.shape), base[:0], spread)


def _around(
    base: NDArray[np.complex128], factors: NDArray[np.complex128], cell: float
) -> _Grid:
    """A grid around all images of some points."""
    turned = [(factor * base) for factor in factors]
    low = complex(
        min(image.real.min() for image in turned),
        min(image.imag.min() for image in turned),
    )
    high = complex(
        max(image.real.max() for image in turned),
        max(image.imag.max() for image in turned),
    )
    span = (high - low) / cell
    shape = (int(span.imag) + 3, int(span.real) + 3)
    if shape[0] * shape[1] > MAX_CELLS:
        name, remedy = "cells of the grid", "take fewer pixels"
        raise ParameterError(name, shape[0] * shape[1], f"at most {MAX_CELLS}", remedy)
    return _Grid(low - cell * (1 + 1j), cell, shape)


def _resolved(
    system: ControlSystem, generations: list[_Generation]
) -> NDArray[np.bool_]:
    """The last generation's pixels, with those in question decided."""
    last = generations[-1]
    image = last.marked.copy()
    reach = math.floor(last.spread / last.grid.size) + 1
    row, column = np.nonzero(_dilated(image, reach) & ~image)
    centre = last.grid.size * ((column + 0.5) + 1j * (row + 0.5))
    points = (last.grid.corner + centre) / system.turn
    owner = np.arange(len(points))
    met = np.zeros(len(points), bool)
    allowance = last.grid.size
    for generation in reversed(generations[:-1]):
        allowance *= system.rho
        points, owner = _pulled(system, points, owner, generation, allowance, met)
        keep = ~met[owner]
        points, owner = points[keep], owner[keep]
    image[row[met], column[met]] = True
    return image


def _pulled(
    system: ControlSystem,
    points: NDArray[np.complex128],
    owner: NDArray[np.int64],
    generation: _Generation,
    allowance: float,
    met: NDArray[np.bool_],
) -> tuple[NDArray[np.complex128], NDArray[np.int64]]:
    """Pull points back by every f_v, and keep those that stay in question.

    Pixels whose question is answered by yes are noted in `met`.
    """
    factors = system.factors
    judge = _judge(generation, allowance)
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


def _judge(
    generation: _Generation, allowance: float
) -> Callable[[NDArray[np.complex128]], NDArray[np.uint8]]:
    """Whether R_g comes near points: `_YES`, `_NO` or `_MAYBE` for each.

    Args:
        generation: What is known of R_g.
        allowance: What a pixel's side has grown to.

    Returns:
        A function of the points: yes is certain within `ACCEPT` allowances, no is
        certain beyond `HALF_DIAGONAL` of them.
    """
    grid = generation.grid
    if len(generation.points) == 1 and generation.spread == 0:
        only, near = generation.points[0], ACCEPT * allowance
        return lambda points: np.where(np.abs(points - only) <= near, _YES, _NO)
    sure = math.floor(ACCEPT * allowance / (math.sqrt(2) * grid.size)) - 1
    reach = (generation.spread + HALF_DIAGONAL * allowance) / grid.size
    reach = min(math.floor(reach) + 1, sum(grid.shape))
    padded = np.pad(generation.marked, reach)
    table = np.where(_dilated(padded, reach), _MAYBE, _NO)
    if sure >= 0:
        table[_dilated(padded, min(sure, sum(grid.shape)))] = _YES
    corner = grid.corner - reach * grid.size * (1 + 1j)
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


def _dilated(marked: NDArray[np.bool_], reach: int) -> NDArray[np.bool_]:
    """Cells within some rows and columns of a marked one."""
    result = marked.copy()
    for lines in (result, result.T):
        done = 0
        while done < reach:
            shift = min(2 * done + 1, reach - done)
            old = lines.copy()
            lines[shift:] |= old[:-shift]
            lines[:-shift] |= old[shift:]
            done += shift
    return result
