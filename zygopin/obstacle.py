"""Convex solids that a foot can meet: where they are, and what they are made of."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.branch import Branch
from zygopin.errors import ParameterError
from zygopin.rotations import as_rotations

CONVEX = 1e-9
"""How far a vertex may lie outside a face, over the mesh's size: rounding in files."""

SLIVER = 1e-15
"""The same for a triangle whose area vanishes, over size³ and not divided by it."""

FLAT = 1e-6
"""Thickness of a mesh over its width below which its vertices count as coplanar."""

MOST_VERTICES = 1000
"""Vertices that a mesh may have: each triangle is held against each of them."""


@dataclass(frozen=True, eq=False)
class Sphere:
    """A solid ball.

    Attributes:
        radius: Radius > 0 [m].
        centre: Its centre [m], shape (3,).
    """

    radius: float
    centre: NDArray[np.float64]

    def __init__(self, radius: float, centre: ArrayLike) -> None:
        object.__setattr__(self, "radius", checks.length("sphere.radius", radius))
        object.__setattr__(self, "centre", _places("sphere.centre", centre, (3,)))


@dataclass(frozen=True, eq=False)
class Box:
    """A solid box.

    Attributes:
        size: Lengths of its edges > 0 [m], shape (3,).
        centre: Its centre [m], shape (3,).
        rotation: R_world_box, shape (3, 3); given None: along the world's axes.
    """

    size: NDArray[np.float64]
    centre: NDArray[np.float64]
    rotation: NDArray[np.float64]

    def __init__(
        self, size: ArrayLike, centre: ArrayLike, rotation: ArrayLike | None = None
    ) -> None:
        size = checks.lengths("box.size", size, last=3)
        checks.shaped("box.size", size, (3,))
        turn = np.eye(3) if rotation is None else _rotation("box.rotation", rotation)
        object.__setattr__(self, "size", size)
        object.__setattr__(self, "centre", _places("box.centre", centre, (3,)))
        object.__setattr__(self, "rotation", checks.read_only(turn))


@dataclass(frozen=True, eq=False)
class Capsule:
    """A solid cylinder with a half ball on either end.

    Attributes:
        radius: Radius > 0 [m].
        ends: Ends of its core segment, which are apart [m], shape (2, 3).
    """

    radius: float
    ends: NDArray[np.float64]

    def __init__(self, radius: float, ends: ArrayLike) -> None:
        ends = _places("capsule.ends", ends, (2, 3))
        length = float(np.linalg.norm(ends[1] - ends[0]))
        if length < checks.SMALLEST:
            allowed = f"at least {checks.SMALLEST:g} m"
            remedy = "move them apart, or take a Sphere"
            name = "distance between capsule.ends"
            raise ParameterError(name, length, allowed, remedy)
        object.__setattr__(self, "radius", checks.length("capsule.radius", radius))
        object.__setattr__(self, "ends", ends)


