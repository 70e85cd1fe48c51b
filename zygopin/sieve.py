"""A sieve for many poses: which are clearly within a branch, and which clearly outside.

Bones are seen along the branch's axis, in single precision where that is enough.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from zygopin.cases import Cases
from zygopin.cross_section import CrossSection
from zygopin.directions import Floats, pitch_matrix, product, running_sum
from zygopin.grasp import Booleans

ROUNDING = 16
"""Rounding of a distance to the axis, in units of the last place of the lengths it is
computed from, beside one unit for each radian of pitch; four times what was seen."""

BROAD = 1e-3
"""Rounding, over the foot's size, that would leave too much to the full check: single
precision, which takes half the time, is used below."""


class _Limits(NamedTuple):
    """Branches for the sieve: n of them, or 1.

    Attributes:
        section: The planes across them.
        inside: Squared distance below which a bone is too near, shape (P, n) [m²].
        outside: Squared distance above which it touches nothing, shape (P, n) [m²].
    """

    section: CrossSection
    inside: Floats
    outside: Floats


class Sieve:
    """Tells which bones are clearly within a branch, and which clearly outside."""

    def __init__(self, cases: Cases) -> None:
        self.cases, foot = cases, cases.foot
        turns, start = pitch_matrix(foot)
        pitch = float((np.abs(start[:, 0]) + turns.sum(axis=1)).max())
        units = (ROUNDING + pitch) * (cases.branch.largest_extent + foot.size)
        coarse = units * np.finfo(np.float32).eps > BROAD * foot.size
        self.kind: type[np.floating] = np.float64 if coarse else np.float32
        rounding = units * float(np.finfo(self.kind).eps)
        self.slack = cases.criteria.metres(foot) + rounding
        # Where each bone ends in its toe's plane, and how it gets there from its start.
        steps = np.concatenate([running_sum(foot), np.eye(foot.phalanx_count)])
        self.turns, self.start, self.steps = (
            x.astype(self.kind) for x in (turns, start, steps * foot.lengths)
        )
        self.only = None if cases.branch.batch_shape else self.limits(slice(0, 1))

    def limits(self, part: slice) -> _Limits:
        """The limits of some cases' branches."""
        foot, branch = self.cases.foot, self.cases.branches(part)
        section = (x.astype(self.kind) for x in CrossSection.of(foot, branch))
        reach = np.atleast_1d(np.asarray(branch.radius)) + foot.radii[:, None]
        inside = np.maximum(reach - self.slack, 0) ** 2
        outside = (reach + self.slack) ** 2
        return _Limits(
            CrossSection(*section), inside.astype(self.kind), outside.astype(self.kind)
        )

    def met(self, part: slice) -> tuple[Booleans, Booleans]:
        """Whether some bone may touch the infinite branch, and whether one enters it.

        Args:
            part: Which n cases.

        Returns:
            Two masks, shape (n,): the first leaves nothing out, the second is certain.
        """
        limits = self.only or self.limits(part)
        squares = self._squares(self.cases.poses(part), limits.section)
        entered = squares < limits.inside
        near = squares <= limits.outside
        near &= ~entered
        return np.logical_or.reduce(near), np.logical_or.reduce(entered)

    def _squares(self, poses: Floats, section: CrossSection) -> Floats:
        """Squared distances of the bones from the axes [m²], shape (P, n)."""
        pitch = product(self.turns, poses.T.astype(self.kind))
        pitch += self.start
        along, down = (product(self.steps, turn(pitch)) for turn in (np.cos, np.sin))
        shape = (2, *pitch.shape)
        bones = section.seen(along.reshape(shape), down.reshape(shape))
        end, step = bones[:, 0], bones[:, 1]
        end -= section.centre
        # How far back from its end a bone is nearest to the axis, in bones.
        back, square = np.add.reduce(end * step), np.add.reduce(step * step)
        np.maximum(square, np.finfo(self.kind).tiny, out=square)
        back /= square
        np.minimum(np.maximum(back, 0, out=back), 1, out=back)
        step *= back
        end -= step
        end *= end
        squares: Floats = np.add.reduce(end)
        return squares
