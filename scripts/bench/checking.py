"""The job of checks: what is asked, what counts as an answer, what counts as right."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from bench.peer import WrongAnswerError, check
from bench.posing import Posing
from zygopin import Branch, Criteria, Foot, GraspVerdicts, check_grasp
from zygopin.clearance import Floats
from zygopin.grasp import PARAMETER_SLACK, GraspReport

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]

EDGE = 1e-6
"""How near t may be to a bone's end, or a scalar product to zero, for a verdict to be
held against another's: beyond, rounding or a tool's tolerance decides."""


@dataclass(frozen=True)
class Checking:
    """The job: verdicts on many control sequences, or on many branches.

    Attributes:
        foot: The foot.
        controls: The controls, shape (N, P); for many branches (P,).
        branch: One branch, or a batch of N.
    """

    foot: Foot
    controls: Floats
    branch: Branch

    @cached_property
    def posing(self) -> Posing:
        """Its forward kinematics alone."""
        return Posing(self.foot, np.atleast_2d(self.controls))

    @cached_property
    def right(self) -> GraspReport:
        """What zygopin answers, with its evidence."""
        return check_grasp(self.foot, self.controls, self.branch)

    @property
    def tolerance(self) -> float:
        """The contact tolerance [m]."""
        return Criteria().metres(self.foot)

    @property
    def count(self) -> int:
        """Number of verdicts."""
        return len(self.controls) if self.controls.ndim > 1 else self.branches

    @property
    def branches(self) -> int:
        """Number of branches."""
        return int(np.prod(self.branch.batch_shape, dtype=int))

    @cached_property
    def sections(self) -> tuple[Floats, Floats]:
        """Centres (n, 1, 3) of the n branches, and planes across them (n, 3, 2)."""
        axis = np.atleast_2d(self.branch.axis)
        aside = np.cross(axis, (1.0, 0.0, 0.0))  # no branch lies along x
        aside /= np.linalg.norm(aside, axis=1, keepdims=True)
        across = np.stack([aside, np.cross(axis, aside)], axis=2)
        return np.atleast_2d(self.branch.centre)[:, None], across

    @cached_property
    def opposed(self) -> tuple[Indices, Indices]:
        """Pairs of phalanges of opposable fingers."""
        finger = self.foot.finger_of_phalanx
        pairs = np.zeros((len(finger),) * 2, dtype=bool)
        for one, other in self.foot.opposable_pairs:
            pairs |= (finger[:, None] == one) & (finger == other)
        i, j = np.nonzero(pairs)
        return i, j

    def few(self, count: int) -> Checking:
        """The first so many of them."""
        if self.controls.ndim > 1:
            return Checking(self.foot, self.controls[:count], self.branch)
        return Checking(self.foot, self.controls, self.branch[:count])

    def settled(self, band: float) -> Booleans:
        """Verdicts that no error of a clearance within the band can turn.

        Args:
            band: Largest error of a clearance [m].

        Returns:
            Mask of the verdicts that must be the same.
        """
        report = self.right
        sure = np.abs(np.abs(report.clearance) - self.tolerance) > band
        ends = np.minimum(np.abs(report.t), np.abs(report.t - 1))
        sure &= ~report.touching | (ends > EDGE)
        # NaN, where no two toes touch, is sure.
        return np.asarray(sure.all(axis=-1) & ~(np.abs(report.scalar_product) <= EDGE))


@dataclass(frozen=True)
class Answer:
    """What a tool makes of a job, as far as it answers.

    Attributes:
        clear: No phalanx penetrates the branch.
        clearance: Clearances [m], shape (N, P).
        stable: Two opposable fingers are tangent.
        grasping: Stable, and the contacts are a quarter turn apart at least.
        feasible: Clear, and fingers do not collide either.
    """

    clear: Booleans | None = None
    clearance: Floats | None = None
    stable: Booleans | None = None
    grasping: Booleans | None = None
    feasible: Booleans | None = None

    def with_fingers(self, apart: Booleans) -> Answer:
        """The same, knowing where the fingers do not collide."""
        assert self.clear is not None  # noqa: S101
        return replace(self, feasible=self.clear & apart)


def decided(job: Checking, junctions: Floats, clearance: Floats) -> Answer:
    """Verdicts from a tool's junctions and clearances, the cheap way.

    Only where two phalanges touch does anything but the clearances matter.

    Args:
        job: The job.
        junctions: The tool's junctions [m], shape (N, P + F, 3), or of one pose.
        clearance: The tool's clearances [m], shape (N, P).

    Returns:
        The answer without `feasible`.
    """
    stable, grasping = np.zeros((2, len(clearance)), dtype=bool)
    touching = np.abs(clearance) <= job.tolerance
    (rows,) = np.nonzero(touching.sum(axis=1) > 1)
    if len(rows):
        some = junctions[rows] if len(junctions) > 1 else junctions
        product = _products(job, job.posing.bones(some), touching[rows], rows)
        stable[rows] = np.isfinite(product)
        grasping[rows] = product <= PARAMETER_SLACK
    clear = np.asarray((clearance >= -job.tolerance).all(axis=1))
    return Answer(clear, clearance, stable, grasping)


def _products(
    job: Checking, bones: Floats, touching: Booleans, rows: Indices
) -> Floats:
    """Least products of contact normals of opposable fingers; infinite without.

    Seen along the branch, where a normal points from its centre to the nearest point.
    """
    centre, across = job.sections
    if len(centre) > 1:
        centre, across = centre[rows], across[rows]
    seen = (bones.reshape(len(bones), -1, 3) - centre) @ across
    start, end = np.moveaxis(seen.reshape(*bones.shape[:3], 2), 2, 0)
    line = end - start
    t = -(start * line).sum(axis=-1) / (line * line).sum(axis=-1)
    normal = start + t[..., None] * line
    normal /= np.sqrt((normal * normal).sum(axis=-1))[..., None]
    tangent = touching & (np.abs(t - 0.5) <= 0.5 + PARAMETER_SLACK)
    i, j = job.opposed
    products = (normal[:, i] * normal[:, j]).sum(axis=-1)
    both = tangent[:, i] & tangent[:, j]
    return np.asarray(np.where(both, products, np.inf).min(axis=-1))


def compare(name: str, job: Checking, answer: Answer, tolerance: float) -> int:
    """Hold a tool's answer against zygopin's, all that it answers.

    Args:
        name: The tool.
        job: The job.
        answer: Its answer.
        tolerance: Difference of clearances that is allowed, over the foot's size.

    Returns:
        How many verdicts lie in the tolerance band, and were not compared.

    Raises:
        WrongAnswerError: A clearance is off by more, or a verdict outside the band.
    """
    band, right = tolerance * job.foot.size, job.right
    sure = job.settled(band)
    if answer.clearance is not None:
        apart = np.abs(answer.clearance - right.clearance).max() / job.foot.size
        check(name, float(apart), tolerance)
    wanted = {
        "clear": ~right.penetrating.any(axis=-1),
        "stable": right.stable,
        "grasping": right.grasping,
        "feasible": right.feasible,
    }
    for verdict, mine in wanted.items():
        given = getattr(answer, verdict)
        wrong = 0 if given is None else int(((given != mine) & sure).sum())
        if wrong:
            raise WrongAnswerError(name, f"differs in {wrong} verdicts on {verdict}")
    return int((~sure).sum())


def of_verdicts(found: GraspReport | GraspVerdicts) -> Answer:
    """Zygopin's own verdicts as an answer."""
    return Answer(stable=found.stable, grasping=found.grasping, feasible=found.feasible)
