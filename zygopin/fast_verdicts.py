"""Verdicts by compiled loops, for the engine `fast`: a block of cases at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from zygopin.blocks import Part
from zygopin.branch import Branch
from zygopin.cases import Cases
from zygopin.cross_section import CrossSection
from zygopin.directions import Floats
from zygopin.fast_bones import chains, half_tangents
from zygopin.foot import Foot
from zygopin.grasp import PARAMETER_SLACK, Booleans, finger_pairs, least_gap
from zygopin.kinematics import as_azimuths
from zygopin.verdict_kernels import (
    Near,
    Toes,
    across,
    apart,
    ended,
    laid,
    least_products,
    met,
    seen,
)


class FastVerdicts:
    """Tells whether poses are stable, grasp and are feasible."""

    def __init__(self, cases: Cases) -> None:
        self.cases, foot = cases, cases.foot
        self.tolerance = cases.criteria.metres(foot)
        azimuths = as_azimuths(foot, None)
        self.azimuth = azimuths[foot.finger_of_phalanx]
        self.toes = _toes(foot, self.azimuth, self.tolerance)
        turn = np.subtract.outer(azimuths, azimuths)
        by_bones = cases.criteria.reading == "base_to_tip"
        self.weights = np.cos(turn) if by_bones else np.ones_like(turn)
        one = not cases.branch.batch_shape
        self.only = _section(foot, cases.branch) if one else None

    def settled(self, part: Part) -> tuple[Booleans, Booleans]:
        """Verdicts on some cases, and which are left to the exact engine.

        Args:
            part: Which n cases.

        Returns:
            Stable, grasping, feasible, shape (3, n), and those that the loops cannot
            decide, shape (n,).
        """
        branch = self.cases.branches(part)
        section = self.only or _section(self.cases.foot, branch)
        along, down = self._bones(self.cases.poses(part))
        shape = np.broadcast_shapes(along.shape, section.across.shape)
        bones, normal = np.empty((2, *shape)), np.empty((2, *shape))
        near = Near(np.empty(shape), np.empty(shape), normal)
        seen(_wide(along, shape), _wide(down, shape), section, bones)
        across(bones, section.centre[:, 0], self.toes, near)
        radius = _wide(branch.radius, shape[1:])
        tangent, entered = np.empty(shape, bool), np.zeros(shape[1], bool)
        met(near, radius, self.toes, self.tolerance, tangent, entered)
        left = np.full(shape[1], branch.least_radius <= self.tolerance)
        if branch.length is not None:
            self._end(along, down, branch, near, left)
        if self.cases.criteria.reading == "base_to_tip":
            normal[0], normal[1] = along, down
            normal /= self.toes.lengths[:, None]
        least = np.full(shape[1], np.inf)
        least_products(normal, tangent, self.weights, self.toes, least)
        free = self._free(along, down, ~entered)
        return np.array([np.isfinite(least), least <= PARAMETER_SLACK, free]), left

    def _bones(self, poses: Floats) -> tuple[Floats, Floats]:
        """Horizontal parts of the bones [m], and how far they go down, (P, n) each."""
        shape = poses.shape[::-1]
        along, down = np.empty(shape), np.empty(shape)
        tangent = half_tangents(poses, chains(self.cases.foot))
        laid(tangent, self.toes, along, down)
        return along, down

    def _end(
        self, along: Floats, down: Floats, branch: Branch, near: Near, left: Booleans
    ) -> None:
        """Leave out what meets finite branches where they may have ended."""
        x, y, z = np.atleast_2d(branch.axis).T
        azimuth = self.azimuth[:, None]
        axial = along * (np.cos(azimuth) * x + np.sin(azimuth) * y) - down * z
        start = -np.einsum("...i,...i->...", branch.centre, branch.axis)
        axial, start = _wide(axial, near.t.shape), _wide(start, left.shape)
        radius = _wide(branch.radius, left.shape)
        ends = radius, _wide(branch.half_length, left.shape), self.tolerance
        ended(axial, start, self.toes, near, ends, left)

    def _free(self, along: Floats, down: Floats, clear: Booleans) -> Booleans:
        """Which cases that are clear of the branch are free of fingers as well."""
        if along.shape[1] < len(clear):  # one pose on many branches
            return clear & self._apart(along, down)
        (kept,) = np.nonzero(clear)
        if len(kept) < len(clear):
            along, down = along.take(kept, axis=1), down.take(kept, axis=1)
        clear[kept] = self._apart(along, down)
        return clear

    def _apart(self, along: Floats, down: Floats) -> Booleans:
        """Whether no two fingers collide, shape (n,)."""
        free = np.ones(along.shape[1], bool)
        apart(along, down, self.toes, free)
        return free


def _toes(foot: Foot, azimuth: Floats, tolerance: float) -> Toes:
    """The constants of a foot."""
    finger, pairs = foot.finger_of_phalanx, np.array(finger_pairs(foot))
    turn = azimuth[pairs[1]] - azimuth[pairs[0]]
    opposed = np.zeros((len(foot.fingers),) * 2, bool)
    for one, other in foot.opposable_pairs:
        opposed[one, other] = opposed[other, one] = True
    return Toes(
        first=foot.rank_of_phalanx == 1,
        finger=finger,
        lengths=foot.lengths,
        radii=foot.radii,
        opposed=opposed,
        pairs=pairs,
        turn=np.array([np.cos(turn), np.sin(turn)]),
        least=foot.radii[pairs].sum(axis=0) + least_gap(foot, tolerance),
    )


def _section(foot: Foot, branch: Branch) -> CrossSection:
    """The planes across branches, as the loops take them."""
    return CrossSection(*map(np.array, CrossSection.of(foot, branch)))


def _wide(values: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """Numbers of a shape, as the loops take them: themselves if they are."""
    given = np.asarray(values)
    if given.shape == shape and given.flags.carray:
        return given
    wide = np.empty(shape)
    wide[...] = given
    return wide