@dataclass(frozen=True, eq=False)
class ConvexMesh:
    """A solid convex polyhedron.

    Attributes:
        vertices: Vertices [m], shape (V, 3); without triangles, those of the given
            points that are corners of their convex hull.
        triangles: Vertices of each face, counter-clockwise from outside, shape
            (T, 3); given None: those of the vertices' convex hull.
        planes: The solid is where n·x ≤ d: unit normals n and d [m] of its faces,
            shape (F, 4).
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.intp]
    planes: NDArray[np.float64] = field(init=False)

    def __init__(self, vertices: ArrayLike, triangles: ArrayLike | None = None) -> None:
        points = _places("mesh.vertices", vertices, (None, 3))
        middle, unit = _middle_and_size(points)
        local = (points - middle) / unit
        _check_solid(local)
        from scipy.spatial import ConvexHull  # only meshes need SciPy

        hull = ConvexHull(local)
        if triangles is None:
            listed = hull.simplices.astype(np.intp)
            faces = _outward(local, listed, hull.equations[:, :3])
            corners, places = np.unique(faces, return_inverse=True)
            points, faces = points[corners], places.reshape(-1, 3).astype(np.intp)
        else:
            faces = _indices(triangles, len(points))
            _check_closed(faces)
        _check_count(points)
        if triangles is not None:
            _check_convex(local, faces)
        planes = np.unique(hull.equations * (1, 1, 1, -unit), axis=0)
        planes[:, 3] += planes[:, :3] @ middle
        object.__setattr__(self, "vertices", checks.read_only(points))
        object.__setattr__(self, "triangles", checks.read_only(faces))
        object.__setattr__(self, "planes", checks.read_only(planes))


Solid = Sphere | Box | Capsule | ConvexMesh
"""A solid that is no branch."""

Obstacle = Branch | Solid
"""What a foot can meet; a `Branch` here is one, not a batch."""

_NOUNS = {
    Branch: "branch",
    Sphere: "ball",
    Box: "box",
    Capsule: "capsule",
    ConvexMesh: "polyhedron",
}


def as_obstacle(value: object) -> Obstacle:
    """The value, if a foot can meet it.

    Args:
        value: What was given.

    Returns:
        The value.

    Raises:
        ParameterError: It is no obstacle, or a batch of branches.
    """
    if not isinstance(value, Obstacle):
        allowed = "a Branch, Sphere, Box, Capsule or ConvexMesh"
        raise ParameterError("obstacle", value, allowed, "make one of these")
    if isinstance(value, Branch) and value.batch_shape:
        remedy = "take one branch at a time"
        raise ParameterError("obstacle batch", value.batch_shape, "()", remedy)
    return value


def obstacle_noun(obstacle: Obstacle) -> str:
    """What an obstacle is called.

    Args:
        obstacle: The obstacle.

    Returns:
        A noun in plain English, such as `ball`.
    """
    return _NOUNS[type(obstacle)]


def _places(
    name: str, value: ArrayLike, shape: tuple[int | None, ...]
) -> NDArray[np.float64]:
    """Points as an array of a given shape."""
    places = checks.places(name, value)
    checks.shaped(name, places, shape)
    return places


def _rotation(name: str, value: ArrayLike) -> NDArray[np.float64]:
    """The rotation nearest to a matrix that is one but for rounding."""
    given = checks.array(name, value, last=3)
    checks.shaped(name, given, (3, 3))
    return as_rotations(name, given)


def _middle_and_size(points: NDArray[np.float64]) -> tuple[NDArray[np.float64], float]:
    """The middle of some points, and how far they reach from it."""
    if len(points) < 4:
        remedy = "give the corners of a solid"
        raise ParameterError("mesh.vertices", len(points), "at least 4", remedy)
    middle = (points.min(axis=0) + points.max(axis=0)) / 2
    size = float(np.abs(points - middle).max())
    if size < checks.SMALLEST:
        allowed = f"at least {checks.SMALLEST:g} m"
        raise ParameterError("size of the mesh", size, allowed, "give it in metres")
    return middle, size


def _check_solid(local: NDArray[np.float64]) -> None:
    """Points, in units of their size, that do not lie in one plane."""
    spread = np.linalg.svd(local - local.mean(axis=0), compute_uv=False)
    flat = float(spread[2] / spread[0])
    if flat < FLAT:
        name, allowed = "thickness of the mesh over its width", f"at least {FLAT:g}"
        raise ParameterError(name, flat, allowed, "give vertices that are not coplanar")


def _check_count(points: NDArray[np.float64]) -> None:
    """No more vertices than can be worked with."""
    if len(points) > MOST_VERTICES:
        allowed, remedy = f"at most {MOST_VERTICES}", "thin the mesh out"
        raise ParameterError("number of mesh.vertices", len(points), allowed, remedy)


def _outward(
    points: NDArray[np.float64],
    triangles: NDArray[np.intp],
    normals: NDArray[np.float64],
) -> NDArray[np.intp]:
    """Triangles turned to run counter-clockwise seen against their outward normals."""
    a, b, c = np.moveaxis(points[triangles], 1, 0)
    inward = np.einsum("ij,ij->i", np.cross(b - a, c - a), normals) < 0
    return np.where(inward[:, None], triangles[:, ::-1], triangles)


def _indices(triangles: ArrayLike, count: int) -> NDArray[np.intp]:
    """Triangles as indices of vertices."""
    given = checks.array("mesh.triangles", triangles, last=3)
    checks.shaped("mesh.triangles", given, (None, 3))
    good = (given >= 0) & (given < count) & (given == np.floor(given))
    allowed, remedy = f"an integer from 0 to {count - 1}", "count vertices from 0"
    checks.require("mesh.triangles", given, good, allowed, remedy)
    return given.astype(np.intp)


def _check_closed(faces: NDArray[np.intp]) -> None:
    """Every edge belongs to two triangles, which run along it in opposite senses."""
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    there = {(int(a), int(b)) for a, b in edges}
    lone = sorted((a, b) for a, b in there if (b, a) not in there or a == b)
    if lone or len(there) < len(edges) or not len(edges):
        allowed = "closed: each edge in two triangles, once in either sense"
        remedy = "mend it, or leave the triangles out for the convex hull"
        raise ParameterError("mesh.triangles", lone[:1], allowed, remedy)


def _check_convex(local: NDArray[np.float64], faces: NDArray[np.intp]) -> None:
    """No vertex lies outside a face; points in units of their size."""
    a, b, c = np.moveaxis(local[faces], 1, 0)
    normals = np.cross(b - a, c - a)
    above = normals @ local.T - np.einsum("ij,ij->i", normals, a)[:, None]
    areas = np.linalg.norm(normals, axis=1)[:, None]
    checks.require(
        "height of a vertex over a face, mesh",
        above / np.maximum(areas, SLIVER),
        above <= CONVEX * areas + SLIVER,
        "at most 0: it is not convex, or the face is inside out",
        "leave the triangles out for the convex hull",
    )
