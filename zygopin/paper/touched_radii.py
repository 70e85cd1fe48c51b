"""The radii that fingers can touch, against random poses."""

from __future__ import annotations

import numpy as np

from zygopin.branch import Branch
from zygopin.clearance import branch_clearance
from zygopin.foot import Foot
from zygopin.grasp import check_grasp
from zygopin.kinematics import forward_kinematics
from zygopin.paper.entry import EXACT, Measurement, at_most
from zygopin.paper.finger_plane import (
    ITERATED,
    Floats,
)
from zygopin.touch import touch_intervals

SAMPLES = 100_000
"""Random control sequences."""

PARTS = 20
"""Parts in which they are measured: some ten megabytes each."""

AXES = Branch(0.1, [(0.0, 0.0, -0.6), (0.0, 0.0, -1.0), (0.0, 0.0, -2.0)])
"""Axes for which touch intervals are sought; their radius does not matter."""


def touch_measurements(foot: Foot) -> tuple[Measurement, ...]:
    """Random controls against the touch intervals, and who attains their ends.

    Args:
        foot: The foot.

    Returns:
        The measurements.
    """
    found = touch_intervals(foot, AXES)
    controls = np.random.default_rng(3).uniform(size=(SAMPLES, 1, foot.phalanx_count))
    parts = np.array_split(controls, PARTS)
    distance = np.concatenate([_nearest(foot, part) for part in parts])
    below = (found.least[..., 0] - distance).max()
    above = (distance - found.most[..., 1]).max()
    ends = (
        (found.least_controls, found.least[..., 1]),
        (found.most_controls, found.most[..., 0]),
    )
    return (
        Measurement(
            "touch_excess",
            f"farthest that the nearest phalanx of {SAMPLES} random poses leaves its "
            "finger's touch interval; four fingers, three axes",
            float(max(below, above)),
            at_most(EXACT, "certified bounds"),
        ),
        Measurement(
            "touch_width",
            "widest bracket of an interval's end",
            float(found.width.max()),
            at_most(float(found.tolerance * foot.size), "the tolerance asked for"),
        ),
        Measurement(
            "touch_attained",
            "largest clearance by FCL of the poses at the intervals' ends",
            max(_attained(foot, *end) for end in ends),
            at_most(ITERATED, "a touch"),
        ),
    )


def _nearest(foot: Foot, controls: Floats) -> Floats:
    """How far each finger's nearest phalanx is from each axis, shape (n, 3, F)."""
    bones = forward_kinematics(foot, controls)
    axial = branch_clearance(bones, foot.radii, AXES).distance + AXES.radius
    fingers = foot.finger_slices.values()
    return np.stack([axial[..., part].min(axis=-1) for part in fingers], axis=-1)


def _attained(foot: Foot, controls: Floats, radius: Floats) -> float:
    """How far by FCL fingers are from touching branches of these radii."""
    worst = 0.0
    for index, part in enumerate(foot.finger_slices.values()):
        branch = Branch(radius[:, index], AXES.centre)
        report = check_grasp(foot, controls, branch, engine="fcl")
        gap = report.clearance[:, part].min(axis=1)
        worst = max(worst, float(np.abs(gap).max()))
    return worst
