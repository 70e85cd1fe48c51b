"""Figures of an atlas: the map of its regions with poses beside it, and the wrap."""

from __future__ import annotations

import string
from collections.abc import Sequence
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin import kinds
from zygopin.atlas import VERDICTS, Atlas
from zygopin.atlas_regions import (
    MOST_PICKED,
    REGION_WORDS,
    Cell,
    Region,
    open_cells,
    open_share,
    picked_cells,
    pose_report,
    region_map,
    region_shares,
)
from zygopin.errors import ParameterError
from zygopin.figures import (
    INK,
    Axes,
    Figure,
    ListedColormap,
    Patch,
    PolyCollection,
    Unit,
    foot_title,
    new_figure,
    save_figure,
    unit_of,
)
from zygopin.files import check_file
from zygopin.looks import WOOD, finger_paint
from zygopin.side_views import BARK, draw_side_view

Floats = NDArray[np.float64]

REGION_COLOURS = {
    Region.GRASPING: "#1e9e4a",
    Region.FEASIBLE: "#f0a30a",
    Region.TOUCHABLE: "#8fb3d9",
    Region.STABLE: "#e7b8a6",
    Region.NONE: "#f6f7f8",
    Region.UNDECIDED: "#a569bd",
    Region.HOLDS_BASE: "#aab0b8",
}
"""Colours of the regions: verdicts as in scenes, where they are vivid."""

HATCH = "////"
"""Where more may be possible than is shown."""

VIEWS = 6
"""Poses beside the map, unless cells are given."""

COLUMNS = 2
"""Columns of poses."""


