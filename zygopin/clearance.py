"""Exact engine: distances from bones to branches and to each other, batched."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch

Floats = NDArray[np.float64]

PARALLEL = 1e-12
"""Sine of the angle to the axis below which a bone counts as parallel to it: its
projection is then a point up to rounding, and any t is as near as another."""

UNTURNED = 1e-16
"""Squared sine of the angle between two bones below which they count as parallel:
that of rounding. Their distance is then off by their length times the sine at most."""

BISECTIONS = 60
"""Halvings of [0, 1] that bring t below the spacing of doubles."""


@dataclass(frozen=True)
class Clearance:
    """Where phalanges are nearest to a branch: the record of both engines.

    Attributes:
        distance: Signed clearance between skin and bark [m], shape (…, P); the
            depth of the deepest point where negative.
        t: Position on the line of the bone, 0 at its start and 1 at its end, shape
            (…, P); outside [0, 1] where the line's nearest point is off the bone.
        point: Nearest point of the branch's surface [m], shape (…, P, 3).
        normal: Unit normal there, from the branch outward, shape (…, P, 3).
        lateral: Whether that point lies on the branch's side, not on an end.
    """

    distance: Floats
    t: Floats
    point: Floats
    normal: Floats
    lateral: NDArray[np.bool_]


class Nearest(NamedTuple):
    """Where bare bones are nearest to a solid.

    Attributes:
        t: Position on the bone, in [0, 1], shape (…).
        gap: Signed distance between bone and solid [m], shape (…).
        normal: Unit normal of the solid there, outward, shape (…, 3).
    """

    t: Floats
    gap: Floats
    normal: Floats


def branch_clearance(bones: Floats, radii: Floats, branch: Branch) -> Clearance:
    """Clearance between phalanges and branches: MODEL.md, section 4.

    clearance = dist(bone, axis line) − r − εₖ, and the distance to the capped
    cylinder where the end of a finite branch is nearer than its side.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii εₖ [m], shape (P,).
        branch: The branch, or a batch of them that broadcasts against the bones'.

    Returns:
        The record, with the common batch shape. Exact up to rounding.
    """
    pose = _Relative.of(bones, branch)
    t_line = pose.nearest_on_line()
    t = np.clip(t_line, 0.0, 1.0)
    radial, axial = pose.radial(t), pose.axial(t)
    gap = norm(radial) - pose.radius
    # The capped cylinder lies inside the infinite one, so where the infinite one's
    # nearest point belongs to both, it is the nearest of both.
    lateral = np.abs(axial) - pose.half <= np.minimum(gap, 0.0)
    normal = _radial_normal(radial, pose)
    if not lateral.all():
        ends = ~lateral
        part = pose.select(ends)
        t_line[ends], gap[ends], normal[ends], lateral[ends] = _end_clearance(part)
        t = np.clip(t_line, 0.0, 1.0)
    # From the bone's point back along the normal, so that point and normal agree.
    skin = pose.start + t[..., None] * pose.bone
    point = pose.centre + skin - gap[..., None] * normal
    return Clearance(gap - radii, t_line, point, normal, lateral)


def segment_distance(first: Floats, second: Floats) -> Floats:
    """Distance between segments.

    Args:
        first: Segments [m], shape (…, 2, 3).
        second: Segments [m], shape (…, 2, 3).

    Returns:
        Distances [m], shape (…).
    """
    _, offset = segment_offset(first, second)
    return norm(offset)


def segment_offset(first: Floats, second: Floats) -> tuple[Floats, Floats]:
    """Where the first segments are nearest to the second, and how they lie there.

    Args:
        first: Segments [m], shape (…, 2, 3).
        second: Segments [m], shape (…, 2, 3).

    Returns:
        Positions on the first in [0, 1], shape (…), and vectors [m] from the second
        to the first, shape (…, 3).
    """
    p, u = first[..., 0, :], first[..., 1, :] - first[..., 0, :]
    q, v = second[..., 0, :], second[..., 1, :] - second[..., 0, :]
    w = p - q
    s, t = _nearest_parameters(dot(u, u), dot(v, v), dot(u, v), dot(u, w), dot(v, w))
    return s, w + s[..., None] * u - t[..., None] * v


def skin_distance(
    bones: Floats, radii: Floats, pairs: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> Floats:
    """Distance between the skins of pairs of phalanges.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii [m], shape (P,).
        pairs: Indices of the first and of the second phalanges, shape (M,) each.

    Returns:
        Signed distances [m], shape (…, M): negative where skins overlap.
    """
    i, j = pairs
    start, line = bones[..., 0, :], bones[..., 1, :] - bones[..., 0, :]
    # All products at once, and then the pairs: a third of the time of pairs first.
    lines, starts = line @ line.swapaxes(-1, -2), line @ start.swapaxes(-1, -2)
    s, t = _nearest_parameters(
        lines[..., i, i],
        lines[..., j, j],
        lines[..., i, j],
        starts[..., i, i] - starts[..., i, j],
        starts[..., j, i] - starts[..., j, j],
    )
    square = np.zeros(s.shape)
    for x, u in zip(np.moveaxis(start, -1, 0), np.moveaxis(line, -1, 0), strict=True):
        square += (x[..., i] + s * u[..., i] - x[..., j] - t * u[..., j]) ** 2
    return np.asarray(np.sqrt(square) - radii[i] - radii[j])


def _nearest_parameters(
    uu: Floats, vv: Floats, uv: Floats, uw: Floats, vw: Floats
) -> tuple[Floats, Floats]:
    """Where two segments p + s·u and q + t·v are nearest, from products with p − q.

    The lines' own solution, clamped, then each parameter for the other clamped one;
    for parallel lines any s serves.
    """
    determinant = uu * vv - uv * uv
    crossing = determinant > UNTURNED * uu * vv
    s = np.divide(uv * vw - uw * vv, determinant, np.zeros_like(uv), where=crossing)
    t = np.clip((uv * np.clip(s, 0, 1) + vw) / vv, 0, 1)
    return np.clip((uv * t - uw) / uu, 0, 1), t


@dataclass(frozen=True)
class _Relative:
    """Bones seen from the branch: every field broadcast to the batch (…, P)."""

    centre: Floats
    axis: Floats
    radius: Floats
    half: Floats
    start: Floats
    bone: Floats
    start_axial: Floats
    bone_axial: Floats

    @classmethod
    def of(cls, bones: Floats, branch: Branch) -> _Relative:
        shape = np.broadcast_shapes(bones.shape[:-3], branch.batch_shape)
        shape = (*shape, bones.shape[-3])
        vectors = (branch.centre[..., None, :], branch.axis[..., None, :])
        centre, axis = (np.broadcast_to(x, (*shape, 3)) for x in vectors)
        scalars = (np.asarray(branch.radius), branch.half_length)
        radius, half = (np.broadcast_to(x[..., None], shape) for x in scalars)
        start = bones[..., 0, :] - centre
        bone = np.broadcast_to(bones[..., 1, :] - bones[..., 0, :], start.shape)
        return cls(
            centre, axis, radius, half, start, bone, dot(start, axis), dot(bone, axis)
        )

    def select(self, mask: NDArray[np.bool_]) -> _Relative:
        """The bones of a mask, as one flat batch."""
        return _Relative(*(getattr(self, name)[mask] for name in self.__annotations__))

    def radial(self, t: Floats) -> Floats:
        """From the axis to the bone's point at t, perpendicular to the axis."""
        return (
            self.start
            - self.start_axial[..., None] * self.axis
            + t[..., None] * self.projected()
        )

    def axial(self, t: Floats) -> Floats:
        """Coordinate along the axis of the bone's point at t."""
        return self.start_axial + t * self.bone_axial

    def projected(self) -> Floats:
        """The bone projected along the axis."""
        return self.bone - self.bone_axial[..., None] * self.axis

    def nearest_on_line(self) -> Floats:
        """Where the bone's line is nearest to the axis; midway where parallel."""
        flat = self.projected()
        square = dot(flat, flat)
        turned = square > PARALLEL**2 * dot(self.bone, self.bone)
        middle = np.full_like(square, 0.5)
        return np.divide(-dot(self.start, flat), square, middle, where=turned)


