"""The figure of a design: the graspable radii of the foot before and after."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from zygopin import kinds
from zygopin.design import Design
from zygopin.figures import ACCENT, INK, Axes, Unit, new_figure, save_figure, unit_of
from zygopin.files import check_file
from zygopin.foot import Foot
from zygopin.graspable import GraspableRadii

TICKS = (1, 1.5, 2, 3, 4, 5, 6, 8)
"""Leading digits of the ticks on the axis of radii."""

MOST_TICKS = 12

BAR = 0.5
"""Height of a bar, over the distance from one to the next."""

RANGE_COLOUR = "#e4e6ea"


def plot_design(design: Design, path: Path | str) -> Path:
    """Draw the perches that a foot grasps before and after its design, as bars.

    Args:
        design: The design.
        path: The PNG file.

    Returns:
        The path.

    Raises:
        FileError: The file cannot be written.
        MissingExtraError: Matplotlib is not installed.
    """
    check_file(path)
    kinds.instance("design", design, Design)
    unit = unit_of(design.before.foot)
    ends = (design.before.low, design.before.high)
    low, high = (end * unit.per_metre for end in ends)
    figure = new_figure(8.0, 2.9)
    panel = figure.subplots()
    _draw_bars(panel, 0, design.before, INK, unit)
    _draw_bars(panel, 1, design.after, ACCENT, unit)
    panel.set_xscale("log")
    panel.set_xlim(low, high)
    panel.set_ylim(1.5, -0.75)
    ticks = _ticks(low, high)
    panel.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    panel.set_xticks([], minor=True)
    panel.set_yticks([0, 1], ["before", "after"])
    panel.tick_params(labelsize=9)
    panel.set_xlabel(f"radius of the perch [{unit.name}]", fontsize=9)
    figure.suptitle(_title(design.before, design.after), fontsize=11)
    return save_figure(figure, path)


def _draw_bars(
    panel: Axes, place: int, perches: GraspableRadii, colour: str, unit: Unit
) -> None:
    """The asked range of radii, the graspable ones in it, and the foot's parameters."""
    asked = (perches.low, perches.high)
    for (low, high), shade in (
        (asked, RANGE_COLOUR),
        *((ends, colour) for ends in perches.intervals),
    ):
        width = (high - low) * unit.per_metre
        panel.barh(place, width, left=low * unit.per_metre, height=BAR, color=shade)
    panel.annotate(
        f"{_parameters(perches.foot)};  {perches.share:.1%} of the range",
        (perches.low * unit.per_metre, place - 0.32),
        xytext=(4, 0),
        textcoords="offset points",
        fontsize=8,
        color=INK,
    )


def _title(before: GraspableRadii, after: GraspableRadii) -> str:
    """Whose perches these are."""
    same = "" if before.foot == after.foot else f" and {after.foot.name}"
    return f"perches grasped at rest by {before.foot.name}{same}"


def _parameters(foot: Foot) -> str:
    """A foot's parameters in one line."""
    omega, splay = math.degrees(foot.omega), math.degrees(foot.splay)
    scale = unit_of(foot).text(foot.scale)
    return f"ρ = {foot.rho:.4g}, ω = {omega:.4g}°, Ω = {splay:.4g}°, s = {scale}"


def _ticks(low: float, high: float) -> list[float]:
    """Round numbers within a range, and its ends."""
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    round_ones = np.array([lead * 10.0**power for power in powers for lead in TICKS])
    apart = math.log(high / low) / MOST_TICKS
    kept = [low]
    for tick in [*round_ones[(round_ones > low) & (round_ones < high)], high]:
        if math.log(tick / kept[-1]) > apart:
            kept.append(float(tick))
        elif tick == high and len(kept) > 1:
            kept[-1] = high
    return kept
