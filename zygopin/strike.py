"""A strike from flight to lock, as a record to look at and to measure."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.closing import Closing
from zygopin.errors import ParameterError
from zygopin.flight import Flight
from zygopin.foot import Foot
from zygopin.grip import grip_of
from zygopin.obstacle import Obstacle
from zygopin.stance import Stance
from zygopin.tendon import Contact, Phase, TendonFoot
from zygopin.trajectory import StrikeTrajectory

FRAMES = 240
"""Instants of a record, besides its events', unless said otherwise."""

MOST_FRAMES = 1_000_000
"""Instants that a record may have: some gigabytes."""

CLOSING_SHARE = 0.5
"""Share of the instants that closings get, which are short and full of events."""

HOLD = 0.5
"""How long a record shows the locked foot at least, over the closing time."""

Floats = NDArray[np.float64]


def simulate_strike(
    foot: Foot,
    obstacle: Obstacle,
    flight: Flight,
    *,
    closing: Closing | None = None,
    contact: Contact | None = None,
    frames: int = FRAMES,
) -> StrikeTrajectory:
    """Fly until an obstacle is met, close the toes on it and lock: MODEL.md, section 6.

    Args:
        foot: The foot.
        obstacle: What it strikes at, in the world's frame [m].
        flight: The base's motion, the toes' turn and the controls, while it is free.
        closing: How the toes close; None: smoothly, in the reading `contact`.
        contact: What counts as contact; None: the defaults.
        frames: Instants of the record, besides the events'.

    Returns:
        The record, from the flight's start to its end, or to the lock where that is
        later. Where nothing is met it is free throughout.

    Raises:
        ParameterError: A value is out of range, the flight has no end, or the obstacle
            already holds the base.
    """
    count = checks.integer("frames", frames, 2, MOST_FRAMES)
    automaton = TendonFoot(foot, obstacle, flight, closing=closing, contact=contact)
    end = automaton.flow.end
    if not np.isfinite(end):
        remedy = "give waypoints, or a function with an end"
        raise ParameterError("end of the motion", end, "a finite time", remedy)
    automaton.run(end)
    if automaton.mode == "locked":
        lock = automaton.events[-1].time
        automaton.run(max(end, lock + HOLD * automaton.closing.duration))
    return record(automaton, count)


def record(automaton: TendonFoot, frames: int = FRAMES) -> StrikeTrajectory:
    """What an automaton has gone through so far.

    Args:
        automaton: The automaton, after a run.
        frames: Instants of the record, besides the events'.

    Returns:
        The record.

    Raises:
        ParameterError: It has not run yet.
    """
    if not automaton.phases:
        remedy = "run it to a later time first"
        raise ParameterError("phases", [], "one or more", remedy)
    moments = [np.array([event.time]) for event in automaton.events]
    parts = []
    for phase in automaton.phases:
        inside = [t for t in moments if phase.start <= t[0] <= phase.end]
        times = np.unique(
            np.concatenate([_instants(phase, automaton, frames), *inside])
        )
        parts.append((phase.mode, times, phase.stances(times)))
    stances = _joined(automaton.foot, [stances for _, _, stances in parts])
    bones = stances.bones
    return StrikeTrajectory(
        foot=automaton.foot,
        obstacle=automaton.obstacle,
        reading=automaton.closing.reading,
        tolerance=automaton.tolerance,
        times=np.concatenate([times for _, times, _ in parts]),
        modes=np.concatenate([np.full(len(times), mode) for mode, times, _ in parts]),
        controls=stances.controls,
        azimuths=stances.azimuths,
        base=stances.base,
        bones=bones,
        clearance=automaton.near(bones).distance,
        events=tuple(automaton.events),
        grip=grip_of(
            automaton.foot, bones[-1], automaton.near(bones[-1]), automaton.tolerance
        ),
    )


def _instants(phase: Phase, automaton: TendonFoot, frames: int) -> Floats:
    """Evenly spaced instants of a phase, its share of all."""
    closing = [p.end - p.start for p in automaton.phases if p.mode == "closing"]
    total = automaton.phases[-1].end - automaton.phases[0].start
    share = (phase.end - phase.start) / max(total, np.finfo(float).tiny)
    if closing:
        share *= 1 - CLOSING_SHARE
    if phase.mode == "closing":
        share = CLOSING_SHARE / len(closing)
    return np.linspace(phase.start, phase.end, max(2, round(share * frames)))


def _joined(foot: Foot, parts: list[Stance]) -> Stance:
    """Batches of stances as one."""
    base = np.concatenate([part.base for part in parts])
    azimuths = np.concatenate([part.azimuths for part in parts])
    return Stance(foot, base, azimuths, np.concatenate([p.controls for p in parts]))
