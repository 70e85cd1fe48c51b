"""A row of an atlas as a scene that plays: the branch grows, the foot grasps it."""

from __future__ import annotations

from collections.abc import Sequence
from html import escape
from pathlib import Path

import numpy as np

from zygopin import kinds
from zygopin.atlas import Atlas
from zygopin.atlas_regions import (
    REGION_WORDS,
    Region,
    pose_report,
)
from zygopin.atlas_row import Row
from zygopin.camera import View, framed, wrap_direction
from zygopin.canvas import Canvas
from zygopin.caption import Lengths, foot_rows, legend, section
from zygopin.drawing import (
    GRASPING,
    PENETRATING,
    STABLE,
    TOUCHING,
    draw_axes,
    draw_branch,
    draw_contacts,
    draw_foot,
    moved_parts,
    rims,
    stretch_beyond,
)
from zygopin.files import check_file, write_text
from zygopin.foot import Foot
from zygopin.looks import WOOD, Paint, drawn_radii, finger_paint
from zygopin.playback import (
    Playback,
    Span,
    Track,
    page_time,
    phalanx_frames,
    player_controls,
)
from zygopin.scene import direction_pairs, keys
from zygopin.viewer import Player, Recorder, page, set_stage

SPEEDS = (0.25, 0.5, 1.0, 2.0, 4.0)

WIDE_STEP = 0.45
"""Radius over the foot's size from which the frame leaves a branch out."""

REGION_PAINTS = {
    Region.GRASPING: Paint(0x1B7F3B),
    Region.FEASIBLE: Paint(0xB45309),
    Region.TOUCHABLE: Paint(0x2F5FC4),
    Region.STABLE: Paint(0xA33B2A),
    Region.NONE: Paint(0x69727D),
    Region.UNDECIDED: Paint(0x7D3C98),
}
"""White letters can be read on each."""

HINT = (
    "Space plays and pauses, the slider and the arrow keys go from branch to branch, "
    "a radius in the table jumps to it. Each picture is a pose that was checked; "
    "without one the foot is not drawn."
)


def export_atlas_scene(
    atlas: Atlas,
    path: Path | str,
    *,
    height: float | None = None,
    title: str | None = None,
) -> Path:
    """Write one row of an atlas as an HTML file that plays it in meshcat's viewer.

    The branch grows step by step, and the foot takes the pose that shows most on it.
    A slider, the keyboard and a table go to any branch. The file asks for nothing: it
    works offline. The same atlas gives the same bytes.

    Args:
        atlas: The atlas.
        path: The file; its folders are made where they are missing.
        height: z of the branches' centres [m], the nearest of the grid's; None: for
            each radius the highest of the grid's that leaves room for the skin between
            the base and the bark, as for a foot at rest.
        title: Title in plain text; None: the foot's name.

    Returns:
        The path.

    Raises:
        ParameterError: There is no branch at that height that leaves the base free.
        FileError: The file cannot be written.
    """
    check_file(path)
    kinds.instance("atlas", atlas, Atlas)
    row, foot = Row.at(atlas, height), atlas.foot
    view = _view(row)
    recorder = Recorder()
    set_stage(recorder, view)
    canvas = Canvas(recorder, view.target, view.unit)
    draw_foot(canvas, foot, row.bones[0])
    _draw_steps(canvas, row)
    spans = [_span(row, step) for step in row.changes]
    playback = Playback(
        row.times, _tracks(row), spans, [], _glimpses(row), _labels(row)
    )
    name = foot.name.replace("_", " ").capitalize()
    title = (
        f"{name} on branches of growing radius"
        if title is None
        else kinds.text("title", title)
    )
    words = _caption(row, title, draw_axes(canvas, view))
    marks = [span.start for span in spans[1:]]
    ends = (float(row.times[0]), float(row.times[-1]))
    player = Player(
        playback.data(canvas), player_controls(ends, spans, marks, _speeds())
    )
    return write_text(path, page(recorder, view, title, words, player))


def _view(row: Row) -> View:
    """The view that frames all poses, and branches that are not too wide for it."""
    foot, grid = row.atlas.foot, row.atlas.grid
    points = row.bones.reshape(-1, 3)
    radii = np.tile(np.repeat(drawn_radii(foot), 2), len(row.cells))
    for step in range(len(row.cells)):
        if step == 0 or row.radius(step) < WIDE_STEP * foot.size:
            ends = rims(row.branch(step), _stretch(row))
            points = np.concatenate([points, ends])
            radii = np.concatenate([radii, np.zeros(len(ends))])
    up = np.eye(3)[2 if abs(grid.axis[2]) < 0.9 else 0]
    up = up - (up @ grid.axis) * grid.axis
    return framed(points, radii, wrap_direction(grid.axis, up / np.linalg.norm(up)))


