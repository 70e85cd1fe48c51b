"""Poses tangent to a branch, made without any projection: witnesses for the tests.

Every pose has, for each phalanx, one radius with which it touches a branch of a given
axis: its distance from the axis, less the skin.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import numpy as np

from zygopin import Branch, Finger, Foot
from zygopin.clearance import branch_clearance
from zygopin.kinematics import forward_kinematics
from zygopin.projection import BACK, BEHIND, PALM, ProjectedFinger

TOLERANCE = 1e-6
"""Contact tolerance of the tests, over the foot's size."""


@dataclass(frozen=True, eq=False)
class Tangencies:
    """One phalanx's contacts in n poses: fields of shape (n,), controls (n, K)."""

    controls: np.ndarray
    radius: np.ndarray
    wrap: np.ndarray
    side: np.ndarray
    spare: np.ndarray  # clearance of the nearest phalanx before
    inside: np.ndarray

    def take(self, which):
        return Tangencies(*(getattr(self, field.name)[which] for field in fields(self)))

    def contacts(self, *, side, solid, least=1e-3):
        """Those with one side, inside the bone; solid: nothing before enters."""
        good = self.inside & (self.radius > least) & (self.side == side)
        return self.take(good & ((self.spare >= 0) | (not solid)))


def random_view(seed, most=5):
    """A foot of one finger, an axis that is not in its plane, and a centre."""
    rng = np.random.default_rng(seed)
    azimuth = rng.choice([0.0, rng.uniform(-3, 3)])
    orientation = rng.choice([0.0, rng.uniform(-1, 1)])
    finger = Finger("toe", int(rng.integers(1, most + 1)), azimuth, orientation)
    foot = Foot(
        rho=rng.uniform(1.02, 3.0),
        omega=rng.choice([rng.uniform(0.05, 6.0), rng.uniform(0.3, 2.0)]),
        thickness=rng.choice([0.0, rng.uniform(0, 0.3)]),
        fingers=(finger,),
    )
    across = np.array([-math.sin(azimuth), math.cos(azimuth), 0.0])
    axis = rng.choice([0.0, 0.5, 3.0]) * rng.standard_normal(3) + across
    centre = rng.standard_normal(3) * foot.size * 10 ** rng.uniform(-1.5, 0.5)
    return foot, axis / np.linalg.norm(axis), centre


def projected(foot, axis):
    return ProjectedFinger.of(foot, 0, axis)


def random_controls(rng, count, joints):
    """Controls inside the cube, on its edges and at its corners."""
    inside = rng.random((count, joints))
    corner = rng.random((count, joints)) < rng.choice([0.0, 0.5, 1.0], (count, 1))
    return np.where(corner, np.round(inside), inside)


def tangencies(foot, axis, centre, rank, controls):
    """Contacts of phalanx `rank` of the first finger, in 3-D."""
    bones = forward_kinematics(foot, controls)
    near = branch_clearance(bones, foot.radii, Branch(1.0, centre, axis))
    radii, normal = near.distance + 1.0, near.normal[:, rank - 1]
    t, finger = near.t[:, rank - 1], foot.fingers[0]
    pitch = finger.orientation + foot.omega * controls[:, :rank].sum(-1)[:, None]
    along = np.array([math.cos(finger.azimuth), math.sin(finger.azimuth), 0.0])
    down = np.array([0.0, 0.0, -1.0])
    bone = np.cos(pitch) * along + np.sin(pitch) * down
    palm = np.cos(pitch) * down - np.sin(pitch) * along
    base = (centre @ axis) * axis - centre
    flexion = np.sign(np.cross(bone, palm) @ axis)
    turned = np.arctan2(np.cross(base, normal) @ axis, normal @ base) * flexion
    before = np.min(radii[:, : rank - 1], axis=1, initial=np.inf)
    return Tangencies(
        controls,
        radii[:, rank - 1],
        (turned - BEHIND) % (2 * np.pi) + BEHIND,
        np.where(np.sum(normal * palm, axis=-1) < 0, PALM, BACK),
        before - radii[:, rank - 1],
        (t >= 0) & (t <= 1),
    )


def edge_tangencies(view, rank, rng, *, side, solid, count=40, rounds=25):
    """Contacts driven to an edge of what is possible, by random descent.

    Args:
        view: Foot, axis and centre.
        rank: Number of the phalanx.
        rng: Random numbers.
        side: Side of the toe.
        solid: Whether the phalanges before stay outside.
        count: Poses.
        rounds: Steps of the descent.

    Returns:
        Contacts, of those poses that came to have one.
    """
    foot = view[0]
    goal = np.array([[1, 0], [-1, 0], [0, 1], [0, -1], [1, 1], [-1, 1]])
    goal = goal[rng.integers(len(goal))]

    def score(poses):
        made = tangencies(*view, rank, poses)
        good = made.inside & (made.radius > 1e-3 * foot.size) & (made.side == side)
        good &= (made.spare >= 0) | (not solid)
        merit = goal[0] * made.radius / foot.size + goal[1] * made.wrap
        return np.where(good, merit, -np.inf)

    poses = random_controls(rng, count, foot.phalanx_count)
    best = score(poses)
    for _ in range(rounds):
        step = 10 ** rng.uniform(-4, -0.5, (count, 1)) * rng.standard_normal(
            poses.shape
        )
        tried = np.clip(poses + step, 0.0, 1.0)
        found = score(tried)
        poses[found > best] = tried[found > best]
        best = np.maximum(best, found)
    return tangencies(*view, rank, poses[np.isfinite(best)])


def cases(seeds, *, solids=(True, False), most=5):
    """Views with contacts: (view, finger, rank, side, solid, contacts)."""
    for seed in seeds:
        view, rng = random_view(seed, most), np.random.default_rng(seed + 1)
        finger = projected(*view[:2])
        rank = int(rng.integers(1, len(finger.lengths) + 1))
        for side in (PALM, BACK):
            for solid in solids:
                made = edge_tangencies(view, rank, rng, side=side, solid=solid)
                made = made.contacts(side=side, solid=solid, least=1e-3 * view[0].size)
                if len(made.radius):
                    yield view, finger, rank, side, solid, made


def base_distance(view):
    """Distance of the base from the axis [m]."""
    _, axis, centre = view
    return np.linalg.norm(centre - (centre @ axis) * axis)
