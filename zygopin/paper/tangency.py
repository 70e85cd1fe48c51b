"""The paper's tangency system (stable): solved, substituted back, and its misprints."""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_search import stable_branches
from zygopin.branch_solutions import BranchSolutions
from zygopin.foot import Foot
from zygopin.grasp import Criteria, check_grasp
from zygopin.paper.entry import (
    BY_HAND,
    EXACT,
    ROUNDING,
    Entry,
    Measurement,
    at_least,
    at_most,
    equal,
)
from zygopin.paper.finger_plane import (
    ITERATED,
    PAIR,
    PLACE,
    Floats,
    angle_modulo_pi,
    phalanx_lines,
)
from zygopin.paper.tangency_solver import Tangency, solve, tangent_lines_of
from zygopin.placement import Placement

LEVELS = 4
"""Equal levels of each control for which all stable branches are listed."""

CHANGE = 1e-3
"""Change of a radius that leaves no solution."""

RANDOM = 1000
"""Random poses and branches."""

SYSTEM = (
    r"$\phi(t)=\gamma(\theta)$, $\text{arg}\,\phi(t)=\text{arg}\,\dot\gamma(\theta)$, "
    r"$\omega\in[0,2\pi)$, $t\in[0,1]$"
)


@dataclass(frozen=True, eq=False)
class Solved:
    """All stable branches of a control set, and the system solved on them.

    Attributes:
        foot: The whole foot.
        found: The branches with the tangent phalanges of fingers 1 and 3.
        solved: Solutions of the system, shape (N, 2).
        slant: Angle between phalanx and γ̇ [rad], shape (N, 2).
        straight: Whether the toe is straight up to the phalanx, shape (N, 2).
    """

    foot: Foot
    found: BranchSolutions
    solved: Tangency
    slant: Floats
    straight: NDArray[np.bool_]


@lru_cache(1)
def solved_branches() -> Solved:
    """The stable branches of the paper's foot on which the system is solved.

    Returns:
        The record.
    """
    foot = Foot.preset("paper")
    found = stable_branches(foot, PAIR, LEVELS)
    lines = tangent_lines_of(found)
    solved = solve(foot, lines, found.height[:, None], found.radius[:, None])
    start, step = lines
    # Where the toe's start is in line with the phalanx, or the base itself.
    straight = np.abs((start * np.conj(step)).imag) <= EXACT
    return Solved(foot, found, solved, angle_modulo_pi(step, solved.tangent), straight)


def tangency_system() -> Entry:
    """The system as a test of tangency, both ways.

    Returns:
        The entry.
    """
    cases = solved_branches()
    return Entry(
        key="tangency-system",
        kind="statement",
        title="The tangency system",
        place=f"{PLACE}, system (3)",
        printed=SYSTEM,
        ours=(
            r"$\phi(t)=\gamma(\theta)$, "
            r"$\text{arg}(\phi(1)-\phi(0))=\text{arg}\,\dot\gamma(\theta)$ modulo "
            r"$\pi$, $\theta\in[0,2\pi)$, $t\in[0,1]$"
        ),
        finding=(
            "For branches with their axes at $x=0$ and the base outside, all "
            f"solutions for fingers 1 and 3 are listed, {LEVELS} levels of each "
            "control, by linear equations seen along the branch. A family, in which "
            "one parameter stays free, counts once, by one of its branches. On each "
            "of them the corrected system is solved in the finger's plane: "
            r"parallelism leaves two $\theta$, and incidence then one $t$. It has a "
            "solution wherever the exact engine and FCL find a tangency. Conversely, "
            "where a phalanx is not tangent, what is left of incidence is at least "
            "its distance from the bark, for it joins a point of the bone to a point "
            "of the bark, or two parallel lines."
        ),
        measurements=(*_solutions(cases), *_no_solutions(cases)),
    )


