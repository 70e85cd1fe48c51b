"""Verdicts for many poses and branches, without the evidence.

Most poses are settled by how far each bone is from the branch's axis, roughly. What
meets the branch, to the tolerance, is measured as `check_grasp` does.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from zygopin import checks, kinds
from zygopin.blocks import Part, as_threads, entries, in_blocks
from zygopin.bones import posed_bones
from zygopin.branch import Branch
from zygopin.clearance import branch_clearance
from zygopin.contact_products import least_products
from zygopin.cross_section import CrossSection
from zygopin.directions import Floats, pitch_matrix, product, running_sum
from zygopin.foot import Foot
from zygopin.grasp import (
    PARAMETER_SLACK,
    Booleans,
    Criteria,
    base_to_tip,
    check_branch,
    classify,
    fingers_apart,
)
from zygopin.kinematics import Controls, read_controls

ROUNDING = 16
"""Rounding of a distance to the axis, in units of the last place of the lengths it is
computed from, beside one unit for each radian of pitch; four times what was seen."""

BROAD = 1e-3
"""Rounding, over the foot's size, that would leave too much to the full check: single
precision, which takes half the time, is used below."""


FEW = 16
"""Cases up to which the sieve costs more than it saves."""

MEASURED = 1024
"""Cases in which all is measured at once: ten times the numbers of the sieve."""


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
    kinds.instance("foot", foot, Foot)
    kinds.instance("branch", branch, Branch)
    criteria = kinds.optional("criteria", criteria, Criteria)
    threads = as_threads(threads)
    values = read_controls(foot, controls)
    check_branch(foot, branch)
    shapes = values.shape[:-1], branch.batch_shape
    batch = checks.common_batch("controls and branch", *shapes)
    count = int(np.prod(batch, dtype=int))
    cases = _Cases(foot, values, branch, batch, criteria)
    touched, entered = _sifted(cases, count, threads)
    free = np.flatnonzero(~(touched | entered))
    if branch.length is not None:
        touched |= entered  # what enters the infinite branch may pass by this one
    met = np.flatnonzero(touched)
    found = np.zeros((3, count), dtype=bool)

    def check(part: slice) -> None:
        found[:, met[part]] = cases.checked(met[part])

    def compare(part: slice) -> None:
        found[2, free[part]] = cases.apart(free[part])

    for settle, some in ((check, met), (compare, free)):
        if len(some):
            in_blocks(settle, len(some), threads, size=MEASURED)
    return GraspVerdicts(*found.reshape(3, *batch))


def _sifted(
    cases: _Cases, count: int, threads: int | None
) -> tuple[Booleans, Booleans]:
    """Which cases may touch the infinite branch, and which enter it for certain."""
    touched, entered = np.ones(count, dtype=bool), np.zeros(count, dtype=bool)
    if count > FEW:
        sieve = _Sieve(cases)

        def sift(part: slice) -> None:
            touched[part], entered[part] = sieve.met(part)

        in_blocks(sift, count, threads)
    return touched, entered


@dataclass(frozen=True, eq=False)
class _Cases:
    """Poses on branches, a flat batch of them.

    Attributes:
        foot: The foot.
        controls: Checked controls, shape (…, P).
        branch: The branches, which leave the base outside.
        batch: Shape of the batch.
        criteria: What counts as contact and as a grasp.
    """

    foot: Foot
    controls: Floats
    branch: Branch
    batch: tuple[int, ...]
    criteria: Criteria

    def poses(self, part: Part) -> Floats:
        """Controls of some cases, shape (n, P), or (1, P) where all have the same."""
        return np.atleast_2d(entries(self.controls, self.batch, part, 1))

    def checked(self, part: Part) -> Booleans:
        """Stable, grasping, feasible of some cases, shape (3, n): all is measured."""
        foot, tolerance = self.foot, self.criteria.metres(self.foot)
        bones = posed_bones(foot, self.poses(part), threads=1)
        branch = self.branch.entries(self.batch, part)
        near = branch_clearance(bones, foot.radii, branch)
        contacts = classify(near, tolerance)
        vectors = near.normal
        if self.criteria.reading == "base_to_tip":
            vectors = base_to_tip(bones)
        (least,) = least_products(foot, contacts.tangent, vectors)
        entered = contacts.penetrating.any(axis=-1)
        free = ~entered & fingers_apart(foot, bones, tolerance)
        return np.array([np.isfinite(least), least <= PARAMETER_SLACK, free])

    def apart(self, part: Part) -> Booleans:
        """Whether no two fingers collide, shape (n,) or (1,)."""
        bones = posed_bones(self.foot, self.poses(part), threads=1)
        return fingers_apart(self.foot, bones, self.criteria.metres(self.foot))


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


class _Sieve:
    """Tells which bones are clearly within a branch, and which clearly outside."""

    def __init__(self, cases: _Cases) -> None:
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
        foot, branch = self.cases.foot, self.cases.branch
        branch = branch.entries(self.cases.batch, part)
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
