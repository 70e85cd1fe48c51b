"""Contacts and their friction: wrenches, pyramids, and what is refused."""

from __future__ import annotations

import numpy as np
import pytest
from stances import perched, ring

from zygopin.branch import Branch
from zygopin.contacts import Contacts, Friction, branch_contacts
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.grasp import check_grasp
from zygopin.kinematics import forward_kinematics


def test_a_wrench_by_hand():
    # At (2, 0, 0) about (1, 0, 0), force (0, 3, 0): torque (0, 0, 3) N·m; over 0.5 m.
    contacts = Contacts([[2, 0, 0]], [[1, 0, 0]], origin=[1, 0, 0], scale=0.5)
    assert contacts.wrenches(np.array([[0.0, 3.0, 0.0]])) == pytest.approx(
        np.array([[0, 3, 0, 0, 0, 6.0]])
    )
    assert contacts.wrench_at([0, 3, 0], [2, 0, 0]) == pytest.approx([0, 3, 0, 0, 0, 6])


def test_normals_are_made_unit_and_arrays_are_copies():
    points, normals = np.array([[1.0, 0, 0]]), np.array([[5.0, 0, 0]])
    contacts = Contacts(points, normals)
    points[:], normals[:] = 7, 7
    assert contacts.points.tolist() == [[1, 0, 0]]
    assert contacts.normals.tolist() == [[1, 0, 0]]
    with pytest.raises(ValueError, match="read-only"):
        contacts.points[0] = 0


@pytest.mark.parametrize("edges", [3, 8, 17])
def test_the_pyramids_lie_on_both_sides_of_the_cone(edges):
    normals = np.random.default_rng(3).normal(size=(5, 3))
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    friction = Friction(0.7, edges)
    inner, outer = (friction.forces(normals, around=a) for a in (False, True))
    for forces, reach in ((inner, 0.7), (outer, 0.7 / np.cos(np.pi / edges))):
        along = np.einsum("nei,ni->ne", forces, normals)
        across = forces - along[..., None] * normals[:, None]
        assert along == pytest.approx(1)
        assert np.linalg.norm(across, axis=-1) == pytest.approx(reach)
    sides = np.diff(outer, axis=1) / 2 + outer[:, :-1] - normals[:, None]
    assert np.linalg.norm(sides, axis=-1) == pytest.approx(0.7)  # touches the cone


def test_contacts_of_a_perch_are_its_touching_phalanges():
    plan = perched()
    contacts = branch_contacts(plan.report)
    assert contacts.phalanges.tolist() == np.flatnonzero(plan.report.touching).tolist()
    gaps = np.linalg.norm((contacts.points - contacts.origin)[:, [0, 2]], axis=-1)
    assert gaps == pytest.approx(contacts.scale, rel=1e-9)  # the branch lies along y
    assert contacts.origin == pytest.approx(plan.branch.centre)


def test_a_junction_that_two_phalanges_share_is_one_contact():
    foot = Foot.preset("parrot").replace(thickness=0.0)
    controls, angle, radius = np.zeros(14), 0.4, 0.005
    controls[3] = angle / foot.omega  # finger 2 bends down after its first phalanx
    junction = forward_kinematics(foot, controls)[2, 1]
    ahead = junction / np.linalg.norm(junction)
    outward = np.array([0, 0, 1.0]) + np.tan(angle / 2) * ahead
    centre = junction + radius * outward / np.linalg.norm(outward)
    axis = np.cross(outward, ahead)
    report = check_grasp(foot, controls, Branch(radius, centre, axis))
    assert report.touching[[2, 3]].all()
    contacts = branch_contacts(report)
    assert contacts.phalanges.tolist() == [2]
    assert contacts.points[0] == pytest.approx(junction)


@pytest.mark.parametrize("value", [-0.1, np.nan, np.inf, "0.5", 1e9])
def test_an_impossible_friction_is_one_line(value):
    with pytest.raises(ParameterError, match=r"friction = .*from 0 to 1000") as caught:
        Friction(value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("edges", [2, 65, 8.5])
def test_edges_are_a_few(edges):
    with pytest.raises(ParameterError, match=r"friction\.edges"):
        Friction(0.5, edges)


def test_no_contacts_are_refused():
    with pytest.raises(ParameterError, match="at least one contact"):
        Contacts(np.zeros((0, 3)), np.zeros((0, 3)))
    foot = Foot.preset("parrot")
    report = check_grasp(foot, np.zeros(14), Branch(0.01, (0, 0, -0.05)))
    with pytest.raises(ParameterError, match="touches the branch"):
        branch_contacts(report)


def test_coincident_contacts_are_refused_by_number():
    with pytest.raises(ParameterError, match="1 and 2 at one place"):
        ring(0, 120, 120)


def test_a_normal_of_length_zero_is_refused():
    with pytest.raises(ParameterError, match=r"normals\[1\]"):
        Contacts(np.eye(3)[:2], [[1, 0, 0], [0, 0, 0]])


def test_a_batch_of_stances_is_refused():
    foot = Foot.preset("parrot")
    report = check_grasp(foot, np.zeros((2, 14)), Branch(0.01, (0, 0, -0.05)))
    with pytest.raises(ParameterError, match="one stance"):
        branch_contacts(report)