def _solutions(cases: Solved) -> tuple[Measurement, ...]:
    """Solutions where phalanges are tangent."""
    found, solved = cases.found, cases.solved
    angle = np.arctan2(*np.moveaxis(_normals(found), -1, 0)[[2, 0]])
    turned = np.abs(np.exp(1j * angle) - np.exp(1j * solved.angle))
    return (
        Measurement(
            "solutions",
            "solutions listed, a family once",
            float(len(found)),
        ),
        Measurement(
            "families", "families among them", float(np.count_nonzero(found.family))
        ),
        Measurement(
            "incidence",
            r"largest $|\phi(t)-\gamma(\theta)|$ on them",
            float(solved.misfit.max()),
            at_most(ITERATED, f"the slack on t, else {ROUNDING}"),
        ),
        Measurement(
            "parallelism",
            r"largest angle between phalanx and $\dot\gamma(\theta)$",
            float(cases.slant.max()),
            at_most(EXACT, ROUNDING),
            unit="rad",
        ),
        Measurement(
            "t",
            "largest difference of $t$ from that of the linear equations",
            float(np.abs(solved.t - found.t).max()),
            at_most(ITERATED, "equations seen along the branch"),
        ),
        Measurement(
            "theta",
            r"largest $|e^{i\theta}-n|$, $n$ the contact normal of the exact engine",
            float(turned.max()),
            at_most(ITERATED, "exact engine, in space"),
        ),
        Measurement(
            "clearance",
            "largest distance of these phalanges from the bark, exact engine",
            float(found.residual.max()),
            at_most(EXACT, ROUNDING),
        ),
        Measurement(
            "clearance_fcl",
            "the same by FCL",
            float(found.fcl_difference().max()),
            at_most(ITERATED, "FCL"),
        ),
    )


def _no_solutions(cases: Solved) -> tuple[Measurement, ...]:
    """No solutions where they are not."""
    misfit, tangent, clearance = _random_phalanges(cases.foot)
    return (
        Measurement(
            "changed_radius",
            f"least misfit on the same branches, their radii changed by ±{CHANGE:g}",
            _misfit_of_changed(cases),
            at_least(
                CHANGE - EXACT,
                f"the change: two parallel lines so far apart, {BY_HAND}",
            ),
        ),
        Measurement(
            "random_surplus",
            f"least of misfit less distance from the bark, {misfit.size} phalanges, "
            "random poses on random branches",
            float((misfit - np.abs(clearance)).min()),
            at_least(-EXACT, f"{BY_HAND}: never negative"),
        ),
        Measurement(
            "random_disagreements",
            "of them those that solve the system and are not tangent, or the reverse",
            float(np.count_nonzero((misfit <= ITERATED) != tangent)),
            equal(0.0, 0.0, "exact engine"),
        ),
    )


def _normals(found: BranchSolutions) -> Floats:
    """Contact normals by the exact engine, shape (N, 2, 3)."""
    report = check_grasp(found.foot, found.controls, found.branches)
    return np.take_along_axis(report.normal, _places(found)[..., None], axis=1)


def _places(found: BranchSolutions) -> NDArray[np.int64]:
    """Where the tangent phalanges stand among those of both fingers, shape (N, 2)."""
    starts = [part.start for part in found.foot.finger_slices.values()]
    return np.asarray(found.phalanx - 1 + starts)


def _misfit_of_changed(cases: Solved) -> float:
    """Least misfit of the solutions' phalanges after their radii have changed."""
    found, lines = cases.found, tangent_lines_of(cases.found)
    height = found.height[:, None]
    radii = (found.radius[:, None] + change for change in (CHANGE, -CHANGE))
    return min(
        float(solve(cases.foot, lines, height, radius).misfit.min()) for radius in radii
    )


def _random_phalanges(foot: Foot) -> tuple[Floats, NDArray[np.bool_], Floats]:
    """Misfit, tangency and clearance of fingers 1 and 3, shape (RANDOM, 6) each."""
    chance = np.random.default_rng(2)
    controls = chance.uniform(size=(RANDOM, foot.phalanx_count))
    radius = chance.uniform(0.05, 2.0, RANDOM)
    height = -radius * chance.uniform(1.0, 1.5, RANDOM)
    branch = Placement().branch(height, radius)
    criteria = Criteria(tolerance=ITERATED)
    report = check_grasp(foot, controls, branch, criteria=criteria)
    parts = [foot.finger_slices[finger] for finger in PAIR]
    misfit = [
        solve(
            foot,
            phalanx_lines(foot, finger, controls[:, part]),
            height[:, None],
            radius[:, None],
        ).misfit
        for finger, part in zip(PAIR, parts, strict=True)
    ]
    tangent = [report.tangent[:, part] for part in parts]
    clearance = [report.clearance[:, part] for part in parts]
    return np.hstack(misfit), np.hstack(tangent), np.hstack(clearance)
