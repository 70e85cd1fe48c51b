"""An owl's strike as a scene that plays: one HTML file that works offline."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin import kinds
from zygopin.branch import Branch
from zygopin.camera import DISTANCE, View, framed, wrap_direction
from zygopin.canvas import Canvas
from zygopin.caption import Key
from zygopin.drawing import STABLE, draw_axes, draw_foot, moved_parts, stretch_beyond
from zygopin.errors import ParameterError
from zygopin.files import check_file, write_text
from zygopin.looks import Paint, drawn_radii, finger_paint
from zygopin.obstacle import Capsule, obstacle_noun
from zygopin.obstacle_drawing import (
    draw_obstacle,
    obstacle_extent,
    obstacle_paint,
)
from zygopin.playback import Playback, Span, Track, phalanx_frames
from zygopin.scene import direction_pairs, keys
from zygopin.strike_caption import controls, strike_caption
from zygopin.trajectory import Mode, StrikeTrajectory
from zygopin.viewer import Player, Recorder, page, set_stage

MOST_FRAMES = 400
"""Instants that a page holds, unless more of them matter: a quarter of a megabyte."""

CLOSEST = 0.36
"""The final foot's longer side over the frame's height: as much of the flight is in
the frame as leaves the foot this large."""

WIDE_OBSTACLE = 1.5
"""Extent of an obstacle over the foot's size from which the frame leaves it out."""

MODE_PAINTS: dict[Mode, Paint] = {
    "free": Paint(0x2F5FC4),
    "closing": Paint(0xB45309),
    "locked": Paint(0x1B7F3B),
}
"""White letters can be read on each."""

AXES_AT = -0.72
"""Place of the directions across the frame: at the left, under the hind toes, whose
sweep is shorter below than that of the front toes."""

WHOLE, AXES = "/meshcat", "axes"
"""Paths of all that is drawn, and of the directions in its corner."""

CONTACT = STABLE
FADED = 0.4
"""Share of white in the colour of a talon's path."""


def export_strike(
    trajectory: StrikeTrajectory, path: Path | str, *, title: str | None = None
) -> Path:
    """Write a strike as one HTML file that plays it in meshcat's viewer.

    The eye flies with the foot until the target is in sight. The page plays once,
    slowed down, and stops; a slider, the keyboard and a list of events go to any time,
    and `#t=0.123` after its address opens it at that time [s]. The file asks for
    nothing: it works offline. The same strike gives the same bytes.

    Args:
        trajectory: The strike.
        path: The file; its folders are made where they are missing.
        title: Title in plain text; None: the foot's name and what it struck at.

    Returns:
        The path.

    Raises:
        ParameterError: The trajectory is of another type.
        FileError: The file cannot be written.
    """
    check_file(path)
    if not isinstance(trajectory, StrikeTrajectory):
        remedy = "pass what simulate_strike returned"
        given = type(trajectory).__name__
        raise ParameterError("trajectory", given, "a StrikeTrajectory", remedy)
    title = _default_title(trajectory) if title is None else kinds.text("title", title)
    frames, spans = kept_frames(trajectory), mode_spans(trajectory)
    view = strike_view(trajectory)
    recorder = Recorder()
    set_stage(recorder, view)
    canvas = Canvas(recorder, view.target, view.unit)
    draw_foot(canvas, trajectory.foot, trajectory.bones[0])
    draw_obstacle(canvas, trajectory.obstacle, drawn_stretch(trajectory))
    _draw_paths(canvas, trajectory, frames)
    playback = Playback(
        trajectory.times[frames],
        [*_following(trajectory, canvas), *_tracks(trajectory, frames)],
        spans,
        _draw_contacts(canvas, trajectory),
    )
    colours = _legend(trajectory, draw_axes(canvas, view, AXES_AT))
    words = strike_caption(trajectory, title, spans[-1].colour, colours)
    player = Player(playback.data(canvas), controls(trajectory, spans))
    return write_text(path, page(recorder, view, title, words, player))


