"""Verdicts: is the foot stable on a branch, does it grasp it, is the pose feasible."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields, replace
from functools import lru_cache
from typing import Any, Literal, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.blocks import entries
from zygopin.branch import Branch, check_base
from zygopin.clearance import Clearance, Floats, least_skin_distance
from zygopin.directions import FEET
from zygopin.engine import Engine, FasterName, make_engine
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.kinematics import Controls, read_controls

Reading = Literal["section", "base_to_tip"]
Booleans = NDArray[np.bool_]

READINGS: tuple[Reading, ...] = ("section", "base_to_tip")

TOLERANCE = 1e-6
"""Contact tolerance over the foot's size: controls written with seven decimals
keep a contact, and a parrot's toe is placed to 60 nm."""

LARGEST_TOLERANCE = 0.1
"""Contact tolerance, over the foot's size, above which a touch means nothing."""

BLOCK = 1024
"""Cases checked at once: what is in between stays in the cache."""

FARTHEST, THINNEST = 1e6, 1e-6
"""A branch's extent and least radius over the foot's size: beyond, rounding or the
tolerance decides instead of the geometry."""

PARAMETER_SLACK = 1e-9
"""Slack on t in [0, 1] and on the sign of the scalar product: rounding."""


@dataclass(frozen=True)
class Criteria:
    """What counts as contact and as a grasp.

    Attributes:
        reading: Which scalar product decides on a grasp (MODEL.md, section 5).
        tolerance: Contact tolerance [m]; None: `TOLERANCE` times the foot's size.
    """

    reading: Reading = "section"
    tolerance: float | None = None

    def __post_init__(self) -> None:
        kinds.one_of("reading", self.reading, READINGS)
        if self.tolerance is not None:
            remedy = "give metres, such as 1e-8"
            tolerance = checks.number(
                "tolerance",
                self.tolerance,
                allowed="a positive number",
                where=lambda x: x > 0,
                remedy=remedy,
            )
            object.__setattr__(self, "tolerance", tolerance)

    def metres(self, foot: Foot) -> float:
        """The tolerance for a foot [m].

        Raises:
            ParameterError: It is more than `LARGEST_TOLERANCE` of the foot's size.
        """
        kinds.instance("foot", foot, Foot)
        if self.tolerance is None:
            return TOLERANCE * foot.size
        most = LARGEST_TOLERANCE * foot.size
        if self.tolerance > most:
            allowed = f"at most {most:.3g} m, {LARGEST_TOLERANCE:.0%} of the foot"
            remedy = "a contact is a touch: give less"
            raise ParameterError("tolerance", self.tolerance, allowed, remedy)
        return self.tolerance


@dataclass(frozen=True, eq=False)
class GraspReport:
    """Verdicts with the evidence for them; P phalanges, `…` the batch.

    Attributes:
        foot: The foot.
        controls: The controls, shape (…, P).
        branch: The branch, or the batch of them.
        tolerance: Contact tolerance [m].
        bones: Bones [m], shape (…, P, 2, 3).
        clearance: Signed clearance of each phalanx [m], shape (…, P).
        t: Where the line of the bone is nearest, 0 to 1 on the bone, shape (…, P).
        point: Nearest points of the branch [m], shape (…, P, 3).
        normal: Unit normals of the branch there, outward, shape (…, P, 3).
        touching: |clearance| ≤ tolerance, shape (…, P).
        tangent: Touching inside the bone, on the branch's side, shape (…, P).
        penetrating: clearance < −tolerance, shape (…, P).
        finger_clearance: Least distance between two fingers' skins [m], shape (…).
        stable: Two opposable fingers are tangent, shape (…).
        grasping: Stable, and the reading's scalar product is ≤ 0, shape (…).
        feasible: Nothing penetrates: neither the branch nor another finger.
        scalar_product: Least product of contact normals over tangent phalanges of
            opposable fingers, shape (…); NaN without such a pair.
        scalar_product_base_to_tip: The same of the phalanges' directions.
    """

    foot: Foot
    controls: Floats
    branch: Branch
    tolerance: float
    bones: Floats
    clearance: Floats
    t: Floats
    point: Floats
    normal: Floats
    touching: Booleans
    tangent: Booleans
    penetrating: Booleans
    finger_clearance: Floats
    stable: Booleans
    grasping: Booleans
    feasible: Booleans
    scalar_product: Floats
    scalar_product_base_to_tip: Floats

    def __post_init__(self) -> None:
        checks.freeze(self)

    def difference(self, other: GraspReport) -> float:
        """Largest difference of clearances, the report's check by another engine.

        A phalanx that is inside a finite branch near its end has two depths: that of
        its deepest point (exact engine) and that of a way out (FCL).

        Args:
            other: A report on the same controls and branch.

        Returns:
            The largest |difference| over branch and finger clearances [m].
        """
        kinds.instance("other", other, GraspReport)
        apart = np.abs(self.clearance - other.clearance)
        some = np.isfinite(self.finger_clearance)  # infinite without a second finger
        fingers = self.finger_clearance[some] - other.finger_clearance[some]
        return float(max(apart.max(initial=0.0), np.abs(fingers).max(initial=0.0)))


