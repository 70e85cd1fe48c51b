"""Branches around a foot: anywhere, touched by one phalanx, tangent to two."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from differ.corners import Rng
from zygopin import Branch, Foot, forward_kinematics
from zygopin.clearance import Floats, dot, norm
from zygopin.grasp import FARTHEST, THINNEST

KINDS = 3
"""Anywhere, touched by one phalanx, tangent to the lines of two."""

AWAY = 2.5
"""Distance of the axis, over the radius and the foot's size, beyond which a branch that
touches is given up."""


class _Placed(NamedTuple):
    """Branches of n poses: radius (n,), centre and axis (n, 3)."""

    radius: Floats
    centre: Floats
    axis: Floats


def around(foot: Foot, controls: Floats, corners: tuple[str, ...], rng: Rng) -> Branch:
    """A branch for each pose, none of them around the base.

    Args:
        foot: The foot.
        controls: Controls, shape (n, P).
        corners: The corners of the case.
        rng: Where they come from.

    Returns:
        The branches, batch (n,).
    """
    bones, count = forward_kinematics(foot, controls), len(controls)
    radius, axis = _radii(foot, count, corners, rng), _directions(count, rng)
    if "axis in a toe's plane" in corners:
        axis = _in_planes(foot, bones, rng)
    anywhere = _anywhere(foot, radius, axis, corners, rng)
    if "base on the bark" in corners:
        return Branch(*anywhere)
    kind = rng.integers(KINDS, size=count)
    if "touch at a junction" in corners:
        kind[:] = 1
    one = _touched(foot, bones, anywhere, corners, rng)
    two = _tangent(foot, bones, anywhere, rng)
    centre = np.choose(kind[:, None], [anywhere.centre, one, two])
    along = dot(centre, axis)[:, None] * axis
    aside = norm(centre - along)
    good = (
        np.isfinite(aside) & (aside >= radius) & (aside < AWAY * (radius + foot.size))
    )
    return Branch(radius, np.where(good[:, None], centre, anywhere.centre), axis)


def _radii(foot: Foot, count: int, corners: tuple[str, ...], rng: Rng) -> Floats:
    """Radii from a hundredth of the foot to twice its size, or a corner's."""
    low, high = -2.0, 0.3
    if "branch thin" in corners:
        low, high = np.log10(1.01 * THINNEST), -4.0
    if "branch huge" in corners:
        low, high = 3.0, np.log10(FARTHEST / 4)
    return foot.size * 10 ** rng.uniform(low, high, count)


def _directions(count: int, rng: Rng) -> Floats:
    """Random unit vectors, shape (n, 3)."""
    axis = rng.normal(size=(count, 3))
    return axis / norm(axis)[:, None]


def _in_planes(foot: Foot, bones: Floats, rng: Rng) -> Floats:
    """Axes in a toe's plane; every other one along a bone, shape (n, 3)."""
    rows = np.arange(len(bones))
    phalanx = rng.integers(bones.shape[1], size=len(bones))
    azimuth = np.array([finger.azimuth for finger in foot.fingers])
    azimuth = azimuth[foot.finger_of_phalanx[phalanx]]
    pitch = rng.uniform(-np.pi, np.pi, len(bones))
    level = np.cos(pitch)
    axis = np.stack(
        [level * np.cos(azimuth), level * np.sin(azimuth), np.sin(pitch)], 1
    )
    line = bones[rows, phalanx, 1] - bones[rows, phalanx, 0]
    return np.where((rows % 2 == 0)[:, None], line / norm(line)[:, None], axis)


def _anywhere(
    foot: Foot, radius: Floats, axis: Floats, corners: tuple[str, ...], rng: Rng
) -> _Placed:
    """Branches at most the foot's size from the base, or on it."""
    aside = np.cross(axis, rng.normal(size=axis.shape))
    aside /= norm(aside)[:, None]
    gap = foot.size * rng.uniform(0, 1, len(radius))
    if "base on the bark" in corners:
        gap[:] = 0.0
    along = foot.size * rng.normal(size=(len(radius), 1))
    return _Placed(radius, (radius + gap)[:, None] * aside + along * axis, axis)


def _touched(
    foot: Foot, bones: Floats, at: _Placed, corners: tuple[str, ...], rng: Rng
) -> Floats:
    """Centres of branches that a phalanx lies against, NaN where along it, (n, 3)."""
    rows = np.arange(len(bones))
    phalanx = rng.integers(bones.shape[1], size=len(bones))
    start, end = bones[rows, phalanx].swapaxes(0, 1)
    place = rng.uniform(size=(len(bones), 1))
    if "touch at a junction" in corners:
        place = np.round(place)
    normal = _across(end - start, at.axis) * rng.choice([-1, 1], (len(bones), 1))
    reach = (at.radius + foot.radii[phalanx])[:, None]
    return np.asarray(start + place * (end - start) + reach * normal)


def _across(line: Floats, axis: Floats) -> Floats:
    """Unit normals of lines and axes, NaN where they are parallel, shape (n, 3)."""
    normal = np.cross(axis, line)
    size = norm(normal)[:, None]
    good = size > 1e-6 * norm(line)[:, None]
    return np.divide(normal, size, np.full_like(normal, np.nan), where=good)


def _tangent(foot: Foot, bones: Floats, at: _Placed, rng: Rng) -> Floats:
    """Centres of branches tangent to the lines of two phalanges, or NaN, (n, 3)."""
    rows = np.arange(len(bones))[:, None]
    phalanx = rng.integers(bones.shape[1], size=(len(bones), 2))
    picked = bones[rows, phalanx]
    normal = np.stack(
        [_across(picked[:, i, 1] - picked[:, i, 0], at.axis) for i in (0, 1)], axis=1
    )
    normal *= rng.choice([-1, 1], (len(bones), 2, 1))
    # normal · centre = normal · start + r + skin, for both; and no part along the axis.
    right = dot(normal, picked[:, :, 0]) + at.radius[:, None] + foot.radii[phalanx]
    matrix = np.concatenate([normal, at.axis[:, None]], axis=1)
    regular = np.abs(np.linalg.det(np.nan_to_num(matrix))) > 1e-3
    centre = np.full((len(bones), 3), np.nan)
    wanted = np.pad(right, ((0, 0), (0, 1)))[regular][..., None]
    centre[regular] = np.linalg.solve(matrix[regular], wanted)[..., 0]
    return centre
