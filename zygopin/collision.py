"""FCL engine: the answers of the exact engine from python-fcl's distance queries.

How FCL is asked follows from how it answers: capsules against capsules are exact,
so a branch is a long capsule wherever its end is out of reach; lengths are in units
of the foot, since FCL's tolerances are absolute; normals come from nearest points.
"""

from __future__ import annotations

from dataclasses import dataclass, fields

import fcl
import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.branch import Branch
from zygopin.clearance import Clearance, Floats, Nearest, dot, norm
from zygopin.fcl_solids import (
    Solids,
    capsules,
    cored,
    nearest_points,
    placed,
    quaternions,
)
from zygopin.obstacle import Solid

REACH = 2.0
"""Half-length of the capsule that stands for a branch, in units of the foot's
reach: its caps stay out of reach."""

SHRUNK = 0.5
"""Share of the radius at which nearest points are asked for: at contact the gap
of the true solids vanishes and with it the direction; this one's does not."""

COINCIDENT = 1e-12
"""Gap, in units of the foot, below which nearest points have no direction."""

SIDEWAYS = 1e-6
"""Axial part of a normal below which it belongs to a branch's side: the accuracy
of FCL's normals on a capped cylinder."""

CLAMPED = 1e-9
"""How near to 0 or 1 rounding leaves the t of a nearest point at a bone's end."""


def distances(
    bones: Floats,
    radii: Floats,
    branch: Branch,
    pairs: tuple[NDArray[np.intp], NDArray[np.intp]],
) -> tuple[Clearance, Floats]:
    """`branch_clearance` and `least_skin_distance`, with the solids made once.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii εₖ [m], shape (P,).
        branch: The branch, or a batch of them that broadcasts against the bones'.
        pairs: Indices of the first and of the second phalanges, shape (M,) each.

    Returns:
        The record, and signed distances [m] of the bones' own batch.
    """
    toes = _Toes.of(bones, radii)
    return _branch_clearance(toes, branch), _least_skin_distance(toes, pairs)


def branch_clearance(bones: Floats, radii: Floats, branch: Branch) -> Clearance:
    """Clearance between phalanges and branches, by FCL.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii εₖ [m], shape (P,).
        branch: The branch, or a batch of them that broadcasts against the bones'.

    Returns:
        The record of the exact engine. Where a finite branch's end is nearer than
        its side, the accuracy is that of FCL's capsule against cylinder.
    """
    return _branch_clearance(_Toes.of(bones, radii), branch)


def solid_nearest(bones: Floats, solid: Solid) -> Nearest:
    """Where bare bones are nearest to a solid, by FCL.

    A sphere or capsule is asked for as its core: FCL's distances between cores are
    exact, those to the round solids only where they are apart.

    Args:
        bones: Bones [m], shape (n, 2, 3).
        solid: The solid.

    Returns:
        The nearest points. In a box or mesh the gap is minus a way out, often but not
        always the shortest; where bone and solid or core coincide, the normal is only
        roughly outward.
    """
    origin = bones[0, 0] if len(bones) else np.zeros(3)
    unit = _unit(bones - origin)
    local = (bones - origin) / unit
    bare = capsules(local, np.zeros(len(local)))
    other, middle, radius = cored(solid, origin, unit)
    gap, near, far = nearest_points(bare, [other] * len(bare), signed=radius == 0)
    t, core = _core(local[:, 0], local[:, 1] - local[:, 0], near)
    apart = (np.abs(gap) > COINCIDENT)[:, None]
    vectors = np.where(apart, np.sign(gap)[:, None] * (near - far), core - middle)
    size = norm(vectors)[:, None]
    upward = np.broadcast_to((0.0, 0.0, 1.0), vectors.shape)
    normal = np.divide(vectors, size, upward.copy(), where=size > 0)
    return Nearest(t, (gap - radius) * unit, normal)


