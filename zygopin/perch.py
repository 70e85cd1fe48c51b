"""Planner: from a branch to the controls with which the foot perches on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property, partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.branch import Branch
from zygopin.clearance import Floats, segment_distance
from zygopin.closure import closure_quality
from zygopin.contacts import Friction, branch_contacts
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Foot
from zygopin.grasp import (
    PARAMETER_SLACK,
    Criteria,
    GraspReport,
    check_branch,
    check_grasp,
)
from zygopin.load import pull_limit
from zygopin.reason import MILLIMETRES, why_not
from zygopin.strength import Strength
from zygopin.wrap import FingerPoses, finger_poses

LEVELS = 7
"""Angles tried at each joint beside the closing one."""

COARSE_LEVELS = 4
"""The same while heights are compared."""

HEIGHTS = 17
"""Heights compared in one round."""

DEEPEST = 0.6
"""Deepest gap between base and bark that is tried, over the foot's size."""

BEAM = 4000
"""Combinations of fingers' poses kept while fingers are added one by one."""

ROUNDS = 2
"""Rounds of the search for a height, the second around the best of the first."""

VERTICAL = 1e-6
"""Squared sine of the slope to the vertical below which a branch has no height."""

PENALTY, GRASP, TOE, TOUCH, CONTACT, NEAR = 1e6, 1e4, 1e3, 1e2, 0.3, 1e-3
"""Ranks of what a combination is worth: nothing that collides, then a grasp, then
toes that are tangent, then toes that touch, then wrap, then how near a toe comes
that does not touch. A tangent phalanx is worth CONTACT radians of wrap: toes conform
to the branch rather than reach on past it."""

TRIED_RADII = (0.1, 0.15, 0.2, 0.3, 0.4, 0.6, 0.9, 1.3)
"""Radii over the foot's size that are tried where the given one cannot be grasped,
the nearest first."""

BELOW = np.array([0.0, 0.0, -50.0])
"""A place for a branch whose height is still to be found, over the foot's size."""

Preference = Literal["wrap", "quality", "pull"]

SHORTLIST: dict[str, int] = {"wrap": 1, "quality": 24, "pull": 96}
"""How many grasps are compared for each preference: a second or two of work."""

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]


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
    """

    controls: Floats
    branch: Branch
    report: GraspReport
    wrap: Floats
    searched: bool

    def __post_init__(self) -> None:
        self.wrap.setflags(write=False)

    @property
    def grasping(self) -> bool:
        """Whether the plan is a grasp that enters neither branch nor finger."""
        return why_not(self.report) is None

    @cached_property
    def reason(self) -> str | None:
        """Why this is no feasible grasp, in one line; None where it is one.

        Looked for when it is first asked for: a remedy takes many more plans.
        """
        return _reason(self.report, searched=self.searched)


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
    search over the joints before a contact is a grid: a plan that is found is
    checked exactly, a grasp that exists only between grid angles may be missed.

    Args:
        foot: The foot.
        branch: One branch, of any pose.
        find_height: Also move the branch along z to where it is grasped best.
        levels: Angles tried at each joint, 2 to 33; the work grows as levels^K, so
            that fingers of many phalanges get fewer.
        prefer: What the best grasp has most of: `wrap`; `quality`, Ferrari and
            Canny's; or `pull`, the force away from the branch that it bears. The
            latter two are compared over a shortlist of the grasps found.
        strength: How hard toes press, for those two; None: 1 N at friction 0.5.

    Returns:
        The best plan; its `reason` says why where it is no feasible grasp.

    Raises:
        ParameterError: A batch of branches, one that holds the foot's base, a vertical
            branch whose height is to be found, or levels out of range.
        UnknownNameError: There is no such preference.
    """
    if prefer not in SHORTLIST:
        raise UnknownNameError("preference", prefer, tuple(SHORTLIST))
    if branch.batch_shape:
        remedy = "plan for one branch at a time"
        raise ParameterError("branch batch", branch.batch_shape, "()", remedy)
    levels = checks.integer("levels", levels, 2, 33)
    check_branch(foot, branch)
    if find_height:
        branch = _best_height(foot, branch)
    value = partial(_hold, prefer, strength or Strength(1.0, Friction()))
    report, wrap = _planned(foot, branch, levels, value, SHORTLIST[prefer])
    return PerchPlan(report.controls, branch, report, wrap, find_height)


