"""Clearance between a foot's phalanges and any solid that it can meet."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from zygopin import checks, kinds
from zygopin.branch import Branch
from zygopin.clearance import (
    Clearance,
    Floats,
    Nearest,
    branch_clearance,
    dot,
    norm,
    segment_offset,
)
from zygopin.engine import ENGINES, EngineName
from zygopin.obstacle import (
    Box,
    Capsule,
    ConvexMesh,
    Obstacle,
    Solid,
    Sphere,
    as_obstacle,
)
from zygopin.polytope import Polytope

AT_END = 1e-9
"""How near to 0 or 1 rounding leaves the t of a nearest point at a bone's end."""

LEVEL = 1e-9
"""Slope of the distance along a bone below which its end is no nearer than the rest
of its line: rounding of a normal."""

ON_CORE = 1e-12
"""Distance from the core over the radius below which it has no direction."""

Route = Callable[[Floats], Nearest]


def obstacle_clearance(
    bones: ArrayLike,
    radii: ArrayLike,
    obstacle: Obstacle,
    *,
    engine: EngineName | None = None,
) -> Clearance:
    """Clearance between phalanges and an obstacle.

    clearance = dist(bone, solid) − εₖ outside. Where the bone enters the solid, the
    distance is minus the depth of its deepest point; FCL tells a way out of a box, of
    a mesh or of a branch's end instead, which is never less.

    Args:
        bones: Bones in the world frame [m], shape (…, P, 2, 3).
        radii: Skin radii εₖ ≥ 0 [m], shape (P,).
        obstacle: The obstacle, in the world frame.
        engine: `exact`, the default, or `fcl`, which shares nothing with it.

    Returns:
        The record, with the bones' batch shape. `lateral` is true throughout except
        at the ends of a branch, and t is where the line of the bone is nearest.

    Raises:
        ParameterError: Bones or radii of the wrong shape, not finite, of no length or
            negative; or no obstacle.
        UnknownNameError: There is no engine of that name.
    """
    if engine is not None:
        kinds.one_of("engine", engine, ENGINES)
    solid = as_obstacle(obstacle)
    lines, skins = _checked(bones, radii)
    if isinstance(solid, Branch):
        return _kept(_branch(lines, skins, solid, engine))
    flat = lines.reshape(-1, 2, 3)
    route = _exact(solid) if engine != "fcl" else _fcl(solid)
    found = route(flat)
    core = flat[:, 0] + found.t[:, None] * (flat[:, 1] - flat[:, 0])
    point = core - found.gap[:, None] * found.normal
    shape = lines.shape[:-2]
    return _kept(
        Clearance(
            found.gap.reshape(shape) - skins,
            _on_line(flat, found, solid, route).reshape(shape),
            point.reshape(*shape, 3),
            found.normal.reshape(*shape, 3),
            np.ones(shape, dtype=bool),
        )
    )


def _kept(found: Clearance) -> Clearance:
    """The record, its arrays made read-only."""
    for values in vars(found).values():
        checks.read_only(values)
    return found


def _checked(bones: ArrayLike, radii: ArrayLike) -> tuple[Floats, Floats]:
    """Bones and radii as arrays that fit together."""
    skins = checks.array("radii", radii)
    checks.shaped("radii", skins, (None,))
    checks.require("radii", skins, skins >= 0, "at least 0", "give metres")
    lines = checks.places("bones", bones)
    tail = (len(skins), 2, 3)
    checks.shaped("bones", lines, (*lines.shape[:-3], *tail))
    lengths = norm(lines[..., 1, :] - lines[..., 0, :])
    remedy = "give a bone two ends that are apart"
    checks.require("length of bones", lengths, lengths > 0, "positive", remedy)
    return lines, skins


def _branch(
    bones: Floats, radii: Floats, branch: Branch, engine: EngineName | None
) -> Clearance:
    """Clearance from a branch, by the engine that there is for it."""
    if engine != "fcl":
        return branch_clearance(bones, radii, branch)
    from zygopin import collision  # FCL takes a quarter of a second

    # Seen from the foot: FCL's engine takes lengths in units of the distance from 0.
    origin = bones.reshape(-1, 3)[0] if bones.size else np.zeros(3)
    near = branch.moved_to(branch.centre - origin)
    found = collision.branch_clearance(bones - origin, radii, near)
    found.point[...] += origin
    return found


def _exact(solid: Solid) -> Route:
    """The closed forms for a solid."""
    if isinstance(solid, (Box, ConvexMesh)):
        return Polytope.of(solid).nearest
    return partial(_to_core, solid)


def _fcl(solid: Solid) -> Route:
    """FCL's queries for a solid."""
    from zygopin import collision  # FCL takes a quarter of a second

    return lambda bones: collision.solid_nearest(bones, solid)


def _to_core(solid: Sphere | Capsule, bones: Floats) -> Nearest:
    """Where bones are nearest to the core of a sphere or capsule."""
    line = bones[:, 1] - bones[:, 0]
    if isinstance(solid, Sphere):
        start, along = bones[:, 0] - solid.centre, np.zeros(3)
        t = np.clip(-dot(start, line) / dot(line, line), 0.0, 1.0)
        offset = start + t[:, None] * line
    else:
        along = solid.ends[1] - solid.ends[0]
        t, offset = segment_offset(bones, solid.ends)
    length = norm(offset)[:, None]
    # Where the bone meets the core, a normal across both.
    across = np.cross(line, along)
    spare = np.cross(line, np.eye(3)[np.argmin(np.abs(line), axis=1)])
    flat = norm(across) <= ON_CORE * norm(line) * norm(along)
    across = np.where(flat[:, None], spare, across)
    away = across / norm(across)[:, None]
    normal = np.divide(offset, length, away, where=length > ON_CORE * solid.radius)
    return Nearest(t, length[:, 0] - solid.radius, normal)


def _on_line(bones: Floats, found: Nearest, solid: Solid, route: Route) -> Floats:
    """From the nearest point of the bone to that of its line, where that is off it."""
    line = bones[:, 1] - bones[:, 0]
    slope = dot(found.normal, line) / norm(line)
    before = (found.t <= AT_END) & (slope > LEVEL)
    beyond = (found.t >= 1 - AT_END) & (slope < -LEVEL)
    off = before | beyond
    t = found.t.copy()
    if off.any():
        # The line is nearest within the solid's reach of its point nearest the middle.
        middle, reach = _ball(solid)
        start, line = bones[off, 0], line[off]
        square = dot(line, line)
        centre = dot(middle - start, line) / square
        half = reach / np.sqrt(square)
        window = np.stack([centre - half, centre + half], axis=1)
        ends = start[:, None] + window[..., None] * line[:, None]
        t[off] = centre + (2 * route(ends).t - 1) * half
    return np.asarray(t)


def _ball(solid: Solid) -> tuple[Floats, float]:
    """Centre and radius of a ball that holds a solid."""
    if isinstance(solid, Sphere):
        return solid.centre, solid.radius
    if isinstance(solid, Box):
        return solid.centre, float(norm(solid.size)) / 2
    points = solid.ends if isinstance(solid, Capsule) else solid.vertices
    middle = points.mean(axis=0)
    skin = solid.radius if isinstance(solid, Capsule) else 0.0
    return middle, float(norm(points - middle).max()) + skin
