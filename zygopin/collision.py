"""FCL engine: the answers of the exact engine from python-fcl's distance queries.

How FCL is asked follows from how it answers: capsules against capsules are exact,
so a branch is a long capsule wherever its end is out of reach; lengths are in units
of the foot, since FCL's tolerances are absolute; normals come from nearest points.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

import fcl
import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.branch import Branch
from zygopin.clearance import Clearance, Floats, Nearest, dot, norm
from zygopin.fcl_solids import (
    Solids,
    bare_distances,
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
    t, core = _core(local, near)
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
        skin: Skin radii, shape (…, P).
        solids: A capsule for each phalanx of each pose, in C order.
    """

    unit: float
    bones: Floats
    skin: Floats
    solids: list[fcl.CollisionObject]

    @classmethod
    def of(cls, bones: Floats, radii: Floats) -> _Toes:
        unit = _unit(bones)
        if not math.isfinite(unit):
            remedy = "give bones of a foot"
            checks.require("bones", bones, np.isfinite(bones), "finite", remedy)
        bones, skin = bones / unit, np.empty(bones.shape[:-2])
        skin[...] = radii / unit
        solids = capsules(bones.reshape(-1, 2, 3), skin.reshape(-1))
        return cls(unit, bones, skin, solids)


def _branch_clearance(toes: _Toes, branch: Branch) -> Clearance:
    """Clearance between phalanges and branches."""
    unit, own = toes.unit, toes.bones.shape[:-2]
    batch = checks.common_batch("bones and branch", own[:-1], branch.batch_shape)
    shape = (*batch, own[-1])
    branches = branch.rows[..., None, :] / np.array([unit] * 3 + [1.0] * 3 + [unit] * 2)
    rows, phalanges = _Rows.of(toes, branches, shape), _spread(toes.solids, own, shape)
    # Objects cost more than queries: those of a branch serve all phalanges it has.
    stems = _spread(_stems(branches), branches.shape[:-1], shape)
    record = _at_side(phalanges, stems, rows)
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


def _stems(branches: Floats) -> list[fcl.CollisionObject]:
    """Slim capsules that stand for branches, their middles beside the base."""
    flat = branches.reshape(-1, 8)
    centre, axis, radius = flat[:, :3], flat[:, 3:6], flat[:, 6]
    middles = centre - dot(centre, axis)[:, None] * axis
    shapes = (fcl.Capsule(slim, 2 * REACH) for slim in SHRUNK * radius)
    return [*map(placed, shapes, quaternions(axis).tolist(), middles)]


def _spread(
    solids: list[fcl.CollisionObject], own: tuple[int, ...], shape: tuple[int, ...]
) -> list[fcl.CollisionObject]:
    """Solids of a shape of their own, one for each entry of a wider shape."""
    if own == shape:
        return solids
    if len(solids) == 1:
        return solids * math.prod(shape)
    places = np.arange(len(solids)).reshape(own)
    return [solids[i] for i in np.broadcast_to(places, shape).ravel().tolist()]


def _least_skin_distance(
    toes: _Toes, pairs: tuple[NDArray[np.intp], NDArray[np.intp]]
) -> Floats:
    """Least distance between the skins of pairs of phalanges."""
    *batch, count = toes.bones.shape[:-2]
    first, second = (side.tolist() for side in pairs)
    least = []
    for start in range(0, len(toes.solids), count):
        place = toes.solids[start : start + count].__getitem__
        one, other = map(place, first), map(place, second)
        least.append(min(bare_distances(one, other), default=np.inf))
    return np.array(least).reshape(batch) * toes.unit


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
    def of(cls, toes: _Toes, branches: Floats, shape: tuple[int, ...]) -> _Rows:
        wide = _rows(branches, shape, 8)
        return cls(
            _rows(toes.bones, shape, 2, 3),
            _rows(toes.skin, shape),
            *(wide[:, :3], wide[:, 3:6], wide[:, 6], wide[:, 7]),
        )

    def select(self, mask: NDArray[np.bool_]) -> _Rows:
        """Some of the rows."""
        return _Rows(*(getattr(self, field.name)[mask] for field in fields(self)))


