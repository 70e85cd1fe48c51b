"""A made-up strike: a foot that swoops down on a ball, closes and locks."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from zygopin.foot import Foot
from zygopin.grip import grip_of
from zygopin.kinematics import forward_kinematics
from zygopin.obstacle import Sphere
from zygopin.solid_clearance import obstacle_clearance
from zygopin.trajectory import StrikeEvent, StrikeTrajectory

CONTACT, LOCKED, END = 0.15, 0.21, 0.26
"""When the modes change, and when the record ends [s]."""

BALL = Sphere(0.017, np.array([0.0, 0.0, 0.0]))


def made_strike(obstacle=BALL, samples=131, closed=0.62, **changes):
    """A strike whose numbers follow from a few formulas, not from a simulation.

    Args:
        obstacle: What is there; the foot closes around the origin whatever it is.
        samples: Instants.
        closed: Controls at the end.
        **changes: Fields to set otherwise.

    Returns:
        The trajectory.
    """
    foot = Foot.preset("owl")
    times = np.unique(
        np.append(np.linspace(0, END, samples), [event.time for event in events()])
    )
    modes = np.where(times < CONTACT, "free", "closing")
    modes = np.where(times < LOCKED, modes, "locked")
    shut = closed * np.clip((times - CONTACT) / (LOCKED - CONTACT), 0, 1)
    controls = np.repeat(shut[:, None], foot.phalanx_count, axis=1)
    azimuths, base = flight(foot, times)
    local = forward_kinematics(foot, controls, azimuths=azimuths)
    bones = np.einsum("nij,npkj->npki", base[:, :3, :3], local)
    bones += base[:, None, None, :3, 3]
    near = obstacle_clearance(bones, foot.radii, obstacle)
    last = obstacle_clearance(bones[-1], foot.radii, obstacle)
    values = {
        "foot": foot,
        "obstacle": obstacle,
        "reading": "contact",
        "tolerance": 1e-6,
        "times": times,
        "modes": modes,
        "controls": controls,
        "azimuths": azimuths,
        "base": base,
        "bones": bones,
        "clearance": near.distance,
        "events": events(),
        "grip": grip_of(foot, bones[-1], last, 1e-6),
    }
    return StrikeTrajectory(**{**values, **changes})


def flight(foot, times):
    """Azimuths, and poses of a base that swoops down and stops above the origin."""
    left = np.clip(1 - times / CONTACT, 0, 1)[:, None]
    base = np.tile(np.eye(4), (len(times), 1, 1))
    base[:, :3, 3] = left * np.array([-0.22, 0.02, 0.3]) + np.array([0, 0, 0.0225])
    turns = Rotation.from_rotvec(-(0.9 * left + 0.1) * np.array([0.0, 1.0, 0.0]))
    base[:, :3, :3] = turns.as_matrix()
    own = np.array([finger.azimuth for finger in foot.fingers])
    turned = np.array([finger.reversal for finger in foot.fingers])
    return own + left * turned, base


def events():
    """The events of the made-up strike."""
    on_top = np.array([0.0, 0.0, 0.017])
    return (
        StrikeEvent("engaged", CONTACT, "finger2", 1, on_top, 0.0),
        StrikeEvent("stopped", 0.18, "finger2", 2, np.array([0.017, 0, 0]), 1e-7),
        StrikeEvent("stopped", 0.19, "finger4", 3, np.array([-0.017, 0, 0]), 1e-7),
        StrikeEvent("locked", LOCKED),
    )
