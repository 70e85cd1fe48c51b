"""A grasp as a scene to look at: one HTML file that works offline."""

from __future__ import annotations

import math
from collections.abc import Iterable
from pathlib import Path

import numpy as np

from zygopin import kinds
from zygopin.camera import View, framed, grasp_direction
from zygopin.canvas import Canvas
from zygopin.caption import Key, caption
from zygopin.drawing import (
    AXIS_PAINTS,
    GRASPING,
    PENETRATING,
    STABLE,
    TOUCHING,
    draw_axes,
    draw_branch,
    draw_contacts,
    draw_foot,
    rims,
    stretch_beyond,
)
from zygopin.errors import ParameterError
from zygopin.files import check_file, write_text
from zygopin.foot import Foot
from zygopin.grasp import GraspReport
from zygopin.hold import Hold
from zygopin.hold_drawing import draw_hold, pull_arrow
from zygopin.looks import WOOD, Paint, drawn_radii, finger_paint
from zygopin.viewer import Recorder, page, set_stage

WIDE_BRANCH = 0.8
"""Radius over the foot's size from which the frame leaves the branch out."""


def export_scene(
    report: GraspReport,
    path: Path | str,
    *,
    title: str | None = None,
    hold: Hold | None = None,
) -> Path:
    """Write a grasp as one HTML file with meshcat's viewer inside.

    The file asks for nothing: it works offline, from a disk or a server. The same
    report gives the same bytes.

    Args:
        report: What `check_grasp` returned for one configuration.
        path: The file; its folders are made where they are missing.
        title: Title in plain text; None: the foot's name and the branch's radius.
        hold: What `check_hold` returned for it, to show friction cones and forces.

    Returns:
        The path.

    Raises:
        ParameterError: The report is of a batch.
        FileError: The file cannot be written.
    """
    check_file(path)
    kinds.instance("report", report, GraspReport)
    if hold is not None:
        kinds.instance("hold", hold, Hold)
    _check_single(report)
    title = _default_title(report) if title is None else kinds.text("title", title)
    view = grasp_view(report, hold)
    recorder = Recorder()
    set_stage(recorder, view)
    canvas = Canvas(recorder, view.target, view.unit)
    draw_foot(canvas, report.foot, report.bones)
    draw_branch(canvas, report.branch, drawn_stretch(report))
    draw_contacts(canvas, report)
    forces = draw_hold(canvas, hold, report.foot, report.bones[0, 0]) if hold else []
    legend = [*_legend(report.foot, draw_axes(canvas, view)), *keys(forces)]
    words = caption(report, title, verdict_paint(report).css, legend, hold)
    return write_text(path, page(recorder, view, title, words))


def grasp_view(report: GraspReport, hold: Hold | None = None) -> View:
    """The view that frames the foot, and a branch of the foot's own order of size.

    Args:
        report: Of one configuration.
        hold: How it holds, where its pull is shown.

    Returns:
        The view.
    """
    points, radii = report.bones.reshape(-1, 3), np.repeat(drawn_radii(report.foot), 2)
    if report.branch.radius < WIDE_BRANCH * report.foot.size:
        ends = rims(report.branch, infinite_stretch(report))
        points = np.concatenate([points, ends])
        radii = np.concatenate([radii, np.zeros(len(ends))])
    if hold is not None and hold.pull.force > 0:
        arrow = pull_arrow(hold, report.foot, report.bones[0, 0])
        points, radii = np.concatenate([points, arrow]), np.append(radii, [0.0, 0.0])
    return framed(points, radii, grasp_direction(report.branch))


def drawn_stretch(report: GraspReport) -> tuple[float, float]:
    """The part of the branch that is drawn, along its axis from its centre.

    Args:
        report: Of one configuration.

    Returns:
        Start and end [m]: the branch's own, or beyond the foot on both sides.
    """
    half = float(report.branch.half_length)
    return (-half, half) if math.isfinite(half) else infinite_stretch(report)


def infinite_stretch(report: GraspReport) -> tuple[float, float]:
    """The part of an infinite branch that shows how the foot lies on it.

    Args:
        report: Of one configuration.

    Returns:
        Start and end along the axis from the branch's centre [m].
    """
    return stretch_beyond(report.branch, report.bones, report.foot.size)


def verdict_paint(report: GraspReport) -> Paint:
    """The colour of the verdict on a whole grasp.

    Args:
        report: Of one configuration.

    Returns:
        The paint.
    """
    if not report.feasible:
        return PENETRATING
    if report.stable:
        return GRASPING if report.grasping else STABLE
    return TOUCHING


def _check_single(report: GraspReport) -> None:
    """The report is one, and of one configuration."""
    if not isinstance(report, GraspReport):
        remedy = "pass what check_grasp returned, or a plan's report"
        raise ParameterError("report", type(report).__name__, "a GraspReport", remedy)
    shape = report.clearance.shape
    if len(shape) != 1:
        remedy = "pass the controls of one configuration to check_grasp"
        raise ParameterError(
            "report.clearance.shape", shape, "of the form (P,)", remedy
        )


def _default_title(report: GraspReport) -> str:
    name = report.foot.name.replace("_", " ").capitalize()
    return (
        f"{name} on a branch of radius {float(report.branch.radius) * 1e3:.4g}\u00a0mm"
    )


def _legend(foot: Foot, arm: float) -> list[Key]:
    """What each colour stands for."""
    pairs = [(finger_paint(i), finger.name) for i, finger in enumerate(foot.fingers)]
    pairs += [
        (WOOD, "branch"),
        (GRASPING, "grasping contact"),
        (STABLE, "stable contact"),
        (TOUCHING, "mere touch"),
        (PENETRATING, "penetration"),
    ]
    return keys([*pairs, *direction_pairs(arm)])


def direction_pairs(arm: float) -> list[tuple[Paint, str]]:
    """The paints of the directions, and what they stand for.

    Args:
        arm: Length that the directions are drawn with [m].

    Returns:
        Paints and plain texts.
    """
    directions = zip(AXIS_PAINTS, ("x forward", "y left", "z up"), strict=True)
    return [(paint, f"{name}, {arm * 1e3:g} mm") for paint, name in directions]


def keys(pairs: Iterable[tuple[Paint, str]]) -> list[Key]:
    """Entries of a legend.

    Args:
        pairs: Paints, and what they stand for in plain text.

    Returns:
        The entries, in order.
    """
    return [Key(paint.css, meaning) for paint, meaning in pairs]
