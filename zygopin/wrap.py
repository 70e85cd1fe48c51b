"""How one finger can lie on a branch: poses that touch it and do not enter it."""

from __future__ import annotations

from dataclasses import dataclass, fields
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.clearance import Floats, branch_clearance, dot
from zygopin.foot import Foot
from zygopin.grasp import Criteria, classify
from zygopin.illinois import crossings

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]

SLACK = 1e-12
"""Penetration that is rounding, over the foot's size."""

CONVERGED = 1e-13
"""Clearance of a contact that has been found, over the foot's size."""

ROUNDING = 8 * np.finfo(float).eps
"""Rounding of a clearance, over the distances whose difference it is."""

MOST_POSES = 2_000_000
"""Poses tried at once: about a gigabyte."""

ITERATIONS = 24
"""Steps of the bracketed secant: enough for doubles on a bracket of one grid step."""

WRAP_BIN = np.deg2rad(12.0)
"""Width of the bins of wrap; one pose is kept for each bin of wrap and of tip."""

TIP_BIN = 0.12
"""Width of the bins of the tip's forward position, over the foot's size: fingers
run into each other below the base, so plans need poses that stay away from there."""

BEHIND = -np.pi / 4
"""Contacts up to this far behind the base's nearest line count as wrapped back,
not as wrapped nearly all the way round."""


@dataclass(frozen=True)
class FingerPoses:
    """Poses of one finger on branches, none of which enters its branch.

    Attributes:
        place: Index of the branch that each pose is for, shape (N,).
        controls: Controls, shape (N, K).
        bones: Bones [m], shape (N, K, 2, 3).
        clearance: Clearance of each phalanx [m], shape (N, K).
        touching: Which phalanges touch, shape (N, K).
        tangent: Which phalanges are tangent, shape (N, K).
        normal: Contact normals, shape (N, K, 3).
        wrap: How far around the branch the last tangent phalanx lies from the
            base's nearest line, in the sense of flexion [rad], shape (N,); −∞
            without one.
    """

    place: Indices
    controls: Floats
    bones: Floats
    clearance: Floats
    touching: Booleans
    tangent: Booleans
    normal: Floats
    wrap: Floats

    def take(self, which: Indices | Booleans) -> FingerPoses:
        """Some of the poses.

        Args:
            which: Their indices, or a mask.

        Returns:
            Those poses, in that order.
        """
        return FingerPoses(
            *(getattr(self, field.name)[which] for field in fields(self))
        )


def finger_poses(
    foot: Foot, finger: int, branches: Branch, levels: int, tolerance: float
) -> FingerPoses:
    """A varied choice of poses of one finger: touching, and wrapped as far as can be.

    Phalanx by phalanx, each joint either takes one of `levels` angles or closes
    until its phalanx meets the branch; whatever enters the branch is dropped. A
    phalanx that meets it inside the bone is tangent, so closing joint after joint is
    the conforming wrap of MODEL.md, section 4, for any axis and any finger.

    Args:
        foot: The foot.
        finger: Index of the finger.
        branches: Branches, batch shape (B,).
        levels: Number of angles tried at each joint; fewer are where `MOST_POSES`
            would be passed.
        tolerance: Contact tolerance [m].

    Returns:
        At most about a hundred poses for each branch; the straight one for a branch
        that every pose enters.
    """
    chain = _Chain.of(foot, finger, branches)
    count = branches.batch_shape[0]
    most = int((MOST_POSES / max(count, 1)) ** (1 / chain.count))
    grid = np.linspace(0.0, 1.0, max(2, min(levels, most)))
    partial = _Partial(
        np.arange(count),
        np.empty((count, 0)),
        np.zeros((count, 3)),
        np.full(count, chain.orientation),
    )
    for rank in range(chain.count):
        partial = _grown(chain, partial, rank, grid)
    lost = np.setdiff1d(np.arange(count), partial.place)
    place = np.concatenate([partial.place, lost])
    straight = np.zeros((len(lost), chain.count))
    controls = np.concatenate([partial.controls, straight])
    return _varied(chain, _evaluated(chain, place, controls, tolerance))


def given_poses(
    foot: Foot, finger: int, branches: Branch, poses: tuple[Indices, Floats]
) -> FingerPoses:
    """Contacts of given poses of one finger, whether or not they enter.

    Args:
        foot: The foot.
        finger: Index of the finger.
        branches: Branches, batch shape (B,).
        poses: Index of each pose's branch, shape (N,), and its controls, (N, K).

    Returns:
        The poses.
    """
    chain, tolerance = _Chain.of(foot, finger, branches), Criteria().metres(foot)
    return _evaluated(chain, *poses, tolerance)


@dataclass(frozen=True)
class _Chain:
    """One finger of a foot, and the branches it is to lie on."""

    branches: Branch
    lengths: Floats
    radii: Floats
    forward: Floats
    orientation: float
    omega: float
    size: float

    @classmethod
    def of(cls, foot: Foot, index: int, branches: Branch) -> _Chain:
        finger = foot.fingers[index]
        part = foot.finger_slices[finger.name]
        forward = np.array([np.cos(finger.azimuth), np.sin(finger.azimuth), 0.0])
        return cls(
            branches,
            foot.lengths[part],
            foot.radii[part],
            forward,
            finger.orientation,
            foot.omega,
            foot.size,
        )

    @property
    def count(self) -> int:
        """Number of phalanges."""
        return len(self.lengths)

    @cached_property
    def rounding(self) -> Floats:
        """Rounding of a clearance from each branch [m], shape (B,)."""
        far = np.linalg.norm(self.branches.centre, axis=-1)
        return np.asarray(ROUNDING * (self.branches.radius + far))

    def step(self, pitch: Floats) -> Floats:
        """Unit vectors at given pitches, (…) to (…, 3)."""
        steps = np.cos(pitch)[..., None] * self.forward
        steps[..., 2] = -np.sin(pitch)
        return steps