def _planned(
    foot: Foot,
    branch: Branch,
    levels: int,
    value: Callable[[GraspReport], float],
    most: int,
) -> tuple[GraspReport, Floats]:
    """Verdicts on the best pose for a branch in its place, and its wrap.

    Among so many grasps, the first of equal value; without a grasp, what comes first.
    """
    poses = _all_poses(foot, branch.broadcast((1,)), levels)
    combos, grasps, _ = _combinations(foot, poses)
    grasping = np.flatnonzero(grasps)
    if len(grasping) > 1 and most > 1:
        spread = np.linspace(0, len(grasping) - 1, min(most, len(grasping)))
        tried = combos[grasping[spread.astype(np.intp)]]
    else:
        tried = combos[:1]
    controls = np.concatenate(
        [p.controls[i] for p, i in zip(poses, tried.T, strict=True)], axis=-1
    )
    reports = [check_grasp(foot, each, branch) for each in controls]
    values = [value(report) for report in reports] if len(reports) > 1 else [0.0]
    best = int(np.argmax(values))
    wrap = np.array([p.wrap[i] for p, i in zip(poses, tried[best], strict=True)])
    return reports[best], wrap


def _hold(prefer: Preference, strength: Strength, report: GraspReport) -> float:
    """What a grasp is worth to those who prefer a firm one; −∞ for none."""
    if not (report.grasping and report.feasible):
        return -math.inf
    contacts = branch_contacts(report)
    if prefer == "quality":
        return closure_quality(contacts, strength.friction).low
    return pull_limit(contacts, strength, -contacts.origin).force


def _all_poses(foot: Foot, branches: Branch, levels: int) -> list[FingerPoses]:
    """The poses of every finger, for a batch of branches."""
    tolerance = Criteria().metres(foot)
    fingers = range(len(foot.fingers))
    return [finger_poses(foot, i, branches, levels, tolerance) for i in fingers]


def _combinations(
    foot: Foot, poses: list[FingerPoses]
) -> tuple[Indices, Booleans, Floats]:
    """One pose for each finger, whether it grasps, what it is worth: the best first.

    Fingers are added one by one; the best `BEAM` combinations are kept.
    """
    combos = np.zeros((1, 0), dtype=np.intp)
    worth, grasps = np.zeros(1), np.zeros(1, dtype=bool)
    for finger, new in enumerate(poses):
        # Every pair of poses is judged once, in a table; combinations look it up.
        total = worth[:, None] + _worth(foot, new)
        grasping = np.repeat(grasps[:, None], len(new.wrap), axis=1)
        for earlier in range(finger):
            row = combos[:, earlier]
            total -= PENALTY * _colliding(foot, poses, earlier, finger)[row]
            if (earlier, finger) in foot.opposable_pairs:
                grasping |= _opposed(poses[earlier], new)[row]
        # Stable, so that equals keep their order and a plan is always the same.
        ranked = np.argsort(-(total + GRASP * grasping), axis=None, kind="stable")
        row, pose = np.unravel_index(ranked[:BEAM], total.shape)
        combos = np.concatenate([combos[row], pose[:, None]], axis=1)
        worth, grasps = total[row, pose], grasping[row, pose]
    return combos, grasps & (worth > -PENALTY / 2), worth + GRASP * grasps


def _worth(foot: Foot, poses: FingerPoses) -> Floats:
    """What each pose of a finger is worth by itself, shape (N,)."""
    entering = (poses.clearance < -Criteria().metres(foot)).any(axis=1)
    touching = poses.touching.any(axis=1)
    gap = np.where(touching, 0.0, poses.clearance.min(axis=1))
    return np.asarray(
        TOE * poses.tangent.any(axis=1)
        + TOUCH * touching
        + np.where(np.isfinite(poses.wrap), poses.wrap, 0.0)
        + CONTACT * poses.tangent.sum(axis=1)
        - NEAR * gap / (foot.size + gap)
        - PENALTY * entering
    )


