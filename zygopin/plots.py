"""Figures of reachable sets: their density, their convergence, their dimension."""

from __future__ import annotations

import math
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.errors import ParameterError
from zygopin.extent import box_dimension
from zygopin.figures import (
    ACCENT,
    INK,
    PALE,
    Axes,
    AxesImage,
    LogNorm,
    Unit,
    name_axes,
    new_figure,
    save_figure,
    unit_of,
)
from zygopin.hausdorff import hausdorff_distance
from zygopin.reach import FingerReach

CELLS = 480
"""Cells across the longer side of a density."""

PANEL = 4.2
"""Width of a panel [inches]: that of its title."""

MOST_DOTS = 40_000
"""Points of a set that are drawn one by one."""

MOST_PANELS = 6
"""Sets of a sequence that get panels of their own."""


def plot_reach(
    reaches: Sequence[FingerReach], path: Path | str, *, hull: bool = False
) -> Path:
    """Draw reachable sets side by side, at the same scale, as densities.

    Args:
        reaches: One set for each panel, of feet of one scale.
        path: The PNG file.
        hull: Whether to draw the convex hulls, with their areas.

    Returns:
        The path.

    Raises:
        ParameterError: There is no set.
        FileError: The file cannot be written.
    """
    _check_some(reaches)
    unit = unit_of(reaches[0].foot)
    box = _box(np.concatenate([_corners(reach.points) for reach in reaches]))
    cell = float(np.ptp(box, axis=1).max()) / CELLS
    counts = [_density(reach.points, box, cell) for reach in reaches]
    most = max(int(count.max()) for count in counts)
    height = PANEL * float(np.ptp(box[1]) / np.ptp(box[0]))
    figure = new_figure(1.3 + PANEL * len(reaches), 1.5 + min(height, 2 * PANEL))
    panels = figure.subplots(1, len(reaches), squeeze=False, sharey=True)[0]
    for panel, reach, count in zip(panels, reaches, counts, strict=True):
        image = _draw_density(panel, count, box * unit.per_metre, most)
        name_axes(panel, unit, leftmost=panel is panels[0])
        words = _reach_title(reach, unit)
        if hull:
            words += f"\n{_drawn_hull(panel, reach, unit)}"
        panel.set_title(words, fontsize=9)
    label = f"points per cell of {unit.text(cell)}"
    figure.colorbar(image, ax=list(panels), label=label, shrink=0.8)
    figure.suptitle(f"$R_{{{reaches[0].depth}}}$ of {_name(reaches[0])}", fontsize=11)
    return save_figure(figure, path)


def plot_convergence(reaches: Sequence[FingerReach], path: Path | str) -> Path:
    """Draw R₁, R₂, … over the last of them, and their distances to the limit.

    Each measured distance is d_H(Rₖ, R_m) to the last set, and the bar above it what
    R_m itself may be away from R∞; the line is the bound s·ρ^−k/(ρ−1).

    Args:
        reaches: Sets of one finger and one set of levels, by growing depth.
        path: The PNG file.

    Returns:
        The path.

    Raises:
        ParameterError: Fewer than two sets.
        FileError: The file cannot be written.
    """
    _check_some(reaches, least=2)
    unit, last = unit_of(reaches[0].foot), reaches[-1]
    places = np.linspace(0, len(reaches) - 2, min(MOST_PANELS, len(reaches) - 1))
    shown = [reaches[round(place)] for place in places]
    figure = new_figure(12.0, 6.0)
    grid = figure.add_gridspec(2, len(shown), height_ratios=(1.35, 1))
    box = _box(np.concatenate([_corners(reach.points) for reach in reaches]))
    for column, reach in enumerate(shown):
        panel = figure.add_subplot(grid[0, column])
        _draw_dots(panel, last, unit, PALE)
        _draw_dots(panel, reach, unit, ACCENT)
        panel.set_title(f"$R_{{{reach.depth}}}$, {_count(reach)} points", fontsize=9)
        panel.set(xlim=box[0] * unit.per_metre, ylim=box[1] * unit.per_metre)
        name_axes(panel, unit, leftmost=column == 0)
    _draw_distances(figure.add_subplot(grid[1, :]), reaches, unit)
    figure.suptitle(f"{_full_name(last)}; grey: $R_{{{last.depth}}}$", fontsize=11)
    return save_figure(figure, path)