def kept_frames(trajectory: StrikeTrajectory) -> NDArray[np.intp]:
    """The instants that a page holds: all, or every so many and those that matter.

    Args:
        trajectory: The strike.

    Returns:
        Their indices, ascending: among them the first, the last, those of events, and
        those on either side of a change of mode.
    """
    count = len(trajectory.times)
    kept = np.isin(trajectory.times, [event.time for event in trajectory.events])
    kept[[0, -1]] = True
    starts = trajectory.mode_starts
    kept[starts] = kept[starts - 1] = True
    spare = max(MOST_FRAMES - int(kept.sum()), 0)
    kept[np.linspace(0, count - 1, min(spare, count)).round().astype(int)] = True
    return np.flatnonzero(kept)


def mode_spans(trajectory: StrikeTrajectory) -> list[Span]:
    """The modes over time, as a page shows them.

    Args:
        trajectory: The strike.

    Returns:
        A span for each stretch of one mode.
    """
    starts = trajectory.mode_starts
    paints = {str(mode): paint for mode, paint in MODE_PAINTS.items()}
    return [
        Span(float(time), str(mode).upper(), paints[mode].css)
        for time, mode in zip(
            trajectory.times[starts], trajectory.modes[starts], strict=True
        )
    ]


def strike_view(trajectory: StrikeTrajectory) -> View:
    """The view that frames the grip closely, with the end of the flight into it.

    Args:
        trajectory: The strike.

    Returns:
        The view, from the earliest instant whose frame leaves the final foot large.
    """
    return _view_since(trajectory, kept_frames(trajectory)[framed_since(trajectory) :])


def framed_since(trajectory: StrikeTrajectory) -> int:
    """From when on the view has the whole foot in its frame.

    Args:
        trajectory: The strike.

    Returns:
        The place among `kept_frames`.
    """
    frames = kept_frames(trajectory)
    low, high = 0, len(frames) - 1
    while low < high:
        middle = (low + high) // 2
        if _final_share(trajectory, _view_since(trajectory, frames[middle:])) < CLOSEST:
            low = middle + 1
        else:
            high = middle
    return low


def drawn_stretch(trajectory: StrikeTrajectory) -> tuple[float, float]:
    """The part of a branch that is drawn: its own, or beyond the final foot.

    Args:
        trajectory: The strike.

    Returns:
        Start and end along its axis from its centre [m]; (0, 0): not a branch.
    """
    branch = trajectory.obstacle
    if not isinstance(branch, Branch):
        return 0.0, 0.0
    if branch.length is not None:
        return -float(branch.half_length), float(branch.half_length)
    return stretch_beyond(branch, trajectory.bones[-1], trajectory.foot.size)


def phalanx_poses(
    trajectory: StrikeTrajectory, frames: NDArray[np.intp]
) -> NDArray[np.float64]:
    """Poses of the phalanges: x along the bone, y across the finger's plane.

    Args:
        trajectory: The strike.
        frames: Which instants.

    Returns:
        T_world_phalanx [m], shape (n, P, 4, 4).
    """
    bones, base = trajectory.bones[frames], trajectory.base[frames]
    azimuth = trajectory.azimuths[frames][:, trajectory.foot.finger_of_phalanx]
    flat = np.stack([-np.sin(azimuth), np.cos(azimuth), np.zeros_like(azimuth)], -1)
    across = flat @ np.swapaxes(base[:, :3, :3], -1, -2)
    return phalanx_frames(bones, across)


def _tracks(trajectory: StrikeTrajectory, frames: NDArray[np.intp]) -> list[Track]:
    """How each phalanx, and what is drawn on it, moves."""
    poses = np.moveaxis(phalanx_poses(trajectory, frames), 1, 0)
    parts = moved_parts(trajectory.foot)
    return [Track(*pair) for pair in zip(poses, parts, strict=True)]


