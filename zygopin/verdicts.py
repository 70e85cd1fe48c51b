"""Verdicts for many poses and branches, without the evidence.

Most poses are settled by how far each bone is from the branch's axis, roughly. What
meets the branch, to the tolerance, is measured as `check_grasp` does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.blocks import as_threads, in_blocks
from zygopin.branch import Branch
from zygopin.cases import Cases
from zygopin.compiler import BATCHED, BatchName, has_compiler
from zygopin.foot import Foot
from zygopin.grasp import Booleans, Criteria, check_branch, check_grasp
from zygopin.kinematics import Controls, read_controls
from zygopin.sieve import Sieve

FEW = 16
"""Cases up to which a whole report costs no more than what saves the work on it."""

MEASURED = 1024
"""Cases in which all is measured at once: ten times the numbers of the sieve."""

LOOPED = 4096
"""Cases of compiled loops: threads seldom wait for each other between them."""


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
    engine: BatchName = "exact",
    criteria: Criteria | None = None,
    threads: int | None = None,
) -> GraspVerdicts:
    """The verdicts of `check_grasp` for many poses or branches: MODEL.md, section 5.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
        branch: A branch, or a batch that broadcasts against the controls'.
        engine: `fast`: in compiled loops, where Numba is installed; see `make_engine`.
        criteria: What counts as contact and as a grasp; None: the defaults.
        threads: How many work on a large batch; None: one for each core.

    Returns:
        The verdicts: those of the exact engine, for every entry.

    Raises:
        ParameterError: A control is outside [0, 1], shapes do not fit, the branch
            holds the foot's base, or that is no number of threads.
        UnknownNameError: There is no such engine, or it takes cases one by one.
    """
    kinds.instance("foot", foot, Foot)
    kinds.instance("branch", branch, Branch)
    kinds.one_of("engine", engine, BATCHED)
    criteria = kinds.optional("criteria", criteria, Criteria)
    threads = as_threads(threads)
    values = read_controls(foot, controls)
    check_branch(foot, branch)
    shapes = values.shape[:-1], branch.batch_shape
    batch = checks.common_batch("controls and branch", *shapes)
    if math.prod(batch) <= FEW:
        report = check_grasp(foot, values, branch, engine=engine, criteria=criteria)
        return GraspVerdicts(report.stable, report.grasping, report.feasible)
    cases = Cases(foot, values, branch, batch, criteria)
    compiled = engine == "fast" and has_compiler()
    found = (_by_loops if compiled else _by_arrays)(cases, threads)
    return GraspVerdicts(*found.reshape(3, *batch))


def _by_arrays(cases: Cases, threads: int | None) -> Booleans:
    """The verdicts by the sieve, and the exact engine for what it leaves, (3, N)."""
    touched, entered = _sifted(cases, threads)
    free = np.flatnonzero(~(touched | entered))
    if cases.branch.length is not None:
        touched |= entered  # what enters the infinite branch may pass by this one
    found = np.zeros((3, cases.count), dtype=bool)
    _check(cases, np.flatnonzero(touched), threads, found)

    def compare(part: slice) -> None:
        found[2, free[part]] = cases.apart(free[part])

    if len(free):
        in_blocks(compare, len(free), threads, size=MEASURED)
    return found


def _by_loops(cases: Cases, threads: int | None) -> Booleans:
    """The verdicts by compiled loops, and the exact engine for what they leave."""
    from zygopin.fast_verdicts import FastVerdicts  # with Numba

    fast = FastVerdicts(cases)
    found, left = np.zeros((3, cases.count), bool), np.zeros(cases.count, bool)

    def settle(part: slice) -> None:
        found[:, part], left[part] = fast.settled(part)

    in_blocks(settle, cases.count, threads, size=LOOPED)
    _check(cases, np.flatnonzero(left), threads, found)
    return found


def _check(
    cases: Cases, some: NDArray[np.intp], threads: int | None, found: Booleans
) -> None:
    """Write what the exact engine says of some cases."""

    def check(part: slice) -> None:
        found[:, some[part]] = cases.checked(some[part])

    if len(some):
        in_blocks(check, len(some), threads, size=MEASURED)


def _sifted(cases: Cases, threads: int | None) -> tuple[Booleans, Booleans]:
    """Which cases may touch the infinite branch, and which enter it for certain."""
    touched, entered = np.empty((2, cases.count), dtype=bool)
    sieve = Sieve(cases)

    def sift(part: slice) -> None:
        touched[part], entered[part] = sieve.met(part)

    in_blocks(sift, cases.count, threads)
    return touched, entered
