"""Exact engine: distances from bones to branches and to each other, batched."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin.blocks import in_blocks
from zygopin.branch import Branch

Floats = NDArray[np.float64]

PARALLEL = 1e-12
"""Sine of the angle to the axis below which a bone counts as parallel to it: its
projection is then a point up to rounding, and any t is as near as another."""

UNTURNED = 1e-16
"""Squared sine of the angle between two bones below which they count as parallel:
that of rounding. Their distance is then off by their length times the sine at most."""

PAIRED = 128
"""Poses whose pairs of phalanges are worked on at once: sixty times as many numbers
as there are poses stay in the cache."""

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


def distances(
    bones: Floats,
    radii: Floats,
    branch: Branch,
    pairs: tuple[NDArray[np.intp], NDArray[np.intp]],
) -> tuple[Clearance, Floats]:
    """`branch_clearance` and `least_skin_distance` at once.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii εₖ [m], shape (P,).
        branch: The branch, or a batch of them that broadcasts against the bones'.
        pairs: Indices of the first and of the second phalanges, shape (M,) each.

    Returns:
        The record, and signed distances [m] of the bones' own batch.
    """
    near = branch_clearance(bones, radii, branch)
    return near, least_skin_distance(bones, radii, pairs)


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
    t = _within(t_line)
    radial = pose.radial(t)
    length = _length(radial)
    gap = length - pose.radius
    normal = _radial_normal(radial, length, pose)
    lateral = np.ones(gap.shape, dtype=bool)
    if branch.length is not None:
        # The capped cylinder lies inside the infinite one, so where the infinite one's
        # nearest point belongs to both, it is the nearest of both.
        lateral = np.abs(pose.axial(t)) - pose.half <= np.minimum(gap, 0.0)
        ends = ~lateral
        part = pose.select(ends)
        t_line[ends], gap[ends], normal[:, ends], lateral[ends] = _end_clearance(part)
        t = _within(t_line)
    # From the bone's point back along the normal, so that point and normal agree.
    point = pose.centre + (pose.start + t * pose.bone - gap * normal)
    distance = gap.T - radii
    return Clearance(distance, t_line.T, point.T, normal.T, lateral.T)


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
    place = bones.T
    start = place[:, 0].copy(order="C")
    line = np.subtract(place[:, 1], start, order="C")
    square = _dot(line, line)
    u, v = line[:, i], line[:, j]
    offset = start[:, i]
    offset -= start[:, j]
    s, t = _nearest_parameters(
        square[i], square[j], _dot(u, v), _dot(u, offset), _dot(v, offset)
    )
    u *= s
    v *= t
    offset += u
    offset -= v
    return np.asarray(_length(offset).T - (radii[i] + radii[j]))


def least_skin_distance(
    bones: Floats, radii: Floats, pairs: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> Floats:
    """Least distance between the skins of pairs of phalanges.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii [m], shape (P,).
        pairs: Indices of the first and of the second phalanges, shape (M,) each.

    Returns:
        Signed distances [m], shape (…): infinite without a pair.
    """
    poses = bones.reshape(-1, *bones.shape[-3:])
    least = np.empty(len(poses))

    def block(part: slice) -> None:
        apart = skin_distance(poses[part], radii, pairs)
        np.min(apart, axis=-1, initial=np.inf, out=least[part])

    in_blocks(block, len(poses), threads=1, size=PAIRED)
    return least.reshape(bones.shape[:-3])


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
    t = _within((uv * _within(s) + vw) / vv)
    return _within((uv * t - uw) / uu), t


@dataclass(frozen=True)
class _Relative:
    """Bones seen from the branch: coordinates first, then phalanges, then the batch.

    Shapes broadcast to (3, P, …), or (P, …) for scalars, with the batch's axes in
    reverse: plain transposes of what is given, on which NumPy works fastest.
    """

    centre: Floats
    axis: Floats
    radius: Floats
    half: Floats
    start: Floats
    bone: Floats
    flat: Floats

    @classmethod
    def of(cls, bones: Floats, branch: Branch) -> _Relative:
        batch = np.broadcast_shapes(bones.shape[:-3], branch.batch_shape)
        axes = len(batch)
        centre, axis = (
            _turned(x, 1, axes)[:, None] for x in (branch.centre, branch.axis)
        )
        radius, half = (
            _turned(np.asarray(x), 0, axes)[None]
            for x in (branch.radius, branch.half_length)
        )
        place = _turned(bones, 3, axes)
        start = np.empty((3, bones.shape[-3], *batch[::-1]))
        np.subtract(place[:, 0], centre, out=start)
        bone = np.subtract(place[:, 1], place[:, 0], order="C")
        flat = bone - _dot(bone, axis) * axis
        return cls(centre, axis, radius, half, start, bone, flat)

    def select(self, mask: NDArray[np.bool_]) -> _Relative:
        """The bones of a mask, as one flat batch: (3, n) and (n,)."""
        parts = (getattr(self, name) for name in self.__annotations__)
        wide = (
            np.broadcast_to(x, (*x.shape[: x.ndim - mask.ndim], *mask.shape))
            for x in parts
        )
        return _Relative(*(x[..., mask] for x in wide))

    def radial(self, t: Floats) -> Floats:
        """From the axis to the bone's point at t, perpendicular to the axis."""
        along = _dot(self.start, self.axis)
        return np.asarray(self.start - along * self.axis + t * self.flat)

    def axial(self, t: Floats) -> Floats:
        """Coordinate along the axis of the bone's point at t."""
        return _dot(self.start, self.axis) + t * _dot(self.bone, self.axis)

    def nearest_on_line(self) -> Floats:
        """Where the bone's line is nearest to the axis; midway where parallel."""
        square = _dot(self.flat, self.flat)
        turned = square > PARALLEL**2 * _dot(self.bone, self.bone)
        along = -_dot(self.start, self.flat)
        middle = np.full(along.shape, 0.5)
        return np.asarray(np.divide(along, square, middle, where=turned))


