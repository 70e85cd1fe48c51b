"""The fingers' reachable sets as clouds around the foot: one offline HTML file."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from html import escape
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.camera import framed
from zygopin.canvas import Canvas
from zygopin.caption import Key, Lengths, foot_rows, legend, section
from zygopin.drawing import draw_axes, draw_foot
from zygopin.files import check_file, write_text
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.looks import Paint, drawn_radii, finger_paint
from zygopin.reach import (
    MOST_LEVELS,
    MOST_POINTS,
    FingerReach,
    finger_reach,
    levels_within,
)
from zygopin.scene import direction_pairs, keys
from zygopin.viewer import Recorder, page, set_stage

MOST_DOTS = 7_000
"""Dots that a cloud is thinned to: all clouds together stay below two megabytes."""

EYE = np.array([0.46, -0.76, 0.46])
"""Where the foot is seen from: its right, from before and above."""

DOT = 0.005
"""Width of a dot in units of the view; the viewer takes it for a right-angled view."""

PALEST = 0.62
"""Share of white in the colour of the first junctions' cloud."""

DRAWN_CONTROL = 0.25
"""Every control of the drawn foot: its junctions lie in their clouds, unobscured."""

_SUPERSCRIPTS = str.maketrans("0123456789", "⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True, eq=False)
class JunctionCloud:
    """Where one junction of a finger can be.

    Attributes:
        reach: The junction's reachable set.
        stride: Every so many points are drawn.
        paint: Their look.
    """

    reach: FingerReach
    stride: int
    paint: Paint

    @property
    def dots(self) -> NDArray[np.float64]:
        """The points that are drawn [m], shape (N, 3)."""
        return self.reach.in_space(slice(None, None, self.stride))


def export_reach_scene(
    foot: Foot, path: Path | str, *, levels: int | None = None, title: str | None = None
) -> Path:
    """Write all fingers' reachable sets as one HTML file with meshcat's viewer inside.

    Each finger has its colour, which deepens from the first junction's set to the
    tip's. The file works offline, and the same foot gives the same bytes.

    Args:
        foot: The foot; it is drawn a quarter closed.
        path: The file; its folders are made where they are missing.
        levels: Equal levels of each control; None: at most 33, and fewer for fingers
            that would have more than two million points.
        title: Title in plain text; None: the foot's name.

    Returns:
        The path.

    Raises:
        ParameterError: The levels are out of range, or the points need more memory.
        FileError: The file cannot be written.
    """
    check_file(path)
    kinds.instance("foot", foot, Foot)
    if levels is not None:
        levels = checks.integer("levels", levels, 2, MOST_POINTS)
    clouds = list(junction_clouds(foot, levels))
    bones = forward_kinematics(foot, np.full(foot.phalanx_count, DRAWN_CONTROL))
    title = (
        f"Reach of {foot.name.replace('_', ' ')}"
        if title is None
        else kinds.text("title", title)
    )
    seen = np.concatenate([bones.reshape(-1, 3), *(cloud.dots for cloud in clouds)])
    radii = np.full(len(seen), float(drawn_radii(foot).max()))
    view = framed(seen, radii, EYE / np.linalg.norm(EYE))
    recorder = Recorder()
    set_stage(recorder, view)
    canvas = Canvas(recorder, view.target, view.unit)
    draw_foot(canvas, foot, bones)
    for cloud in clouds:
        name = f"reach/{cloud.reach.finger.name}/junction{cloud.reach.depth}"
        canvas.cloud(name, cloud.dots, DOT * view.unit / view.half_height, cloud.paint)
    words = _caption(foot, clouds, title, draw_axes(canvas, view))
    return write_text(path, page(recorder, view, title, words))


def junction_clouds(foot: Foot, levels: int | None = None) -> Iterator[JunctionCloud]:
    """Where each junction of each finger can be, thinned for drawing.

    Args:
        foot: The foot.
        levels: Equal levels of each control; None: as many as suit the finger.

    Yields:
        Finger by finger, the first junction's cloud first.

    Raises:
        ParameterError: The levels are out of range, or the points need more memory.
    """
    for index, finger in enumerate(foot.fingers):
        count = levels or levels_within(finger.phalanges, MOST_POINTS, MOST_LEVELS)
        for depth in range(1, finger.phalanges + 1):
            reach = finger_reach(foot, finger.name, count, depth=depth)
            pale = PALEST * (finger.phalanges - depth) / max(finger.phalanges - 1, 1)
            stride = _stride(len(reach.plane.points), count)
            yield JunctionCloud(reach, stride, finger_paint(index).tinted(pale))


def _stride(points: int, levels: int) -> int:
    """A stride that leaves few enough points, and runs through all levels of each.

    Points are numbered by their words in base n: a stride that shares a factor with n
    would draw some of the last controls only.
    """
    stride = -(-points // MOST_DOTS)
    while math.gcd(stride, levels) > 1:
        stride += 1
    return stride


def _caption(
    foot: Foot, clouds: Sequence[JunctionCloud], title: str, arm: float
) -> str:
    """What is shown, how exactly, and the colours."""
    tips = [c for c in clouds if c.reach.depth == c.reach.finger.phalanges]
    lengths = Lengths(foot.size)
    points = {c.reach.finger.name: _count_words(c) for c in tips}
    grid = {c.reach.finger.name: lengths(c.reach.grid_bound) for c in tips}
    words = "Where each junction can be, paler toward the base"
    return "\n".join(
        (
            f"<h1>{escape(title)}</h1>",
            f'<p class="verdict" style="border-color: #69727d">{words}</p>',
            section("Points of the tip's set", points),
            section("Any tip to its set, at most", grid),
            legend(_colours(foot, arm)),
            section("Foot", foot_rows(foot)),
        )
    )


def _count_words(cloud: JunctionCloud) -> str:
    """How many points a set has, and how many of them are drawn."""
    levels, depth = len(cloud.reach.plane.levels), cloud.reach.depth
    exponent = str(depth).translate(_SUPERSCRIPTS)
    power = f"{levels}{exponent} = {levels**depth:_}".replace("_", "\u2009")
    return power if cloud.stride == 1 else f"{power}, 1 in {cloud.stride} drawn"


def _colours(foot: Foot, arm: float) -> Iterator[Key]:
    """What each colour stands for."""
    for index, finger in enumerate(foot.fingers):
        yield Key(finger_paint(index).css, finger.name)
    yield from keys(direction_pairs(arm))