def least_skin_distance(
    bones: Floats, radii: Floats, pairs: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> Floats:
    """Least distance between the skins of pairs of phalanges, by FCL.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii [m], shape (P,).
        pairs: Indices of the first and of the second phalanges, shape (M,) each.

    Returns:
        Signed distances [m], shape (…): negative where skins overlap; infinite without
        pairs.
    """
    return _least_skin_distance(_Toes.of(bones, radii), pairs)


@dataclass(frozen=True)
class _Toes:
    """Phalanges as solids, in units of the foot.

    Attributes:
        unit: The unit [m].
        bones: Bones, shape (…, P, 2, 3).
        skin: Skin radii, shape (P,).
        solids: A capsule for each phalanx of each pose, in C order.
    """

    unit: float
    bones: Floats
    skin: Floats
    solids: list[fcl.CollisionObject]

    @classmethod
    def of(cls, bones: Floats, radii: Floats) -> _Toes:
        remedy = "give bones of a foot"
        checks.require("bones", bones, np.isfinite(bones), "finite", remedy)
        unit = _unit(bones)
        bones, skin = bones / unit, radii / unit
        solids = capsules(bones.reshape(-1, 2, 3), _rows(skin, bones.shape[:-2]))
        return cls(unit, bones, skin, solids)


def _branch_clearance(toes: _Toes, branch: Branch) -> Clearance:
    """Clearance between phalanges and branches."""
    unit, own = toes.unit, toes.bones.shape[:-2]
    batch = checks.common_batch("bones and branch", own[:-1], branch.batch_shape)
    shape = (*batch, own[-1])
    rows, phalanges = _Rows.of(toes, branch, shape), toes.solids
    if shape != own:
        places = np.arange(len(phalanges)).reshape(own)
        phalanges = [phalanges[i] for i in np.broadcast_to(places, shape).ravel()]
    # Objects cost more than queries: those of a branch serve all phalanges it has.
    share = shape[-1] if branch.batch_shape else max(len(phalanges), 1)
    record = _at_side(phalanges, rows, share)
    if not record.lateral.all():
        ends = ~record.lateral
        at_end = _at_end(rows.select(ends))
        for field in fields(Clearance):
            getattr(record, field.name)[ends] = getattr(at_end, field.name)
    return Clearance(
        record.distance.reshape(shape) * unit,
        record.t.reshape(shape),
        record.point.reshape(*shape, 3) * unit,
        record.normal.reshape(*shape, 3),
        record.lateral.reshape(shape),
    )


def _least_skin_distance(
    toes: _Toes, pairs: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> Floats:
    """Least distance between the skins of pairs of phalanges."""
    *batch, count = toes.bones.shape[:-2]
    flat = toes.bones.reshape(-1, count, 2, 3)
    rows, columns = np.nonzero(_may_be_least(flat, toes.skin, pairs))
    first, second = (rows * count + side[columns] for side in pairs)
    one, other = ([toes.solids[i] for i in side] for side in (first, second))
    # Without nearest points: half the time.
    distance = np.fromiter(map(fcl.distance, one, other), float, len(rows))
    least = np.full(len(flat), np.inf)
    np.minimum.at(least, rows, distance)
    return least.reshape(batch) * toes.unit


def _may_be_least(
    bones: Floats, radii: Floats, pairs: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> NDArray[np.bool_]:
    """Which pairs may be the nearest ones, by the spheres around them, (n, M).

    No pair is farther apart than its middles, none nearer than its spheres.
    """
    i, j = pairs
    start, end = bones[:, :, 0], bones[:, :, 1]
    middle, size = (start + end) / 2, norm(end - start) / 2
    offset = middle.take(i, axis=1) - middle.take(j, axis=1)
    most = norm(offset) - (radii.take(i) + radii.take(j))
    least = most - (size.take(i, axis=1) + size.take(j, axis=1))
    return np.asarray(least <= most.min(axis=1, initial=np.inf, keepdims=True))


@dataclass(frozen=True)
class _Rows:
    """Phalanges and their branches in units of the foot, one row each."""

    bone: Floats
    skin: Floats
    centre: Floats
    axis: Floats
    radius: Floats
    half: Floats

    @classmethod
    def of(cls, toes: _Toes, branch: Branch, shape: tuple[int, ...]) -> _Rows:
        unit = toes.unit
        return cls(
            _rows(toes.bones, shape, 2, 3),
            _rows(toes.skin, shape),
            _rows(branch.centre[..., None, :] / unit, shape, 3),
            _rows(branch.axis[..., None, :], shape, 3),
            _rows(np.asarray(branch.radius)[..., None] / unit, shape),
            _rows(branch.half_length[..., None] / unit, shape),
        )

    def select(self, mask: NDArray[np.bool_] | slice) -> _Rows:
        """Some of the rows."""
        return _Rows(*(getattr(self, field.name)[mask] for field in fields(self)))

    def lines(self) -> Floats:
        """From the start of each bone to its end."""
        return np.asarray(self.bone[:, 1] - self.bone[:, 0])

    def stems(self) -> Solids:
        """Slim capsules that stand for the branches, their middles beside the base."""
        middles = self.centre - dot(self.centre, self.axis)[:, None] * self.axis
        shapes = (fcl.Capsule(radius, 2 * REACH) for radius in SHRUNK * self.radius)
        return [*map(placed, shapes, quaternions(self.axis), middles)]


def _rows(values: Floats, shape: tuple[int, ...], *tail: int) -> Floats:
    """Values that broadcast to a shape, one row for each of its entries."""
    wide = np.empty((*shape, *tail))
    wide[...] = values
    return wide.reshape(-1, *tail)


def _at_side(phalanges: Solids, rows: _Rows, share: int) -> Clearance:
    """Nearest points on the branches' sides, `lateral` where there is such a side.

    Args:
        phalanges: The phalanges.
        rows: The phalanges and branches, as numbers.
        share: So many rows after one another have the same branch.
    """
    slims = rows.select(slice(None, None, share)).stems()
    each = [solid for solid in slims for _ in range(share)]
    gap, near, far = nearest_points(phalanges, each, signed=False)
    # Between capsules FCL's distance is exact, overlapping or not.
    distance = gap - (1 - SHRUNK) * rows.radius
    lines = rows.lines()
    t, core = _core(rows.bone[:, 0], lines, near)
    normal = _direction(near - far, gap, rows)
    axial = dot(core - rows.centre, rows.axis)
    lateral = np.abs(axial) - rows.half <= np.minimum(distance + rows.skin, 0.0)
    point = rows.centre + axial[:, None] * rows.axis + rows.radius[:, None] * normal
    offset = (distance + rows.radius + rows.skin)[:, None] * normal
    vertex = _on_line(t, offset, lines, rows.axis)
    return Clearance(distance, vertex, point, normal, lateral)


def _at_end(rows: _Rows) -> Clearance:
    """Nearest points on the capped cylinders: bare bones, so that gaps stay open."""
    bare = capsules(rows.bone, np.zeros_like(rows.skin))
    frames = quaternions(rows.axis)
    shapes = map(fcl.Cylinder, rows.radius, 2 * rows.half)
    solids = [*map(placed, shapes, frames, rows.centre)]
    gap, near, far = nearest_points(bare, solids, signed=True)
    normal = _direction(near - far, gap, rows)
    t, _ = _core(rows.bone[:, 0], rows.lines(), near)
    lateral = np.abs(dot(normal, rows.axis)) < SIDEWAYS
    return Clearance(gap - rows.skin, t, far, normal, lateral)


def _core(starts: Floats, lines: Floats, points: Floats) -> tuple[Floats, Floats]:
    """The bones' own points nearest to given points: t in [0, 1], and the points."""
    t = dot(points - starts, lines) / dot(lines, lines)
    t = np.minimum(np.maximum(t, 0.0), 1.0)
    return t, starts + t[:, None] * lines


def _direction(offsets: Floats, gaps: Floats, rows: _Rows) -> Floats:
    """Unit vectors from branch to phalanx; across both where they cross."""
    vectors = np.sign(gaps)[:, None] * offsets
    met = np.abs(gaps) <= COINCIDENT
    if met.any():
        axis, bone = rows.axis[met], rows.bone[met]
        across = np.cross(axis, bone[:, 1] - bone[:, 0])
        spare = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis), axis=1)])
        vectors[met] = np.where((across == 0).all(axis=1)[:, None], spare, across)
    return np.asarray(vectors / norm(vectors)[:, None])


def _on_line(t: Floats, offsets: Floats, lines: Floats, axes: Floats) -> Floats:
    """From the nearest point of the bone to that of its line: one Newton step.

    The squared distance from the axis is a parabola along the line, so its slope
    at t gives the vertex. Inside the bone the slope is zero but for rounding.
    """
    square = dot(lines, lines) - dot(lines, axes) ** 2
    clamped = (np.abs(t - 0.5) > 0.5 - CLAMPED) & (square > 0)
    return t - np.divide(dot(offsets, lines), square, np.zeros_like(t), where=clamped)


def _unit(bones: Floats) -> float:
    """The farthest that any junction is from the base: the unit of length."""
    return float(np.sqrt(dot(bones, bones).max(initial=0.0))) or 1.0
