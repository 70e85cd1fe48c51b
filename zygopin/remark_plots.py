"""The figure of the remark's counterexample: a ball that a toe sweeps through."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.engagement import engaged_junctions
from zygopin.figures import (
    ACCENT,
    FINE,
    INK,
    PALE,
    Axes,
    Circle,
    Polygon,
    Unit,
    draw_toe,
    foot_title,
    line_width,
    name_axes,
    new_figure,
    note,
    save_figure,
    unit_of,
)
from zygopin.files import check_file
from zygopin.foot import Foot
from zygopin.looks import finger_paint
from zygopin.phalanx_sweep import Sweep, about_z
from zygopin.remark import Counterexample, counterexample

STAGES = 4
"""Stages that are drawn before the ball is lost, and after."""

WOOD, LOST = "#d9b384", "#7f93ad"
"""Colours of the ball, and of a toe that has lost it."""

ARC = np.exp(1j * np.linspace(-math.pi / 2, math.pi / 2, 25))
"""A half circle ahead."""


def plot_remark(
    foot: Foot,
    path: Path | str,
    *,
    finger: str | int | None = None,
    lost_at: float | None = None,
) -> Path:
    """Draw a ball that a closing toe sweeps through: `zygopin.remark`.

    Args:
        foot: The foot.
        path: The PNG file.
        finger: Name, or number from 1; None: the last, which is the source's.
        lost_at: v at which contact is lost; None: as in `counterexample`.

    Returns:
        The path.

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: There is no such ball.
        FileError: The file cannot be written.
    """
    check_file(path)
    found, unit = counterexample(foot, finger=finger, lost_at=lost_at), unit_of(foot)
    figure = new_figure(11.0, 4.8)
    left, right = figure.subplots(1, 2, width_ratios=(1.2, 1))
    _draw_stages(left, found, unit)
    _draw_clearances(right, found, unit)
    figure.suptitle(foot_title(foot), fontsize=11)
    return save_figure(figure, path)


def _draw_stages(panel: Axes, found: Counterexample, unit: Unit) -> None:
    """The toe at stages before and after the ball is lost, and the ball."""
    foot, toe, last = found.foot, found.finger, found.lost_at
    pose, ball = about_z(toe.azimuth), found.obstacle
    place = np.array([ball.centre @ pose[:3, 0], ball.centre[2]]) * unit.per_metre
    radius = ball.radius * unit.per_metre
    panel.add_patch(Circle((place[0], place[1]), radius, color=WOOD, zorder=2))
    early, late = np.linspace(0, last, STAGES), np.linspace(last, 1, STAGES)[1:]
    skin = foot.radii[foot.finger_slices[toe.name].start] * unit.per_metre
    for values, colour in ((early, ACCENT), (late, LOST)):
        for points in engaged_junctions(foot, toe, values) * unit.per_metre:
            draw_toe(panel, points, colour, width=0.8)
            x, z = points[:2].real, points[:2].imag
            panel.plot(x, z, color=colour, linewidth=2.6)
            outline = _capsule(points[0], points[1], skin)
            corners = np.stack([outline.real, outline.imag], axis=1)
            panel.add_patch(Polygon(corners, color=colour, alpha=0.12, linewidth=0))
    for value in (0.0, last, 1.0):
        before, tip = engaged_junctions(foot, toe, [value])[0, -2:] * unit.per_metre
        note(panel, f"v = {value:.3g}", tip, tip - before)
    panel.plot(0, 0, "s", color=INK, markersize=5)
    panel.set_aspect("equal")
    panel.margins(0.17, 0.12)
    panel.grid(color=PALE, linewidth=0.4)
    words = "red: the first phalanx meets the ball; grey: it has lost it"
    panel.set_title(f"{toe.name}; {words}", fontsize=9)
    name_axes(panel, unit)


def _draw_clearances(panel: Axes, found: Counterexample, unit: Unit) -> None:
    """Clearance of each finger's first phalanx, as v goes from 0 to 1."""
    values = np.linspace(0, 1, FINE)
    for index, finger in enumerate(found.foot.fingers):
        pose = about_z(finger.azimuth)
        swept = Sweep(found.foot, finger, pose, found.obstacle)
        clearances = swept.clearances(values) * unit.per_metre
        colour = finger_paint(index).css
        width = line_width(index, len(found.foot.fingers))
        panel.plot(values, clearances, color=colour, linewidth=width, label=finger.name)
    low, high = panel.get_ylim()
    panel.axhspan(low, 0, color=WOOD, alpha=0.25, linewidth=0)
    panel.axhline(0, color=INK, linewidth=0.7)
    panel.axvline(found.lost_at, color=INK, linewidth=0.8, linestyle="--")
    lost = f"lost at v = {found.lost_at:.4g}"
    panel.annotate(
        lost, (found.lost_at, low), (5, 7), textcoords="offset points", fontsize=9
    )
    panel.set(xlim=(0, 1), ylim=(low, high))
    panel.tick_params(labelsize=8)
    panel.set_xlabel("v, every control", fontsize=9)
    panel.set_ylabel(f"clearance to the ball [{unit.name}]", fontsize=9)
    panel.set_title("first phalanges; below 0 they meet the ball", fontsize=9)
    panel.grid(color=PALE, linewidth=0.4)
    panel.legend(fontsize=8, framealpha=0.9, loc="upper left")


def _capsule(start: complex, end: complex, radius: float) -> NDArray[np.complex128]:
    """The outline of a phalanx with its skin."""
    ahead = (end - start) / abs(end - start) * radius
    return np.concatenate([end + ahead * ARC, start - ahead * ARC])
