"""Branches to which a phalanx of each of two fingers is tangent, with the verdicts."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.branch import Branch
from zygopin.clearance import Floats
from zygopin.control_system import Levels
from zygopin.crossings import Crossings, SystemCounts
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.grasp import PARAMETER_SLACK, Criteria, check_grasp
from zygopin.placement import Placement
from zygopin.reach import find_finger
from zygopin.records import joined, taken
from zygopin.tangent_lines import (
    Integers,
    TangentLines,
    control_set,
    line_count,
    whole_controls,
)

Booleans = NDArray[np.bool_]
Pair = tuple[str | int, str | int]

SOLUTION_BYTES = 128
"""Memory of one solution, beside its controls."""


@dataclass(frozen=True, eq=False)
class BranchSolutions:
    """Branches to which a phalanx of each of two fingers is tangent.

    A solution is one branch, or a one-parameter family of them, which its ends tell;
    then `height`, `radius`, `t` and the verdicts are those of a branch midway. Controls
    after the tangent phalanx are 0: a straight toe goes on along the tangent, and never
    enters the branch that it is tangent to. The verdicts are said of these controls,
    and of the two fingers alone.

    Attributes:
        foot: The foot with the two fingers alone, P phalanges in all.
        placement: Where the branches lie.
        tolerance: Contact tolerance of the verdicts [m].
        counts: What became of the systems.
        controls: Controls of both fingers, shape (N, P).
        phalanx: Number k of the tangent phalanx of each finger, shape (N, 2).
        side: 1: on its palm's side; −1: on its back; shape (N, 2).
        t: Where on each bone the branch touches, 0 to 1, shape (N, 2).
        height: z of the branch's centre [m], shape (N,).
        radius: Radius [m], shape (N,).
        heights: Ends of the family [m], shape (N, 2); equal for a single branch.
        radii: Radii at those ends [m], shape (N, 2).
        residual: Largest |clearance| of the two phalanges [m], shape (N,).
        stable: Verdict of `check_grasp`, shape (N,).
        grasping: The same in the reading `section`.
        grasping_base_to_tip: The same in the reading `base_to_tip`.
        feasible: Nothing penetrates: neither the branch nor the other finger.
        scalar_product: Least product of contact normals, shape (N,); NaN where not
            stable.
        scalar_product_base_to_tip: Least product of the phalanges' directions.
    """

    foot: Foot
    placement: Placement
    tolerance: float
    counts: SystemCounts
    controls: Floats
    phalanx: Integers
    side: Integers
    t: Floats
    height: Floats
    radius: Floats
    heights: Floats
    radii: Floats
    residual: Floats
    stable: Booleans
    grasping: Booleans
    grasping_base_to_tip: Booleans
    feasible: Booleans
    scalar_product: Floats
    scalar_product_base_to_tip: Floats

    def __post_init__(self) -> None:
        checks.freeze(self)

    def __len__(self) -> int:
        return len(self.height)

    @property
    def family(self) -> Booleans:
        """Which solutions are one-parameter families, shape (N,)."""
        return np.asarray(self.heights[:, 0] != self.heights[:, 1])

    @property
    def branches(self) -> Branch:
        """The branches, a batch of shape (N,)."""
        return self.placement.branch(self.height, self.radius)

    def fcl_difference(self) -> Floats:
        """Check by FCL: how far it finds the tangent phalanges from the branch.

        Returns:
            Larger |clearance| of the two phalanges by FCL [m], shape (N,): within the
            tolerance where the engines agree on the contact.
        """
        report = check_grasp(self.foot, self.controls, self.branches, engine="fcl")
        return _residual(self.foot, self.phalanx, report.clearance)


@dataclass(frozen=True)
class Search:
    """What branches are searched for: two fingers, a control set, a placement.

    Attributes:
        foot: The foot with the two fingers alone.
        levels: The control set, shape (n,).
        lines: Number of tangent lines of each finger.
        placement: Where the branches lie.
        criteria: What counts as contact.
    """

    foot: Foot
    levels: Floats
    lines: tuple[int, int]
    placement: Placement
    criteria: Criteria

    @classmethod
    def of(
        cls,
        foot: Foot,
        pair: Pair,
        levels: Levels,
        placement: Placement | None = None,
        criteria: Criteria | None = None,
    ) -> Search:
        """A checked search.

        Args:
            foot: The foot.
            pair: Two opposable fingers, by name or by number from 1.
            levels: The control set, 0 and 1 in it.
            placement: Where the branches lie; None: across the foot, below its base.
            criteria: What counts as contact; None: the default for the two fingers.

        Returns:
            The search.

        Raises:
            ParameterError: The fingers are not opposable, or the levels no control set.
            UnknownNameError: There is no finger of that name.
        """
        placement = kinds.optional("placement", placement, Placement)
        criteria = kinds.optional("criteria", criteria, Criteria)
        two = pair_of_fingers(foot, pair)
        values = control_set(levels)
        counts = line_count(two, 0, values), line_count(two, 1, values)
        return cls(two, values, counts, placement, criteria)

    @property
    def bytes_each(self) -> int:
        """Memory of one solution."""
        return SOLUTION_BYTES + 8 * self.foot.phalanx_count


@dataclass(frozen=True)
class Found:
    """Branches that a search has found, still without verdicts.

    Attributes:
        rank: Number k of each finger's tangent phalanx, shape (N, 2).
        word: Index of its v₁ … vₖ among the words of the levels, shape (N, 2).
        side: 1: on its palm's side; −1: on its back; shape (N, 2).
        t: Where on each bone the branch touches, shape (N, 2).
        height: Height [m], shape (N,).
        radius: Radius [m], shape (N,).
        heights: Ends of the family [m], shape (N, 2).
        radii: Radii there [m], shape (N, 2).
    """

    rank: Integers
    word: Integers
    side: Integers
    t: Floats
    height: Floats
    radius: Floats
    heights: Floats
    radii: Floats

    @classmethod
    def at(cls, one: TangentLines, other: TangentLines, where: Crossings) -> Found:
        """What the crossings of two sets of lines are.

        Args:
            one: The first finger's lines.
            other: The second finger's.
            where: Their crossings.

        Returns:
            The branches.
        """
        one, other = taken(one, where.one), taken(other, where.other)
        place = where.heights
        radii = one.offset[:, None] - np.where(
            one.normal_z[:, None] == 0, 0.0, one.normal_z[:, None] * place
        )
        t = [lines.t_start + lines.t_rate * where.height for lines in (one, other)]
        return cls(
            rank=np.stack([one.rank, other.rank], axis=1),
            word=np.stack([one.word, other.word], axis=1),
            side=np.stack([one.side, other.side], axis=1),
            t=np.stack(t, axis=1),
            height=where.height,
            radius=one.offset - one.normal_z * where.height,
            heights=place,
            radii=radii,
        )


def with_verdicts(
    search: Search, parts: list[Found], counts: SystemCounts
) -> BranchSolutions:
    """Branches with their verdicts by the exact engine.

    Args:
        search: The search.
        parts: What it has found.
        counts: What became of the systems.

    Returns:
        The solutions.
    """
    foot, found = search.foot, joined(parts)
    controls = np.concatenate(
        [
            whole_controls(search.levels, finger.phalanges, rank, word)
            for finger, rank, word in zip(
                foot.fingers, found.rank.T, found.word.T, strict=True
            )
        ],
        axis=1,
    )
    branches = search.placement.branch(found.height, found.radius)
    report = check_grasp(foot, controls, branches, criteria=search.criteria)
    section, base_to_tip = report.scalar_product, report.scalar_product_base_to_tip
    return BranchSolutions(
        foot=foot,
        placement=search.placement,
        tolerance=report.tolerance,
        counts=counts,
        controls=controls,
        phalanx=found.rank,
        side=found.side,
        t=found.t,
        height=found.height,
        radius=found.radius,
        heights=found.heights,
        radii=found.radii,
        residual=_residual(foot, found.rank, report.clearance),
        stable=report.stable,
        grasping=_opposed(section),
        grasping_base_to_tip=_opposed(base_to_tip),
        feasible=report.feasible,
        scalar_product=section,
        scalar_product_base_to_tip=base_to_tip,
    )


def pair_of_fingers(foot: Foot, pair: Pair) -> Foot:
    """The foot with two opposable fingers alone.

    Args:
        foot: The foot.
        pair: The fingers, by name or by number from 1.

    Returns:
        The foot with these two, in this order.

    Raises:
        ParameterError: They are not two fingers, or not opposable.
        UnknownNameError: There is no finger of that name.
    """
    kinds.instance("foot", foot, Foot)
    if not isinstance(pair, (tuple, list)) or len(pair) != 2:
        raise ParameterError("pair", pair, "two fingers", "give two names or numbers")
    fingers = tuple(find_finger(foot, finger) for finger in pair)
    if fingers[0] != fingers[1]:
        two = foot.replace(fingers=fingers)
        if two.opposable_pairs:
            return two
    names = " and ".join(finger.name for finger in fingers)
    remedy = "take one that points forward and one that points back"
    raise ParameterError("pair", names, "opposable", remedy)


def _residual(foot: Foot, rank: Integers, clearance: Floats) -> Floats:
    """Larger |clearance| of the two tangent phalanges, (N, P) to (N,)."""
    starts = [part.start for part in foot.finger_slices.values()]
    near = np.take_along_axis(np.abs(clearance), rank - 1 + starts, axis=1)
    return np.asarray(near.max(axis=1))


def _opposed(product: Floats) -> Booleans:
    """Whether a scalar product exists and is non-positive."""
    return np.asarray(np.nan_to_num(product, nan=np.inf) <= PARAMETER_SLACK)