def _following(trajectory: StrikeTrajectory, canvas: Canvas) -> list[Track]:
    """The whole scene moves back as long as the foot has not come into the frame.

    So the eye flies with the foot, and then stays on the target. The directions move
    forth, and so stay where they are.
    """
    places = trajectory.base[kept_frames(trajectory), :3, 3]
    since = framed_since(trajectory)
    ahead = places - places[since]
    ahead[since:] = 0.0
    tracks = []
    for path, shift in ((WHOLE, -ahead), (AXES, ahead)):
        poses = np.tile(np.eye(4), (len(places), 1, 1))
        poses[:, :3, 3] = canvas.origin + shift
        tracks.append(Track(poses, [(path, 0.0)]))
    return tracks


def _view_since(trajectory: StrikeTrajectory, frames: NDArray[np.intp]) -> View:
    """The view of the foot at some instants, and of an obstacle of its own size."""
    points = trajectory.bones[frames].reshape(-1, 3)
    radii = np.tile(np.repeat(drawn_radii(trajectory.foot), 2), len(frames))
    solid, radius = obstacle_extent(trajectory.obstacle, drawn_stretch(trajectory))
    extent = float(np.ptp(solid, axis=0).max()) + 2 * radius
    if extent < WIDE_OBSTACLE * trajectory.foot.size:
        points = np.concatenate([points, solid])
        radii = np.concatenate([radii, np.full(len(solid), radius)])
    return framed(points, radii, _direction(trajectory))


def _final_share(trajectory: StrikeTrajectory, view: View) -> float:
    """The final foot's longer side over the frame's height."""
    seen = trajectory.bones[-1].reshape(-1, 3) @ view.axes[:2].T
    skin = 2 * float(drawn_radii(trajectory.foot).max())
    side = float(np.ptp(seen, axis=0).max()) + skin
    return side / (2 * DISTANCE * view.half_height * view.unit)


def _direction(trajectory: StrikeTrajectory) -> NDArray[np.float64]:
    """The eye's direction: nearly along what the toes wrap around."""
    lateral, up = trajectory.base[-1][:3, 1], trajectory.base[-1][:3, 2]
    axis, obstacle = lateral, trajectory.obstacle
    if isinstance(obstacle, Branch):
        axis = obstacle.axis
    elif isinstance(obstacle, Capsule) and np.ptp(obstacle.ends, axis=0).any():
        axis = obstacle.ends[1] - obstacle.ends[0]
        axis = axis / np.linalg.norm(axis)
    if abs(axis @ up) > 0.9:  # struck end on: no toe wraps around it
        axis = lateral
    outward = up - (up @ axis) * axis
    return wrap_direction(axis, outward / np.linalg.norm(outward))


def _draw_paths(
    canvas: Canvas, trajectory: StrikeTrajectory, frames: NDArray[np.intp]
) -> None:
    """Draw the path of each talon."""
    for index, (name, part) in enumerate(trajectory.foot.finger_slices.items()):
        talons = trajectory.bones[frames, part.stop - 1, 1]
        canvas.thread(f"ways/{name}", talons, finger_paint(index).tinted(FADED))


def _draw_contacts(
    canvas: Canvas, trajectory: StrikeTrajectory
) -> list[tuple[str, float]]:
    """Draw where the obstacle was met; paths, and times from which each is seen."""
    drawn = []
    for number, event in enumerate(trajectory.events, start=1):
        if event.point is not None:
            path = f"contacts/event{number}"
            canvas.ball(path, event.point, 0.02 * canvas.unit, CONTACT)
            drawn.append((path, event.time))
    return drawn


def _default_title(trajectory: StrikeTrajectory) -> str:
    name = trajectory.foot.name.replace("_", " ").capitalize()
    return f"{name} strikes at a {obstacle_noun(trajectory.obstacle)}"


def _legend(trajectory: StrikeTrajectory, arm: float) -> list[Key]:
    """What each colour stands for."""
    fingers = trajectory.foot.fingers
    pairs = [(finger_paint(i), finger.name) for i, finger in enumerate(fingers)]
    obstacle = trajectory.obstacle
    pairs += [(obstacle_paint(obstacle), obstacle_noun(obstacle)), (CONTACT, "contact")]
    return keys([*pairs, *direction_pairs(arm)])
