"""The figure of a strike over time: modes, clearances, controls, events."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from zygopin import kinds
from zygopin.figures import (
    INK,
    PALE,
    Axes,
    line_width,
    new_figure,
    save_figure,
    unit_of,
)
from zygopin.files import check_file
from zygopin.finger import Finger
from zygopin.looks import finger_paint
from zygopin.obstacle import obstacle_noun
from zygopin.trajectory import EventKind, Mode, StrikeTrajectory

MILLI = 1e3
"""Milliseconds in a second."""

MARGIN = 0.25
"""Time that a closing is shown with before and after, over its own."""

NARROW = 0.12
"""Share of a panel's width below which a mode is not named."""

LINEAR = 1e-3
"""Clearance over the foot's size below which its axis is linear."""

LIGHTEST = 0.7
"""Share of white in the colour of the joints farthest out."""

MODE_COLOURS: dict[Mode, str] = {
    "free": "#ffffff",
    "closing": "#fbead0",
    "locked": "#e4e9f0",
}

EVENT_MARKERS: dict[EventKind, str] = {
    "engaged": "D",
    "stopped": "o",
    "crossed": "X",
    "locked": "s",
    "released": "v",
}


def plot_strike(trajectory: StrikeTrajectory, path: Path | str) -> Path:
    """Draw a strike over time: modes, clearances, controls and events.

    Left the whole of it; right its closing, where there is one.

    Args:
        trajectory: The strike.
        path: The PNG file.

    Returns:
        The path.

    Raises:
        FileError: The file cannot be written.
    """
    check_file(path)
    kinds.instance("trajectory", trajectory, StrikeTrajectory)
    foot, spans = trajectory.foot, _spans(trajectory)
    rows = 1 + len(foot.fingers)
    figure = new_figure(5.4 * len(spans), 3.4 + 1.05 * len(foot.fingers))
    grid = figure.subplots(
        rows,
        len(spans),
        squeeze=False,
        sharex="col",
        sharey="row",
        height_ratios=(2.6, *[1] * len(foot.fingers)),
    )
    for panels, (title, span) in zip(grid.T, spans.items(), strict=True):
        _draw_clearances(panels[0], trajectory)
        for finger, panel in zip(foot.fingers, panels[1:], strict=True):
            _draw_controls(panel, trajectory, finger)
        for panel in panels:
            _shade_modes(panel, trajectory)
            panel.tick_params(labelsize=8)
        panels[0].set_title(title, fontsize=9, pad=18)
        _name_modes(panels[0], trajectory, span)
        panels[-1].set_xlim(*span)
        panels[-1].set_xlabel("time [ms]", fontsize=9)
    _name_clearances(grid[0, 0], trajectory)
    for finger, panel in zip(foot.fingers, grid[1:, 0], strict=True):
        panel.set_ylabel(finger.name, fontsize=9)
        panel.set(ylim=(-0.12, 1.12), yticks=(0, 0.5, 1))
    words = "controls: dark for a finger's first joint, light for its last"
    grid[1, 0].set_title(words, fontsize=8, loc="left", pad=3)
    figure.suptitle(_strike_title(trajectory), fontsize=11)
    return save_figure(figure, path)


def _strike_title(trajectory: StrikeTrajectory) -> str:
    """Which strike a figure shows."""
    noun = obstacle_noun(trajectory.obstacle)
    return f"{trajectory.foot.name} at a {noun}, reading: {trajectory.reading}"


def _spans(trajectory: StrikeTrajectory) -> dict[str, tuple[float, float]]:
    """What the columns show, and from when to when [ms]."""
    times = MILLI * trajectory.times
    spans = {"the whole strike": (times[0], times[-1])}
    closing = times[trajectory.modes == "closing"]
    if len(closing):
        margin = MARGIN * float(np.ptp(closing))
        spans["its closing"] = (closing[0] - margin, closing[-1] + margin)
    return spans


def _runs(trajectory: StrikeTrajectory) -> list[tuple[Mode, float, float]]:
    """The modes in order, and from when to when [ms]."""
    starts = trajectory.mode_starts
    edges = MILLI * trajectory.times[[*starts, -1]]
    modes = trajectory.modes[starts]
    return list(zip(modes.tolist(), edges[:-1], edges[1:], strict=True))


