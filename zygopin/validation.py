"""The iterated function system held against Pinocchio's workspace of the URDF."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from zygopin import checks, kinds, names
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.hausdorff import directed_distance, hausdorff_distance
from zygopin.model import FootModel
from zygopin.reach import (
    MOST_LEVELS,
    FingerReach,
    finger_length,
    finger_reach,
    levels_within,
)

MOST_CONFIGURATIONS = 40_000
"""Configurations of a finger that go through Pinocchio: a third of a second's work."""

EQUALITY = 1e-12
"""Distance over the finger's length within which two points are one: far above the
rounding of a dozen turns, far below what any change of the model makes."""

TAIL_LEVELS = 3
"""Levels of the sets whose distance to their limit is measured."""

TAIL_DEPTH = 10
"""Depth of the set that stands for the limit: 59 049 points."""

SAMPLES = 2000
"""Random controls of each finger, unless said otherwise."""

Check = Literal["grid", "words", "random", "limit"]
"""What a row compares; see `validate_foot`."""

CHECKS: tuple[Check, ...] = ("grid", "words", "random", "limit")


@dataclass(frozen=True)
class ValidationRow:
    """One comparison of one finger.

    Attributes:
        finger: The finger's name.
        check: What is compared.
        levels: Number of equal levels of each control.
        configurations: Configurations that went through Pinocchio.
        value: What was measured [m].
        bound: What it is held against [m].
        slack: What the value may differ from the bound, where they shall be equal
            [m]; None: the bound is an upper one.
        pose: Where a finger that can turn stood; None: one that cannot.
    """

    finger: str
    check: Check
    levels: int
    configurations: int
    value: float
    bound: float
    slack: float | None = None
    pose: names.Pose | None = None

    @property
    def ok(self) -> bool:
        """Whether the value keeps to the bound."""
        if self.slack is None:
            return self.value <= self.bound
        return abs(self.value - self.bound) <= self.slack


@dataclass(frozen=True)
class ReachValidation:
    """How a foot's reachable sets stood against Pinocchio.

    Attributes:
        foot: The foot.
        rows: One comparison each, finger by finger.
    """

    foot: Foot
    rows: tuple[ValidationRow, ...]

    @property
    def ok(self) -> bool:
        """Whether every row is."""
        return all(row.ok for row in self.rows)


def validate_foot(
    foot: Foot,
    *,
    levels: int = MOST_LEVELS,
    samples: int = SAMPLES,
    urdf: str | None = None,
    rng: np.random.Generator | None = None,
) -> ReachValidation:
    """Hold each finger's reachable set against the URDF's workspace in Pinocchio.

    A control turns its joint from one limit of the URDF to the other, so that the
    description stands for itself. Four rows for each finger:

    - `grid`: Hausdorff distance of the whole grid of controls through Pinocchio and
      of the iterated function system; at most 1e-12 of the finger's length.
    - `words`: the largest distance between the tip of a control sequence and the
      point that the set's `words` gives it; at most the same.
    - `random`: how far tips of controls anywhere in [0, 1] stray from the set; at
      most its `grid_bound`.
    - `limit`: d_H(Rₖ, R∞) for three levels, Rₖ from Pinocchio, R∞ as R_m and the
      tail ρ^−m/(ρ−1) that remains; equal to ρ^−k/(ρ−1) (MODEL.md, section 3).

    A finger that can turn stands at one limit of its reversal joint in these rows.
    `grid` and `words` follow once more with the joint at its other limit, against the
    set turned to the reversed azimuth: the rows of the pose `spread`. The other two
    measure the same joints again, and would say nothing new.

    Args:
        foot: The foot.
        levels: Equal levels of each control; fewer for fingers that would have more
            than 40 000 configurations. Each row says how many.
        samples: Random controls of each finger.
        urdf: The URDF; None: `to_urdf(foot)`.
        rng: Where random controls come from; None: a generator of seed 0.

    Returns:
        The rows, four for each finger and two more where it turns.

    Raises:
        ParameterError: A number is out of range.
        DescriptionError: The URDF is malformed, or is not one of this foot.
    """
    rows = iter_validation(foot, levels=levels, samples=samples, urdf=urdf, rng=rng)
    return ReachValidation(foot, tuple(rows))


def iter_validation(
    foot: Foot,
    *,
    levels: int = MOST_LEVELS,
    samples: int = SAMPLES,
    urdf: str | None = None,
    rng: np.random.Generator | None = None,
) -> Iterator[ValidationRow]:
    """The rows of `validate_foot` one by one, as they are found.

    Args:
        foot: The foot.
        levels: Equal levels of each control.
        samples: Random controls of each finger.
        urdf: The URDF; None: `to_urdf(foot)`.
        rng: Where random controls come from; None: a generator of seed 0.

    Returns:
        An iterator over `row_count(foot)` rows.

    Raises:
        ParameterError: A number is out of range.
        DescriptionError: The URDF is malformed, or is not one of this foot.
    """
    kinds.instance("foot", foot, Foot)
    levels = checks.integer("levels", levels, 2, MOST_CONFIGURATIONS)
    samples = checks.integer("samples", samples, 1, 10**7)
    if rng is None:
        rng = np.random.default_rng(0)
    kinds.instance("rng", rng, np.random.Generator)
    model = FootModel(foot, urdf)
    return _rows(model, levels, samples, rng)


