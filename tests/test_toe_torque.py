"""Torques at the joints: Pinocchio against the lever by hand; tendons."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from stances import perched

from zygopin.branch import Branch
from zygopin.contacts import Contacts, Friction, branch_contacts
from zygopin.errors import ParameterError
from zygopin.foot import Finger, Foot
from zygopin.grasp import check_grasp
from zygopin.hold import UP
from zygopin.load import bearing_forces, pull_limit
from zygopin.model import FootModel
from zygopin.strength import Strength
from zygopin.toe_torque import joint_drive, joint_torques, tendon_drive, torque_matrix


@pytest.mark.parametrize("name", ["parrot", "owl"])
def test_the_lever_of_each_force_about_each_joint(name):
    plan = perched(name)
    foot, bones = plan.report.foot, plan.report.bones
    contacts = branch_contacts(plan.report)
    matrix = torque_matrix(FootModel(foot), plan.controls, contacts)
    finger = foot.finger_of_phalanx
    for k in range(foot.phalanx_count):
        azimuth = foot.fingers[finger[k]].azimuth
        axis = np.array([-np.sin(azimuth), np.cos(azimuth), 0])
        for n, (point, rank) in enumerate(
            zip(contacts.points, contacts.phalanges, strict=True)
        ):
            beyond = finger[rank] == finger[k] and rank >= k
            lever = np.cross(axis, point - bones[k, 0]) * beyond
            assert matrix[k, n] == pytest.approx(lever, abs=1e-15)


def test_a_branch_that_pushes_up_opens_the_toe_by_hand():
    # A straight toe along x, pushed up by 2 N at 30 mm: 0.06 N m to open it.
    foot = Foot(rho=2.0, scale=0.1, fingers=(Finger("toe", 1, 0.0),))
    contacts = Contacts([[0.03, 0, 0]], [[0, 0, 1]], phalanges=[0])
    matrix = torque_matrix(FootModel(foot), np.zeros(1), contacts)
    assert matrix[0, 0] @ [0, 0, 2] == pytest.approx(-0.06)


def test_joints_bear_the_weight_of_a_bird_by_virtual_work():
    # Toes that turn by δq against torques τ lift the load by the work of its forces.
    plan = perched()
    model, contacts = FootModel(plan.report.foot), branch_contacts(plan.report)
    weight = contacts.wrench_at([0, 0, -0.4], [0, 0, 0.02])
    forces = bearing_forces(contacts, Strength(5.0, Friction(0.5)), weight)
    torques = joint_torques(model, plan.controls, contacts, forces)
    turn = 1e-7 * np.random.default_rng(2).normal(size=14)
    moved = model.forward(plan.controls + turn / model.foot.omega)
    before = model.forward(plan.controls)
    # A contact's point rides on its phalanx: rigid, in the plane of its finger.
    work = 0.0
    for point, rank, force in zip(
        contacts.points, contacts.phalanges, forces, strict=True
    ):
        here, there = before[rank], moved[rank]
        spin = np.cross(here[1] - here[0], there[1] - there[0])
        spin /= np.sum((here[1] - here[0]) ** 2)
        work += force @ (there[0] - here[0] + np.cross(spin, point - here[0]))
    assert torques @ turn == pytest.approx(-work, rel=1e-5)
    with pytest.raises(ParameterError, match="forces"):
        joint_torques(model, plan.controls, contacts, forces[1:])


def test_a_contact_of_no_phalanx_has_no_torque():
    contacts = Contacts([[0.03, 0, 0]], [[0, 0, 1]])
    with pytest.raises(ParameterError, match=r"phalanges\[0\] = -1"):
        torque_matrix(FootModel(Foot.preset("parrot")), np.zeros(14), contacts)


def test_a_toe_of_one_joint_presses_with_tension_times_arm_over_lever():
    # One straight toe along x over a branch across, at 0.04 from the joint: N·0.04 =
    # tension·arm. Frictionless, it bears a pull up of just that.
    foot = Foot(rho=2.0, scale=0.1, thickness=0.01, fingers=(Finger("toe", 1, 0.0),))
    branch = Branch(0.015, (0.04, 0, -0.02))
    report = check_grasp(foot, np.zeros(1), branch)
    contacts = branch_contacts(report)
    tendon = tendon_drive(FootModel(foot), report, contacts, tension=8.0)
    free = replace(tendon, straight=np.array([False]))
    firm = Strength(100.0, Friction(0.0), free)
    down = pull_limit(contacts, firm, [0, 0, -1], point=[0.04, 0, 0])
    assert tendon.torques.tolist() == [[8.0 * 0.005]]
    assert down.force == pytest.approx(8.0 * 0.005 / 0.04)
    # On its open stop the toe bears what the branch does: the stop closes it.
    stopped = Strength(100.0, Friction(0.0), tendon)
    rest = pull_limit(contacts, stopped, [0, 0, -1], point=[0.04, 0, 0])
    assert rest.force == pytest.approx(100.0)
    # The drive alone bounds it too, and a motor at the joint does as the tendon.
    alone = Strength(math.inf, Friction(0.0), free)
    motor = joint_drive(FootModel(foot), report, contacts, 0.04)
    own = Strength(math.inf, Friction(0.0), replace(motor, straight=free.straight))
    for strength in (alone, own):
        limit = pull_limit(contacts, strength, [0, 0, -1], point=[0.04, 0, 0])
        assert limit.force == pytest.approx(1.0)


def test_one_tension_for_all_joints_bears_less_than_any_torques():
    plan = perched()
    model, contacts = FootModel(plan.report.foot), branch_contacts(plan.report)
    tendon = tendon_drive(model, plan.report, contacts, 5.0)
    steep = replace(tendon, torques=tendon.torques * 0.5 ** np.arange(14.0)[:, None])
    for direction in np.eye(3):
        alone = pull_limit(contacts, Strength(1, Friction(1.0)), direction)
        for one in (tendon, steep):
            shared = Strength(1, Friction(1.0), one)
            assert pull_limit(contacts, shared, direction).force <= alone.force + 1e-9


def test_a_pull_under_tension_leaves_every_joint_balanced():
    plan = perched()
    foot, model = plan.report.foot, FootModel(plan.report.foot)
    contacts = branch_contacts(plan.report)
    shares = foot.rho ** (-2.0 * foot.rank_of_phalanx[:, None])
    tendon = tendon_drive(model, plan.report, contacts, 5.0)
    tendon = replace(tendon, torques=tendon.torques * shares)
    firm = Strength(1.0, Friction(1.0), tendon)
    limit = pull_limit(contacts, firm, [0, 0, -1])
    assert limit.force > 0.1
    torques = np.einsum("pni,ni->p", tendon.matrix, limit.contact_forces)
    for toe in range(4):
        joints = foot.finger_of_phalanx == toe
        tensions = -torques[joints] / tendon.torques[joints, toe]
        assert np.ptp(tensions) < 1e-9
        assert -1e-9 < tensions[0] <= 1 + 1e-9


def test_joints_with_motors_bear_no_torque_beyond_theirs():
    plan = perched()
    foot, model = plan.report.foot, FootModel(plan.report.foot)
    contacts, most = branch_contacts(plan.report), 1e-3
    motors = joint_drive(model, plan.report, contacts, np.full(14, most))
    limits = []
    for share in (1.0, 2.0):
        drive = replace(motors, torques=share * motors.torques)
        limits.append(
            pull_limit(contacts, Strength(math.inf, Friction(0.5), drive), UP)
        )
    torques = np.einsum("pni,ni->p", motors.matrix, limits[0].contact_forces)
    assert np.abs(torques).max() == pytest.approx(most)
    assert limits[1].force == pytest.approx(2 * limits[0].force)
    assert foot.phalanx_count == len(torques)


@pytest.mark.parametrize("tension", [0, -1, np.nan])
def test_a_tendon_pulls(tension):
    plan = perched()
    model, contacts = FootModel(plan.report.foot), branch_contacts(plan.report)
    with pytest.raises(ParameterError, match="tension"):
        tendon_drive(model, plan.report, contacts, tension)


def test_bare_bones_have_no_tendon():
    foot = Foot(rho=2.0, scale=0.1, fingers=(Finger("toe", 1, 0.0),))
    report = check_grasp(foot, np.zeros(1), Branch(0.015, (0.04, 0, -0.015)))
    with pytest.raises(ParameterError, match="thickness"):
        tendon_drive(FootModel(foot), report, branch_contacts(report), 1.0)


@pytest.mark.parametrize("torques", [0.0, -1.0, [1e-3] * 13, math.nan])
def test_motors_turn_every_joint(torques):
    plan = perched()
    model, contacts = FootModel(plan.report.foot), branch_contacts(plan.report)
    with pytest.raises(ParameterError, match="torques"):
        joint_drive(model, plan.report, contacts, torques)


def test_a_force_without_bound_needs_a_drive():
    with pytest.raises(ParameterError, match="toe force"):
        Strength(math.inf, Friction(0.5))
