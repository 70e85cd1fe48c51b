"""Reachable sets and attractors as images, off by less than a pixel by construction.

A net is drawn (`nets`): a pixel is marked if it holds a point of the net, or one is
within `ACCEPT` of its centre. A point of the set in a marked cell is in a marked pixel.
Any other is within `SPREAD` of a point of the net, and some pixel's centre is within
`ACCEPT` of both. So every marked centre is within a pixel of the set, and every point
of the set within a pixel of a marked centre.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.control_system import (
    ControlSystem,
    as_depth,
    depth_bound,
    frozen,
)
from zygopin.nets import (
    DIAGONAL,
    Grid,
    Net,
    around_image,
    attractor_net,
    base_net,
    image_net,
)

HALF_DIAGONAL = DIAGONAL / 2
"""From a pixel's centre to its corner, and a little for rounding [pixels]."""

ACCEPT = 0.98
"""Distance of the set from a marked pixel's centre, at most [pixels]."""

SPREAD = 0.65
"""Distance of two points that some pixel's centre is within `ACCEPT` of [pixels]."""

ATTRACTOR = 0.01
"""Distance of a set from the attractor that is drawn in its place [pixels]."""

COARSENING = 0.4
"""Cells of a generation are ρ^0.4 times those of the next: less work, finer edges."""

OUTLINE = 256
"""Pixels across the first, coarse pass, which finds how large the set is."""

EDGE = 0.05
"""Share of the cells that are in an edge, roughly: what finer cells cost."""

MAX_PIXELS = 2**14
"""Most pixels along a side."""


@dataclass(frozen=True)
class Raster:
    """An image of a reachable set or an attractor.

    Attributes:
        image: Marked pixels, row 0 at the lowest z, read-only, shape (rows, columns).
        extent: Outer edges (x least, x most, z least, z most).
        pixel: Side of a pixel.
        depth: Number of phalanges of the set that was drawn; None: the attractor.
        error_bound: Bound on the Hausdorff distance between the centres of the marked
            pixels and the set: less than `pixel`.
    """

    image: NDArray[np.bool_]
    extent: tuple[float, float, float, float]
    pixel: float
    depth: int | None
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
        ParameterError: A parameter is out of range, or a grid or a net would be too
            large: nearer to ρ = 1 they grow.
    """
    pixels = checks.integer("pixels", pixels, 8, MAX_PIXELS)
    depth = None if depth is None else as_depth(depth)
    reach = system.tail(0) * (1 + 4 / OUTLINE)
    whole = Grid(-reach * (1 + 1j), 2 * reach / OUTLINE, (OUTLINE, OUTLINE))
    window = _window(_net(system, depth, whole), pixels)
    net = _net(system, depth, window)
    side = pixels * window.size
    low = window.corner
    extent = (low.real, low.real + side, low.imag, low.imag + side)
    marked, error = _drawn(net, window)
    drawn = _drawn_depth(system, depth, window)
    if depth is not None and drawn is None:
        error += depth_bound(system.rho, depth)
    return Raster(frozen(marked), extent, window.size, drawn, error)


def _drawn_depth(system: ControlSystem, depth: int | None, window: Grid) -> int | None:
    """The depth; None where the attractor looks the same."""
    if depth is None or depth_bound(system.rho, depth) < ATTRACTOR * window.size:
        return None
    return depth


def _net(system: ControlSystem, depth: int | None, window: Grid) -> Net:
    """A net of a set, fine enough for pixels."""
    depth = _drawn_depth(system, depth, window)
    if depth is None:
        per_pixel, fineness = _fineness(system.rho)
        return attractor_net(system, window.finer(per_pixel), fineness)
    coarsening = system.rho**COARSENING
    per_pixel, fineness = _fineness(system.rho / coarsening)
    cells = window.finer(per_pixel)
    net = base_net()
    for left in range(depth - 1, 0, -1):
        grid = around_image(system, net, cells.size * coarsening**left)
        net = image_net(system, net, grid, fineness)
    return image_net(system, net, cells, fineness)


def _fineness(shrink: float) -> tuple[int, int]:
    """Cells along a pixel's side, and finer cells along a cell's.

    So many that the spread, which is the greater of 1/shrink + 1/finer and 1/finer over
    1 − 1/shrink [diagonals of a cell], is at most `SPREAD`.
    """
    choices = []
    for cells in range(1, 9):
        most = SPREAD * cells / DIAGONAL
        if most > 1 / shrink:
            finer = max(1 / (most - 1 / shrink), 1 / most / (1 - 1 / shrink))
            choices.append((cells, math.ceil(finer)))
    return min(choices, key=lambda pair: pair[0] ** 2 * (1 + EDGE * pair[1] ** 2))


def _window(net: Net, pixels: int) -> Grid:
    """A square of pixels around a whole set, and one more on each side."""
    low = complex(net.points.real.min(), net.points.imag.min())
    high = complex(net.points.real.max(), net.points.imag.max())
    side = max((high - low).real, (high - low).imag) + 2 * net.resolution
    side *= pixels / (pixels - 2)
    corner = (low + high) / 2 - side / 2 * (1 + 1j)
    return Grid(corner, side / pixels, (pixels, pixels))


def _drawn(net: Net, window: Grid) -> tuple[NDArray[np.bool_], float]:
    """Marked pixels, and how far their centres and the set may be from each other."""
    from scipy.ndimage import minimum_filter

    rows, columns = window.shape
    by = net.grid.shape[0] // rows
    marked: NDArray[np.bool_] = np.any(
        net.marked.reshape(rows, by, columns, by), axis=(1, 3)
    )
    near = min(HALF_DIAGONAL + net.spread / window.size, ACCEPT)
    full = minimum_filter(marked, 3).ravel()
    places = window.places(net.points)
    places = places[~full[window.index(places)]]
    centres = np.floor(places.real) + 0.5 + 1j * (np.floor(places.imag) + 0.5)
    for across, up in itertools.product((-1, 0, 1), repeat=2):
        centre = centres + complex(across, up)
        close = centre[np.abs(centre - places) <= near]
        marked[close.imag.astype(np.intp), close.real.astype(np.intp)] = True
    return marked, near * window.size
