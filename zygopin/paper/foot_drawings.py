"""Drawings of the whole foot: from above, under the paper's labels, from the side."""

from __future__ import annotations

import math
from collections.abc import Mapping
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.figures import (
    ACCENT,
    INK,
    PALE,
    Axes,
    draw_toe,
    new_figure,
    note,
    save_figure,
)
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.looks import finger_paint
from zygopin.paper.top_view import (
    ANGLE_LABELS,
    BASE_HEIGHT,
    COUNTS,
    LABELS,
    assignments,
)

ARC, WORDS = 0.3, {"π/6": 0.58, "5π/6": 0.52}
"""Radius of the arcs of angles, and of the places of their labels."""

PLACE = 0.6
"""Where a phalanx's length is written, along it."""

ARCS = ((-1, 1, "π/6"), (1, 11, "5π/6"), (11, 13, "π/6"), (13, 23, "5π/6"))
"""Sectors between fingers: from and to, over π/12, and the paper's labels."""

ASIDE = 0.18
"""Distance of a phalanx's length from it."""

CENTRE = 68.0
"""Where the base is put from left to right in the paper's drawing [points]."""

LETTERS = 10.0
"""Size of the paper's labels [points]."""

LOWEST, HIGHEST, FRAME_HEIGHT = -15, 325, 7.0
"""What is shown of the paper's drawing [points], and how tall [inches]."""

FRACTIONS = {"π/6": r"$\frac{\pi}{6}$", "5π/6": r"$\frac{5}{6}\pi$"}
"""Angles as the paper writes them."""

Points = NDArray[np.complex128]


def draw_foot_from_above(foot: Foot, path: Path) -> Path:
    """Draw a straight foot from above with its angles, names and lengths.

    Args:
        foot: The foot.
        path: The PNG file.

    Returns:
        The path.
    """
    figure = new_figure(6.4, 8.6)
    panel = figure.subplots()
    for index, points in enumerate(straight_toes(foot)):
        _draw_named_toe(panel, foot, index, points)
    for first, last, words in ARCS:
        _draw_arc(panel, first * math.pi / 12, last * math.pi / 12, words)
    panel.plot(0, 0, "s", color=INK, markersize=6)
    name_top_axes(panel)
    panel.set(xlim=(1.55, -1.55), ylim=(-3.35, 2.95))
    return save_figure(figure, path)


def draw_labels(feet: Mapping[str, Foot], path: Path) -> Path:
    """Draw the paper's labels where its source puts them, over each of some feet.

    Args:
        feet: The feet, by the titles of their panels.
        path: The PNG file.

    Returns:
        The path.
    """
    figure = new_figure(9.0, FRAME_HEIGHT + 0.9)
    panels = figure.subplots(1, len(feet), sharex=True, sharey=True, squeeze=False)[0]
    for panel, (title, foot) in zip(panels, feet.items(), strict=True):
        _draw_under_labels(panel, foot)
        panel.set_title(title, fontsize=10)
    panels[0].set_ylabel("up [points]; dotted: the base's height", fontsize=9)
    return save_figure(figure, path)


def draw_back_toes(
    panels: Mapping[str, tuple[list[Points], list[Points]]], path: Path
) -> Path:
    """Draw stages of a forward toe and of a back toe, in side views.

    Args:
        panels: For each title the junctions of the forward toe and of the back toe,
            at the stages v = 0, 1/2 and 1.
        path: The PNG file.

    Returns:
        The path.
    """
    drawn = np.concatenate(
        [toe for pair in panels.values() for toes in pair for toe in toes]
    )
    tall = float(np.ptp(drawn.imag) / np.ptp(drawn.real))
    figure = new_figure(10.5, 1.4 + 4.9 * tall)
    views = figure.subplots(1, len(panels), sharex=True, sharey=True, squeeze=False)[0]
    for view, (title, (forward, back)) in zip(views, panels.items(), strict=True):
        for stages, colour in ((forward, ACCENT), (back, finger_paint(0).css)):
            for points, shade in zip(stages, (INK, "#8b939e", colour), strict=True):
                draw_toe(view, points, shade, 1.4 if shade is not colour else 2.4)
        note(view, "forward", forward[-1][-1], forward[-1][-1] - forward[-1][-2])
        note(view, "back", back[-1][-1], back[-1][-1] - back[-1][-2])
        view.plot(0, 0, "s", color=INK, markersize=6)
        view.set_title(title, fontsize=10)
        view.set_aspect("equal")
        view.margins(0.08, 0.16)
        view.tick_params(labelsize=8)
        view.set_xlabel("x, forward; black: v = 0, grey: 1/2, colour: 1", fontsize=9)
        view.grid(color=PALE, linewidth=0.4)
    views[0].set_ylabel("z, up", fontsize=9)
    return save_figure(figure, path)


