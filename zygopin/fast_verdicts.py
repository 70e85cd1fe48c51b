"""Verdicts by compiled loops, for the engine `fast`: a block of cases at a time."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from zygopin.blocks import Part
from zygopin.branch import Branch
from zygopin.cases import Cases
from zygopin.cross_section import CrossSection
from zygopin.directions import Floats, directions
from zygopin.foot import Foot
from zygopin.grasp import PARAMETER_SLACK, Booleans, finger_pairs, least_gap
from zygopin.kinematics import as_azimuths
from zygopin.verdict_kernels import (
    Near,
    Toes,
    across,
    apart,
    ended,
    least_products,
    met,
)


class FastVerdicts:
    """Tells whether poses are stable, grasp and are feasible."""

    def __init__(self, cases: Cases) -> None:
        self.cases, foot = cases, cases.foot
        self.tolerance = cases.criteria.metres(foot)
        self.azimuth = as_azimuths(foot, None)[foot.finger_of_phalanx]
        self.toes = _toes(foot, self.azimuth, self.tolerance)
        one = not cases.branch.batch_shape
        self.only = CrossSection.of(foot, cases.branch) if one else None

    def settled(self, part: Part) -> tuple[Booleans, Booleans]:
        """Verdicts on some cases, and which are left to the exact engine.

        Args:
            part: Which n cases.

        Returns:
            Stable, grasping, feasible, shape (3, n), and those that the loops cannot
            decide, shape (n,).
        """
        branch = self.cases.branches(part)
        pointing = directions(self.cases.foot, self.cases.poses(part))
        along, down = pointing * self.toes.lengths[:, None]
        section = self.only or CrossSection.of(self.cases.foot, branch)
        bones = section.seen(along, down)
        shape = bones.shape[1:]
        near = Near(np.empty(shape), np.empty(shape), np.empty(bones.shape))
        across(bones, _wide(-section.centre[:, 0], bones[:, 0]), self.toes, near)
        radius = _wide(branch.radius, bones[0, 0])
        tangent, entered = np.empty(shape, bool), np.zeros(shape[1], bool)
        met(near, radius, self.toes, self.tolerance, tangent, entered)
        left = np.full(shape[1], branch.least_radius <= self.tolerance)
        if branch.length is not None:
            self._end(along, down, branch, near, left)
        by_bones = self.cases.criteria.reading == "base_to_tip"
        vectors = self._lines(pointing, shape) if by_bones else near.normal
        least = np.full(shape[1], np.inf)
        least_products(vectors, tangent, self.toes, least)
        free = self._free(along, down, ~entered)
        return np.array([np.isfinite(least), least <= PARAMETER_SLACK, free]), left

    def _end(
        self, along: Floats, down: Floats, branch: Branch, near: Near, left: Booleans
    ) -> None:
        """Leave out what meets finite branches where they may have ended."""
        x, y, z = np.atleast_2d(branch.axis).T
        azimuth = self.azimuth[:, None]
        axial = along * (np.cos(azimuth) * x + np.sin(azimuth) * y) - down * z
        start = -np.einsum("...i,...i->...", branch.centre, branch.axis)
        axial, start = _wide(axial, near.t), _wide(start, left)
        sizes = _wide(branch.radius, left), _wide(branch.half_length, left)
        ended(axial, start, self.toes, near, (*sizes, self.tolerance), left)

    def _lines(self, pointing: Floats, shape: tuple[int, ...]) -> Floats:
        """Unit vectors from base to tip, shape (3, P, n)."""
        lines = np.empty((3, *shape))
        azimuth = self.azimuth[:, None]
        lines[0], lines[1] = (
            pointing[0] * np.cos(azimuth),
            pointing[0] * np.sin(azimuth),
        )
        lines[2] = -pointing[1]
        return lines

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


def _wide(values: ArrayLike, like: Floats | Booleans) -> Floats:
    """Numbers, one for each entry of an array: a new one in C order."""
    wide = np.empty(like.shape)
    wide[...] = np.asarray(values)
    return wide
