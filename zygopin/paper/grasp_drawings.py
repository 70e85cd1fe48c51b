"""Figures of poses astride a branch, with the directions that products are of."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from zygopin.contact_products import base_to_tip
from zygopin.figures import (
    ACCENT,
    INK,
    PALE,
    Axes,
    Figure,
    Unit,
    new_figure,
    note,
    save_figure,
)
from zygopin.grasp import GraspReport, check_grasp
from zygopin.paper.finger_plane import (
    PAIR,
    Floats,
)
from zygopin.paper.grasp_cases import Case, perch, quarter_turn, trunk
from zygopin.side_views import draw_side_view, side_view

UNIT = Unit("1", 1.0)
"""The paper's own unit of length."""

ARROW = 0.3
"""Length of an arrow over the foot's size."""


def draw_quarter_turn(path: Path) -> Path:
    """Draw the pose whose product is zero.

    Args:
        path: The PNG file.

    Returns:
        The path.
    """
    figure = new_figure(6.5, 5.4)
    panel = figure.subplots()
    panel.set_ylabel("z, up", fontsize=9)
    report = _draw_case(panel, quarter_turn())
    for finger, away in zip(PAIR, (-1 + 0.6j, 1 + 0.4j), strict=True):
        index = _tangent(report, finger)
        place = complex(side_view(report.point[index], report.branch.axis))
        note(panel, f"{finger[:-1]} {finger[-1]}", place, 1.6 * away)
    _name_arrows(figure, panel)
    return save_figure(figure, path)


def draw_readings(path: Path) -> Path:
    """Draw both readings of the product, on a trunk and on a perch.

    Args:
        path: The PNG file.

    Returns:
        The path.
    """
    figure = new_figure(8.6, 4.9)
    views = figure.subplots(1, 2, sharey=True)
    views[0].set_ylabel("z, up", fontsize=9)
    titles = ("on a trunk of radius 22", "on a perch of radius 0.698")
    for view, case, title in zip(views, (trunk(), perch()), titles, strict=True):
        report = _draw_case(view, case)
        words = (
            f"{title}\nnormals {float(report.scalar_product):.3f}, directions "
            f"{float(report.scalar_product_base_to_tip):.3f}"
        )
        view.set_title(words.replace("-", "−"), fontsize=10)
    _name_arrows(figure, views[0])
    return save_figure(figure, path)


def _name_arrows(figure: Figure, view: Axes) -> None:
    """The legend of both directions, below all panels."""
    for colour, words in ((INK, "contact normal"), (ACCENT, "base to tip")):
        view.plot([], [], color=colour, linewidth=2, label=words)
    figure.legend(loc="outside lower center", ncols=2, fontsize=9)


def _draw_case(view: Axes, case: Case) -> GraspReport:
    """A pose on its branch, with both directions at its contacts."""
    report = check_grasp(case.foot, case.controls, case.branch)
    draw_side_view(view, report, UNIT)
    directions = base_to_tip(report.bones)
    for finger in PAIR:
        index = _tangent(report, finger)
        place = report.point[index]
        _arrow(view, report, place, report.normal[index], INK)
        _arrow(view, report, place, directions[index], ACCENT)
    view.plot(0, 0, "s", color=INK, markersize=5)
    view.set_axisbelow(True)
    view.grid(color=PALE, linewidth=0.4)
    view.tick_params(labelsize=8)
    view.set_xlabel("x, forward", fontsize=9)
    return report


def _tangent(report: GraspReport, finger: str) -> int:
    """The finger's tangent phalanx."""
    part = report.foot.finger_slices[finger]
    return int(part.start + np.argmax(report.tangent[part]))


def _arrow(
    view: Axes,
    report: GraspReport,
    place: Floats,
    direction: Floats,
    colour: str,
) -> None:
    """An arrow along a direction of space, seen along the branch."""
    start, way = (complex(side_view(x, report.branch.axis)) for x in (place, direction))
    end = start + ARROW * report.foot.size * way
    style = {"arrowstyle": "-|>", "color": colour, "lw": 1.8}
    ends = (end.real, end.imag), (start.real, start.imag)
    view.annotate("", *ends, arrowprops=style, zorder=6)
