"""Obstacles: what they keep, and what no solid may be."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from zygopin.branch import Branch
from zygopin.errors import ParameterError
from zygopin.obstacle import Box, Capsule, ConvexMesh, Sphere, as_obstacle

CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
TETRAHEDRON = np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], float)
OUTWARD = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
ENDS = [(0, 0, 0), (0, 0, 1)]


def volume(mesh):
    """By the divergence theorem: positive where the triangles face outward."""
    a, b, c = np.moveaxis(mesh.vertices[mesh.triangles], 1, 0)
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


@pytest.mark.parametrize(
    ("solid", "names"),
    [
        (Sphere(1, [0, 0, -2]), ("centre",)),
        (Box([1, 2, 3], [0, 0, -2]), ("size", "centre", "rotation")),
        (Capsule(1, ENDS), ("ends",)),
        (ConvexMesh(CUBE), ("vertices", "triangles", "planes")),
        (ConvexMesh(TETRAHEDRON, OUTWARD), ("vertices", "triangles", "planes")),
    ],
)
def test_what_is_given_is_kept_as_arrays_that_cannot_be_written(solid, names):
    for name in names:
        with pytest.raises(ValueError, match="read-only"):
            getattr(solid, name)[0] = 1
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(solid, name, None)
    assert as_obstacle(solid) is solid


def test_what_is_given_is_copied():
    vertices, turn = CUBE.copy(), np.eye(3)
    mesh, box = ConvexMesh(vertices), Box((1, 1, 1), (0, 0, 0), turn)
    vertices[:], turn[:] = 7, 7
    assert mesh.vertices.max() == 1
    assert (box.rotation == np.eye(3)).all()


def test_a_box_lies_along_the_world_unless_it_is_turned():
    assert (Box((1, 2, 3), (0, 0, 0)).rotation == np.eye(3)).all()
    turn = Rotation.from_euler("xyz", (0.3, -0.4, 2.0)).as_matrix()
    rounded = Box((1, 2, 3), (0, 0, 0), np.round(turn, 10)).rotation
    assert rounded == pytest.approx(turn, abs=1e-9)
    assert rounded.T @ rounded == pytest.approx(np.eye(3), abs=1e-15)


def test_a_mesh_of_points_is_their_hull():
    inside = [(0.5, 0.5, 0.5), (0.2, 0.9, 0.4)]
    mesh = ConvexMesh([*inside, *CUBE.tolist()])
    assert sorted(map(tuple, mesh.vertices)) == sorted(map(tuple, CUBE))
    assert mesh.triangles.shape == (12, 3)
    assert volume(mesh) == pytest.approx(1)
    assert len(mesh.planes) == 6
    heights = mesh.vertices @ mesh.planes[:, :3].T - mesh.planes[:, 3]
    assert heights.max(axis=0) == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize("scale", [1e-9, 1.0, 1e9])
def test_a_hull_may_be_of_any_size_and_anywhere(scale):
    points = np.random.default_rng(0).normal(size=(60, 3)) + 5
    mesh = ConvexMesh(points * scale)
    again = ConvexMesh(mesh.vertices, mesh.triangles)
    assert volume(mesh) == pytest.approx(volume(ConvexMesh(points)) * scale**3)
    assert volume(again) == volume(mesh)
    assert (again.planes == mesh.planes).all()


def test_triangles_are_kept_as_given():
    mesh = ConvexMesh(TETRAHEDRON, OUTWARD)
    assert mesh.triangles.tolist() == [list(face) for face in OUTWARD]
    assert volume(mesh) == pytest.approx(1 / 6)


def test_a_dent_up_to_rounding_is_none():
    cube = ConvexMesh(CUBE)
    dented = cube.vertices + np.random.default_rng(1).normal(size=(8, 3)) * 1e-11
    assert volume(ConvexMesh(dented, cube.triangles)) == pytest.approx(1)


@pytest.mark.parametrize("length", [0, -1, math.nan, math.inf, 1e-13, 1e13, "1", None])
def test_a_length_that_is_none_is_one_line(length):
    for make in (
        lambda: Sphere(length, (0, 0, 0)),
        lambda: Capsule(length, ENDS),
        lambda: Box((1, length, 1), (0, 0, 0)),
    ):
        with pytest.raises(ParameterError, match=r"(radius|size)") as caught:
            make()
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Sphere([1, 2], (0, 0, 0)), r"sphere.radius.shape = \(2,\)"),
        (lambda: Sphere(1, [(0, 0, 0)]), r"sphere.centre.shape = \(1, 3\)"),
        (lambda: Sphere(1, (0, 0, math.nan)), r"sphere.centre\[2\] = nan"),
        (lambda: Sphere(1, (0, 0, 1e13)), r"sphere.centre\[2\] = .* within 1e\+12 m"),
        (lambda: Box(1, (0, 0, 0)), r"box.size.shape = \(\)"),
        (lambda: Box([(1, 1, 1)], (0, 0, 0)), r"box.size.shape = \(1, 3\)"),
        (lambda: Box((1, 1, 1), (0, 0, 0), np.ones(3)), "box.rotation.shape"),
        (
            lambda: Box((1, 1, 1), (0, 0, 0), 1e300 * np.eye(3)),
            "error of box.rotation = 3.0 is not within 1e-06 of orthonormal",
        ),
        (
            lambda: Box((1, 1, 1), (0, 0, 0), np.diag([1, 1, 1 - 1e-6])),
            "error of box.rotation = .* within 1e-06 of orthonormal",
        ),
        (
            lambda: Box((1, 1, 1), (0, 0, 0), np.diag([1, 1, -1])),
            "determinant of box.rotation = -1.0 is not 1: swap two columns",
        ),
        (lambda: Capsule(1, [(0, 0, 0)] * 2), "move them apart, or take a Sphere"),
        (lambda: Capsule(1, (0, 0, 1)), r"capsule.ends.shape = \(3,\)"),
        (lambda: ConvexMesh(CUBE[:3]), "mesh.vertices = 3 is not at least 4"),
        (lambda: ConvexMesh(CUBE * 0), "size of the mesh = 0.0"),
        (lambda: ConvexMesh(CUBE * (1, 1, 0)), "vertices that are not coplanar"),
        (lambda: ConvexMesh(CUBE + math.nan), r"mesh.vertices\[0, 0\] = nan"),
        (lambda: ConvexMesh(TETRAHEDRON, [(0, 1, 4)]), r"mesh.triangles\[0, 2\] = 4"),
        (lambda: ConvexMesh(TETRAHEDRON, [(0, 1, -1)]), r"mesh.triangles\[0, 2\] = -1"),
        (lambda: ConvexMesh(TETRAHEDRON, [(0, 1, 0.5)]), "not an integer from 0 to 3"),
        (lambda: ConvexMesh(TETRAHEDRON, OUTWARD[:3]), "closed: each edge in two"),
        (lambda: ConvexMesh(TETRAHEDRON, OUTWARD * 2), "closed: each edge in two"),
        (lambda: ConvexMesh(TETRAHEDRON, np.empty((0, 3), int)), "is not closed"),
        (
            lambda: ConvexMesh(TETRAHEDRON, np.fliplr(OUTWARD)),
            "not convex, or the face is inside out",
        ),
    ],
)
def test_what_is_no_solid_is_one_line(make, message):
    with pytest.raises(ParameterError, match=message) as caught:
        make()
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("dent", [1e-8, 1e-3, 0.2])
def test_a_mesh_that_is_not_convex_is_refused(dent):
    # A cube with a pyramid pressed into its top instead of put on it.
    raised = ConvexMesh([*CUBE, (0.5, 0.5, 1.2)])
    place = int(np.argmax(raised.vertices[:, 2]))
    pressed = raised.vertices.copy()
    pressed[place, 2] = 1 - dent
    with pytest.raises(ParameterError, match="leave the triangles out"):
        ConvexMesh(pressed, raised.triangles)
    assert volume(ConvexMesh(pressed)) == pytest.approx(1)


def test_a_mesh_of_too_many_vertices_is_refused():
    ball = np.random.default_rng(2).normal(size=(1500, 3))
    ball /= np.linalg.norm(ball, axis=1, keepdims=True)
    with pytest.raises(ParameterError, match=r"number of mesh.vertices = 1500"):
        ConvexMesh(ball)
    assert len(ConvexMesh(np.concatenate([ball / 3, CUBE - 0.5])).vertices) == 8


def test_a_branch_is_an_obstacle_and_a_batch_of_them_is_none():
    branch = Branch(0.01, (0, 0, 0))
    assert as_obstacle(branch) is branch
    with pytest.raises(ParameterError, match="take one branch at a time"):
        as_obstacle(Branch([1, 2], (0, 0, -9)))


@pytest.mark.parametrize("value", [None, 1.0, "ball", Sphere, (1, (0, 0, 0))])
def test_anything_else_is_no_obstacle(value):
    with pytest.raises(ParameterError, match="a Branch, Sphere, Box, Capsule or Conv"):
        as_obstacle(value)
