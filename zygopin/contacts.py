"""Point contacts between foot and branch, and the wrenches that friction lets act."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.errors import ParameterError
from zygopin.finger import MAX_PHALANGES
from zygopin.foot import MAX_FINGERS
from zygopin.grasp import GraspReport

Floats = NDArray[np.float64]

NEAREST = 1e-9
"""Distance below which two contacts are one, over the scale."""

LARGEST_FRICTION = 1e3
"""Coefficient beyond which a cone is a half-space but for rounding."""


MOST_PHALANGES = MAX_FINGERS * MAX_PHALANGES
"""Phalanges that a foot may have."""


@dataclass(frozen=True, eq=False)
class Contacts:
    """Frictional point contacts of one stance: MODEL.md, section 5, "held".

    A wrench is (force, torque about the origin over the scale), both in newtons, in
    the world's directions. For a branch, the scale is its radius and the origin the
    point of its axis that is nearest to the foot's base.

    Attributes:
        points: Where the foot is touched [m], shape (N, 3).
        normals: Unit normals from the branch outward, shape (N, 3): where a contact
            can push the foot.
        origin: Point about which torques are taken [m], shape (3,).
        scale: Length by which torques are divided [m].
        phalanges: Index of each contact's phalanx in the foot, shape (N,); −1 where
            there is none.

    Raises:
        ParameterError: No contacts, two at one place, a normal of length 0, a scale
            that is not positive, or shapes that do not fit.
    """

    points: Floats
    normals: Floats
    origin: Floats = field(default_factory=lambda: np.zeros(3))
    scale: float = 1.0
    phalanges: NDArray[np.intp] | None = None

    def __post_init__(self) -> None:
        points = checks.array("contacts.points", self.points, last=3)
        checks.shaped("contacts.points", points, (None, 3))
        if not len(points):
            remedy = "give a stance that touches the branch"
            raise ParameterError("contacts", 0, "at least one contact", remedy)
        normals = checks.array("contacts.normals", self.normals, last=3)
        checks.shaped("contacts.normals", normals, points.shape)
        lengths = np.linalg.norm(normals, axis=-1)
        remedy = "give outward normals"
        checks.require("contacts.normals", lengths, lengths > 0, "not zero", remedy)
        scale = checks.length("contacts.scale", self.scale)
        origin = checks.places("contacts.origin", self.origin)
        checks.shaped("contacts.origin", origin, (3,))
        _check_apart(points, scale)
        object.__setattr__(self, "points", points)
        object.__setattr__(self, "normals", normals / lengths[:, None])
        object.__setattr__(self, "origin", origin)
        object.__setattr__(self, "scale", scale)
        ranks = _ranks(self.phalanges, len(points))
        object.__setattr__(self, "phalanges", ranks)
        checks.freeze(self)

    def wrenches(self, forces: Floats) -> Floats:
        """Wrenches of forces on the foot.

        Args:
            forces: Forces at the contacts [N], shape (N, …, 3).

        Returns:
            Wrenches [N], shape (N, …, 6).
        """
        forces = checks.array("forces", forces, last=3)
        between = (1,) * (forces.ndim - 2)
        checks.shaped("forces", forces, (len(self.points), *forces.shape[1:]))
        arms = (self.points - self.origin).reshape(-1, *between, 3)
        return np.concatenate([forces, np.cross(arms, forces) / self.scale], axis=-1)

    def wrench_at(self, force: ArrayLike, point: ArrayLike) -> Floats:
        """Wrench of a force that acts elsewhere, such as the weight.

        Args:
            force: Force [N], shape (…, 3).
            point: Where it acts [m], shape (…, 3).

        Returns:
            Wrench [N], shape (…, 6).
        """
        push = checks.array("force", force, last=3)
        place = checks.places("point", point)
        checks.common_batch("force and point", push.shape[:-1], place.shape[:-1])
        arm = place - self.origin
        return np.concatenate([push, np.cross(arm, push) / self.scale], axis=-1)


@dataclass(frozen=True)
class Friction:
    """Coulomb's cone, |tangential| ≤ μ·normal, as a pyramid of so many edges.

    The inscribed pyramid lies between the cone of μ·cos(π/edges) and that of μ; the
    circumscribed one holds the cone. What both say is true of the cone.

    Attributes:
        coefficient: Coefficient of friction μ ≥ 0.
        edges: Edges of the pyramid, 3 to 64.

    Raises:
        ParameterError: A coefficient that is negative or beyond `LARGEST_FRICTION`,
            or edges out of range.
    """

    coefficient: float = 0.5
    edges: int = 8

    def __post_init__(self) -> None:
        value = checks.number(
            "friction",
            self.coefficient,
            allowed=f"a coefficient from 0 to {LARGEST_FRICTION:g}",
            where=lambda mu: 0 <= mu <= LARGEST_FRICTION,
            remedy="give one, such as 0.5",
        )
        object.__setattr__(self, "coefficient", value)
        edges = checks.integer("friction.edges", self.edges, 3, 64)
        object.__setattr__(self, "edges", edges)

    @property
    def rounding(self) -> float:
        """How much smaller the inscribed pyramid is at its narrowest: cos(π/edges)."""
        return math.cos(math.pi / self.edges)

    def forces(self, normals: Floats, *, around: bool = False) -> Floats:
        """The edges of each contact's pyramid, with a normal force of 1 N.

        Args:
            normals: Unit normals, shape (N, 3).
            around: Whether the pyramid is circumscribed, not inscribed.

        Returns:
            Forces [N], shape (N, edges, 3).
        """
        normals = checks.array("normals", normals, last=3)
        checks.shaped("normals", normals, (None, 3))
        checks.flag("around", around)
        reach = self.coefficient / (self.rounding if around else 1.0)
        spare = np.eye(3)[np.argmin(np.abs(normals), axis=-1)]
        first = np.cross(normals, spare)
        first /= np.linalg.norm(first, axis=-1, keepdims=True)
        second = np.cross(normals, first)
        angles = 2 * np.pi * np.arange(self.edges) / self.edges
        across = np.multiply.outer(np.cos(angles), first)
        across += np.multiply.outer(np.sin(angles), second)
        edges: Floats = normals[:, None] + reach * across.swapaxes(0, 1)
        return edges


def branch_contacts(report: GraspReport) -> Contacts:
    """The contacts of one stance on a branch: every phalanx that touches it.

    Phalanges that touch at the junction they share are one contact.

    Args:
        report: The verdicts on one stance.

    Returns:
        The contacts.

    Raises:
        ParameterError: A batch of stances, or none of the phalanges touches.
    """
    kinds.instance("report", report, GraspReport)
    if report.touching.ndim != 1:
        batch = report.touching.shape[:-1]
        remedy = "give the report on one stance"
        raise ParameterError("report batch", batch, "()", remedy)
    branch = report.branch
    axis, centre = branch.axis, branch.centre
    radius = float(branch.radius)
    found: list[int] = []
    for phalanx in np.flatnonzero(report.touching):
        offsets = report.point[found] - report.point[phalanx]
        if (np.linalg.norm(offsets, axis=-1) > NEAREST * radius).all():
            found.append(int(phalanx))
    return Contacts(
        points=report.point[found],
        normals=report.normal[found],
        origin=centre - (centre @ axis) * axis,
        scale=radius,
        phalanges=np.array(found, dtype=np.intp),
    )


def _ranks(phalanges: ArrayLike | None, count: int) -> NDArray[np.intp]:
    """Checked indices of phalanges, −1 where there is none, shape (count,)."""
    given = np.full(count, -1)
    if phalanges is not None:
        given = checks.array("contacts.phalanges", phalanges)
    checks.shaped("contacts.phalanges", given, (count,))
    good = (given >= -1) & (given < MOST_PHALANGES) & (given == np.floor(given))
    remedy = "give each contact's phalanx, or -1"
    checks.require("contacts.phalanges", given, good, "an index", remedy)
    return given.astype(np.intp)


def _check_apart(points: Floats, scale: float) -> None:
    """Raise if two contacts are at one place."""
    i, j = np.triu_indices(len(points), 1)
    gaps = np.linalg.norm(points[i] - points[j], axis=-1)
    near = np.flatnonzero(gaps <= NEAREST * scale)
    if len(near):
        pair = f"{i[near[0]]} and {j[near[0]]} at one place"
        raise ParameterError("contacts", pair, "apart", "give each contact once")
