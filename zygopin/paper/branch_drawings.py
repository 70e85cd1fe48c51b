"""Figures of a branch and its section in the plane of fingers 1 and 3."""

from __future__ import annotations

import math
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from zygopin.figures import (
    ACCENT,
    INK,
    PALE,
    Axes,
    Unit,
    draw_toe,
    name_axes,
    new_figure,
    note,
    save_figure,
)
from zygopin.foot import Foot
from zygopin.looks import WOOD, finger_paint
from zygopin.paper.finger_plane import (
    PAIR,
    Complexes,
    in_space,
    phalanx_lines,
    section,
    widths,
)
from zygopin.side_views import BARK

UNIT = Unit("1", 1.0)
"""The paper's own unit of length."""

AROUND = np.linspace(0, 2 * math.pi, 361)

HALF_LENGTH, ABOVE, BELOW, ASIDE = 1.5, 0.5, 2.5, 1.9
"""What figure 4 shows of the branch and of the plane."""

NEAR = 0.045
"""What figure 5 shows on either side of the junction where the contact is."""

SEEN_FROM = {"elev": 24.0, "azim": -52.0}


@dataclass(frozen=True)
class Panel:
    """Closed toes on one reading of the section.

    Attributes:
        name: The reading.
        width: Horizontal half-axis over the radius.
        radius: The radius.
        t: Where on the second phalanx's line it is touched.
    """

    name: str
    width: float
    radius: float
    t: float


def draw_figure_4(path: Path) -> Path:
    """Draw the paper's figure 4: branch, plane and ellipse.

    Args:
        path: The PNG file.

    Returns:
        The path.
    """
    foot, figure = Foot.preset("paper"), new_figure(7.0, 6.0)
    view: Any = figure.add_subplot(projection="3d", computed_zorder=False)
    _draw_cylinder(view)
    _draw_plane(view, foot)
    ellipse = in_space(foot, section(AROUND, -1.0, 1.0, widths(foot)["true"]))
    view.plot(*ellipse.T, color="black", linewidth=2.4, zorder=6)
    for index, finger in ((0, PAIR[0]), (2, PAIR[1])):
        count = foot.fingers[index].phalanges
        start, step = phalanx_lines(foot, finger, np.zeros(count))
        toe = in_space(foot, np.append(start[:1], start + step))
        colour = finger_paint(index).css
        view.plot(*toe.T, "o-", color=colour, linewidth=2.2, ms=3.5, zorder=7)
        view.text(*(toe[-1] + (0, 0, 0.1)), f"finger {index + 1}", color=colour)
    corner = in_space(foot, -ASIDE + 1j * (ABOVE + 0.1))
    view.text(*corner, "plane of fingers 1 and 3", fontsize=10)
    view.set(xlabel="x", ylabel="y", zlabel="z")
    view.set_aspect("equal")
    view.view_init(**SEEN_FROM)
    view.tick_params(labelsize=8)
    return save_figure(figure, path)


def _draw_cylinder(view: Any) -> None:  # noqa: ANN401
    """The branch of figure 4, its rims and its axis."""
    along = np.linspace(-HALF_LENGTH, HALF_LENGTH, 2)
    angle, y = np.meshgrid(AROUND[::5], along)
    x, z = np.cos(angle), np.sin(angle) - 1
    view.plot_surface(x, y, z, color=WOOD.css, alpha=0.32, linewidth=0, zorder=2)
    for end in along:
        rim = np.cos(AROUND), np.full_like(AROUND, end), np.sin(AROUND) - 1
        view.plot(*rim, color=WOOD.css, linewidth=1.0, zorder=3)
    axis = np.zeros(2), along * 1.15, -np.ones(2)
    view.plot(*axis, color=WOOD.css, linewidth=0.9, linestyle="-.", zorder=3)


def _draw_plane(view: Any, foot: Foot) -> None:  # noqa: ANN401
    """The plane of fingers 1 and 3, with its outline."""
    across, up = np.meshgrid([-ASIDE, ASIDE], [-BELOW, ABOVE])
    x, y, z = np.moveaxis(in_space(foot, across + 1j * up), -1, 0)
    view.plot_surface(x, y, z, color="#5b6675", alpha=0.22, linewidth=0, zorder=4)
    corners = np.array([-1, 1, 1, -1, -1]) * ASIDE
    heights = np.array([-BELOW, -BELOW, ABOVE, ABOVE, -BELOW])
    edge = in_space(foot, corners + 1j * heights)
    view.plot(*edge.T, color="#5b6675", linewidth=0.9, zorder=4)


