"""Drawings of the owl's foot: its two poses, their areas, and a talon's paths."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.extent import convex_hull
from zygopin.figures import (
    ACCENT,
    FINE,
    INK,
    PALE,
    Axes,
    Polygon,
    draw_toe,
    new_figure,
    note,
    save_figure,
)
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.looks import finger_paint
from zygopin.paper.foot_drawings import name_top_axes, turned
from zygopin.paper.toe_sums import BACK_TOE, PAPER_TURN, closing_turns, junctions
from zygopin.spread import SpreadStudy
from zygopin.stance import azimuths_at

MILLI = 1e3
"""Millimetres in a metre."""

FRAME = 118.0
"""What a panel shows on either side of the base [mm]."""

CURVES = (
    ("hull", "hull of the talons", INK),
    ("strike_first", "ball met by first phalanges", ACCENT),
    ("strike_all", "ball met by all phalanges", "#2b8f8c"),
)
"""Areas of a study: their names there, in words, and their colours."""


def draw_poses(owl: Foot, path: Path) -> Path:
    """Draw a foot from above with its toe back and with its toe turned.

    Args:
        owl: The foot.
        path: The PNG file.

    Returns:
        The path.
    """
    figure = new_figure(10.5, 6.0)
    titles = ("zygodactyl: toe 4 back", "spread: toe 4 forward (“isodactyl”)")
    panels = figure.subplots(1, 2, sharex=True, sharey=True)
    for turn, (panel, title) in enumerate(zip(panels, titles, strict=True)):
        azimuths = azimuths_at(owl, np.array(float(turn)))
        _draw_pose(panel, owl, azimuths)
        panel.set_title(title, fontsize=10)
        name_top_axes(panel, " [mm]")
    panels[0].set(xlim=(FRAME, -FRAME), ylim=(-FRAME - 12, FRAME))
    panels[1].set_ylabel("")
    return save_figure(figure, path)


def draw_areas(study: SpreadStudy, path: Path) -> Path:
    """Draw the areas that a foot covers as its toe turns.

    Args:
        study: The areas.
        path: The PNG file.

    Returns:
        The path.
    """
    (toe,) = (each for each in study.foot.fingers if each.reversal)
    turns = math.degrees(toe.reversal) * study.reversal
    figure = new_figure(7.6, 4.4)
    panel = figure.subplots()
    for name, words, colour in CURVES:
        curve = getattr(study, name)
        shares = curve.areas / curve.zygodactyl
        panel.plot(turns, shares, color=colour, label=words, linewidth=1.8)
        best = curve.best_reversal * math.degrees(toe.reversal)
        panel.plot(best, curve.best_area / curve.zygodactyl, "o", color=colour)
    panel.axvline(turns[-1], color=INK, linewidth=0.7, linestyle=":")
    panel.set_xlim(0, turns[-1])
    panel.set_xticks(np.arange(0, turns[-1] + 1, 15))
    panel.set_xlabel("turn of toe 4 from back to front [°]", fontsize=9)
    panel.set_ylabel("area over that of the zygodactyl pose", fontsize=9)
    panel.tick_params(labelsize=8)
    panel.grid(color=PALE, linewidth=0.4)
    panel.legend(fontsize=9, loc="upper left")
    return save_figure(figure, path)


def draw_ranges(rho: float, path: Path) -> Path:
    """Draw a closing toe's end and its talon's path, for two ranges of v.

    Args:
        rho: Scaling factor ρ.
        path: The PNG file.

    Returns:
        The path.
    """
    figure = new_figure(7.0, 5.4)
    panel = figure.subplots()
    for last, colour, words, away in (
        (1.0, INK, "v = 1: 150°", -1 - 0.6j),
        (PAPER_TURN, ACCENT, "v = π/6: 78.5°", 1 - 0.6j),
    ):
        turns = closing_turns(PAPER_TURN, np.linspace(0, last, FINE), BACK_TOE)
        toes = junctions(rho, turns)
        track = toes[:, -1]
        panel.plot(track.real, track.imag, color=colour, linewidth=1.2, ls="--")
        draw_toe(panel, toes[-1], colour, 2.2)
        note(panel, words, complex(track[-1]), away * 1.6)
    straight = junctions(rho, np.zeros(BACK_TOE))
    draw_toe(panel, straight, PALE, 1.4)
    note(panel, "v = 0", complex(straight[-1]), 1j)
    panel.plot(0, 0, "s", color=INK, markersize=6)
    panel.set_aspect("equal")
    panel.margins(0.12)
    panel.tick_params(labelsize=8)
    panel.set_xlabel("x, along toe 4", fontsize=9)
    panel.set_ylabel("z, up", fontsize=9)
    panel.grid(color=PALE, linewidth=0.4)
    return save_figure(figure, path)


def _draw_pose(panel: Axes, owl: Foot, azimuths: NDArray[np.float64]) -> None:
    """A straight foot from above in its skin, with the hull of its talons."""
    straight = np.zeros(owl.phalanx_count)
    bones = forward_kinematics(owl, straight, azimuths=azimuths) * MILLI
    flat = turned(bones[..., 0] + 1j * bones[..., 1])
    talons = [part.stop - 1 for part in owl.finger_slices.values()]
    hull = convex_hull(flat[talons, 1]).points
    corners = np.stack([hull.real, hull.imag], axis=1)
    panel.add_patch(Polygon(corners, fill=False, edgecolor=INK, ls="--", lw=0.9))
    for index, part in enumerate(owl.finger_slices.values()):
        colour, ahead = finger_paint(index).css, np.exp(1j * azimuths[index])
        for bone, skin in zip(flat[part], owl.radii[part] * MILLI, strict=True):
            outline = _outline(bone, float(skin))
            panel.add_patch(Polygon(outline, color=colour, alpha=0.25, linewidth=0))
        draw_toe(panel, np.append(0, flat[part, 1]), colour)
        degrees = round(math.degrees(azimuths[index]))
        words = f"toe {index + 1}\n{degrees}°".replace("-", "−")
        note(panel, words, complex(flat[part][-1, 1]), complex(1j * ahead))


def _outline(bone: NDArray[np.complex128], radius: float) -> NDArray[np.float64]:
    """The outline of a phalanx with its skin, shape (n, 2)."""
    ahead = radius * (bone[1] - bone[0]) / abs(bone[1] - bone[0])
    arc = ahead * np.exp(1j * np.linspace(-math.pi / 2, math.pi / 2, 13))
    outline = np.concatenate([bone[1] + arc, bone[0] - arc])
    return np.stack([outline.real, outline.imag], axis=1)