def row_count(foot: Foot) -> int:
    """How many rows the validation of a foot has.

    Args:
        foot: The foot.

    Returns:
        Four for each finger, and two more for each that turns.
    """
    turning = sum(map(names.is_reversible, foot.fingers))
    return len(CHECKS) * len(foot.fingers) + 2 * turning


def _rows(
    model: FootModel, levels: int, samples: int, rng: np.random.Generator
) -> Iterator[ValidationRow]:
    """The rows of each finger: as it stands, then turned."""
    foot = model.foot
    for finger in foot.fingers:
        count = levels_within(finger.phalanges, MOST_CONFIGURATIONS, levels)
        reach = finger_reach(foot, finger.name, count)
        yield from _grid_rows(model, reach, _first_pose(finger))
        yield _random_row(model, reach, rng.uniform(size=(samples, reach.depth)))
        yield _limit_row(model, finger)
        if names.is_reversible(finger):
            yield from _grid_rows(model, reach, "spread")


def _first_pose(finger: Finger) -> names.Pose | None:
    """The pose of a finger at its own azimuth."""
    return "zygodactyl" if names.is_reversible(finger) else None


def _in_space(reach: FingerReach, pose: names.Pose | None) -> NDArray[np.float64]:
    """Points of a set [m], shape (N, 3), in a pose of its finger."""
    finger, foot = reach.finger, reach.foot
    if pose != "spread" or finger.reversed_azimuth is None:
        return reach.in_space()
    turned = replace(finger, azimuth=finger.reversed_azimuth)
    fingers = (turned if each == finger else each for each in foot.fingers)
    return replace(reach, foot=foot.replace(fingers=tuple(fingers))).in_space()


def _grid_rows(
    model: FootModel, reach: FingerReach, pose: names.Pose | None
) -> Iterator[ValidationRow]:
    """The whole grid as a set, and point by point through the words."""
    name, levels = reach.finger.name, reach.plane.levels
    bound = EQUALITY * finger_length(model.foot, name)
    grid = _grid(levels, reach.depth)
    tips, points = _tips(model, reach.finger, grid, pose), _in_space(reach, pose)
    size = len(levels), len(grid)
    whole = hausdorff_distance(tips, points).value
    yield ValidationRow(name, "grid", *size, whole, bound, pose=pose)
    words = reach.plane.words(np.arange(len(points)))
    places = tuple(np.searchsorted(levels, words).T)
    order = np.ravel_multi_index(places, (len(levels),) * reach.depth)
    apart = float(np.linalg.norm(tips[order] - points, axis=-1).max())
    yield ValidationRow(name, "words", *size, apart, bound, pose=pose)


def _random_row(
    model: FootModel, reach: FingerReach, controls: NDArray[np.float64]
) -> ValidationRow:
    """Controls anywhere in [0, 1] against the bound of the grid."""
    pose = _first_pose(reach.finger)
    tips = _tips(model, reach.finger, controls, pose)
    strayed = directed_distance(tips, reach.in_space()).value
    size = len(reach.plane.levels), len(controls)
    name = reach.finger.name
    return ValidationRow(name, "random", *size, strayed, reach.grid_bound, pose=pose)


def _limit_row(model: FootModel, finger: Finger) -> ValidationRow:
    """The distance to the limit that depth alone makes, which is known exactly."""
    foot, depth = model.foot, finger.phalanges
    grid = _grid(np.linspace(0, 1, TAIL_LEVELS), depth)
    near = finger_reach(foot, finger.name, TAIL_LEVELS)
    deeper = max(TAIL_DEPTH, depth + 1)
    far = finger_reach(foot, finger.name, TAIL_LEVELS, depth=deeper)
    pose = _first_pose(finger)
    tips = _tips(model, finger, grid, pose)
    measured = hausdorff_distance(tips, far.in_space()).value
    return ValidationRow(
        finger.name,
        "limit",
        TAIL_LEVELS,
        len(grid),
        measured + far.depth_bound,
        near.depth_bound,
        EQUALITY * foot.scale / (foot.rho - 1),
        pose,
    )


def _grid(levels: NDArray[np.float64], phalanges: int) -> NDArray[np.float64]:
    """Every sequence of some levels, the last control fastest, shape (n^K, K)."""
    axes = np.meshgrid(*[levels] * phalanges, indexing="ij")
    return np.stack(axes, axis=-1).reshape(-1, phalanges)


def _tips(
    model: FootModel,
    finger: Finger,
    controls: NDArray[np.float64],
    pose: names.Pose | None,
) -> NDArray[np.float64]:
    """Tips of a finger in Pinocchio [m], shape (N, 3), between the URDF's limits."""
    robot = model.model
    places = model.coordinates(names.flexion_joints(finger))
    limits = robot.lowerPositionLimit, robot.upperPositionLimit
    low, high = (limit[places] for limit in limits)
    angles = low + controls * (high - low)
    data, q = robot.createData(), pin.neutral(robot)
    if pose is not None:
        turn = model.coordinates([names.reversal_joint(finger)])
        q[turn] = limits[(pose == "spread") == (finger.reversal > 0)][turn]
    frame = robot.getFrameId(names.tip_link(finger), pin.FrameType.BODY)
    tip, found = data.oMf[frame].translation, np.empty((len(angles), 3))
    for row, out in zip(angles, found, strict=True):
        q[places] = row
        pin.framesForwardKinematics(robot, data, q)
        out[:] = tip
    return found