def plot_box_counts(reach: FingerReach, path: Path | str) -> Path:
    """Draw the box counts of a set and the line whose slope is its dimension.

    Boxes smaller than the set's depth bound do not see the attractor: where the range
    of the fit has any, a broken line marks the bound.

    Args:
        reach: The set.
        path: The PNG file.

    Returns:
        The path.

    Raises:
        ParameterError: All points are one.
        FileError: The file cannot be written.
    """
    unit, found = unit_of(reach.foot), box_dimension(reach.points)
    sides = found.sides * unit.per_metre
    fit = np.polyfit(np.log(sides), np.log(found.counts), 1)
    figure = new_figure(6.4, 4.8)
    panel = figure.subplots()
    panel.loglog(sides, found.counts, "o", color=ACCENT, label="boxes with a point")
    slope = (
        f"slope −{found.dimension:.4g}, off by {found.residual:.2g} of log N at most"
    )
    panel.loglog(sides, np.exp(np.polyval(fit, np.log(sides))), color=INK, label=slope)
    if reach.depth_bound > found.sides.min():
        bound = reach.depth_bound * unit.per_metre
        panel.axvline(bound, color=INK, ls="--", lw=0.8, label=_bound_text(reach))
    panel.set_xlabel(f"side of a box [{unit.name}]")
    panel.set_ylabel("boxes N")
    panel.grid(visible=True, which="both", color=PALE, linewidth=0.4)
    panel.legend(frameon=False, fontsize=9)
    spread = f"{unit.text(found.sides.min())} to {unit.text(found.sides.max())}"
    panel.set_title(
        f"$R_{{{reach.depth}}}$ of {_full_name(reach)}\n"
        f"box-counting dimension {found.dimension:.4g}, boxes of {spread}",
        fontsize=9,
    )
    return save_figure(figure, path)


def _draw_density(
    panel: Axes, counts: NDArray[np.intp], box: NDArray[np.float64], most: int
) -> AxesImage:
    """Counts of points by cell, on a scale of colours that panels share."""
    return panel.imshow(
        np.ma.masked_equal(counts.T, 0),
        origin="lower",
        extent=(*box[0], *box[1]),
        norm=LogNorm(1, max(most, 2)),
        cmap="viridis_r",
        interpolation="nearest",
        aspect="equal",
    )