def check_grasp(
    foot: Foot,
    controls: Controls,
    branch: Branch,
    *,
    engine: FasterName | Engine = "exact",
    criteria: Criteria | None = None,
) -> GraspReport:
    """Verdicts for given controls on a branch: MODEL.md, sections 4 and 5.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}.
        branch: A branch, or a batch that broadcasts against the controls'.
        engine: `exact`, `fcl`, `fast`, or one of these that `make_engine` made for
            this foot, for repeated use.
        criteria: What counts as contact and as a grasp; None: the defaults.

    Returns:
        The report, batched.

    Raises:
        ParameterError: A control is outside [0, 1], shapes do not fit, or the branch
            holds the foot's base.
        UnknownNameError: A finger, engine or reading does not exist.
    """
    kinds.instance("foot", foot, Foot)
    kinds.instance("branch", branch, Branch)
    values = read_controls(foot, controls)
    criteria = kinds.optional("criteria", criteria, Criteria)
    made = engine if isinstance(engine, Engine) else make_engine(engine, foot)
    if made.foot != foot:
        remedy = "make the engine for this foot"
        raise ParameterError("engine.foot", made.foot.name, "the foot", remedy)
    check_branch(foot, branch)
    shapes = values.shape[:-1], branch.batch_shape
    batch = checks.common_batch("controls and branch", *shapes)
    count = math.prod(batch)
    if count <= BLOCK:
        return _report(foot, values, branch, made, criteria)
    parts = []
    for start in range(0, count, BLOCK):
        part = slice(start, min(start + BLOCK, count))
        poses, branches = entries(values, batch, part, 1), branch.entries(batch, part)
        parts.append(_report(foot, poses, branches, made, criteria))
    return _joined(parts, branch, batch)


def check_branch(foot: Foot, branch: Branch) -> None:
    """A branch leaves the base outside, and is of a size that means something.

    Args:
        foot: The foot.
        branch: The branch, or a batch.

    Raises:
        ParameterError: It holds the foot's base inside it, is beyond `FARTHEST` or
            thinner than `THINNEST`.
    """
    check_base(branch)
    far, thin = FARTHEST * foot.size, THINNEST * foot.size
    if branch.largest_extent <= far and branch.least_radius >= thin:
        return
    radius = np.asarray(branch.radius)
    extent = radius + np.linalg.norm(branch.centre, axis=-1)
    most, least = f"at most {far:.3g} m for this foot", f"at least {thin:.3g} m for it"
    name, remedy = "extent of the branch", "move it nearer, or take a thinner one"
    checks.require(name, extent, extent <= far, most, remedy)
    checks.require("branch.radius", radius, radius >= thin, least, "take a thicker one")


