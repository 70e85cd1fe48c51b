"""Solids as python-fcl has them, and the nearest points of two."""

from __future__ import annotations

from collections.abc import Sequence

import fcl
import numpy as np

from zygopin import checks
from zygopin.clearance import Floats, norm
from zygopin.obstacle import Capsule, ConvexMesh, Solid, Sphere

Solids = Sequence[fcl.CollisionObject]


def capsules(bones: Floats, radii: Floats) -> list[fcl.CollisionObject]:
    """Segments with a radius as FCL's capsules.

    Args:
        bones: Segments, shape (n, 2, 3).
        radii: Radii, shape (n,).

    Returns:
        One solid for each.

    Raises:
        ParameterError: A segment is not finite, or has no length, or a radius is not
            at least 0: FCL would answer nonsense, or end the process.
    """
    lines = bones[:, 1] - bones[:, 0]
    lengths = norm(lines)
    remedy = "give bones of a foot, and its radii"
    sized = (lengths > 0) & np.isfinite(lengths)
    checks.require("length of bones", lengths, sized, "positive and finite", remedy)
    thick = (radii >= 0) & np.isfinite(radii)
    checks.require("radii", radii, thick, "at least 0 and finite", remedy)
    frames = quaternions(lines / lengths[:, None])
    middles = (bones[:, 0] + bones[:, 1]) / 2
    return [*map(placed, map(fcl.Capsule, radii, lengths), frames, middles)]


def cored(
    solid: Solid, origin: Floats, unit: float
) -> tuple[fcl.CollisionObject, Floats, float]:
    """A solid, or the core of a round one, as FCL's.

    Args:
        solid: The solid [m].
        origin: Where it is seen from [m], shape (3,).
        unit: The unit of length [m].

    Returns:
        The solid or its core, its middle, shape (3,), and the radius around the core:
        0 for a solid without one.
    """
    straight = np.array([1.0, 0.0, 0.0, 0.0])
    if isinstance(solid, ConvexMesh):
        vertices = (solid.vertices - origin) / unit
        count = len(solid.triangles)
        faces = np.insert(solid.triangles, 0, 3, axis=1).ravel()
        hull = fcl.Convex(vertices, count, faces)
        middle = vertices.mean(axis=0)
        return placed(hull, straight, np.zeros(3)), middle, 0.0
    if isinstance(solid, Capsule):
        ends = (solid.ends - origin) / unit
        core = capsules(ends[None], np.zeros(1))[0]
        return core, ends.mean(axis=0), solid.radius / unit
    centre = (solid.centre - origin) / unit
    if isinstance(solid, Sphere):
        point = fcl.Capsule(0.0, 0.0)
        return placed(point, straight, centre), centre, solid.radius / unit
    box = fcl.CollisionObject(fcl.Box(*(solid.size / unit)))
    box.setRotation(solid.rotation)
    box.setTranslation(centre)
    return box, centre, 0.0


def placed(shape: object, frame: Floats, centre: Floats) -> fcl.CollisionObject:
    """A shape in its place; setters cost half of what a Transform does.

    Args:
        shape: FCL's shape.
        frame: Its rotation as a quaternion (w, x, y, z).
        centre: Its centre, shape (3,).

    Returns:
        The solid.
    """
    solid = fcl.CollisionObject(shape)
    solid.setQuatRotation(frame)
    solid.setTranslation(centre)
    return solid


def quaternions(directions: Floats) -> Floats:
    """Rotations that lay the z axis along lines, one way or the other.

    What is laid so must be the same from both ends, as capsules and cylinders are:
    the nearer way is far from the one direction where the formula has no value.

    Args:
        directions: Unit vectors, shape (n, 3).

    Returns:
        Quaternions (w, x, y, z), shape (n, 4).
    """
    x, y, z = directions.T
    way, up = np.copysign(1.0, z), 1 + np.abs(z)
    turns = np.zeros((len(directions), 4))
    turns[:, 0], turns[:, 1], turns[:, 2] = up, -y * way, x * way
    turns /= np.sqrt(2 * up)[:, None]
    return turns


def nearest_points(
    first: Solids, second: Solids, *, signed: bool
) -> tuple[Floats, Floats, Floats]:
    """Distances of pairs of solids and the nearest points of both.

    Where solids overlap and a sign is wanted, the depth is that of a contact: FCL's
    own signed distance is wrong at a touch and ends the process for thin boxes.

    Args:
        first: Solids, n of them.
        second: The other solid of each pair.
        signed: Whether a sign is wanted.

    Returns:
        Distances, shape (n,), and points on the first and the second, shape (n, 3).
    """
    request = fcl.DistanceRequest(True)
    table = np.empty((len(first), 7))
    for row, one, other in zip(table, first, second, strict=True):
        result = fcl.DistanceResult()
        row[0] = fcl.distance(one, other, request, result)
        row[1:4], row[4:7] = result.nearest_points
        if signed and row[0] <= 0:
            row[:] = _contact(one, other, row)
    return table[:, 0], table[:, 1:4], table[:, 4:7]


def _contact(
    one: fcl.CollisionObject, other: fcl.CollisionObject, row: Floats
) -> Floats:
    """Minus the depth of an overlap and the deepest points of both, shape (7,)."""
    result = fcl.CollisionResult()
    request = fcl.CollisionRequest(num_max_contacts=1, enable_contact=True)
    if not fcl.collide(one, other, request, result):
        return np.concatenate([[0.0], row[1:]])
    contact = result.contacts[0]
    middle, depth = np.asarray(contact.pos), contact.penetration_depth
    half = depth / 2 * np.asarray(contact.normal)
    return np.concatenate([[-depth], middle + half, middle - half])
