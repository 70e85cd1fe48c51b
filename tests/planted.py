"""Branches on which random poses are stable: found by trying, not by any search.

Controls are drawn, and the branch is solved for: a phalanx of each of two opposite toes
is tangent to it, which is a 2×2 system for height and radius. Whether the pose then
enters, or grasps, is for the checks to say.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zygopin import Branch, check_grasp
from zygopin.contact_products import least_products
from zygopin.kinematics import forward_kinematics
from zygopin.witnesses import palmar

LEAST = 0.03
"""Least radius over the foot's size."""


class Planted(NamedTuple):
    """Branches with a stable pose each: fields of shape (n,), controls (n, P)."""

    height: np.ndarray
    radius: np.ndarray
    controls: np.ndarray
    feasible: np.ndarray
    grasping: np.ndarray  # feasible, and a quarter turn apart with the toes' palms

    def take(self, which):
        return Planted(*(field[which] for field in self))


def planted(foot, seed, axis=(0.0, 1.0, 0.0), count=20_000):
    """Stable poses on branches of one direction, centred above or below the base."""
    rng, axis = np.random.default_rng(seed), np.array(axis) / np.linalg.norm(axis)
    controls = rng.random((count, foot.phalanx_count)) ** rng.choice([0.5, 1, 2, 4])
    pairs = np.array(foot.opposable_pairs)[
        rng.integers(len(foot.opposable_pairs), size=count)
    ]
    starts = np.array([part.start for part in foot.finger_slices.values()])
    sizes = np.array([finger.phalanges for finger in foot.fingers])
    chosen = starts[pairs] + (rng.random(pairs.shape) * sizes[pairs]).astype(int)
    height, radius = _solved(
        foot, controls, chosen, axis, rng.choice([-1, 1], (count, 2))
    )
    centre = height[:, None] * np.array([0.0, 0.0, 1.0])
    outside = np.linalg.norm(centre - (centre @ axis)[:, None] * axis, axis=1) > radius
    good = (radius > LEAST * foot.size) & (radius < foot.size) & outside
    branch = Branch(radius[good], centre[good], axis)
    report = check_grasp(foot, controls[good], branch)
    (product,) = least_products(foot, report.tangent & palmar(report), report.normal)
    grasping = report.feasible & (np.nan_to_num(product, nan=1.0) <= 0)
    every = Planted(
        height[good], radius[good], controls[good], report.feasible, grasping
    )
    return every.take(report.stable)


def _solved(foot, controls, chosen, axis, signs):
    """Height and radius of the branch tangent to two phalanges in each pose, (n,)."""
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    plane = np.stack([across, np.cross(axis, across)]) / np.linalg.norm(across)
    rows = np.arange(len(controls))[:, None]
    bones = forward_kinematics(foot, controls)[rows, chosen] @ plane.T
    line = bones[:, :, 1] - bones[:, :, 0]
    normal = np.stack([-line[..., 1], line[..., 0]], axis=-1)
    normal *= (signs / np.linalg.norm(normal, axis=-1))[..., None]
    # normal · (h·up − start) = r + skin
    matrix = np.stack([normal @ plane[:, 2], -np.ones(chosen.shape)], axis=-1)
    right = np.sum(normal * bones[:, :, 0], axis=-1) + foot.radii[chosen]
    result = np.full((len(controls), 2), np.nan)
    regular = np.abs(np.linalg.det(matrix)) > 1e-6
    result[regular] = np.linalg.solve(matrix[regular], right[regular][..., None])[
        ..., 0
    ]
    return result.T