def _draw_dots(panel: Axes, reach: FingerReach, unit: Unit, colour: str) -> None:
    """The points of a set, or evenly strided ones of a large set."""
    points = reach.points[:: max(1, len(reach.points) // MOST_DOTS)]
    points = points * unit.per_metre
    size = 1.2 if len(points) > 200 else 3.5
    panel.plot(points.real, points.imag, "o", ms=size, mew=0, color=colour)
    panel.set_aspect("equal")


def _draw_distances(panel: Axes, reaches: Sequence[FingerReach], unit: Unit) -> None:
    """Distances to the limit by depth: measured, and the bound."""
    last = reaches[-1]
    depths = [reach.depth for reach in reaches]
    bounds = np.array([reach.depth_bound for reach in reaches]) * unit.per_metre
    measured = [
        hausdorff_distance(reach.points, last.points).value * unit.per_metre
        for reach in reaches[:-1]
    ]
    tail = np.full(len(measured), bounds[-1])
    bars = np.stack([np.zeros_like(tail), tail])
    label = f"measured $d_H(R_k, R_{{{last.depth}}})$ + what remains to $R_\\infty$"
    panel.semilogy(depths, bounds, "-", color=INK, label="$s\\,\\rho^{-k}/(\\rho-1)$")
    panel.errorbar(depths[:-1], measured, bars, fmt="o", color=ACCENT, label=label)
    panel.set_xlabel("depth k")
    panel.set_ylabel(f"$d_H(R_k, R_\\infty)$ [{unit.name}]")
    panel.set_xticks(depths)
    panel.grid(visible=True, which="both", color=PALE, linewidth=0.4)
    panel.legend(frameon=False)


def _drawn_hull(panel: Axes, reach: FingerReach, unit: Unit) -> str:
    """Draw the convex hull's outline; returns its area in words."""
    corners = np.append(reach.hull.points, reach.hull.points[:1]) * unit.per_metre
    panel.plot(corners.real, corners.imag, color=ACCENT, linewidth=0.9)
    return f"convex hull: {reach.hull.area * unit.per_metre**2:.4g} {unit.name}²"


def _bound_text(reach: FingerReach) -> str:
    """What the depth bound is called where it limits the boxes."""
    return f"$d_H$ to $R_\\infty$: {unit_of(reach.foot).text(reach.depth_bound)}"


def _density(
    points: NDArray[np.complex128], box: NDArray[np.float64], cell: float
) -> NDArray[np.intp]:
    """How many points each cell of a box holds, shape (columns, rows)."""
    shape = np.maximum(1, np.ceil(np.ptp(box, axis=1) / cell - 1e-9)).astype(int)
    places = [
        np.clip((values - low) / cell, 0, size - 1).astype(np.intp)
        for values, low, size in zip(
            (points.real, points.imag), box[:, 0], shape, strict=True
        )
    ]
    flat = np.ravel_multi_index(tuple(places), tuple(shape))
    counts = np.bincount(flat, minlength=int(np.prod(shape)))
    return np.asarray(counts.reshape(shape), dtype=np.intp)


def _box(points: NDArray[np.complex128]) -> NDArray[np.float64]:
    """The frame of some points with a margin: ranges of x and z, shape (2, 2)."""
    ranges = np.array(
        [[f(v) for f in (np.min, np.max)] for v in (points.real, points.imag)]
    )
    margin = 0.04 * float(np.ptp(ranges, axis=1).max())
    return np.asarray(ranges + np.array([-margin, margin]))


def _corners(points: NDArray[np.complex128]) -> NDArray[np.complex128]:
    """The lower left and upper right corner of the points' range."""
    low = complex(points.real.min(), points.imag.min())
    return np.array([low, complex(points.real.max(), points.imag.max())])


def _reach_title(reach: FingerReach, unit: Unit) -> str:
    """What a panel shows, and how far it may be from what it stands for."""
    omega = math.degrees(reach.foot.omega)
    grid, whole = reach.grid_bound, reach.grid_bound + reach.depth_bound
    return (
        f"ω = {omega:.6g}°: {_count(reach)} points, {len(reach.plane.levels)} levels\n"
        f"$d_H$ ≤ {unit.text(grid)} to all controls in [0, 1]\n"
        f"$d_H$ ≤ {unit.text(whole)} to $R_\\infty$"
    )


def _count(reach: FingerReach) -> str:
    """The number of points, its thousands apart."""
    return f"{len(reach.plane.points):_}".replace("_", "\u2009")


def _name(reach: FingerReach) -> str:
    """Which set of which finger."""
    foot, length = reach.foot, unit_of(reach.foot).text(reach.foot.scale)
    return f"{foot.name}, {reach.finger.name}, ρ = {foot.rho:.6g}, s = {length}"


def _full_name(reach: FingerReach) -> str:
    """Which set of which finger, with its joint limit and its levels."""
    omega = math.degrees(reach.foot.omega)
    return f"{_name(reach)}, ω = {omega:.6g}°, {len(reach.plane.levels)} levels"


def _check_some(reaches: Sequence[FingerReach], least: int = 1) -> None:
    """There are sets to draw."""
    if len(reaches) < least:
        allowed = f"at least {least}"
        remedy = "give the sets to draw"
        raise ParameterError("number of reachable sets", len(reaches), allowed, remedy)