def _radial_normal(radial: Floats, pose: _Relative) -> Floats:
    """Unit vectors away from the axis; across the bone where it meets the axis."""
    length = norm(radial)
    on_axis = length <= PARALLEL * pose.radius
    if on_axis.any():
        flat = pose.projected()[on_axis]
        axis = pose.axis[on_axis]
        spare = np.eye(3)[np.argmin(np.abs(axis), axis=-1)]
        parallel = norm(flat) <= PARALLEL * norm(pose.bone[on_axis])
        across = np.cross(axis, np.where(parallel[..., None], spare, flat))
        radial, length = radial.copy(), length.copy()
        radial[on_axis], length[on_axis] = across, norm(across)
    return np.asarray(radial / length[..., None])


def _end_clearance(pose: _Relative) -> tuple[Floats, Floats, Floats, Any]:
    """Nearest points where the side does not decide: bones in a flat batch (n,).

    The signed distance to a convex solid is convex along a bone, so bisection on
    the sign of its slope finds the least.

    Args:
        pose: The bones.

    Returns:
        t in [0, 1], gap of the bone [m], unit normal (n, 3), whether lateral.
    """

    def slope(t: Floats) -> Floats:
        return dot(_solid_distance(pose, t)[1], pose.bone)

    t = least_of_convex(slope, len(pose.radius))
    gap, normal, lateral = _solid_distance(pose, t)
    return t, gap, normal, lateral


def least_of_convex(slope: Callable[[Floats], Floats], count: int) -> Floats:
    """Where convex functions on [0, 1] are least, by bisection.

    Args:
        slope: Parameters (n,) to a subgradient of each function there.
        count: Number n of functions.

    Returns:
        Parameters, shape (n,).
    """
    low, high = np.zeros(count), np.ones(count)
    for _ in range(BISECTIONS):
        t = (low + high) / 2
        rising = slope(t) > 0
        low, high = np.where(rising, low, t), np.where(rising, t, high)
    return np.asarray((low + high) / 2)


def _solid_distance(pose: _Relative, t: Floats) -> tuple[Floats, Floats, Any]:
    """Signed distance of a point to the capped cylinder, its gradient, its face."""
    radial, axial = pose.radial(t), pose.axial(t)
    outward = _radial_normal(radial, pose)
    endward = np.sign(axial)[..., None] * pose.axis
    side, end = norm(radial) - pose.radius, np.abs(axial) - pose.half
    rim = (side > 0) & (end > 0)
    # Beyond both, the nearest point is on the rim; elsewhere the farther face decides.
    corner = side[..., None] * outward + end[..., None] * endward
    gap = np.where(rim, np.hypot(side, end), np.maximum(side, end))
    flat = np.where((side >= end)[..., None], outward, endward)
    safe = np.where(rim, gap, 1.0)
    normal = np.where(rim[..., None], corner / safe[..., None], flat)
    return gap, normal, ~rim & (side >= end)


def dot(first: Floats, second: Floats) -> Floats:
    """Scalar products along the last axis."""
    return np.asarray(np.einsum("...i,...i->...", first, second))


def norm(vectors: Floats) -> Floats:
    """Lengths along the last axis."""
    return np.sqrt(dot(vectors, vectors))