def _stretch(row: Row) -> tuple[float, float]:
    """The part of every branch that is drawn, beyond the foot in all its poses [m]."""
    size = row.atlas.foot.size
    return stretch_beyond(row.branch(0), row.bones.reshape(-1, 3), size)


def _draw_steps(canvas: Canvas, row: Row) -> None:
    """Draw each branch, and the contacts of its pose, under a path of its own."""
    for step, cell in enumerate(row.cells):
        inside = canvas.inside(f"step{step}")
        draw_branch(inside, row.branch(step), _stretch(row))
        if row.posed[step]:
            draw_contacts(inside, pose_report(row.atlas, cell))


def _glimpses(row: Row) -> list[tuple[str, list[tuple[float, float]]]]:
    """When each branch is seen, and when the foot is."""
    steps = range(len(row.cells))
    found = [(f"step{step}", [row.ends(step)]) for step in steps]
    return [*found, ("foot", [row.ends(step) for step in steps if row.posed[step]])]


def _tracks(row: Row) -> list[Track]:
    """How each phalanx stands on each branch."""
    foot = row.atlas.foot
    azimuths = np.array([finger.azimuth for finger in foot.fingers])
    azimuth = azimuths[foot.finger_of_phalanx]
    across = np.stack([-np.sin(azimuth), np.cos(azimuth), np.zeros_like(azimuth)], -1)
    poses = phalanx_frames(row.bones, np.broadcast_to(across, row.bones[:, :, 0].shape))
    pairs = zip(np.moveaxis(poses, 1, 0), moved_parts(foot), strict=True)
    return [Track(*pair) for pair in pairs]


def _span(row: Row, step: int) -> Span:
    """What is shown from a step on."""
    region = row.regions[step]
    name = REGION_WORDS[region].upper()
    return Span(float(row.times[step]), name, REGION_PAINTS[region].css)


def _labels(row: Row) -> list[str]:
    """Radius of each branch, as the clock shows it."""
    lengths = Lengths(row.atlas.foot.size)
    return [f"radius {lengths(row.radius(step))}" for step in range(len(row.cells))]


def _speeds() -> str:
    """The choice of speeds."""
    return "".join(
        f'<option value="{speed:g}"{" selected" if speed == 1 else ""}>'
        f"{speed:g} × speed</option>"
        for speed in SPEEDS
    )


def _caption(row: Row, title: str, arm: float) -> str:
    """What is shown, how to play it, and the colours."""
    lengths, last = Lengths(row.atlas.foot.size), len(row.cells) - 1
    height = "as for a foot at rest" if row.height is None else lengths(row.height)
    grasped = sum(region == Region.GRASPING for region in row.regions)
    words = f"Grasped: {grasped} of {len(row.cells)} branches"
    colour = REGION_PAINTS[Region.GRASPING if grasped else Region.NONE].css
    rows = {
        "Least radius": lengths(row.radius(0)),
        "Greatest radius": lengths(row.radius(last)),
        "Centres at z =": height,
    }
    return "\n".join(
        (
            f"<h1>{escape(title)}</h1>",
            f'<p class="verdict" style="border-color: {colour}">{words}</p>',
            f'<p class="hint">{escape(HINT)}</p>',
            section("Branches", rows),
            _table(row),
            legend(keys(_paints(row.atlas.foot, arm))),
            section("Foot", foot_rows(row.atlas.foot)),
        )
    )


def _table(row: Row) -> str:
    """From which radius on what is shown, each with a button that jumps there."""
    lengths, body = Lengths(row.atlas.foot.size), ""
    for step in row.changes:
        text, words = lengths(row.radius(step)), REGION_WORDS[row.regions[step]]
        body += (
            f'<tr><td><button type="button" data-time="{page_time(row.times[step])}" '
            f'aria-label="Jump to radius {text}: {words}">{text}</button></td>'
            f"<td>{words}</td></tr>"
        )
    head = '<th scope="col">From radius</th><th scope="col">Shown</th>'
    return (
        '<section><h2>What is shown</h2><table class="events">'
        f"<thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></section>"
    )


def _paints(foot: Foot, arm: float) -> Sequence[tuple[Paint, str]]:
    """What each colour stands for."""
    pairs = [(finger_paint(i), finger.name) for i, finger in enumerate(foot.fingers)]
    return [
        *pairs,
        (WOOD, "branch"),
        (GRASPING, "contact of a grasp"),
        (STABLE, "tangent, no grasp"),
        (TOUCHING, "mere touch"),
        (PENETRATING, "entered"),
        *direction_pairs(arm),
    ]
