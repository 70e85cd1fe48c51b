"""Routes to grasps: the planner, FCL, other searches, and grasps that were planted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from differ.clearances import sure
from differ.comparison import Comparison, same
from differ.draw import Draw, Size
from differ.route import Route
from differ.tangencies import SHORT
from zygopin import (
    Branch,
    Existence,
    GraspReport,
    PerchPlan,
    check_grasp,
    plan_perch,
    search_perch,
)
from zygopin.contact_products import least_products
from zygopin.grasp import PARAMETER_SLACK
from zygopin.witnesses import palmar

MOST_LEVELS = 9
"""Most angles that the other search tries at each joint."""


def against_engines(drawn: Draw) -> Sequence[Comparison]:
    """The planner on one branch: its yes by FCL, its no against a grasp or a search."""
    branch, planted = _branch(drawn)
    drawn.beyond.update(branch=branch, planted=planted)
    plan = plan_perch(drawn.foot, branch)
    said = np.array([plan.existence is not Existence.NONE])
    decided = np.array([plan.existence is not Existence.UNDECIDED])
    found = [same("grasping / FCL", *_by_fcl(plan))] if plan.grasping else []
    known = planted or (not said[0] and _searched(drawn, branch))
    return (*found, same("a grasp exists / is denied", said, said | known, decided))


def _branch(drawn: Draw) -> tuple[Branch, bool]:
    """A branch, and whether one of the poses drawn grasps it: every other time."""
    report = check_grasp(drawn.foot, drawn.controls, drawn.branch)
    grasped = np.flatnonzero(with_palms(report) & report.feasible)
    if len(grasped) and drawn.rng.random() < 0.5:
        return drawn.branch[int(grasped[0])], True
    return drawn.branch[int(drawn.rng.integers(len(drawn.controls)))], False


def with_palms(report: GraspReport) -> np.ndarray:
    """Grasps with the toes' palms, which is what proofs are about, shape (…)."""
    tangent = report.tangent & palmar(report)
    (product,) = least_products(report.foot, tangent, report.normal)
    return np.asarray(np.nan_to_num(product, nan=1.0) <= PARAMETER_SLACK)


def _by_fcl(plan: PerchPlan) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The plan's verdicts, FCL's, and whether they are decided, shape (1, 2)."""
    report = plan.report
    other = check_grasp(report.foot, report.controls, report.branch, engine="fcl")
    verdicts = [
        [(bool(each.grasping), bool(each.feasible))] for each in (report, other)
    ]
    return np.array(verdicts[0]), np.array(verdicts[1]), np.array([sure(report)])


def _searched(drawn: Draw, branch: Branch) -> bool:
    """Whether the grid search finds a grasp with the palms, at other angles."""
    levels = int(drawn.rng.integers(2, MOST_LEVELS + 1))
    plan = search_perch(drawn.foot, branch, levels=levels)
    return plan.grasping and bool(with_palms(plan.report))


ROUTES = (
    Route(
        "planner",
        "plan_perch: yes / FCL; no / grasps by random poses, another grid",
        "verdicts alike; `undecided` is told as such",
        against_engines,
        Size(poses=3000, fingers=4, phalanges=4, opposed=True),
        SHORT,
        posed=False,
    ),
)
"""Routes to grasps."""
