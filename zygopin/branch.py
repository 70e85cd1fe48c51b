"""The branch: a solid circular cylinder in any pose, and its projection."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import blocks, checks, kinds
from zygopin.errors import ParameterError

BASE_SLACK = 1e-9
"""How far the base may lie inside, relative to the radius: rounding of a base that
sits on the bark."""


def branch_axis(yaw: float = 0.0, pitch: float = 0.0) -> NDArray[np.float64]:
    """Direction of a branch: the y axis pitched about x, then turned about z.

    Args:
        yaw: Turn about z [rad].
        pitch: Rise of the +y end above the horizontal [rad].

    Returns:
        Unit axis, shape (3,).

    Raises:
        ParameterError: An angle is not finite.
    """
    yaw, pitch = checks.angle("yaw", yaw), checks.angle("pitch", pitch)
    level = math.cos(pitch)
    return np.array([-math.sin(yaw) * level, math.cos(yaw) * level, math.sin(pitch)])


def yaw_and_pitch(axis: ArrayLike) -> tuple[float, float]:
    """The angles from which `branch_axis` makes an axis, or its opposite.

    Args:
        axis: Direction, shape (3,).

    Returns:
        Yaw in [-π/2, π/2] and pitch [rad].
    """
    x, y, z = np.asarray(axis, float) / np.linalg.norm(axis)
    if y < 0:
        x, y, z = -x, -y, -z
    return math.atan2(-x, y), math.asin(max(-1.0, min(1.0, z)))


@dataclass(frozen=True, eq=False)
class Branch:
    """A solid cylinder (MODEL.md, section 4), or a batch of them.

    Radius, centre, axis and length broadcast against one another; their common
    leading axes are the batch, and broadcast against the controls' batch.

    Attributes:
        radius: Radius r > 0 [m], shape (…).
        centre: A point of the axis, midway along a finite branch [m], shape (…, 3).
        axis: Direction; stored as a unit vector, shape (…, 3).
        length: Length [m], shape (…); None: infinite.
    """

    radius: float | NDArray[np.float64]
    centre: NDArray[np.float64]
    axis: NDArray[np.float64] = dataclasses.field(
        default_factory=lambda: np.array([0.0, 1.0, 0.0])
    )
    length: float | NDArray[np.float64] | None = None

    def __init__(
        self,
        radius: ArrayLike,
        centre: ArrayLike,
        axis: ArrayLike = (0.0, 1.0, 0.0),
        length: ArrayLike | None = None,
    ) -> None:
        self._set("radius", _plain(checks.lengths("branch.radius", radius)))
        self._set("centre", checks.places("branch.centre", centre))
        self._set(
            "axis", checks.read_only(_unit(checks.array("branch.axis", axis, last=3)))
        )
        if length is not None:
            length = _plain(checks.lengths("branch.length", length))
        self._set("length", length)
        checks.common_batch("radius, centre, axis and length", *self._shapes())

    def _set(self, field: str, value: object) -> None:
        object.__setattr__(self, field, value)

    @cached_property
    def batch_shape(self) -> tuple[int, ...]:
        """The leading axes; () for one branch."""
        return np.broadcast_shapes(*self._shapes())

    def _shapes(self) -> tuple[tuple[int, ...], ...]:
        """The leading axes of each field."""
        return (
            np.shape(self.radius),
            self.centre.shape[:-1],
            self.axis.shape[:-1],
            np.shape(self.half_length),
        )

    @cached_property
    def half_length(self) -> NDArray[np.float64]:
        """Half the length [m], shape (…), read-only; infinite where there is no end."""
        length = np.inf if self.length is None else self.length
        return checks.read_only(np.array(np.divide(length, 2.0)))

    @cached_property
    def rows(self) -> NDArray[np.float64]:
        """Centre, axis, radius, half-length side by side, shape (…, 8), read-only."""
        rows = np.empty((*self.batch_shape, 8))
        rows[..., :3], rows[..., 3:6] = self.centre, self.axis
        rows[..., 6], rows[..., 7] = self.radius, self.half_length
        return checks.read_only(rows)

    @cached_property
    def largest_extent(self) -> float:
        """Largest of the batch's radius + |centre| [m]."""
        extent = np.asarray(self.radius) + np.linalg.norm(self.centre, axis=-1)
        return float(extent.max(initial=0))

    @cached_property
    def least_radius(self) -> float:
        """Least radius of the batch [m]."""
        return float(np.min(self.radius, initial=np.inf))

    @cached_property
    def holds_origin(self) -> NDArray[np.bool_]:
        """Whether the origin lies inside the solid, shape (…), read-only."""
        along = np.abs(np.einsum("...i,...i->...", self.centre, self.axis))
        far = self.base_distance() >= self.radius * (1 - BASE_SLACK)
        outside = far | (along > self.half_length)
        inside = np.logical_not(outside)
        return checks.read_only(np.array(np.broadcast_to(inside, self.batch_shape)))

    def base_distance(self) -> NDArray[np.float64]:
        """Distance from the base's origin to the axis line [m], shape (…)."""
        along = np.einsum("...i,...i->...", self.centre, self.axis)
        return np.asarray(
            np.linalg.norm(self.centre - along[..., None] * self.axis, axis=-1)
        )

    def frame(self, reference: ArrayLike = (1.0, 0.0, 0.0)) -> NDArray[np.float64]:
        """An orthonormal frame with the axis as its last column.

        The first two columns span the plane onto which fingers are projected
        (MODEL.md, section 4, "Section").

        Args:
            reference: Direction near which the first column lies, shape (3,).

        Returns:
            R_world_branch, shape (…, 3, 3), right-handed.
        """
        reference = checks.places("reference", reference)
        checks.shaped("reference", reference, (3,))
        reference = np.broadcast_to(reference, self.axis.shape)
        flat = self._across(reference)
        weak = np.linalg.norm(flat, axis=-1, keepdims=True) < 1e-6
        spare = np.eye(3)[np.argmin(np.abs(self.axis), axis=-1)]
        first = np.where(weak, np.cross(self.axis, spare), flat)
        first = first / np.linalg.norm(first, axis=-1, keepdims=True)
        first = self._across(first)  # again: what is left of a near axis is rounded
        first = first / np.linalg.norm(first, axis=-1, keepdims=True)
        return np.stack([first, np.cross(self.axis, first), self.axis], axis=-1)

    def _across(self, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
        """The part of vectors that is perpendicular to the axis, shape (…, 3)."""
        along = np.einsum("...i,...i->...", vectors, self.axis)[..., None]
        return np.asarray(vectors - along * self.axis)

    def broadcast(self, shape: tuple[int, ...]) -> Branch:
        """This branch as a flat batch.

        Args:
            shape: The batch shape to broadcast to.

        Returns:
            A batch of shape (n,), n the number of entries of `shape`.

        Raises:
            ParameterError: The branch does not broadcast to that shape.
        """
        kinds.shape("shape", shape)
        if checks.common_batch("shape and branch", shape, self.batch_shape) != shape:
            allowed = f"one to which {self.batch_shape} broadcasts"
            raise ParameterError("shape", shape, allowed, "give a larger one")
        return self._changed(
            lambda x, tail: np.broadcast_to(x, (*shape, *tail)).reshape(-1, *tail)
        )

    def entries(self, batch: tuple[int, ...], part: blocks.Part) -> Branch:
        """Some entries of this branch broadcast to a batch.

        Args:
            batch: Shape that the batch shape broadcasts to.
            part: Which of its n entries, in C order.

        Returns:
            A batch of shape (n,); the branch itself where it is only one.
        """
        return self._changed(lambda x, tail: blocks.entries(x, batch, part, len(tail)))

    def __getitem__(self, index: Any) -> Branch:  # noqa: ANN401
        shape = self.batch_shape
        if len(shape) == 1:  # as below, in one step
            return self._changed(
                lambda x, tail: np.broadcast_to(x, (*shape, *tail))[index]
            )
        places = np.arange(np.prod(shape, dtype=int)).reshape(shape)[index]
        return self.broadcast(shape)._changed(lambda x, _: x[places])

    def _changed(self, change: Callable[[Any, tuple[int, ...]], Any]) -> Branch:
        """Every field changed alike; entries of a valid batch need no new check."""
        new = object.__new__(Branch)
        new._set("radius", _plain(change(np.asarray(self.radius), ())))
        new._set("centre", checks.read_only(change(self.centre, (3,))))
        new._set("axis", checks.read_only(change(self.axis, (3,))))
        length = self.length
        if length is not None:
            length = _plain(change(np.asarray(length), ()))
        new._set("length", length)
        return new

    def moved_to(self, centre: ArrayLike) -> Branch:
        """This branch with another centre.

        Args:
            centre: The new centre [m], shape (…, 3).

        Returns:
            The new branch.

        Raises:
            ParameterError: The centre is not finite.
        """
        return Branch(self.radius, centre, self.axis, self.length)


def _unit(axis: NDArray[np.float64]) -> NDArray[np.float64]:
    """The axis scaled to length 1, whatever its length: squares may overflow."""
    largest = np.abs(axis).max(axis=-1)
    remedy = "give a direction, such as (0, 1, 0)"
    checks.require("branch.axis.norm", largest, largest > 0, "positive", remedy)
    axis = axis / largest[..., None]
    return np.asarray(axis / np.linalg.norm(axis, axis=-1, keepdims=True))


def _plain(values: NDArray[np.float64]) -> float | NDArray[np.float64]:
    """The array, read-only, or the number where there is only one."""
    return float(values) if np.ndim(values) == 0 else checks.read_only(values)


def check_base(branch: Branch) -> None:
    """The base of a foot that stands at the origin lies outside the solid.

    Args:
        branch: The branch, or a batch, in the foot's frame.

    Raises:
        ParameterError: The branch holds the origin inside it.
    """
    if not branch.holds_origin.any():
        return
    distance = np.broadcast_to(branch.base_distance(), branch.batch_shape)
    checks.require(
        "distance of the base from the branch's axis",
        distance,
        ~branch.holds_origin,
        "at least the branch's radius: the branch holds the base inside it",
        "move the centre away from the origin, or make the branch thinner",
    )
