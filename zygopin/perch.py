"""Planner: from a branch to the controls with which the foot perches on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property, partial

import numpy as np

from zygopin import checks, kinds
from zygopin.branch import Branch
from zygopin.clearance import Floats
from zygopin.contacts import Friction
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.grasp import GraspReport, check_branch, check_grasp
from zygopin.perch_candidates import (
    Candidates,
    laid_candidates,
    search_candidates,
)
from zygopin.perch_column import Column
from zygopin.perch_combinations import Indices
from zygopin.perch_height import COARSE_LEVELS, column_heights
from zygopin.perch_proof import Existence, disproved
from zygopin.preference import SHORTLIST, Preference, preference_value
from zygopin.reason import MILLIMETRES, why_not
from zygopin.strength import Strength

LEVELS = 7
"""Angles tried at each joint beside the closing one."""

TRIED_RADII = (0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.9, 1.3)
"""Radii over the foot's size that are tried where the given one cannot be grasped,
the nearest first."""

BELOW = np.array([0.0, 0.0, -50.0])
"""A place for a branch whose height is still to be found, over the foot's size."""

MODE_SHARE = 3
"""Grasps that are compared for each set of tangent phalanges."""

PROVED = "no grasp with the toes' palms exists"
"""How the reason begins where that is proved."""

Value = Callable[[GraspReport], float]


@dataclass(frozen=True, eq=False)
class PerchPlan:
    """How the foot perches on a branch, or what is possible instead.

    Attributes:
        controls: The controls, shape (P,).
        branch: The branch; at the height found, where none was given.
        report: The exact engine's verdicts on these controls.
        wrap: How far around the branch each finger's last tangent phalanx lies
            from the base's nearest line [rad], shape (F,); −∞ without one.
        searched: Whether the height was searched for.
        column: The heights that a proof is about; None where none was asked for.
    """

    controls: Floats
    branch: Branch
    report: GraspReport
    wrap: Floats
    searched: bool
    column: Column | None = field(default=None, repr=False)

    def __post_init__(self) -> None:
        self.wrap.setflags(write=False)

    @property
    def grasping(self) -> bool:
        """Whether the plan is a grasp that enters neither branch nor finger."""
        return why_not(self.report) is None

    @cached_property
    def existence(self) -> Existence:
        """Whether the branch can be grasped at all: found, none (proved), undecided.

        Proofs are about the toes' palms, the sides to which they flex: `NONE` says
        nothing of grasps with a toe's back. They hold for contacts within the report's
        tolerance. They are looked for when this is first asked for, which takes some
        seconds at most. Where the height was searched for, `NONE` is said of the
        heights of `column` alone. A branch with an end in reach of the toes stays
        undecided.
        """
        if self.grasping:
            return Existence.FOUND
        if self.column is None or not disproved(self.column).all():
            return Existence.UNDECIDED
        return Existence.NONE

    @cached_property
    def reason(self) -> str | None:
        """Why this is no feasible grasp, in one line; None where it is one.

        It begins with `PROVED` where that is proved. Looked for when it is first asked
        for: the proof takes time, and a remedy many more plans.
        """
        fact = why_not(self.report)
        if fact is None:
            return None
        text = f"{fact}: {_advice(self.report, searched=self.searched)}"
        if self.existence is not Existence.NONE:
            return text
        if self.column is None or not self.searched:
            return f"{PROVED}: {text}"
        return f"{PROVED} at {len(self.column.heights)} heights tried: {text}"


