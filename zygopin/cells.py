"""Generations of a reachable set on grids of cells, one true point in each.

R_g = F(R_{g−1}), keeping one true point in each cell of a grid. Marked cells hold true
points. What dropping the others loses is at most a cell's diagonal, and the next
contraction divides it by ρ.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.control_system import ControlSystem
from zygopin.errors import ParameterError

COARSENING = 0.4
"""Cells of a generation are ρ^0.4 times those of the next: less work, more spread."""

OUTLINE = 256
"""Cells across the first, coarse pass, which finds how large the set is."""

MAX_CELLS = 2**29
"""Most cells in a grid: half a gigabyte."""


@dataclass(frozen=True)
class Grid:
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
class Generation:
    """The cells that R_g meets, as far as the push knows.

    Attributes:
        grid: The cells.
        marked: Cells that hold a true point, of the grid's shape.
        points: One true point in each; empty in the last generation.
        spread: How far a point of R_g may be from a true point in a marked cell.
    """

    grid: Grid
    marked: NDArray[np.bool_]
    points: NDArray[np.complex128]
    spread: float

    def window(self, turn: complex, pixels: int) -> Grid:
        """A square of pixels around the whole set, after a turn."""
        points = turn * self.points
        slack = self.spread + 3 * self.grid.size
        low = complex(points.real.min(), points.imag.min())
        high = complex(points.real.max(), points.imag.max())
        side = max((high - low).real, (high - low).imag) + 2 * slack
        corner = (low + high) / 2 - side / 2 * (1 + 1j)
        return Grid(corner, side / pixels, (pixels, pixels))


def push(system: ControlSystem, depth: int, window: Grid | None) -> list[Generation]:
    """Push the base through the contractions, generation by generation.

    Args:
        system: The contractions, of a finite control set.
        depth: The last generation k.
        window: The pixels that the last generation is drawn into; None: a coarse pass,
            with `OUTLINE` cells across.

    Returns:
        Generations 0 to k.

    Raises:
        ParameterError: A grid would be too large.
    """
    size = 2 * system.tail(0) / OUTLINE if window is None else window.size
    origin = Grid(-0.5 - 0.5j, 1.0, (1, 1))
    start = np.zeros(1, complex)
    generations = [Generation(origin, np.ones((1, 1), bool), start, 0.0)]
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
) -> Generation:
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
    return Generation(grid, marked.reshape(grid.shape), points, spread)


def _drawn(
    base: NDArray[np.complex128],
    factors: NDArray[np.complex128],
    window: Grid,
    spread: float,
) -> Generation:
    """All images of some points, marked in a window that holds them."""
    marked = np.zeros(window.shape[0] * window.shape[1], bool)
    for factor in factors:
        marked[window.index(window.places(base, factor))] = True
    return Generation(window, marked.reshape(window.shape), base[:0], spread)


def _around(
    base: NDArray[np.complex128], factors: NDArray[np.complex128], cell: float
) -> Grid:
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
    return Grid(low, cell, shape)


def _outline(
    points: NDArray[np.complex128],
) -> tuple[NDArray[np.complex128], float]:
    """A few points, and how far any of the given ones may be from them."""
    if len(points) <= OUTLINE:
        return points, 0.0
    low = complex(points.real.min(), points.imag.min())
    span = max(np.ptp(points.real), np.ptp(points.imag))
    grid = Grid(low, span / OUTLINE * (1 + 1e-9), (OUTLINE, OUTLINE))
    marked = np.zeros(OUTLINE**2, bool)
    marked[grid.index(grid.places(points, 1.0))] = True
    row, column = np.divmod(np.flatnonzero(marked), OUTLINE)
    centres: NDArray[np.complex128] = (column + 0.5) + 1j * (row + 0.5)
    return low + grid.size * centres, grid.size
