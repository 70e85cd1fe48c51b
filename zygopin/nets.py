"""Nets of reachable sets: true points, so many that each of the set has one nearby.

Of the images of a net one is kept in each cell of a grid, and one in each *finer* cell
along the edge, which is where the set may have points in cells that hold none. Sets are
as the first phalanx turns them: f_v(x) = exp(−iωv)/ρ · (x + turn).

Let x = f_v(y) be a point of the new set in a cell that holds none. y shares its cell
with a point of the old net, or has one within the old spread. The image of that one is
within the greater of the two distances over ρ from x: so it is in the edge, and one is
kept in its finer cell. Hence the new spread:

    spread' = max(diagonal of an old cell, spread) / ρ + diagonal of a finer cell.

An attractor is its own image: its net grows until no image is new.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.control_system import ControlSystem
from zygopin.errors import ParameterError

DIAGONAL = math.sqrt(2) * (1 + 1e-6)
"""Diagonal of a cell, and a little for rounding [cells]."""

MAX_CELLS = 2**28
"""Most cells in a grid: five bytes each."""

MAX_POINTS = 2**25
"""Most points that are kept at once: half a gigabyte."""

CHUNK = 2**16
"""Points that are mapped at once."""

Points = NDArray[np.complex128]


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

    @property
    def count(self) -> int:
        """Number of cells."""
        return self.shape[0] * self.shape[1]

    def places(self, points: Points) -> Points:
        """Points in units of the grid: column + i·row."""
        places: Points = points * (1 / self.size)
        places -= self.corner / self.size
        return places

    def points(self, places: Points) -> Points:
        """What `places` was made from."""
        points: Points = places * self.size + self.corner
        return points

    def index(self, places: Points) -> NDArray[np.intp]:
        """Flat index of the cell at each place, which must lie in the grid."""
        cells = places.imag.astype(np.intp)
        cells *= self.shape[1]
        cells += places.real.astype(np.intp)
        return cells

    def finer(self, by: int) -> Grid:
        """The same rectangle, of cells that are some times smaller."""
        rows, columns = self.shape
        return Grid(self.corner, self.size / by, (rows * by, columns * by))


@dataclass(frozen=True)
class Net:
    """True points of a set.

    Attributes:
        grid: The cells.
        marked: Cells that hold one, of the grid's shape.
        points: The points, shape (n,).
        spread: How far a point of the set in a cell that is not marked may be from one
            of the net.
    """

    grid: Grid
    marked: NDArray[np.bool_]
    points: Points
    spread: float

    @property
    def resolution(self) -> float:
        """How far any point of the set may be from one of the net."""
        return max(DIAGONAL * self.grid.size, self.spread)


def base_net() -> Net:
    """R₀ = {0}, in a cell of no size."""
    cell = Grid(0j, 0.0, (1, 1))
    return Net(cell, np.ones((1, 1), bool), np.zeros(1, complex), 0.0)


def around_image(system: ControlSystem, old: Net, size: float) -> Grid:
    """Cells that hold a set's image.

    Args:
        system: The contractions, of a finite control set.
        old: A net of the set.
        size: Side of a cell.

    Returns:
        The grid.
    """
    factors = system.factors
    rows = np.flatnonzero(old.marked.any(axis=1))
    first = old.marked[rows].argmax(axis=1)
    last = old.marked.shape[1] - 1 - old.marked[rows, ::-1].argmax(axis=1)
    ends = np.concatenate([first, last]) + 0.5 + 1j * (np.tile(rows, 2) + 0.5)
    points = old.grid.points(ends)
    images = np.concatenate([factor * (points + system.turn) for factor in factors])
    margin = (DIAGONAL * old.grid.size + old.spread) / system.rho + size
    low = complex(images.real.min() - margin, images.imag.min() - margin)
    high = complex(images.real.max() + margin, images.imag.max() + margin)
    span = (high - low) / size
    return Grid(low, size, (math.ceil(span.imag), math.ceil(span.real)))


def image_net(system: ControlSystem, old: Net, grid: Grid, fineness: int) -> Net:
    """Push a net through the contractions, once.

    Args:
        system: The contractions, of a finite control set.
        old: A net of a set.
        grid: Cells that hold the set's image.
        fineness: Finer cells along the side of one.

    Returns:
        A net of the set's image.

    Raises:
        ParameterError: The grid or the net would be too large.
    """
    cells, start = _Cells(grid), [old.points]
    inner = _pushed(system, start, cells, endless=False)
    reach = old.resolution / system.rho
    finer = _FinerCells(cells, inner, reach, fineness)
    outer = _pushed(system, start, finer, endless=False)
    return _net(cells, inner + outer, reach + DIAGONAL * grid.size / fineness)


def attractor_net(system: ControlSystem, grid: Grid, fineness: int) -> Net:
    """A net of the attractor R∞.

    Args:
        system: The contractions, of a finite control set.
        grid: Cells that hold the attractor.
        fineness: Finer cells along the side of one.

    Returns:
        The net.

    Raises:
        ParameterError: The grid or the net would be too large.
    """
    cells = _Cells(grid)
    factor = system.factors[:1]
    start = [factor * system.turn / (1 - factor)]  # of the word 000…
    cells(grid.places(start[0]))
    inner = start + _pushed(system, start, cells, endless=True)
    finest = DIAGONAL * grid.size / fineness
    # What the two kinds of parents of a point in an unmarked cell allow.
    reach = max(DIAGONAL * grid.size, finest * system.rho / (system.rho - 1))
    reach /= system.rho
    finer = _FinerCells(cells, inner, reach, fineness)
    outer = _pushed(system, inner, finer, endless=True)
    return _net(cells, inner + outer, reach + finest)


class _Cells:
    """Keeps the first point in each cell."""

    def __init__(self, grid: Grid) -> None:
        if grid.count > MAX_CELLS:
            allowed, remedy = f"at most {MAX_CELLS}", "take fewer pixels"
            raise ParameterError("cells of the grid", grid.count, allowed, remedy)
        self.grid = grid
        self.marked = np.zeros(grid.count, bool)

    def __call__(self, places: Points) -> Points:
        """The places that are the first in their cells."""
        return places[_first(self.marked, self.grid.index(places))]


class _FinerCells:
    """Keeps the first point in each finer cell of the edge."""

    def __init__(
        self, cells: _Cells, inner: list[Points], reach: float, fineness: int
    ) -> None:
        """The edge: where unmarked cells are within the reach."""
        from scipy.ndimage import maximum_filter

        self.cells, self.grid, self.fineness = cells, cells.grid, fineness
        free = ~cells.marked.reshape(self.grid.shape)
        width = 2 * math.ceil(reach / self.grid.size) + 1
        edge = maximum_filter(free, width, mode="constant", cval=True).ravel()
        # Of each cell: the number of its finer ones' block; 0: none yet; -1: no edge.
        self.block = edge.astype(np.int32) - 1
        self.blocks = 0
        self.marked = np.zeros(0, bool)
        for points in inner:
            self(self.grid.places(points))

    def __call__(self, places: Points) -> Points:
        """The places that are the first in their finer cells."""
        cell = self.grid.index(places)
        inside = np.flatnonzero(self.block[cell] >= 0)
        places, cell = places[inside], cell[inside]
        self.cells.marked[cell] = True
        self._number(cell[self.block[cell] == 0])
        key = self.block[cell].astype(np.intp)
        for part in (places.imag, places.real):
            key *= self.fineness
            key += (part % 1 * self.fineness).astype(np.intp)
        return places[_first(self.marked, key)]

    def _number(self, cells: NDArray[np.intp]) -> None:
        """Give blocks to cells that have none."""
        cells = np.unique(cells)
        self.block[cells] = self.blocks + np.arange(1, len(cells) + 1)
        self.blocks += len(cells)
        needed = (self.blocks + 1) * self.fineness**2
        if needed > len(self.marked):
            more = np.zeros(2 * needed - len(self.marked), bool)
            self.marked = np.concatenate([self.marked, more])


def _pushed(
    system: ControlSystem,
    start: list[Points],
    sieve: _Cells | _FinerCells,
    *,
    endless: bool,
) -> list[Points]:
    """What is kept of points' images; endless: and of the images of those."""
    grid, kept, count = sieve.grid, [], 0
    while start:
        new = [
            sieve(places)
            for points in start
            for places in _images(system, points, grid)
        ]
        points = grid.points(np.concatenate(new))
        count += len(points)
        if count > MAX_POINTS:
            allowed, remedy = f"at most {MAX_POINTS}", "take fewer pixels"
            raise ParameterError("points of the net", count, allowed, remedy)
        kept.append(points)
        start = [points] if endless and len(points) else []
    return kept


def _images(system: ControlSystem, points: Points, grid: Grid) -> Iterator[Points]:
    """Places of points' images by every contraction, some at a time."""
    for start in range(0, len(points), CHUNK):
        base = points[start : start + CHUNK] + system.turn
        for factor in system.factors:
            places = base * (factor / grid.size)
            places -= grid.corner / grid.size
            yield places


def _net(cells: _Cells, points: list[Points], spread: float) -> Net:
    """What was kept."""
    marked = cells.marked.reshape(cells.grid.shape)
    return Net(cells.grid, marked, np.concatenate(points), spread)


def _first(marked: NDArray[np.bool_], keys: NDArray[np.intp]) -> NDArray[np.intp]:
    """Where keys come first that were not marked; all are marked then."""
    free = np.flatnonzero(~marked[keys])
    keys, first = np.unique(keys[free], return_index=True)
    marked[keys] = True
    return free[first]