def plan_perch(
    foot: Foot,
    branch: Branch,
    *,
    find_height: bool = False,
    levels: int = LEVELS,
    prefer: Preference = "wrap",
    strength: Strength | None = None,
) -> PerchPlan:
    """Controls that perch on a branch, wrapped as far as they can be.

    Each finger's poses that touch without entering the branch are found by closing
    its joints one after another (MODEL.md, section 4, "Conforming wrap"); the
    combination is chosen that grasps with most toes and keeps fingers apart. The
    search over the joints before a contact is a grid. Where it finds no grasp, toes
    are laid on the branch by the search behind the atlas, as far round as they can be;
    where that finds none either, the plan's `existence` looks for the proof that there
    is none. What is found is checked exactly.

    Args:
        foot: The foot.
        branch: One branch, of any pose.
        find_height: Also move the branch along z to where it is grasped best. No grasp
            is then said of some heights over the range that is searched.
        levels: Angles tried at each joint, 2 to 33; the work grows as levels^K, so
            that fingers of many phalanges get fewer.
        prefer: What the best grasp has most of: `wrap`; `quality`, Ferrari and
            Canny's; `pull`, the force away from the branch that it bears; `margin`, the
            flexion that its most closed joint has left (`flexion_left`); or
            `opposition`, the least scalar product of contact normals. All but the
            first are compared over a shortlist of the grasps found.
        strength: How hard toes press, for `quality` and `pull`; None: 1 N at friction
            0.5.

    Returns:
        The best plan; its `reason` says why where it is no feasible grasp, and its
        `existence` whether there is none.

    Raises:
        ParameterError: A batch of branches, one that holds the foot's base, a vertical
            branch whose height is to be found, or levels out of range.
        UnknownNameError: There is no such preference.
    """
    value = _value(prefer, strength)
    found, column = _candidates(foot, branch, find_height, levels)
    rows = _spread(found.grasping, SHORTLIST[prefer])
    row, report = _best(found, rows, value)
    return _plan(found, row, report, searched=find_height, column=column)


def search_perch(
    foot: Foot, branch: Branch, *, find_height: bool = False, levels: int = LEVELS
) -> PerchPlan:
    """What the grid search of `plan_perch` finds, without its further work.

    For thousands of plans of which only the grasps count: where it finds none, the
    tangent search is not tried, and `existence` stays undecided.

    Args:
        foot: The foot.
        branch: One branch, of any pose.
        find_height: As for `plan_perch`.
        levels: As for `plan_perch`.

    Returns:
        The plan.

    Raises:
        ParameterError: As for `plan_perch`.
    """
    checks.flag("find_height", find_height)
    levels = _checked(foot, branch, levels)
    found = search_candidates(foot, branch, levels, find_height=find_height)
    row, report = _best(found, np.zeros(1, dtype=np.intp), lambda _: 0.0)
    return _plan(found, row, report, searched=find_height, column=None)


def perch_solutions(
    foot: Foot,
    branch: Branch,
    *,
    find_height: bool = False,
    levels: int = LEVELS,
    prefer: Preference = "wrap",
    strength: Strength | None = None,
) -> tuple[PerchPlan, ...]:
    """The distinct ways to grasp a branch that are found, the best first.

    Two grasps are alike where the same phalanges are tangent: for each such set the
    best grasp is given. These are the sets among the combinations that the search
    keeps: all are grasps, but there may be other sets. What is complete, wherever
    `plan_perch` is not undecided, is whether there is any.

    Args:
        foot: The foot.
        branch: One branch, of any pose.
        find_height: Also move the branch along z, to one place for all.
        levels: As for `plan_perch`.
        prefer: What the best grasp has most of, and what the grasps are sorted by.
        strength: As for `plan_perch`.

    Returns:
        A plan for each set of tangent phalanges; none without a grasp.

    Raises:
        ParameterError: As for `plan_perch`.
        UnknownNameError: There is no such preference.
    """
    value = _value(prefer, strength)
    found, _ = _candidates(foot, branch, find_height, levels)
    most = min(SHORTLIST[prefer], MODE_SHARE)
    plans = []
    for rows in found.modes():
        row, report = _best(found, rows[:most], value)
        plan = _plan(found, row, report, searched=find_height, column=None)
        if plan.grasping:
            plans.append((value(report), -row, plan))
    plans.sort(key=lambda each: each[:2], reverse=True)
    return tuple(plan for _, _, plan in plans)


