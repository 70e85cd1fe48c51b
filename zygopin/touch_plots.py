"""The figure of touch intervals: bands of radii against ω and against ρ."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.branch import Branch
from zygopin.errors import ParameterError
from zygopin.figures import (
    INK,
    PALE,
    Axes,
    Unit,
    foot_title,
    line_width,
    new_figure,
    save_figure,
    unit_of,
)
from zygopin.files import check_file
from zygopin.foot import Foot
from zygopin.looks import finger_paint
from zygopin.touch import touch_intervals

OMEGAS = np.radians(np.linspace(5.0, 175.0, 35))
"""Joint limits that are drawn, unless said otherwise [rad]."""

RHOS = np.linspace(1.05, 2.0, 20)
"""Scaling factors that are drawn, unless said otherwise."""

DRAWN = 3e-3
"""Tolerance over the finger's length: less than a line's width."""

SHADE = 0.16
"""Opacity of a band: those of four fingers may lie over each other."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class _Bands:
    """Touch intervals of each finger along one parameter.

    Attributes:
        values: Values of the parameter, shape (n,).
        least: Least radii [m], shape (n, F).
        most: Greatest radii [m], NaN where there is none, shape (n, F).
    """

    values: Floats
    least: Floats
    most: Floats

    @classmethod
    def of(cls, values: Floats, feet: Sequence[Foot], branch: Branch) -> _Bands:
        found = [touch_intervals(foot, branch, tolerance=DRAWN) for foot in feet]
        most = np.array([each.most[:, 0] for each in found])
        least = np.array([each.least[:, 1] for each in found])
        empty = most <= 0
        return cls(
            values,
            np.where(empty, np.nan, np.maximum(least, 0.0)),
            np.where(empty, np.nan, most),
        )


def plot_touch_bands(
    foot: Foot,
    branch: Branch,
    path: Path | str,
    *,
    omegas: ArrayLike | None = None,
    rhos: ArrayLike | None = None,
) -> Path:
    """Draw which radii each finger can touch, as bands against ω and against ρ.

    Args:
        foot: The foot; its own ω and ρ are marked.
        branch: One branch: its axis line.
        path: The PNG file.
        omegas: Joint limits ω [rad], ascending, shape (n,); None: 5° to 175°.
        rhos: Scaling factors ρ, ascending, shape (n,); None: 1.05 to 2.

    Returns:
        The path.

    Raises:
        ParameterError: A value is out of range, or the branch is a batch.
        FileError: The file cannot be written.
    """
    check_file(path)
    kinds.instance("foot", foot, Foot)
    kinds.instance("branch", branch, Branch)
    if branch.batch_shape:
        remedy = "draw one axis at a time"
        raise ParameterError("branch's batch", branch.batch_shape, "()", remedy)
    turns = _values("omegas", OMEGAS if omegas is None else omegas)
    ratios = _values("rhos", RHOS if rhos is None else rhos)
    by_omega = _Bands.of(turns, [foot.replace(omega=x) for x in turns], branch)
    by_rho = _Bands.of(ratios, [foot.replace(rho=x) for x in ratios], branch)
    unit = unit_of(foot)
    figure = new_figure(11.0, 4.8)
    left, right = figure.subplots(1, 2, sharey=True)
    _draw(left, foot, by_omega, unit, math.degrees(1.0))
    _draw(right, foot, by_rho, unit, 1.0)
    left.set_xlabel("joint limit ω [°]", fontsize=9)
    right.set_xlabel("scaling factor ρ [1]", fontsize=9)
    left.set_ylabel(f"radius of the branch [{unit.name}]", fontsize=9)
    for panel, own in ((left, math.degrees(foot.omega)), (right, foot.rho)):
        panel.axvline(own, color=INK, linewidth=0.8, linestyle=":")
    right.legend(fontsize=8, loc="best", title="can touch, not enter", title_fontsize=8)
    figure.suptitle(f"{foot_title(foot)}; axis {_place(branch, unit)}", fontsize=11)
    return save_figure(figure, path)


def _values(name: str, values: ArrayLike) -> Floats:
    """Ascending values of a parameter, at least two."""
    found = checks.array(name, values)
    if found.ndim != 1 or len(found) < 2 or np.any(np.diff(found) <= 0):
        remedy = "give two values or more, ascending"
        raise ParameterError(name, values, "an ascending sequence", remedy)
    return found


def _draw(panel: Axes, foot: Foot, bands: _Bands, unit: Unit, factor: float) -> None:
    """The band of each finger; later outlines are thinner, so that all are seen."""
    x, count = bands.values * factor, len(foot.fingers)
    for index, finger in enumerate(foot.fingers):
        low, high = (
            edge[:, index] * unit.per_metre for edge in (bands.least, bands.most)
        )
        colour, width = finger_paint(index).css, line_width(index, count)
        panel.fill_between(x, low, high, color=colour, alpha=SHADE, linewidth=0)
        panel.plot(x, low, color=colour, linewidth=width, label=finger.name)
        panel.plot(x, high, color=colour, linewidth=width)
    panel.set_xlim(x[0], x[-1])
    panel.set_ylim(bottom=0)
    panel.tick_params(labelsize=8)
    panel.grid(color=PALE, linewidth=0.4)


def _place(branch: Branch, unit: Unit) -> str:
    """Where an axis line lies: a point of it, and its direction."""
    point = ", ".join(f"{x:.3g}" for x in branch.centre * unit.per_metre + 0.0)
    axis = ", ".join(f"{x:.3g}" for x in branch.axis + 0.0)
    return f"through ({point}) {unit.name} along ({axis})"