def draw_ellipses(path: Path, outline: Complexes) -> Path:
    """Draw the printed ellipses in the section that FCL finds.

    Args:
        path: The PNG file.
        outline: The section, points of the plane.

    Returns:
        The path.
    """
    foot, figure = Foot.preset("paper"), new_figure(7.0, 5.4)
    panel, wide = figure.subplots(), widths(foot)
    panel.fill(outline.real, outline.imag, color=BARK, label="the branch, by FCL")
    styles = (
        ("true", INK, "-", "half-axes r/cos Ω and r"),
        ("printed", ACCENT, "-", "printed: r·cos Ω and r"),
        ("once", ACCENT, "--", "printed once: r·Ω and r"),
    )
    for name, colour, line, words in styles:
        points = section(AROUND, -1.0, 1.0, wide[name])
        panel.plot(
            points.real, points.imag, line, color=colour, linewidth=1.4, label=words
        )
    panel.plot(0, 0, "s", color=INK, markersize=5)
    note(panel, "base", 0j, 1j)
    panel.set_aspect("equal")
    panel.set_xlim(-1.5, 1.5)
    panel.set_ylim(-2.15, 0.3)
    panel.set_axisbelow(True)
    panel.grid(color=PALE, linewidth=0.4)
    name_axes(panel, UNIT)
    panel.set_xlabel("along finger 3", fontsize=9)
    panel.set_ylabel("z, up", fontsize=9)
    figure.legend(loc="outside lower center", ncols=2, fontsize=9)
    return save_figure(figure, path)


def draw_closed_toes(path: Path, foot: Foot, panels: list[Panel]) -> Path:
    """Draw closed toes on the section of a branch, reading by reading.

    Args:
        path: The PNG file.
        foot: The foot.
        panels: The readings.

    Returns:
        The path.
    """
    figure = new_figure(8.6, 6.1)
    above, below = figure.subplots(2, len(panels), sharex="row", sharey="row")
    for view, near, each in zip(above, below, panels, strict=True):
        _draw_closed(view, foot, each)
        _draw_closed(near, foot, each)
        _name_panel(view, each)
        near.set_xlabel("along finger 3", fontsize=9)
    junction = phalanx_lines(foot, PAIR[1], np.ones(2))[1][0]
    below[0].set_xlim(junction.real - NEAR, junction.real + NEAR)
    below[0].set_ylim(junction.imag - NEAR, junction.imag + NEAR)
    for view in (above[0], below[0]):
        view.set_ylabel("z, up", fontsize=9)
    return save_figure(figure, path)


def _name_panel(view: Axes, each: Panel) -> None:
    """The reading, its radius, and where the line is touched."""
    words = f"{each.name}\nr = {each.radius:.4f}, t = {each.t + 0.0:.3f}"
    view.set_title(words.replace("-", "−"), fontsize=9.5)


def _draw_closed(view: Axes, foot: Foot, each: Panel) -> None:
    """One reading: section, toes, and the line of the second phalanx."""
    outline = section(AROUND, -each.radius, each.radius, each.width)
    view.fill(outline.real, outline.imag, facecolor=BARK, edgecolor=WOOD.css)
    for index, finger in ((0, PAIR[0]), (2, PAIR[1])):
        count = foot.fingers[index].phalanges
        start, step = phalanx_lines(foot, finger, np.ones(count))
        line = start[1] + np.array([-1.6, 1.6]) * step[1]
        view.plot(line.real, line.imag, "--", color=PALE, linewidth=1.0, zorder=1.5)
        toe = np.append(start[:1], start + step)
        draw_toe(view, toe, finger_paint(index).css)
        spot = start[1] + each.t * step[1]
        view.plot(spot.real, spot.imag, "x", color=ACCENT, ms=8, mew=2, zorder=5)
    view.plot(0, 0, "s", color=INK, markersize=5)
    view.set_aspect("equal")
    view.tick_params(labelsize=8)
    view.set_axisbelow(True)
    view.grid(color=PALE, linewidth=0.4)