def _report(
    foot: Foot, controls: Floats, branch: Branch, engine: Engine, criteria: Criteria
) -> GraspReport:
    """The report on one block."""
    tolerance = criteria.metres(foot)
    bones = engine.bones(controls)
    near, apart = engine.distances(bones, foot.radii, branch, finger_pairs(foot))
    contacts = classify(near, tolerance)
    section, along = engine.products(foot, contacts.tangent, near.normal, bones)
    decisive = section if criteria.reading == "section" else along
    batch = near.distance.shape[:-1]
    free = ~contacts.penetrating.any(axis=-1) & (apart >= least_gap(foot, tolerance))
    return GraspReport(
        foot=foot,
        controls=_wide(controls, near.distance.shape),
        branch=branch,
        tolerance=tolerance,
        bones=_wide(bones, (*batch, *bones.shape[-3:])),
        clearance=near.distance,
        t=near.t,
        point=near.point,
        normal=near.normal,
        **contacts._asdict(),
        finger_clearance=_wide(apart, batch),
        stable=np.isfinite(decisive),
        grasping=decisive <= PARAMETER_SLACK,
        feasible=free,
        scalar_product=section,
        scalar_product_base_to_tip=along,
    )


class Contacts(NamedTuple):
    """How each phalanx meets the branch: MODEL.md, section 4.

    Attributes:
        touching: |clearance| ≤ tolerance, shape (…, P).
        tangent: Touching inside the bone, on the branch's side, shape (…, P).
        penetrating: clearance < −tolerance, shape (…, P).
    """

    touching: Booleans
    tangent: Booleans
    penetrating: Booleans


def classify(near: Clearance, tolerance: float) -> Contacts:
    """Tell touches, tangencies and penetrations apart: MODEL.md, section 4.

    Args:
        near: The nearest points, shape (…, P).
        tolerance: Contact tolerance [m].

    Returns:
        The three masks.
    """
    touching = np.abs(near.distance) <= tolerance
    inside = np.abs(near.t - 0.5) <= 0.5 + PARAMETER_SLACK
    return Contacts(
        touching, touching & inside & near.lateral, near.distance < -tolerance
    )


def fingers_apart(foot: Foot, bones: Floats, tolerance: float) -> Booleans:
    """Whether no two fingers collide, by the exact engine.

    Args:
        foot: The foot.
        bones: Bones [m], shape (…, P, 2, 3).
        tolerance: Contact tolerance [m].

    Returns:
        The answers, shape (…).
    """
    apart = least_skin_distance(bones, foot.radii, finger_pairs(foot))
    return apart >= least_gap(foot, tolerance)


def least_gap(foot: Foot, tolerance: float) -> float:
    """Least distance between fingers that do not collide.

    Bare bones that cross have no depth: their distance is zero, not negative.

    Args:
        foot: The foot.
        tolerance: Contact tolerance [m].

    Returns:
        The distance of their skins [m].
    """
    return -tolerance if foot.thickness > 0 else tolerance


@lru_cache(FEET)
def finger_pairs(foot: Foot) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of phalanges of different fingers that can meet.

    First phalanges share the base junction, so they are not held against each other.

    Args:
        foot: The foot.

    Returns:
        Indices of the first and of the second phalanges, shape (M,) each, read-only.
    """
    i, j = np.triu_indices(foot.phalanx_count, 1)
    finger, rank = foot.finger_of_phalanx, foot.rank_of_phalanx
    apart = (finger[i] != finger[j]) & (rank[i] + rank[j] > 2)
    return checks.read_only(i[apart]), checks.read_only(j[apart])


def _wide(values: Floats, shape: tuple[int, ...]) -> Floats:
    """Values broadcast to a shape, which they mostly have."""
    return values if values.shape == shape else np.broadcast_to(values, shape)


def _joined(
    parts: list[GraspReport], branch: Branch, batch: tuple[int, ...]
) -> GraspReport:
    """The blocks' reports as one, in the shape of the batch."""
    arrays: dict[str, Any] = {
        field.name: np.concatenate([getattr(part, field.name) for part in parts])
        for field in fields(GraspReport)
        if isinstance(getattr(parts[0], field.name), np.ndarray)
    }
    shaped: dict[str, Any] = {
        name: x.reshape(*batch, *x.shape[1:]) for name, x in arrays.items()
    }
    return replace(parts[0], branch=branch, **shaped)