def _rows(values: Floats, shape: tuple[int, ...], *tail: int) -> Floats:
    """Values that broadcast to a shape, one row for each of its entries."""
    if values.shape == (*shape, *tail):
        return values.reshape(-1, *tail)
    wide = np.empty((*shape, *tail))
    wide[...] = values
    return wide.reshape(-1, *tail)


def _at_side(phalanges: Solids, stems: Solids, rows: _Rows) -> Clearance:
    """Nearest points on the branches' sides, `lateral` where there is such a side.

    Args:
        phalanges: The phalanges.
        stems: What stands for the branch of each.
        rows: The same as numbers.
    """
    gap, near, far = nearest_points(phalanges, stems, signed=False)
    # Between capsules FCL's distance is exact, overlapping or not.
    distance = gap - (1 - SHRUNK) * rows.radius
    t, core = _core(rows.bone, near)
    normal = _direction(near - far, gap, rows)
    axial = dot(core - rows.centre, rows.axis)
    lateral = np.abs(axial) - rows.half <= np.minimum(distance + rows.skin, 0.0)
    point = rows.centre + axial[:, None] * rows.axis + rows.radius[:, None] * normal
    away = distance + rows.radius + rows.skin
    vertex = _on_line(t, away, normal, rows)
    return Clearance(distance, vertex, point, normal, lateral)


def _at_end(rows: _Rows) -> Clearance:
    """Nearest points on the capped cylinders: bare bones, so that gaps stay open."""
    bare = capsules(rows.bone, np.zeros_like(rows.skin))
    frames = quaternions(rows.axis).tolist()
    shapes = map(fcl.Cylinder, rows.radius, 2 * rows.half)
    solids = [*map(placed, shapes, frames, rows.centre)]
    gap, near, far = nearest_points(bare, solids, signed=True)
    normal = _direction(near - far, gap, rows)
    t, _ = _core(rows.bone, near)
    lateral = np.abs(dot(normal, rows.axis)) < SIDEWAYS
    return Clearance(gap - rows.skin, t, far, normal, lateral)


def _core(bones: Floats, points: Floats) -> tuple[Floats, Floats]:
    """The bones' own points nearest to given points: t in [0, 1], and the points."""
    starts = bones[:, 0]
    lines = bones[:, 1] - starts
    t = dot(points - starts, lines) / dot(lines, lines)
    t = np.minimum(np.maximum(t, 0.0), 1.0)
    return t, starts + t[:, None] * lines


def _direction(offsets: Floats, gaps: Floats, rows: _Rows) -> Floats:
    """Unit vectors from branch to phalanx; across both where they cross."""
    vectors = offsets
    if gaps.min(initial=np.inf) <= COINCIDENT:
        vectors, met = np.sign(gaps)[:, None] * offsets, np.abs(gaps) <= COINCIDENT
        axis, bone = rows.axis[met], rows.bone[met]
        across = np.cross(axis, bone[:, 1] - bone[:, 0])
        spare = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis), axis=1)])
        vectors[met] = np.where((across == 0).all(axis=1)[:, None], spare, across)
    return np.asarray(vectors / norm(vectors)[:, None])


def _on_line(t: Floats, away: Floats, normal: Floats, rows: _Rows) -> Floats:
    """From the nearest point of the bone to that of its line: one Newton step.

    The squared distance from the axis is a parabola along the line, so its slope
    at t gives the vertex. Inside the bone the slope is zero but for rounding.
    """
    lines = rows.bone[:, 1] - rows.bone[:, 0]
    square = dot(lines, lines) - dot(lines, rows.axis) ** 2
    clamped = (np.abs(t - 0.5) > 0.5 - CLAMPED) & (square > 0)
    slope = away * dot(normal, lines)
    return t - np.divide(slope, square, np.zeros_like(t), where=clamped)


def _unit(bones: Floats) -> float:
    """The farthest that any junction is from the base: the unit of length."""
    with np.errstate(over="ignore"):  # what is too far is refused, not warned of
        square = dot(bones, bones).max(initial=0.0)
    return float(np.sqrt(square)) or 1.0
