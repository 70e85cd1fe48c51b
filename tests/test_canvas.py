"""Solids recorded for the viewer, and the camera that looks at them."""

import numpy as np
import pytest
import umsgpack

from zygopin.branch import Branch, branch_axis
from zygopin.camera import DISTANCE, HIGHEST, LOWEST, framed, grasp_direction
from zygopin.canvas import Canvas, segment_pose
from zygopin.looks import Paint
from zygopin.viewer import Recorder

PAINT = Paint(0x804020)


def recorded(draw, unit=1.0):
    recorder = Recorder()
    draw(Canvas(recorder, np.zeros(3), unit))
    return [umsgpack.unpackb(message) for message in recorder.messages]


@pytest.mark.parametrize("end", [(1, 2, 3), (0, 0, 2), (0, 0, -2), (0, -1, 0)])
def test_segment_pose_is_right_handed_and_along(end):
    pose = segment_pose((1, 1, 1), np.add(end, 1))
    turn = pose[:3, :3]
    np.testing.assert_allclose(turn.T @ turn, np.eye(3), atol=1e-15)
    assert np.linalg.det(turn) == pytest.approx(1)
    np.testing.assert_allclose(turn[:, 0], end / np.linalg.norm(end), atol=1e-15)


def test_segment_pose_of_a_point_keeps_the_axes():
    np.testing.assert_array_equal(segment_pose((0, 0, 0), (0, 0, 0)), np.eye(4))


def test_capsule_is_a_cylinder_and_two_spheres_under_one_transform():
    ends = np.array([[0.0, 0, 0], [2.0, 0, 0]])
    commands = recorded(lambda canvas: canvas.capsule("a", ends, 0.5, PAINT))
    drawn = [c for c in commands if c["type"] == "set_object"]
    kinds = [c["object"]["geometries"][0]["type"] for c in drawn]
    assert kinds == ["CylinderGeometry", "SphereGeometry", "SphereGeometry"]
    assert [c["path"] for c in commands[-1:]] == ["/meshcat/a"]
    middle = next(
        c for c in commands if c["path"] == "/meshcat/a/shaft" and "matrix" in c
    )
    assert middle["matrix"][12:15] == [1, 0, 0]


def test_names_of_parts_differ_and_repeat():
    def draw(canvas):
        canvas.ball("a", (0, 0, 0), 1.0, PAINT)
        canvas.ball("b", (0, 0, 0), 1.0, PAINT)

    def names(commands):
        drawn = [c["object"] for c in commands if c["type"] == "set_object"]
        parts = [(o["object"], *o["geometries"], *o["materials"]) for o in drawn]
        return [part["uuid"] for three in parts for part in three]

    assert names(recorded(draw)) == names(recorded(draw))
    assert len(set(names(recorded(draw)))) == 6


def test_unit_scaling_leaves_the_scene_alone():
    def scene(unit):
        ends = unit * np.array([[0.1, 0.2, 0.3], [0.5, 0.1, 0.9]])
        return recorded(lambda c: c.arrow("a", ends, 0.01 * unit, PAINT), unit)

    assert scene(1.0) == scene(2.0**-10)


def test_frame_just_holds_a_ball():
    centre = np.array([[3.0, -2.0, 5.0]])
    view = framed(centre, np.array([0.25]), np.array([0.6, 0.0, 0.8]))
    np.testing.assert_allclose(view.target, centre[0], atol=1e-12)
    assert view.unit == pytest.approx(0.25)
    assert view.aspect == pytest.approx(1)
    assert DISTANCE * view.half_height == pytest.approx(1.12)


@pytest.mark.parametrize("yaw", [-1.5, 0.0, 0.9])
@pytest.mark.parametrize("pitch", [-1.5, 0.0, 0.8])
def test_eye_looks_along_the_branch_from_a_fair_height(yaw, pitch):
    axis = branch_axis(yaw, pitch)
    centre = np.cross(axis, (1.0, 0.3, 0.1))
    eye = grasp_direction(Branch(0.1, centre, axis))
    assert np.linalg.norm(eye) == pytest.approx(1)
    assert abs(eye @ axis) > 0.5
    assert LOWEST - 1e-12 <= np.arcsin(eye[2]) <= HIGHEST + 1e-12


def test_eye_is_defined_where_the_base_is_on_the_axis():
    eye = grasp_direction(Branch(0.1, (0, 5, 0), (0, 1, 0), length=2.0))
    assert np.linalg.norm(eye) == pytest.approx(1)