def _value(prefer: Preference, strength: Strength | None) -> Value:
    """What a report is worth to those who prefer it so."""
    if strength is not None:
        kinds.instance("strength", strength, Strength)
    kinds.one_of("preference", prefer, SHORTLIST)
    return partial(preference_value, prefer, strength or Strength(1.0, Friction()))


def _checked(foot: Foot, branch: Branch, levels: int) -> int:
    """The number of levels, once all is known to be in order."""
    kinds.instance("foot", foot, Foot)
    kinds.instance("branch", branch, Branch)
    if branch.batch_shape:
        remedy = "plan for one branch at a time"
        raise ParameterError("branch batch", branch.batch_shape, "()", remedy)
    levels = checks.integer("levels", levels, 2, 33)
    check_branch(foot, branch)
    return levels


def _candidates(
    foot: Foot, branch: Branch, find_height: bool, levels: int
) -> tuple[Candidates, Column | None]:
    """Poses of the foot; without a grasp among them the heights where none is found."""
    checks.flag("find_height", find_height)
    levels = _checked(foot, branch, levels)
    found = search_candidates(foot, branch, levels, find_height=find_height)
    if len(found.grasping):
        return found, None
    heights = found.branch.centre[2:]
    if find_height:
        column = column_heights(foot, branch)
        heights = np.unique(np.concatenate([column, heights]))[::-1]
    there = Column(foot, branch, heights)
    laid = laid_candidates(there, found, COARSE_LEVELS)
    return (found, there) if laid is None else (laid, None)


def _spread(rows: Indices, most: int) -> Indices:
    """So many of the grasps, evenly spread; the first of all without one."""
    if not len(rows):
        return np.zeros(1, dtype=np.intp)
    places = np.linspace(0, len(rows) - 1, min(most, len(rows)))
    return rows[places.astype(np.intp)]


def _best(found: Candidates, rows: Indices, value: Value) -> tuple[int, GraspReport]:
    """The best of some candidates, the first of equals, and its verdicts."""
    controls = found.controls(rows)
    reports = [check_grasp(found.foot, each, found.branch) for each in controls]
    values = [value(report) for report in reports] if len(reports) > 1 else [0.0]
    best = int(np.argmax(values))
    return int(rows[best]), reports[best]


def _plan(
    found: Candidates,
    row: int,
    report: GraspReport,
    *,
    searched: bool,
    column: Column | None,
) -> PerchPlan:
    """The plan of one of the candidates."""
    wrap = found.wrap(row)
    return PerchPlan(report.controls, found.branch, report, wrap, searched, column)


def _advice(report: GraspReport, *, searched: bool) -> str:
    """What would help, for each of the reasons and in their order."""
    if report.penetrating.any():
        return "move the branch down or away from the base"
    if not report.feasible:
        return "take more splay, a thinner skin or another branch"
    if not report.foot.opposable_pairs:
        return "give the foot a finger that points forward and one that points back"
    if not report.stable and not searched:
        return "move the branch under the foot, nearer to the base"
    if not report.touching.any():
        return "take a larger foot, or a longer or less steep branch"
    return _better_branch(report)


def _better_branch(report: GraspReport) -> str:
    """A radius that the foot can grasp in the branch's direction, by trying some."""
    foot, radius = report.foot, float(report.branch.radius)
    tried = sorted(TRIED_RADII, key=lambda x: abs(math.log(x * foot.size / radius)))
    for share in tried:
        branch = Branch(share * foot.size, BELOW * foot.size, report.branch.axis)
        if search_perch(foot, branch, find_height=True, levels=COARSE_LEVELS).grasping:
            kind = "thinner" if share * foot.size < radius else "thicker"
            example = share * foot.size * MILLIMETRES
            return f"take a {kind} branch, such as one of radius {example:.3g} mm"
    return "take a branch across the foot, or a foot whose joints close further"
