"""Drawings of one finger: the paper's notation, and what its limit set leaves out."""

from __future__ import annotations

import math
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

Complexes = NDArray[np.complex128]

GREY = "#69727d"
"""Colour of a limit set."""

AHEAD = 0.3
"""Length of the broken line that goes on straight."""


def draw_notation(path: Path, toe: Complexes, omega: float) -> Path:
    """Draw three phalanges, the last one turned by ω against the one before.

    Args:
        path: The PNG file.
        toe: The junctions x + iz, the base first, shape (4,).
        omega: The turn ω [rad].

    Returns:
        The path.
    """
    figure = new_figure(7.0, 3.6)
    panel = figure.subplots()
    draw_toe(panel, toe, INK, 2.4)
    ahead = (toe[2] - toe[1]) / abs(toe[2] - toe[1])
    straight = np.array([toe[2], toe[2] + AHEAD * ahead])
    panel.plot(straight.real, straight.imag, "--", color=ACCENT, linewidth=1.2)
    arc = toe[2] + 0.6 * AHEAD * ahead * np.exp(-1j * np.linspace(0, omega, 40))
    panel.plot(arc.real, arc.imag, color=ACCENT, linewidth=1.6)
    middle = arc[20] + 0.35 * (arc[20] - toe[2])
    panel.text(middle.real, middle.imag, r"$\omega$", color=ACCENT, fontsize=15)
    names = ("x_{k-2}", "x_{k-1}", "x_k", "x_{k+1}")
    for name, place, away in zip(names, toe, (-1 + 1j, 1j, 1j, -1j), strict=True):
        note(panel, f"${name}$", place, away)
    _label_phalanx(panel, toe[1:3], r"phalanx $k$")
    _label_phalanx(panel, toe[2:4], r"phalanx $k+1$")
    panel.set_aspect("equal")
    panel.margins(0.08, 0.28)
    panel.set_xlabel("x, along the finger")
    panel.set_ylabel("z, up")
    return save_figure(figure, path)


def draw_finite_sums(path: Path, limit: Complexes, sums: Complexes) -> Path:
    """Draw an attractor with the finite sums that are not on it.

    Args:
        path: The PNG file.
        limit: Points that stand for the attractor, that of straight fingers first.
        sums: The finite sums, x₀ first.

    Returns:
        The path.
    """
    figure = new_figure(7.0, 5.4)
    panel = figure.subplots()
    label = r"attractor, $R = \{0, 1\}$"
    panel.plot(limit.real, limit.imag, "o", ms=1.0, mew=0, color=GREY)
    panel.plot([], [], "o", ms=4, mew=0, color=GREY, label=label)
    label = "sums of 0, 1, 2, … phalanges"
    panel.plot(sums.real, sums.imag, "o", ms=4, mew=0, color=ACCENT, label=label)
    end = limit[0].real
    panel.plot(end, 0, "s", ms=6, color=INK, label=r"$1/(\rho-1)$")
    note(panel, "$x_0$", 0j, 1j)
    panel.set_aspect("equal")
    panel.margins(0.08, 0.12)
    panel.grid(color=PALE, linewidth=0.4)
    panel.set_xlabel("x, along the finger")
    panel.set_ylabel("z, up")
    figure.legend(loc="outside lower center", ncols=3, frameon=False)
    return save_figure(figure, path)


def _label_phalanx(panel: Axes, ends: Complexes, text: str) -> None:
    """Write a phalanx's name along it, below."""
    along = ends[1] - ends[0]
    middle = ends.mean() - 0.06j * along / abs(along)
    angle = math.degrees(math.atan2(along.imag, along.real))
    panel.text(
        middle.real,
        middle.imag,
        text,
        rotation=angle,
        ha="center",
        va="top",
        rotation_mode="anchor",
        fontsize=10,
        color=INK,
    )