def plot_atlas(
    atlas: Atlas, path: Path | str, *, cells: Sequence[Cell] | None = None
) -> Path:
    """Draw the map of what a foot can do, with poses on some of the branches.

    Args:
        atlas: The atlas.
        path: The PNG file.
        cells: Rows and columns of the branches whose poses are drawn, at most 26;
            None: up to six that are far apart.

    Returns:
        The path.

    Raises:
        ParameterError: A cell is not on the grid, or has no pose.
        FileError: The file cannot be written.
        MissingExtraError: Matplotlib is not installed.
    """
    check_file(path)
    kinds.instance("atlas", atlas, Atlas)
    if not isinstance(cells, Sequence | None):
        raise ParameterError("cells", cells, "a list", "list rows and columns")
    chosen = picked_cells(atlas, VIEWS) if cells is None else list(cells)
    if len(chosen) > MOST_PICKED:
        remedy = "draw some of them"
        raise ParameterError("cells", len(chosen), f"at most {MOST_PICKED}", remedy)
    reports = [pose_report(atlas, cell) for cell in chosen]
    unit, rows = unit_of(atlas.foot), max(-(-len(chosen) // COLUMNS), 1)
    figure = new_figure(12.0 if chosen else 7.4, max(6.6, 2.2 * rows))
    widths = (1.5, *[0.5] * COLUMNS) if chosen else (1.0,)
    grid = figure.add_gridspec(rows, len(widths), width_ratios=widths)
    panel = figure.add_subplot(grid[:, 0])
    _draw_regions(panel, atlas, unit)
    for place, (cell, report) in enumerate(zip(chosen, reports, strict=True)):
        letter = string.ascii_uppercase[place]
        _mark(panel, atlas, cell, letter, unit)
        row, column = divmod(place, COLUMNS)
        view = figure.add_subplot(grid[row, 1 + column])
        draw_side_view(view, report, unit)
        view.set_title(_view_title(atlas, cell, letter, unit), fontsize=8, loc="left")
        if place >= len(chosen) - COLUMNS:
            view.set_xlabel(f"seen along the branch [{unit.name}]", fontsize=7)
    _name_regions(figure, atlas)
    if chosen:
        _name_toes(figure, atlas)
    figure.suptitle(f"{foot_title(atlas.foot)}\n{_undecided_words(atlas)}", fontsize=10)
    return save_figure(figure, path)


def plot_atlas_wrap(atlas: Atlas, path: Path | str) -> Path:
    """Draw how far a toe wraps around each branch, and how many toes are tangent.

    Args:
        atlas: The atlas.
        path: The PNG file.

    Returns:
        The path.

    Raises:
        ParameterError: It is no atlas.
        FileError: The file cannot be written.
        MissingExtraError: Matplotlib is not installed.
    """
    check_file(path)
    kinds.instance("atlas", atlas, Atlas)
    unit, count = unit_of(atlas.foot), len(atlas.foot.fingers)
    figure = new_figure(12.0, 5.4)
    left, right = figure.subplots(1, 2, sharey=True)
    held = ~atlas.grid.valid
    wrap = np.ma.masked_invalid(np.degrees(np.where(held, np.nan, atlas.wrap[..., 0])))
    toes = np.ma.masked_array(atlas.toes[..., 0], held)
    shades = ListedColormap(_shades(count + 1))
    for panel, values, style in (
        (left, wrap, {"cmap": "viridis", "vmin": 0}),
        (right, toes, {"cmap": shades, "vmin": -0.5, "vmax": count + 0.5}),
    ):
        _draw_held(panel, atlas, unit)
        drawn = panel.pcolormesh(*_edges(atlas, unit), values, **style)
        _name_map(panel, unit, first=panel is left)
        if panel is left:
            figure.colorbar(drawn, ax=panel, label="largest wrap of a toe shown [°]")
        else:
            words = "toes tangent at once, shown"
            figure.colorbar(drawn, ax=panel, label=words, ticks=range(count + 1))
    words = (
        "grey: the branch holds the foot's base; a contact more than 45° behind counts "
        "as nearly all the way round"
    )
    title = f"{foot_title(atlas.foot)}\n{words}"
    figure.suptitle(title, fontsize=10)
    return save_figure(figure, path)


def _draw_regions(panel: Axes, atlas: Atlas, unit: Unit) -> None:
    """The map in colours, hatched where more may be possible."""
    order = sorted(REGION_COLOURS)
    colours = ListedColormap([REGION_COLOURS[region] for region in order])
    low, high = int(order[0]) - 0.5, int(order[-1]) + 0.5
    edges, regions = _edges(atlas, unit), region_map(atlas)
    panel.pcolormesh(*edges, regions, cmap=colours, vmin=low, vmax=high)
    _draw_open(panel, atlas, edges)
    _name_map(panel, unit, first=True)


def _draw_open(panel: Axes, atlas: Atlas, edges: tuple[Floats, Floats]) -> None:
    """Hatch the branches for which more may be possible than is shown."""
    x, y = edges
    corners = [
        [(x[k], y[j]), (x[k + 1], y[j]), (x[k + 1], y[j + 1]), (x[k], y[j + 1])]
        for j, k in np.argwhere(open_cells(atlas))
    ]
    hatched = PolyCollection(corners, facecolor="none", edgecolor=INK, linewidth=0)
    hatched.set_hatch(HATCH)
    panel.add_collection(hatched)


def _draw_held(panel: Axes, atlas: Atlas, unit: Unit) -> None:
    """The branches that hold the base, in grey."""
    grey = ListedColormap([REGION_COLOURS[Region.HOLDS_BASE]])
    held = np.ma.masked_array(np.zeros(atlas.grid.shape), atlas.grid.valid)
    panel.set_facecolor(REGION_COLOURS[Region.NONE])
    panel.pcolormesh(*_edges(atlas, unit), held, cmap=grey)


def _name_map(panel: Axes, unit: Unit, *, first: bool) -> None:
    """What is along a map's axes."""
    panel.set_xlabel(f"radius of the branch [{unit.name}]", fontsize=9)
    if first:
        words = f"height z of its centre over the base [{unit.name}]"
        panel.set_ylabel(words, fontsize=9)
    panel.tick_params(labelsize=8)


def _name_regions(figure: Figure, atlas: Atlas) -> None:
    """The legend under the map: what there is, and how much of it."""
    shares, patches = region_shares(atlas), []
    for region, words in REGION_WORDS.items():
        share = shares.get(region)
        if share == 0 or (share is None and atlas.grid.valid.all()):
            continue
        label = words if share is None else f"{words} {share:.1%}"
        colour = REGION_COLOURS[region]
        patches.append(Patch(facecolor=colour, edgecolor=INK, lw=0.4, label=label))
    if open_cells(atlas).any():
        words = f"more may be possible {open_share(atlas):.1%}"
        patches.append(Patch(fc="white", ec=INK, lw=0.4, hatch=HATCH, label=words))
    figure.legend(handles=patches, loc="outside lower left", ncols=4, fontsize=8)


def _name_toes(figure: Figure, atlas: Atlas) -> None:
    """The legend under the side views."""
    patches = []
    for index, finger in enumerate(atlas.foot.fingers):
        patches.append(Patch(facecolor=finger_paint(index).css, label=finger.name))
    patches.append(Patch(facecolor=BARK, edgecolor=WOOD.css, label="branch"))
    figure.legend(handles=patches, loc="outside lower right", ncols=3, fontsize=8)


def _mark(panel: Axes, atlas: Atlas, cell: Cell, letter: str, unit: Unit) -> None:
    """A letter on the map at a branch."""
    x = atlas.grid.radii[cell[1]] * unit.per_metre
    y = atlas.grid.heights[cell[0]] * unit.per_metre
    panel.text(
        x,
        y,
        letter,
        ha="center",
        va="center",
        fontsize=8,
        fontweight="bold",
        color=INK,
        bbox={"boxstyle": "circle,pad=0.2", "facecolor": "white", "edgecolor": INK},
    )


def _view_title(atlas: Atlas, cell: Cell, letter: str, unit: Unit) -> str:
    """Which branch a side view shows, and what the pose shows."""
    region = REGION_WORDS[Region(region_map(atlas)[cell])]
    radius, height = atlas.grid.radii[cell[1]], atlas.grid.heights[cell[0]]
    return f"{letter}: {region}\nr = {_text(radius, unit)}, z = {_text(height, unit)}"


def _text(metres: float, unit: Unit) -> str:
    """A length in three figures."""
    shown = f"{float(metres) * unit.per_metre + 0.0:.3g}".replace("-", "−")
    return f"{shown} {unit.name}"


def _undecided_words(atlas: Atlas) -> str:
    """How much each question is left open."""
    shares = [f"{name} {atlas.undecided(name):.1%}" for name in VERDICTS]
    return f"undecided: {', '.join(shares)} of the map"


def _edges(atlas: Atlas, unit: Unit) -> tuple[Floats, Floats]:
    """Borders of the cells: radii, shape (R + 1,), and heights, shape (H + 1,)."""
    radii, heights = _borders(atlas.grid.radii), _borders(atlas.grid.heights)
    return np.maximum(radii, 0.0) * unit.per_metre, heights * unit.per_metre


def _borders(values: Floats) -> Floats:
    """Midway between values, and as far beyond the outer ones."""
    if len(values) == 1:
        wide = 0.05 * (abs(float(values[0])) or 1.0)
        return np.array([values[0] - wide, values[0] + wide])
    middle = (values[:-1] + values[1:]) / 2
    first, last = 2 * values[0] - middle[0], 2 * values[-1] - middle[-1]
    return np.concatenate([[first], middle, [last]])


def _shades(count: int) -> list[str]:
    """Colours of numbers of toes, from none to all."""
    pale, deep = np.array([246.0, 247, 248]), np.array([30.0, 80, 60])
    steps = (pale + share * (deep - pale) for share in np.linspace(0, 1, count))
    return [f"#{int(r):02x}{int(g):02x}{int(b):02x}" for r, g, b in steps]
