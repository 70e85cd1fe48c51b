"""The source's figure of a toe that its tendon closes, and of its talon's path."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.engagement import checked_stages, engaged_junctions
from zygopin.figures import (
    FINE,
    INK,
    PALE,
    Normalize,
    ScalarMappable,
    colormaps,
    draw_toe,
    foot_title,
    name_axes,
    new_figure,
    note,
    save_figure,
    to_hex,
    unit_of,
)
from zygopin.files import check_file
from zygopin.foot import Foot
from zygopin.reach import find_finger

STAGES = 7
"""Stages of a closing toe that are drawn, unless said otherwise."""

PANEL, FLATTEST = 4.6, 0.45
"""Width of a toe's panel [inches], and its least height over that."""

Floats = NDArray[np.float64]


def plot_engagement(
    foot: Foot,
    path: Path | str,
    *,
    finger: str | int | None = None,
    stages: int | ArrayLike = STAGES,
) -> Path:
    """Draw a toe at stages of its closing, and the path of its talon: the source's TLM.

    All controls equal v, from 0 to 1, in the finger's plane.

    Args:
        foot: The foot.
        path: The PNG file.
        finger: Name, or number from 1; None: the last, which is the source's.
        stages: Values of v, shape (n,); or how many, at equal steps from 0 to 1.

    Returns:
        The path.

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: A stage is outside [0, 1].
        FileError: The file cannot be written.
    """
    check_file(path)
    kinds.instance("foot", foot, Foot)
    toe = find_finger(foot, len(foot.fingers) if finger is None else finger)
    shown = stages if np.ndim(stages) else _equal_steps(stages)
    values, unit = checked_stages("stages", shown), unit_of(foot)
    points = engaged_junctions(foot, toe, values) * unit.per_metre
    track = engaged_junctions(foot, toe, np.linspace(0, 1, FINE))[:, -1]
    track *= unit.per_metre
    scale = ScalarMappable(Normalize(0, 1), colormaps["viridis_r"])
    colours = [to_hex(scale.cmap(float(value))) for value in values]
    spread = np.append(points.ravel(), track)
    tall = float(np.ptp(spread.imag) / max(np.ptp(spread.real), np.ptp(spread.imag)))
    figure = new_figure(11.0, 1.6 + PANEL * max(tall, FLATTEST))
    left, right = figure.subplots(1, 2, sharex=True, sharey=True)
    for colour, junctions in zip(colours, points, strict=True):
        draw_toe(left, junctions, colour)
    right.plot(track.real, track.imag, color=INK, linewidth=1.0)
    tips = points[:, -1]
    right.scatter(tips.real, tips.imag, c=colours, zorder=3)
    for value, place in ((0, track[0]), (1, track[-1])):
        right.plot(place.real, place.imag, "o", ms=10, mfc="none", mec=INK)
        note(right, f"v = {value}", place)
    for panel, title in (
        (left, f"{toe.name}, stages of v"),
        (right, "path of its talon"),
    ):
        panel.set_title(title, fontsize=9)
        panel.plot(0, 0, "s", color=INK, markersize=5)
        panel.set_aspect("equal")
        panel.margins(0.08)
        name_axes(panel, unit, leftmost=panel is left)
        panel.grid(color=PALE, linewidth=0.4)
    figure.colorbar(scale, ax=[left, right], label="v, every control", shrink=0.9)
    figure.suptitle(foot_title(foot), fontsize=11)
    return save_figure(figure, path)


def _equal_steps(count: object) -> Floats:
    """So many values from 0 to 1."""
    return np.linspace(0, 1, checks.integer("stages", count, 2, FINE))
