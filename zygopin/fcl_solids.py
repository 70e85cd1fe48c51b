"""Solids as python-fcl has them, and the nearest points of two."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from itertools import repeat

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
    frames = quaternions(lines / lengths[:, None]).tolist()
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
    straight = (1.0, 0.0, 0.0, 0.0)
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


def placed(
    shape: object, frame: Sequence[float], centre: Floats
) -> fcl.CollisionObject:
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


def bare_distances(
    first: Iterable[fcl.CollisionObject], second: Iterable[fcl.CollisionObject]
) -> Iterator[float]:
    """Distances of pairs of solids, without nearest points.

    Args:
        first: Solids, n of them.
        second: The other solid of each pair.

    Returns:
        FCL's distances, n of them, made when they are asked for.
    """
    # A result that holds less already is not written to: an eighth of the time.
    request, full = fcl.DistanceRequest(), fcl.DistanceResult(-np.inf)
    return map(fcl.distance, first, second, repeat(request), repeat(full))


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
    request, result = fcl.DistanceRequest(True), fcl.DistanceResult()
    gaps, points = [], [np.empty(0)]
    for one, other in zip(first, second, strict=True):
        result.min_distance = np.inf  # it keeps the nearest of all that it is given
        gap, ends = fcl.distance(one, other, request, result), result.nearest_points
        if signed and gap <= 0:
            gap, ends = _contact(one, other, ends)
        gaps.append(gap)
        points += ends
    near_far = np.concatenate(points).reshape(-1, 2, 3)
    return np.array(gaps), near_far[:, 0], near_far[:, 1]


def _contact(
    one: fcl.CollisionObject, other: fcl.CollisionObject, ends: list[Floats]
) -> tuple[float, list[Floats]]:
    """Minus the depth of an overlap, and the deepest points of both."""
    result = fcl.CollisionResult()
    request = fcl.CollisionRequest(num_max_contacts=1, enable_contact=True)
    if not fcl.collide(one, other, request, result):
        return 0.0, ends
    contact = result.contacts[0]
    middle, depth = np.asarray(contact.pos), contact.penetration_depth
    half = depth / 2 * np.asarray(contact.normal)
    return -depth, [middle + half, middle - half]
