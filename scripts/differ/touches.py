"""Route to touches: certified intervals, random poses, FCL."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from differ.clearances import EPS, TINY
from differ.comparison import Comparison, at_most, close, same
from differ.draw import Draw, Size
from differ.route import Route
from zygopin import (
    Branch,
    Foot,
    collision,
    forward_kinematics,
    touch_intervals,
    touching_controls,
)
from zygopin.clearance import Floats, dot, norm
from zygopin.grasp import THINNEST

ULPS = 256
"""Rounding of a distance to an axis, in units of the last place of the foot's size and
of the axis' distance: the search's own bounds are widened by 64 of each finger's."""

AXES = 2
"""Axes that intervals are sought for; all poses are held against each."""

MAX_BOXES = 1500
"""Boxes for each end of an interval: a second at most. Brackets then stay wide."""


def against_poses(drawn: Draw) -> Sequence[Comparison]:
    """Touch intervals, witnesses and touching controls against plain distances."""
    foot, axes = drawn.foot, drawn.branch[:AXES]
    drawn.beyond.update(centres=axes.centre, axes=axes.axis)
    found = touch_intervals(foot, axes, max_boxes=MAX_BOXES)
    within = ULPS * EPS * (foot.size + norm(axes.centre).max())
    poses = np.stack(
        [_distances(foot, drawn.controls, axis) for axis in _each(axes)], 1
    )
    low, high = (
        np.broadcast_to(bound, poses.shape)
        for bound in (found.least[..., 0], found.most[..., 1])
    )
    near, far = (
        np.concatenate(
            [
                _distances(foot, row[None], a)
                for row, a in zip(c, _each(axes), strict=True)
            ]
        )
        for c in (found.least_controls, found.most_controls)
    )
    return (
        at_most("least distance / random poses", low, poses, within),
        at_most("random poses / greatest distance", poses, high, within),
        close("least distance / its witness", found.least[..., 1], near, within),
        close("greatest distance / its witness", found.most[..., 0], far, within),
        *_touching(foot, axes, found.least[..., 1], found.most[..., 0], within),
    )


def _each(axes: Branch) -> list[Branch]:
    """The branches of a batch (n,), one by one."""
    return [axes[i] for i in range(axes.batch_shape[0])]


def _distances(foot: Foot, controls: Floats, axis: Branch) -> Floats:
    """Least distance of each finger's skin from an axis line [m], shape (n, F)."""
    bones = forward_kinematics(foot, controls) - axis.centre
    flat = bones - dot(bones, axis.axis)[..., None] * axis.axis
    start, line = flat[..., 0, :], flat[..., 1, :] - flat[..., 0, :]
    square = np.maximum(dot(line, line), TINY)
    t = np.clip(-dot(start, line) / square, 0, 1)[..., None]
    inner = norm(start + t * line)
    # A bone along the axis has its ends alone, and rounding may prefer them elsewhere.
    nearest = np.minimum(inner, norm(flat).min(axis=-1)) - foot.radii
    parts = foot.finger_slices.values()
    return np.stack([nearest[:, part].min(axis=-1) for part in parts], axis=-1)


def _touching(
    foot: Foot, axes: Branch, low: Floats, high: Floats, within: float
) -> Sequence[Comparison]:
    """Controls that touch radii within the intervals, finger by finger, by FCL."""
    intervals = touch_intervals(foot, axes, max_boxes=MAX_BOXES)
    wanted = np.maximum((low + high) / 2, 0.0)
    wide = (high - low > 4 * within) & (wanted > THINNEST * foot.size)
    radius = np.where(wide, wanted, foot.size).T  # (F, n)
    found = touching_controls(intervals, radius)
    gaps = np.empty(radius.shape)
    for finger, part in enumerate(foot.finger_slices.values()):
        branch = Branch(radius[finger], axes.centre, axes.axis)
        bones = forward_kinematics(foot, found.controls[finger])
        near = collision.branch_clearance(bones, foot.radii, branch)
        gaps[finger] = near.distance[:, part].min(axis=-1)
    fingers = np.arange(len(gaps))
    touching = found.touching[fingers, :, fingers]
    gaps = np.where(wide.T, gaps, 0.0)
    return (
        same("touching inside the interval / yes", touching | ~wide.T, True | wide.T),
        close("touching controls / FCL", gaps, 0 * gaps, within),
    )


ROUTES = (
    Route(
        "touch-intervals",
        "touch intervals, witnesses, touching controls / plain distances / FCL",
        f"{ULPS} ulp of the foot's size and the axis' distance: rounding",
        against_poses,
        Size(poses=500, fingers=3, phalanges=4),
        posed=False,
    ),
)
"""Route to touches."""