def _colliding(foot: Foot, poses: list[FingerPoses], i: int, j: int) -> Booleans:
    """Which poses of two fingers run into each other, shape (N_i, N_j)."""
    one, other = poses[i].bones, poses[j].bones
    parts = [foot.finger_slices[foot.fingers[k].name] for k in (i, j)]
    skin = foot.radii[parts[0]][:, None] + foot.radii[parts[1]]
    apart = segment_distance(one[:, None, :, None], other[None, :, None, :]) - skin
    apart[..., 0, 0] = np.inf
    # Bare bones that cross have no depth, and the verdict asks for a gap.
    least = 0.0 if foot.thickness > 0 else Criteria().metres(foot)
    return np.asarray(apart.min(axis=(-2, -1)) < least)


def _opposed(one: FingerPoses, other: FingerPoses) -> Booleans:
    """Which poses of two fingers hold the branch between them, shape (N, M)."""
    products = np.einsum("ikx,jlx->ijkl", one.normal, other.normal)
    both = one.tangent[:, None, :, None] & other.tangent[None, :, None, :]
    return np.asarray((both & (products <= PARAMETER_SLACK)).any(axis=(-2, -1)))


def _best_height(foot: Foot, branch: Branch) -> Branch:
    """The branch moved along z to where its coarse plan is worth most."""
    top, low, high = _highest(foot, branch), 0.0, DEEPEST * foot.size
    for _ in range(ROUNDS):
        gaps = np.linspace(low, high, HEIGHTS)
        poses = _all_poses(foot, _lowered(branch, top - gaps), COARSE_LEVELS)
        worths = [
            _combinations(foot, [p.take(p.place == place) for p in poses])[2][0]
            for place in range(HEIGHTS)
        ]
        # Of equally good heights the nearest: the foot sits rather than hangs.
        best = float(gaps[np.argmax(worths - gaps / foot.size)])
        width = (high - low) / (HEIGHTS - 1)
        low, high = max(best - width, 0.0), best + width
    return _lowered(branch, top - np.asarray(best))


def _highest(foot: Foot, branch: Branch) -> float:
    """Height of the centre at which the base's skin rests on the branch [m].

    Solves |centre − (centre·axis) axis| = radius + skin for the centre's z; where
    the branch passes beside the base, the height of the base.
    """
    across = np.eye(3) - np.outer(branch.axis, branch.axis)
    rise, level = across[:, 2], across @ (branch.centre * (1.0, 1.0, 0.0))
    square = float(rise @ rise)
    if square < VERTICAL:
        remedy = "give the branch a slope, or its place"
        raise ParameterError("branch.axis", branch.axis, "across the z axis", remedy)
    reach = float(branch.radius) + float(foot.radii.max())
    half = float(rise @ level) / square
    # Negative where the branch passes beside the base at every height.
    inside = half**2 - (float(level @ level) - reach**2) / square
    return -half - float(np.sqrt(max(inside, 0.0)))


def _lowered(branch: Branch, heights: Floats) -> Branch:
    """The branch with its centre at other heights."""
    level = np.broadcast_to(branch.centre[:2], (*heights.shape, 2))
    return branch.moved_to(np.concatenate([level, heights[..., None]], axis=-1))


def _reason(report: GraspReport, *, searched: bool) -> str | None:
    """Why a plan is no feasible grasp and what would help, in one line."""
    fact = why_not(report)
    if fact is None:
        return None
    return f"{fact}: {_advice(report, searched=searched)}"


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
        there = _best_height(foot, branch)
        found, _ = _planned(foot, there, COARSE_LEVELS, lambda _: 0.0, 1)
        if found.feasible and found.grasping:
            kind = "thinner" if share * foot.size < radius else "thicker"
            example = share * foot.size * MILLIMETRES
            return f"take a {kind} branch, such as one of radius {example:.3g} mm"
    return "take a branch across the foot, or a foot whose joints close further"