def straight_toes(foot: Foot) -> list[Points]:
    """Junctions of the straight toes from above, x + iy.

    Args:
        foot: The foot.

    Returns:
        Points from the base on, over the scale, shape (K + 1,) for each finger.
    """
    bones = forward_kinematics(foot, np.zeros(foot.phalanx_count)) / foot.scale
    ends = bones[:, 1, 0] + 1j * bones[:, 1, 1]
    return [np.append(0, ends[part]) for part in foot.finger_slices.values()]


def name_top_axes(panel: Axes, unit: str = "") -> None:
    """Say what is along the axes of a view from above, x up and y to the left.

    Args:
        panel: The panel, across which y runs.
        unit: What follows the axes' names.
    """
    panel.set_xlabel(f"y, to the left{unit}", fontsize=9)
    panel.set_ylabel(f"x, forward{unit}", fontsize=9)
    panel.tick_params(labelsize=8)
    panel.set_aspect("equal")
    panel.grid(color=PALE, linewidth=0.4)


def turned(points: Points | complex) -> Points:
    """Points x + iy as they stand on a panel across which y runs.

    Args:
        points: Points.

    Returns:
        Points y + ix.
    """
    return np.asarray(1j * np.conj(points))


def _draw_under_labels(panel: Axes, foot: Foot) -> None:
    """A foot at the fitted scale under the paper's labels."""
    scale, base = assignments(foot)[COUNTS].scale, CENTRE + 1j * BASE_HEIGHT
    panel.axhline(BASE_HEIGHT, color=INK, linewidth=0.6, linestyle=":")
    for index, points in enumerate(straight_toes(foot)):
        draw_toe(panel, base + 1j * scale * points, finger_paint(index).css, 2.2)
    # As large as the paper's letters are on its drawing.
    size = LETTERS * FRAME_HEIGHT * 72 / (HIGHEST - LOWEST)
    for index, (name, place) in enumerate(LABELS.items()):
        text, colour = name.replace("finger", "Finger "), finger_paint(index).css
        panel.text(*place, text, fontsize=size, color=colour)
    for name, place in ANGLE_LABELS.items():
        panel.text(*place, FRACTIONS[name.split()[0]], fontsize=size, color=INK)
    panel.set(xlim=(-30, 175), ylim=(LOWEST, HIGHEST), aspect="equal")
    panel.set_xlabel("right in the paper's picture [points]", fontsize=9)
    panel.tick_params(labelsize=8)
    panel.grid(color=PALE, linewidth=0.4)


def _draw_named_toe(panel: Axes, foot: Foot, index: int, points: Points) -> None:
    """A toe with its name and the lengths of its phalanges."""
    finger = foot.fingers[index]
    ahead = np.exp(1j * finger.azimuth)
    # Away from the neighbour that is close by.
    aside = 1j * ahead if index in (1, 3) else -1j * ahead
    draw_toe(panel, turned(points), finger_paint(index).css, 2.2)
    for before, after in pairwise(points.tolist()):
        place = complex(turned(before + PLACE * (after - before) + ASIDE * aside))
        words = f"{abs(after - before):.3f}"
        panel.text(place.real, place.imag, words, fontsize=8, ha="center", va="center")
    number = finger.name.removeprefix("finger")
    # On the screen x is up and y to the left: a direction is turned by i.
    note(panel, f"Finger {number}", complex(turned(points[-1])), complex(1j * ahead))


def _draw_arc(panel: Axes, first: float, last: float, words: str) -> None:
    """The arc of an angle and its label."""
    arc = turned(ARC * np.exp(1j * np.linspace(first, last, 61)))
    panel.plot(arc.real, arc.imag, color=INK, linewidth=0.8)
    place = complex(turned(WORDS[words] * np.exp(0.5j * (first + last))))
    panel.text(
        place.real, place.imag, words, fontsize=12, ha="center", va="center", color=INK
    )
