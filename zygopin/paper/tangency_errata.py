"""Two misprints of the paper's tangency system: an argument, and a range."""

from __future__ import annotations

import math

import numpy as np

from zygopin.foot import Foot
from zygopin.paper.entry import (
    BY_HAND,
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
    widths,
)
from zygopin.paper.grasp_cases import perch
from zygopin.paper.tangency import LEVELS, solved_branches
from zygopin.paper.tangency_solver import fitted, solve, tangent_lines_of
from zygopin.resting import resting_branches


def erratum_6() -> Entry:
    """Parallelism by the argument of a position.

    Returns:
        The entry.
    """
    cases = solved_branches()
    printed = angle_modulo_pi(cases.solved.place, cases.solved.tangent)
    bent = ~cases.straight
    _, step = tangent_lines_of(cases.found)
    against = (step * np.conj(cases.solved.tangent)).real < 0
    return Entry(
        key="erratum-6",
        kind="erratum",
        title="Parallelism is of the phalanx, not of its point",
        place=f"{PLACE}, system (3)",
        printed=r"$\text{arg}(\phi(t;(v_k),k))=\text{arg}(\dot\gamma(\theta))$",
        ours=(
            r"$\text{arg}(\phi(1)-\phi(0))=\text{arg}\,\dot\gamma(\theta)$ modulo $\pi$"
        ),
        finding=(
            r"$\phi(t)$ is a position; its argument is the direction from the base to "
            "the contact, which is the phalanx's own only where the toe is straight up "
            "to there. The toe bends one way and by less than a half turn in all, so "
            "elsewhere the two differ: no tangent phalanx beyond a bend satisfies the "
            "printed condition. On a branch under the base and a finger that crosses "
            "it squarely, tangent and chord of a circle differ by half the angle "
            "between the tangents. And since $\\dot\\gamma$ goes one way around the "
            "branch, phalanges of opposed toes are parallel to it modulo $\\pi$ alone."
        ),
        measurements=(
            Measurement(
                "bent",
                "tangent phalanges after a bend, on the branches of the system's entry",
                float(np.count_nonzero(bent)),
            ),
            Measurement(
                "least",
                r"least angle of $\phi(t)$ and $\dot\gamma(\theta)$ on them",
                float(printed[bent].min()),
                at_least(math.radians(0.1), "zero would satisfy the printed condition"),
                unit="rad",
            ),
            Measurement(
                "median", "median", float(np.median(printed[bent])), unit="rad"
            ),
            Measurement("largest", "largest", float(printed[bent].max()), unit="rad"),
            Measurement(
                "opposite",
                r"tangent phalanges that point against $\dot\gamma$, of "
                f"{cases.slant.size}",
                float(np.count_nonzero(against)),
                at_least(1.0, "why the arguments are compared modulo π"),
            ),
            *_worked_angles(),
        ),
    )


def _worked_angles() -> tuple[Measurement, ...]:
    """Angles of the printed condition that can be worked by hand."""
    case = perch()
    foot, part = case.foot, case.foot.finger_slices[PAIR[1]]
    lines = phalanx_lines(foot, PAIR[1], case.controls[part])
    second = solve(
        foot,
        (lines[0][1], lines[1][1]),
        float(case.branch.centre[2]),
        float(case.branch.radius),
    )
    chords, turns = _chord_angles()
    return (
        Measurement(
            "one_case",
            r"the angle for controls 1, second phalanx of finger 3, $t=\frac12$",
            float(angle_modulo_pi(second.place, second.tangent)),
            equal(
                math.atan2(
                    math.sin(foot.omega), math.cos(foot.omega) + 1 / (2 * foot.rho)
                ),
                ITERATED,
                f"tan = sin ω/(cos ω + 1/(2ρ)), {BY_HAND}",
            ),
            unit="rad",
        ),
        Measurement(
            "chords",
            r"$\Omega=0$, branches under the base: largest difference of the angle "
            r"from $\omega(v_1+\dots+v_k)/2$",
            float(np.abs(chords - turns / 2).max()),
            at_most(ITERATED, f"angle of tangent and chord, {BY_HAND}"),
            unit="rad",
        ),
    )


def erratum_7() -> Entry:
    """The range that the system gives to ω is that of θ.

    Returns:
        The entry.
    """
    cases = solved_branches()
    solved, radius = cases.solved, cases.found.radius[:, None]
    opposite = fitted(
        tangent_lines_of(cases.found),
        solved.angle + math.pi,
        cases.found.height[:, None],
        radius,
        widths(cases.foot)["true"],
    )
    return Entry(
        key="erratum-7",
        kind="erratum",
        title="The range of θ",
        place=f"{PLACE}, system (3)",
        printed=r"$\omega\in[0,2\pi)$",
        ours=r"$\theta\in[0,2\pi)$",
        finding=(
            r"$\omega$ is a parameter of the foot, here $\pi/6$; the unknown that "
            r"needs a range is $\theta$. It needs a whole turn: some contacts are on "
            r"the lower half of the branch. The tangents at $\theta$ and $\theta+\pi$ "
            "are parallel, and the phalanx reaches only one of them, so that there is "
            r"one $\theta$ in the range for each tangent phalanx."
        ),
        measurements=(
            Measurement(
                "least",
                r"least $\theta$ of the solutions",
                float(solved.angle.min()),
                unit="rad",
            ),
            Measurement(
                "largest",
                r"largest $\theta$ of the solutions",
                float(solved.angle.max()),
                unit="rad",
            ),
            Measurement(
                "lower_half",
                rf"contacts with $\theta>\pi$, of {solved.angle.size}",
                float(np.count_nonzero(solved.angle > math.pi + ITERATED)),
                at_least(1.0, "a half turn would miss them"),
            ),
            Measurement(
                "opposite",
                r"least misfit at $\theta+\pi$ over the branch's diameter",
                float((opposite.misfit / (2 * radius)).min()),
                at_least(1 - ITERATED, f"parallel tangents so far apart, {BY_HAND}"),
            ),
        ),
    )


def _chord_angles() -> tuple[Floats, Floats]:
    """The printed condition's angle and the toe's turn, branches under the base, Ω = 0.

    Of contacts on the palm's side, away from the base.
    """
    foot = Foot.preset("paper").replace(splay=0.0)
    found = resting_branches(foot, PAIR, LEVELS)
    lines = tangent_lines_of(found)
    solved = solve(foot, lines, found.height[:, None], found.radius[:, None])
    step = lines[1]
    ahead = np.stack([-np.conj(step[:, 0]), step[:, 1]], axis=1)
    kept = (found.side == 1) & (np.abs(solved.place) > ITERATED)
    angle = angle_modulo_pi(solved.place, solved.tangent)
    return angle[kept], -np.angle(ahead[kept])
