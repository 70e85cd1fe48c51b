"""A strike as users read it: tables, JSON, and files of its whole record."""

from __future__ import annotations

import json
import math
from dataclasses import fields
from pathlib import Path
from typing import Any

import numpy as np

from zygopin import kinds
from zygopin.archive import write_archive
from zygopin.errors import ParameterError
from zygopin.files import check_file, write_text
from zygopin.kinematics import by_finger
from zygopin.obstacle import Obstacle, obstacle_noun
from zygopin.trajectory import StrikeEvent, StrikeTrajectory

SERIES = ("times", "modes", "controls", "azimuths", "base", "bones", "clearance")
"""The arrays of a record, each with an entry for each instant."""

_EVENTS = {
    "engaged": "engages the tendon",
    "stopped": "stops at the target",
    "crossed": "stops at another toe",
    "locked": "the tendon locks",
    "released": "the tendon is released",
}


def strike_document(trajectory: StrikeTrajectory) -> dict[str, Any]:
    """What came of a strike as plain values, all in SI.

    Args:
        trajectory: The strike.

    Returns:
        A mapping for JSON; the whole record is for `save_strike`.
    """
    foot, grip = trajectory.foot, trajectory.grip
    return {
        "foot": foot.to_mapping(),
        "obstacle": obstacle_mapping(trajectory.obstacle),
        "reading": trajectory.reading,
        "tolerance": trajectory.tolerance,
        "events": [_event(event) for event in trajectory.events],
        "end": {
            "time": float(trajectory.times[-1]),
            "mode": str(trajectory.modes[-1]),
            "base": trajectory.base[-1].tolist(),
            "azimuths": _azimuths(trajectory),
            "controls": by_finger(foot, trajectory.controls[-1]),
        },
        "grip": {
            "fingers": list(grip.fingers),
            "grasping": grip.grasping,
            "feasible": grip.feasible,
            "scalar_product": _plain(grip.scalar_product),
            "finger_clearance": _plain(grip.finger_clearance),
        },
        "phalanges": [_phalanx(trajectory, k) for k in range(foot.phalanx_count)],
    }


def save_strike(trajectory: StrikeTrajectory, path: Path | str) -> Path:
    """Write a strike's whole record.

    As `.npz`: the arrays of `StrikeTrajectory` by their names, and `document`, the
    text of what `strike_document` returns. As `.json`: that document, with the arrays
    as lists under `record`.

    Args:
        trajectory: The strike.
        path: The file, `.npz` or `.json`.

    Returns:
        The path.

    Raises:
        ParameterError: The file's name ends otherwise.
        FileError: The file cannot be written.
    """
    kinds.instance("trajectory", trajectory, StrikeTrajectory)
    document, suffix = strike_document(trajectory), check_file(path).suffix.lower()
    series = {name: getattr(trajectory, name) for name in SERIES}
    if suffix == ".npz":
        text = json.dumps(document, allow_nan=False)
        return write_archive(path, {**series, "document": text})
    if suffix == ".json":
        document["record"] = {name: values.tolist() for name, values in series.items()}
        return write_text(path, json.dumps(document, allow_nan=False) + "\n")
    remedy = "name the file so that it ends with one of them"
    raise ParameterError("ending of the file", suffix, ".npz or .json", remedy)


def event_rows(trajectory: StrikeTrajectory) -> list[tuple[str, ...]]:
    """The log of a strike.

    Args:
        trajectory: The strike.

    Returns:
        Texts: time [ms], toe, phalanx, what happened, clearance [µm].
    """
    return [
        (
            f"{event.time * 1e3:.3f}",
            event.finger or "",
            str(event.phalanx or ""),
            _EVENTS[event.kind],
            "" if event.clearance is None else f"{event.clearance * 1e6:.3f}",
        )
        for event in trajectory.events
    ]


def grip_line(trajectory: StrikeTrajectory) -> str:
    """How a strike ended, in one line.

    Args:
        trajectory: The strike.

    Returns:
        Plain text.
    """
    grip, mode = trajectory.grip, str(trajectory.modes[-1])
    if grip.fingers:
        held = f"{len(grip.fingers)} toes touch: {', '.join(grip.fingers)}"
        words = [mode, held, "grasping" if grip.grasping else "not grasping"]
    elif grip.penetrating.any():
        words = [mode, "toes pass into the target, none rests on it"]
    else:
        words = [mode, "no toe touches the target"]
    words.append("feasible" if grip.feasible else f"not feasible: {_why(trajectory)}")
    return "; ".join(words)


def target_line(obstacle: Obstacle) -> str:
    """What an obstacle is, in a few words.

    Args:
        obstacle: The obstacle.

    Returns:
        Such as `ball of radius 15 mm`.
    """
    noun = obstacle_noun(obstacle)
    radius = getattr(obstacle, "radius", None)
    if radius is None:
        return noun
    return f"{noun} of radius {float(radius) * 1e3:.6g} mm"


def obstacle_mapping(obstacle: Obstacle) -> dict[str, Any]:
    """An obstacle as plain values.

    Args:
        obstacle: The obstacle.

    Returns:
        Its kind, and its fields [SI].
    """
    values = {field.name: getattr(obstacle, field.name) for field in fields(obstacle)}
    return {
        "kind": type(obstacle).__name__.lower(),
        **{
            name: value.tolist() if isinstance(value, np.ndarray) else value
            for name, value in values.items()
        },
    }


def _why(trajectory: StrikeTrajectory) -> str:
    """What makes the end infeasible."""
    if trajectory.grip.penetrating.any():
        depth = -float(trajectory.grip.clearance.min()) * 1e3
        return f"a phalanx is {depth:.3g} mm inside the target"
    return "two toes pass through each other"


def _event(event: StrikeEvent) -> dict[str, Any]:
    """An event as plain values."""
    return {
        "kind": event.kind,
        "time": event.time,
        "finger": event.finger,
        "phalanx": event.phalanx,
        "point": None if event.point is None else event.point.tolist(),
        "clearance": event.clearance,
    }


def _phalanx(trajectory: StrikeTrajectory, index: int) -> dict[str, Any]:
    """One phalanx at the end."""
    foot, grip = trajectory.foot, trajectory.grip
    return {
        "finger": foot.fingers[foot.finger_of_phalanx[index]].name,
        "phalanx": int(foot.rank_of_phalanx[index]),
        "clearance": float(grip.clearance[index]),
        "touching": bool(grip.touching[index]),
        "point": grip.point[index].tolist(),
        "normal": grip.normal[index].tolist(),
    }


def _azimuths(trajectory: StrikeTrajectory) -> dict[str, float]:
    """The fingers' azimuths at the end [rad]."""
    names = [finger.name for finger in trajectory.foot.fingers]
    return dict(zip(names, trajectory.azimuths[-1].tolist(), strict=True))


def _plain(value: float) -> float | None:
    """A number, or None where it does not exist."""
    return float(value) if math.isfinite(value) else None