def _turned(values: Floats, tail: int, axes: int) -> Floats:
    """The transpose of values with a number of batch axes before their `tail` axes."""
    missing = axes + tail - values.ndim
    padded = values.reshape((1,) * missing + values.shape)
    return np.asarray(padded.T)


def _radial_normal(radial: Floats, length: Floats, pose: _Relative) -> Floats:
    """Unit vectors away from the axis; across the bone where it meets the axis."""
    on_axis = length <= PARALLEL * pose.radius
    if on_axis.any():
        met = pose.select(on_axis)
        spare = np.eye(3)[np.argmin(np.abs(met.axis), axis=0)].T
        parallel = _length(met.flat) <= PARALLEL * _length(met.bone)
        across = np.cross(met.axis, np.where(parallel, spare, met.flat), axis=0)
        radial, length = radial.copy(), length.copy()
        radial[:, on_axis], length[on_axis] = across, _length(across)
    return np.asarray(radial / length)


def _end_clearance(pose: _Relative) -> tuple[Floats, Floats, Floats, Any]:
    """Nearest points where the side does not decide: bones in a flat batch (n,).

    The signed distance to a convex solid is convex along a bone, so bisection on
    the sign of its slope finds the least.

    Args:
        pose: The bones.

    Returns:
        t in [0, 1], gap of the bone [m], unit normal (3, n), whether lateral.
    """

    def slope(t: Floats) -> Floats:
        return _dot(_solid_distance(pose, t)[1], pose.bone)

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
    length = _length(radial)
    outward = _radial_normal(radial, length, pose)
    endward = np.sign(axial) * pose.axis
    side, end = length - pose.radius, np.abs(axial) - pose.half
    rim = (side > 0) & (end > 0)
    # Beyond both, the nearest point is on the rim; elsewhere the farther face decides.
    corner = side * outward + end * endward
    gap = np.where(rim, np.hypot(side, end), np.maximum(side, end))
    flat = np.where(side >= end, outward, endward)
    normal = np.where(rim, corner / np.where(rim, gap, 1.0), flat)
    return gap, normal, ~rim & (side >= end)


def _within(t: Floats) -> Floats:
    """Parameters clamped to the bone: half of `np.clip`'s time for a few."""
    return np.asarray(np.minimum(np.maximum(t, 0.0), 1.0))


def _dot(first: Floats, second: Floats) -> Floats:
    """Scalar products along the first axis."""
    return np.asarray(np.add.reduce(first * second, axis=0))


def _length(vectors: Floats) -> Floats:
    """Lengths along the first axis."""
    return np.sqrt(_dot(vectors, vectors))


def dot(first: Floats, second: Floats) -> Floats:
    """Scalar products along the last axis."""
    return np.asarray(np.vecdot(first, second))


def norm(vectors: Floats) -> Floats:
    """Lengths along the last axis."""
    return np.asarray(np.sqrt(np.vecdot(vectors, vectors)))
