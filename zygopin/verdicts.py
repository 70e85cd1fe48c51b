"""Verdicts for many poses and branches, without the evidence.

Most poses are settled by how far each bone is from the branch's axis. Only what meets
the branch, to the tolerance, goes through the full check; so the answers are its own.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from zygopin import checks
from zygopin.blocks import entries, in_blocks
from zygopin.branch import Branch
from zygopin.directions import Floats, directions, product, running_sum
from zygopin.foot import Foot
from zygopin.grasp import (
    Booleans,
    Criteria,
    check_branch,
    check_grasp,
    fingers_apart,
)
from zygopin.kinematics import Controls, as_azimuths, posed_bones, read_controls

ROUNDING = 1e-12
"""Rounding of a distance to the axis, over the size of what it is computed from; a
thousand times what was seen."""

TINY = 1e-300
"""Squared length of a bone's projection that stands for none: it divides safely."""


@dataclass(frozen=True, eq=False)
class GraspVerdicts:
    """What `check_grasp` says of poses on branches; `…` the batch.

    Attributes:
        stable: Two opposable fingers are tangent, shape (…).
        grasping: Stable, and the reading's scalar product is ≤ 0, shape (…).
        feasible: Nothing penetrates: neither the branch nor another finger.
    """

    stable: Booleans
    grasping: Booleans
    feasible: Booleans

    def __post_init__(self) -> None:
        checks.freeze(self)


def grasp_verdicts(
    foot: Foot,
    controls: Controls,
    branch: Branch,
    *,
    criteria: Criteria | None = None,
    threads: int | None = None,
) -> GraspVerdicts:
    """The verdicts of `check_grasp` for many poses or branches: MODEL.md, section 5.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
        branch: A branch, or a batch that broadcasts against the controls'.
        criteria: What counts as contact and as a grasp; None: the defaults.
        threads: How many work on a large batch; None: one for each core.

    Returns:
        The verdicts: those of the exact engine, for every entry.

    Raises:
        ParameterError: A control is outside [0, 1], shapes do not fit, the branch
            holds the foot's base, or that is no number of threads.
    """
    values = read_controls(foot, controls)
    check_branch(foot, branch)
    shapes = values.shape[:-1], branch.batch_shape
    batch = checks.common_batch("controls and branch", *shapes)
    sieve = _Sieve(foot, criteria or Criteria())
    found = np.zeros((3, int(np.prod(batch, dtype=int))), dtype=bool)
    only = None if branch.batch_shape else sieve.section(branch)

    def block(part: slice) -> None:
        poses = np.atleast_2d(entries(values, batch, part, 1))
        branches = branch.entries(batch, part)
        section = only or sieve.section(branches)
        sieve.verdicts(poses, branches, section, out=found[:, part])

    in_blocks(block, found.shape[1], threads)
    return GraspVerdicts(*found.reshape(3, *batch))


class _Section(NamedTuple):
    """Branches seen along their axes, for toes that stand upright: n of them, or 1.

    Attributes:
        across: Share of a toe's horizontal that goes across, shape (P, n).
        rise: Share of it that goes up, shape (P, n).
        level: Share of the vertical that goes up, shape (n,).
        centre: The axes, across and up [m], shape (2, n).
        inside: Squared distance below which a bone is too near, shape (P, n) [m²].
        outside: Squared distance above which it touches nothing, shape (P, n) [m²].
    """

    across: Floats
    rise: Floats
    level: Floats
    centre: Floats
    inside: Floats
    outside: Floats

    def projected(self, vectors: Floats) -> tuple[Floats, Floats]:
        """Vectors of the toes' planes, level and down, shape (2, P, n), across and up.

        Returns:
            Two arrays of shape (P, n).
        """
        along, down = vectors
        up = along * self.rise
        up -= down * self.level
        return along * self.across, up


class _Sieve:
    """Settles the clear cases of a block, and has the others checked in full."""

    def __init__(self, foot: Foot, criteria: Criteria) -> None:
        self.foot, self.criteria = foot, criteria
        self.tolerance = criteria.metres(foot)
        azimuth = as_azimuths(foot, None)[foot.finger_of_phalanx]
        self.toes = np.stack([np.cos(azimuth), np.sin(azimuth)], axis=-1)
        self.lengths = foot.lengths[:, None]
        self.sums = running_sum(foot) * foot.lengths

    def section(self, branch: Branch) -> _Section:
        """The section of a branch, or of a batch of shape (n,)."""
        x, y, z = np.atleast_2d(branch.axis).T
        level = np.hypot(x, y)
        upright = level == 0
        length = np.where(upright, 1.0, level)
        # Across the axis and level; then across both.
        first = np.array([np.where(upright, 1.0, -y / length), x / length])
        second = np.array([-z * first[1], z * first[0]])
        place = np.atleast_2d(branch.centre).T
        centre = np.array([first, second]) * place[:2]
        centre = centre.sum(axis=1) + [np.zeros_like(level), level] * place[2]
        radius = np.atleast_1d(np.asarray(branch.radius))
        reach = radius + self.foot.radii[:, None]
        size = radius + np.abs(place).sum(axis=0) + self.foot.size
        slack = self.tolerance + ROUNDING * size
        inside, outside = np.maximum(reach - slack, 0) ** 2, (reach + slack) ** 2
        across, rise = self.toes @ first, self.toes @ second
        wide = np.broadcast_shapes(across.shape, outside.shape)
        across, rise = np.broadcast_to(across, wide), np.broadcast_to(rise, wide)
        return _Section(across, rise, level, centre, inside, outside)

    def verdicts(
        self, poses: Floats, branch: Branch, section: _Section, out: Booleans
    ) -> None:
        """Enter stable, grasping, feasible, shape (3, n), for a block.

        Args:
            poses: Controls, shape (n, P), or (1, P) for all branches.
            branch: A branch, or n of them.
            section: Its, or their, section.
            out: Where the verdicts go; nothing but False before.
        """
        squares = self._squares(poses, section)
        entered = squares < section.inside
        touched = np.any((squares <= section.outside) & ~entered, axis=0)
        entered = np.any(entered, axis=0)
        free = ~(touched | entered)
        if branch.length is not None:
            touched |= entered  # what enters the infinite branch may pass by this one
        if free.any():
            alone = poses if len(poses) == 1 else poses[free]
            bones = posed_bones(self.foot, alone, threads=1)
            out[2, free] = fingers_apart(self.foot, bones, self.tolerance)
        if touched.any():
            some = poses if len(poses) == 1 else poses[touched]
            branches = branch[touched] if branch.batch_shape else branch
            report = check_grasp(self.foot, some, branches, criteria=self.criteria)
            out[:, touched] = report.stable, report.grasping, report.feasible

    def _squares(self, poses: Floats, section: _Section) -> Floats:
        """Squared distances of the bones from the axes [m²], shape (P, n)."""
        pointing = directions(self.foot, poses)
        ends = np.empty_like(pointing)
        for one, sums in zip(pointing, ends, strict=True):
            product(self.sums, one, out=sums)
        pointing *= self.lengths
        x, y = section.projected(ends)
        u, v = section.projected(pointing)
        x -= section.centre[0]
        y -= section.centre[1]
        along = x * u
        along += y * v
        square = u * u
        square += v * v
        np.maximum(square, TINY, out=square)
        # How far back from its end a bone is nearest, in bones.
        along /= square
        np.clip(along, 0, 1, out=along)
        u *= along
        v *= along
        x -= u
        y -= v
        x *= x
        y *= y
        x += y
        return x