def _shade_modes(panel: Axes, trajectory: StrikeTrajectory) -> None:
    """Colour the background by mode, with a line at each change."""
    for mode, start, end in _runs(trajectory):
        panel.axvspan(start, end, color=MODE_COLOURS[mode], linewidth=0, zorder=0)
    for _, start, _ in _runs(trajectory)[1:]:
        panel.axvline(start, color=INK, linewidth=0.8, linestyle="--", zorder=1)


def _name_modes(
    panel: Axes, trajectory: StrikeTrajectory, span: tuple[float, float]
) -> None:
    """Write the modes over a panel, where they are wide enough to be named."""
    for mode, start, end in _runs(trajectory):
        low, high = max(start, span[0]), min(end, span[1])
        if high - low > NARROW * (span[1] - span[0]):
            panel.annotate(
                mode.upper(),
                ((low + high) / 2, 1.0),
                xycoords=("data", "axes fraction"),
                xytext=(0, 4),
                textcoords="offset points",
                ha="center",
                fontsize=8,
                color=INK,
            )


def _draw_clearances(panel: Axes, trajectory: StrikeTrajectory) -> None:
    """The least clearance of each finger, with what stopped it."""
    foot, times = trajectory.foot, MILLI * trajectory.times
    unit = unit_of(foot)
    for index, (name, part) in enumerate(foot.finger_slices.items()):
        least = trajectory.clearance[:, part].min(axis=1) * unit.per_metre
        colour, width = finger_paint(index).css, line_width(index, len(foot.fingers))
        panel.plot(times, least, color=colour, linewidth=width, label=name, zorder=3)
        for event in trajectory.events:
            if event.finger == name and event.clearance is not None:
                marker, gap = EVENT_MARKERS[event.kind], event.clearance
                height = gap * unit.per_metre
                panel.plot(MILLI * event.time, height, marker, color=colour, zorder=4)
    panel.axhline(0, color=INK, linewidth=0.7, zorder=2)
    panel.grid(color=PALE, linewidth=0.4)


def _widest(trajectory: StrikeTrajectory) -> float:
    """The largest clearance that is drawn [m]: the least of a finger at an instant."""
    parts = trajectory.foot.finger_slices.values()
    return max(float(trajectory.clearance[:, part].min(axis=1).max()) for part in parts)


def _name_clearances(panel: Axes, trajectory: StrikeTrajectory) -> None:
    """Scale and legend of the clearances: linear near contact, else logarithmic."""
    unit, size = unit_of(trajectory.foot), trajectory.foot.size
    even = 10.0 ** round(math.log10(LINEAR * size * unit.per_metre))
    panel.set_yscale("symlog", linthresh=even, linscale=0.6)
    words = f"least clearance [{unit.name}]\nlinear within ±{even:g}"
    panel.set_ylabel(words, fontsize=9)
    ends = np.array([trajectory.clearance.min(), _widest(trajectory)])
    low, high = ends * unit.per_metre
    low = 2 * low if low < -even / 4 else -even / 2
    panel.set_ylim(low, max(2 * high, even))
    met = {event.kind for event in trajectory.events if event.finger}
    for kind in sorted(met):
        panel.plot([], [], EVENT_MARKERS[kind], color=INK, label=kind)
    panel.legend(fontsize=8, loc="lower left", framealpha=0.9)


def _draw_controls(panel: Axes, trajectory: StrikeTrajectory, finger: Finger) -> None:
    """The controls of a finger's joints, from dark to light toward the talon."""
    part = trajectory.foot.finger_slices[finger.name]
    paint = finger_paint(trajectory.foot.fingers.index(finger))
    times = MILLI * trajectory.times
    for rank, values in enumerate(trajectory.controls[:, part].T):
        colour = paint.tinted(LIGHTEST * rank / finger.phalanges).css
        width = line_width(rank, finger.phalanges)
        panel.plot(times, values, color=colour, linewidth=width, zorder=3)
        for event in trajectory.events:
            if (event.finger, event.phalanx) == (finger.name, rank + 1):
                # Controls may jump as the tendon engages: the value before.
                place = values[np.searchsorted(trajectory.times, event.time)]
                marker, time = EVENT_MARKERS[event.kind], MILLI * event.time
                panel.plot(time, place, marker, ms=4, color=colour, zorder=4)
    panel.grid(color=PALE, linewidth=0.4)
