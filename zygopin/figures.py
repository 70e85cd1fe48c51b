"""What figures share: units, the names of axes, toes and notes, the file.

Matplotlib comes from here alone, so that its absence is told once.
"""

from __future__ import annotations

import io
import math
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.errors import MissingExtraError
from zygopin.files import write_bytes
from zygopin.foot import Foot

try:
    from matplotlib import colormaps as colormaps
    from matplotlib.axes import Axes as Axes
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.cm import ScalarMappable as ScalarMappable
    from matplotlib.collections import PolyCollection as PolyCollection
    from matplotlib.colors import ListedColormap as ListedColormap
    from matplotlib.colors import LogNorm as LogNorm
    from matplotlib.colors import Normalize as Normalize
    from matplotlib.colors import to_hex as to_hex
    from matplotlib.figure import Figure as Figure
    from matplotlib.image import AxesImage as AxesImage
    from matplotlib.patches import Circle as Circle
    from matplotlib.patches import Patch as Patch
    from matplotlib.patches import Polygon as Polygon
except ImportError as error:
    raise MissingExtraError("matplotlib", "plots") from error

DOTS_PER_INCH = 150

LARGE = 0.5
"""Size of a foot from which its figures are in metres [m], not in millimetres."""

THIN, THICK = 1.2, 3.4
"""Widths of lines that may coincide, the last and the first [points]."""

FINE = 721
"""Values of v along a curve."""

NOTE = 24
"""Distance from a point to the middle of its note [points]."""

INK, ACCENT, PALE = "#22272e", "#c0392b", "#c9ced6"


@dataclass(frozen=True)
class Unit:
    """A unit of length on a figure.

    Attributes:
        name: Its symbol.
        per_metre: How many make a metre.
    """

    name: str
    per_metre: float

    def text(self, metres: float) -> str:
        """A length in words: four figures and the unit."""
        return f"{metres * self.per_metre:.4g} {self.name}"


def unit_of(foot: Foot) -> Unit:
    """The unit that suits a foot: metres for the model's own, else millimetres.

    Args:
        foot: The foot.

    Returns:
        The unit.
    """
    return Unit("m", 1.0) if foot.size >= LARGE else Unit("mm", 1e3)


def new_figure(width: float, height: float) -> Figure:
    """An empty figure that no window knows of.

    Args:
        width: Its width [inches].
        height: Its height [inches].

    Returns:
        The figure.
    """
    return Figure((width, height), dpi=DOTS_PER_INCH, layout="constrained")


def name_axes(panel: Axes, unit: Unit, *, leftmost: bool = True) -> None:
    """Say what is along the axes of a finger's plane.

    Args:
        panel: The panel.
        unit: The unit of both axes.
        leftmost: Whether it is the first in its row, where z is named once.
    """
    panel.set_xlabel(f"x, along the finger [{unit.name}]", fontsize=9)
    panel.tick_params(labelsize=8, labelleft=leftmost)
    if leftmost:
        panel.set_ylabel(f"z, up [{unit.name}]", fontsize=9)


def foot_title(foot: Foot) -> str:
    """Which foot a figure shows.

    Args:
        foot: The foot.

    Returns:
        Its name and parameters.
    """
    length, omega = unit_of(foot).text(foot.scale), math.degrees(foot.omega)
    return f"{foot.name}, ρ = {foot.rho:.6g}, ω = {omega:.6g}°, s = {length}"


def line_width(index: int, count: int) -> float:
    """Width of one of several lines that may coincide: later ones are thinner.

    Args:
        index: Its place among them, from 0, in the order of drawing.
        count: How many there are.

    Returns:
        The width [points].
    """
    return THIN + (THICK - THIN) * (count - 1 - index) / max(count - 1, 1)


def draw_toe(
    panel: Axes, points: NDArray[np.complex128], colour: str, width: float = 1.8
) -> None:
    """Draw a toe as a line with its junctions.

    Args:
        panel: The panel.
        points: The junctions, in the panel's unit, shape (K + 1,).
        colour: The colour.
        width: The line's width [points].
    """
    x, z = points.real, points.imag
    panel.plot(x, z, "o-", color=colour, linewidth=width, markersize=3.5)


def note(panel: Axes, text: str, place: complex, away: complex = -1) -> None:
    """Write a few words beside a point.

    Args:
        panel: The panel.
        text: The words.
        place: The point, in the panel's unit.
        away: Direction of the words from the point.
    """
    away *= NOTE / abs(away)
    panel.annotate(
        text,
        (place.real, place.imag),
        xytext=(away.real, away.imag),
        textcoords="offset points",
        ha="center",
        va="center",
        fontsize=9,
        color=INK,
        bbox={"facecolor": "white", "edgecolor": "none", "alpha": 0.75, "pad": 1},
    )


def save_figure(figure: Figure, path: Path | str) -> Path:
    """Write a figure as PNG, without the program's version in it.

    Args:
        figure: The figure.
        path: The file.

    Returns:
        The path.

    Raises:
        FileError: The file cannot be written.
    """
    FigureCanvasAgg(figure)
    buffer = io.BytesIO()
    figure.savefig(buffer, format="png", metadata={"Software": None})
    return write_bytes(path, buffer.getvalue())
