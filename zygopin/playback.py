"""What moves in a scene, packed for the page that plays it."""

from __future__ import annotations

import base64
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin.canvas import DECIMALS, Canvas
from zygopin.rotations import quaternions

TIME_DECIMALS = 9
"""Decimals of times in a page [s]: a strike takes tenths of a second."""

FARTHEST = 1000.0
"""Coordinate, in units of the view, at which positions are cut: far behind what the
viewer draws, and few enough digits for 32 bits."""


@dataclass(frozen=True, eq=False)
class Track:
    """A frame that moves, and the solids that move with it.

    Attributes:
        poses: T_world_track at each instant [m], shape (n, 4, 4).
        parts: Paths of the solids, and how far along its x axis each starts [m].
    """

    poses: NDArray[np.float64]
    parts: Sequence[tuple[str, float]]


@dataclass(frozen=True)
class Span:
    """A stretch of time, until the next one starts.

    Attributes:
        start: When it starts [s].
        name: Its name, in ASCII.
        colour: Its CSS colour.
    """

    start: float
    name: str
    colour: str


@dataclass(frozen=True, eq=False)
class Playback:
    """What changes in a scene over time.

    Attributes:
        times: Instants, ascending [s], shape (n,).
        tracks: What moves.
        spans: What is called what when; the first starts with the motion.
        appearances: Paths of solids that are unseen until a time [s].
        glimpses: Paths of solids that are seen only from some times to others [s].
        labels: What the clock shows at each instant, and the motion goes in steps from
            one to the next; empty: milliseconds, and it is even.
    """

    times: NDArray[np.float64]
    tracks: Sequence[Track]
    spans: Sequence[Span]
    appearances: Sequence[tuple[str, float]]
    glimpses: Sequence[tuple[str, Sequence[tuple[float, float]]]] = ()
    labels: Sequence[str] = ()

    def data(self, canvas: Canvas) -> dict[str, Any]:
        """The motion as the page's script reads it.

        Args:
            canvas: What the solids are drawn on.

        Returns:
            Plain values.
        """
        return {
            "times": [page_time(time) for time in self.times],
            "timeDecimals": TIME_DECIMALS,
            "decimals": clock_decimals(self.times),
            "quantum": float(f"1e-{DECIMALS}"),
            "tracks": [_addressed(canvas, track.parts) for track in self.tracks],
            "poses": _packed(canvas, np.stack([t.poses for t in self.tracks], axis=1)),
            "spans": [[page_time(p.start), p.name, p.colour] for p in self.spans],
            "appearances": [
                [canvas.address(path), page_time(time)]
                for path, time in self.appearances
            ],
            **self._steps(canvas),
        }

    def _steps(self, canvas: Canvas) -> dict[str, Any]:
        """What only a motion in steps has."""
        if not self.labels:
            return {}
        glimpses = [
            [canvas.address(path), [[page_time(t) for t in ends] for ends in times]]
            for path, times in self.glimpses
        ]
        return {"glimpses": glimpses, "labels": list(self.labels)}


def phalanx_frames(
    bones: NDArray[np.float64], across: NDArray[np.float64]
) -> NDArray[np.float64]:
    """Poses of phalanges: x along the bone, y across the finger's plane.

    Args:
        bones: Bones [m], shape (n, P, 2, 3).
        across: Unit vectors across the planes, shape (n, P, 3).

    Returns:
        T_world_phalanx [m], shape (n, P, 4, 4).
    """
    along = bones[:, :, 1] - bones[:, :, 0]
    along = along / np.linalg.norm(along, axis=-1, keepdims=True)
    poses = np.zeros((*along.shape[:2], 4, 4))
    poses[..., :3, :3] = np.stack([along, across, np.cross(along, across)], axis=-1)
    poses[..., :3, 3] = bones[:, :, 0]
    poses[..., 3, 3] = 1.0
    return poses


def player_controls(
    ends: tuple[float, float],
    spans: Sequence[Span],
    marks: Iterable[float],
    speeds: str,
) -> str:
    """The player's controls as HTML: a slider with marks, a button, mode and speed.

    Args:
        ends: When the motion starts and ends [s].
        spans: What is called what when.
        marks: Times that are marked [s].
        speeds: The options of the choice of speeds, as HTML.

    Returns:
        HTML; hidden until the page's script shows it.
    """
    start, end = map(page_time, ends)
    places = sorted({_share(ends, time) for time in marks})
    ticks = "".join(
        f'<span class="mark" style="left: {x:.3f}%"></span>' for x in places
    )
    return (
        '<section id="player" aria-label="Playback" hidden>\n<div class="track">'
        f'<div class="rail" style="background: {_rail(ends, spans)}" '
        f'aria-hidden="true">{ticks}</div>'
        f'<input id="time" type="range" min="{start}" max="{end}" step="any" '
        f'value="{start}" aria-label="Time"></div>\n<div class="bar">'
        '<button id="play" type="button" aria-keyshortcuts="Space">Play</button>'
        '<output id="mode" for="time" aria-label="Mode"></output>'
        '<span id="clock"></span>'
        f'<select id="speed" aria-label="Speed">{speeds}</select></div>'
        "\n</section>"
    )


def _rail(ends: tuple[float, float], spans: Sequence[Span]) -> str:
    """The slider's background: each span in its colour."""
    starts = [_share(ends, span.start) for span in spans]
    stops = ", ".join(
        f"{span.colour} {start:.3f}% {end:.3f}%"
        for span, start, end in zip(spans, starts, [*starts[1:], 100.0], strict=True)
    )
    return escape(f"linear-gradient(to right, {stops})")


def _share(ends: tuple[float, float], time: float) -> float:
    """How much of a motion is over at a time [%]."""
    start, end = map(float, ends)
    return round(100 * (time - start) / max(end - start, 1e-9), 3)


def page_time(time: float) -> float:
    """A time as every part of a page has it.

    Args:
        time: The time [s].

    Returns:
        The time, rounded [s].
    """
    return round(float(time), TIME_DECIMALS) + 0.0


def clock_decimals(times: NDArray[np.float64]) -> int:
    """Decimals of milliseconds that tell a motion's instants apart.

    Args:
        times: Instants, ascending [s], shape (n,).

    Returns:
        One decimal for a strike of tenths of a second, fewer for longer ones.
    """
    span = max(float(times[-1] - times[0]), 1e-6)
    return max(0, -int(np.floor(np.log10(span))))


def _addressed(
    canvas: Canvas, parts: Sequence[tuple[str, float]]
) -> list[tuple[str, float]]:
    """Parts as the viewer finds them, shifted in units of the view."""
    return [
        (canvas.address(path), round(along / canvas.unit, DECIMALS))
        for path, along in parts
    ]


def _packed(canvas: Canvas, poses: NDArray[np.float64]) -> str:
    """Poses (n, T, 4, 4) as base64 of little-endian 32-bit integers (n, T, 7).

    Each holds a position in the view's units and a quaternion (x, y, z, w), both as
    multiples of the scene's last decimal: exact, and a tenth of meshcat's keyframes.
    """
    units = canvas.in_units(poses)
    places = np.clip(units[..., :3, 3], -FARTHEST, FARTHEST)
    turns = quaternions(poses[..., :3, :3])
    values = np.concatenate([places, turns], axis=-1)
    whole = np.round(values * 10.0**DECIMALS).astype("<i4")
    return base64.b64encode(whole.tobytes()).decode()
