"""Axes for the tests of touch intervals: of all kinds, around the foot."""

from __future__ import annotations

import numpy as np

from zygopin import Branch, Finger, Foot


def one_finger(phalanges, azimuth=0.0, orientation=0.0, **changes):
    """A foot of one finger."""
    finger = Finger("toe", phalanges, azimuth, orientation)
    return Foot(fingers=(finger,), **changes)


def axes_around(foot, count, seed=0):
    """Axes around a foot: vertical, in a finger's plane, through the base, oblique."""
    rng = np.random.default_rng(seed)
    centre = rng.normal(size=(count, 3)) * 0.6 * foot.size
    axis = rng.normal(size=(count, 3))
    azimuth = foot.fingers[0].azimuth
    axis[0] = (0.0, 0.0, 1.0)
    axis[1] = (np.cos(azimuth), np.sin(azimuth), 0.4)
    centre[2] = -2.0 * axis[2]
    return Branch(1.0, centre, axis)


def distances(foot, controls, branch):
    """D of each finger for an axis line, by the package's clearance [m], (…, F)."""
    from zygopin.clearance import branch_clearance
    from zygopin.kinematics import forward_kinematics

    radius = 1e-3 * foot.size
    thin = Branch(radius, branch.centre, branch.axis)
    near = branch_clearance(forward_kinematics(foot, controls), foot.radii, thin)
    parts = foot.finger_slices.values()
    return radius + np.stack([near.distance[..., k].min(-1) for k in parts], axis=-1)