@dataclass(frozen=True)
class _Partial:
    """Poses of the first k phalanges: branch, controls, last junction and pitch."""

    place: Indices
    controls: Floats
    junction: Floats
    pitch: Floats

    def take(self, index: Indices) -> _Partial:
        """Some of the poses."""
        return _Partial(*(getattr(self, field.name)[index] for field in fields(self)))


def _grown(chain: _Chain, old: _Partial, rank: int, grid: Floats) -> _Partial:
    """Poses of one phalanx more: grid angles, and joints closed until contact."""
    clearance = np.stack(
        [_next_clearance(chain, old, rank, np.full(len(old.place), v)) for v in grid], 1
    )
    slack = SLACK * chain.size + chain.rounding[old.place]
    outside = np.nonzero(clearance >= -slack[:, None])
    row, step = np.nonzero((clearance[:, :-1] > 0) & (clearance[:, 1:] < 0))
    ends = (grid[step], grid[step + 1])
    values = (clearance[row, step], clearance[row, step + 1])
    closed, found = _closed(chain, old.take(row), rank, ends, values)
    rows = np.concatenate([outside[0], row[found]])
    control = np.concatenate([grid[outside[1]], closed[found]])
    kept = old.take(rows)
    pitch = kept.pitch + chain.omega * control
    return _Partial(
        kept.place,
        np.concatenate([kept.controls, control[:, None]], axis=1),
        kept.junction + chain.lengths[rank] * chain.step(pitch),
        pitch,
    )


def _next_clearance(chain: _Chain, old: _Partial, rank: int, control: Floats) -> Floats:
    """Clearance of the next phalanx for given controls of its joint [m], (N,)."""
    step = chain.lengths[rank] * chain.step(old.pitch + chain.omega * control)
    bones = np.stack([old.junction, old.junction + step], axis=1)[:, None]
    branches = chain.branches[old.place]
    near = branch_clearance(bones, chain.radii[rank : rank + 1], branches)
    return near.distance[:, 0]


def _closed(
    chain: _Chain,
    old: _Partial,
    rank: int,
    ends: tuple[Floats, Floats],
    values: tuple[Floats, Floats],
) -> tuple[Floats, Booleans]:
    """The next joint turned to contact, inside brackets.

    Args:
        chain: The finger and the branches.
        old: Poses up to the joint.
        rank: Index of the next phalanx.
        ends: Controls that leave the branch clear, and that enter it, (n,) each.
        values: The clearances there [m].

    Returns:
        Controls of the joint, shape (n,), and which of them have converged.
    """

    def clearance(active: Indices, control: Floats) -> Floats:
        return _next_clearance(chain, old.take(active), rank, control)

    enough = CONVERGED * chain.size + chain.rounding[old.place]
    return crossings(clearance, ends, values, enough, ITERATIONS)


def _evaluated(
    chain: _Chain, place: Indices, controls: Floats, tolerance: float
) -> FingerPoses:
    """Contacts and wrap of given poses."""
    pitch = chain.orientation + chain.omega * np.cumsum(controls, axis=1)
    steps = chain.lengths[:, None] * chain.step(pitch)
    ends = np.cumsum(steps, axis=1)
    bones = np.stack([ends - steps, ends], axis=2)
    branches = chain.branches[place]
    near = branch_clearance(bones, chain.radii, branches)
    contacts = classify(near, tolerance)
    return FingerPoses(
        place,
        controls,
        bones,
        near.distance,
        contacts.touching,
        contacts.tangent,
        near.normal,
        _wrap(chain.forward, branches, near.normal, contacts.tangent),
    )


def _wrap(
    forward: Floats, branch: Branch, normals: Floats, tangent: Booleans
) -> Floats:
    """Angle from the base's nearest line to the last tangent contact, (N,)."""
    axis, centre = branch.axis, branch.centre
    base = dot(centre, axis)[:, None] * axis - centre
    base = base / np.linalg.norm(base, axis=1, keepdims=True)
    flexion = np.cross((0.0, 0.0, 1.0), forward)
    # Seen along the flexion's own axis, every finger wraps the same way round.
    sense = np.where(axis @ flexion >= 0, 1.0, -1.0)[:, None]
    side = np.cross(sense * axis, base)
    angle = np.arctan2(dot(normals, side[:, None]), dot(normals, base[:, None]))
    angle = (angle - BEHIND) % (2 * np.pi) + BEHIND
    return np.asarray(np.where(tangent, angle, -np.inf).max(axis=1, initial=-np.inf))


def _varied(chain: _Chain, poses: FingerPoses) -> FingerPoses:
    """For each wrap and place of the tip the pose with most and closest contacts."""
    tips = poses.bones[:, -1, 1] @ chain.forward
    bins = (
        poses.place,
        -np.floor(np.maximum(poses.wrap, 2 * BEHIND) / WRAP_BIN),
        np.floor(tips / (TIP_BIN * chain.size)),
    )
    gap = np.where(poses.touching.any(axis=1), 0.0, poses.clearance.min(axis=1))
    order = np.lexsort(
        (
            poses.clearance.sum(axis=1),
            gap,
            -poses.touching.sum(axis=1),
            -poses.tangent.sum(axis=1),
            *bins[::-1],
        )
    )
    # Sorted by bin and then by merit, the first of each bin is its best.
    codes = np.stack(bins, axis=1)[order]
    first = np.any(codes != np.roll(codes, 1, axis=0), axis=1)
    first[:1] = True
    return poses.take(order[first])
