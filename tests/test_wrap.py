"""Poses of one finger on a branch: none enters it, and they wrap as they should."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from zygopin.branch import Branch, branch_axis
from zygopin.clearance import branch_clearance
from zygopin.foot import Finger, Foot
from zygopin.grasp import Criteria, check_grasp
from zygopin.kinematics import forward_kinematics
from zygopin.wrap import WRAP_BIN, finger_poses

PARROT = Foot.preset("parrot")
SIZE = PARROT.size


def tolerance(foot):
    return Criteria().metres(foot)


def posed(foot, branches, finger=0, levels=7):
    return finger_poses(foot, finger, branches, levels, tolerance(foot))


def perches(foot=PARROT):
    """Branches below the foot: thin and thick, level and sloped, whole and cut."""
    radius = np.array([0.03, 0.2, 0.25, 0.7, 0.3, 1e5]) * foot.size
    angles = [(0, 0), (0, 0), (0.7, -0.2), (0.3, 0.5), (1.2, 0.0), (0, 0)]
    axis = np.array([branch_axis(*pair) for pair in angles])
    below = (radius + 0.06 * foot.size) / np.cos([pitch for _, pitch in angles])
    centre = np.stack([0 * below, 0 * below, -below], axis=1)
    lengths = np.array([9.0, 9.0, 9.0, 9.0, 0.2, 1e6]) * foot.size
    return Branch(radius, centre, axis, lengths)


def every_pose_enters(foot, part, branch):
    """Whether a thousand poses of a finger all enter a branch."""
    controls = np.zeros((1000, foot.phalanx_count))
    size = (1000, part.stop - part.start)
    controls[:, part] = np.random.default_rng(0).random(size)
    bones = forward_kinematics(foot, controls)[:, part]
    near = branch_clearance(bones, foot.radii[part], branch)
    return (near.distance.min(axis=1) < 0).all()


@pytest.mark.parametrize("foot", [PARROT, PARROT.replace(thickness=0.0)])
@pytest.mark.parametrize("finger", [0, 3])
def test_no_pose_enters_its_branch(foot, finger):
    branches = perches(foot)
    poses = posed(foot, branches, finger)
    assert (np.bincount(poses.place, minlength=6) > 0).all()
    assert (np.bincount(poses.place) < 130).all()
    part = foot.finger_slices[foot.fingers[finger].name]
    controls = np.zeros((len(poses.place), 14))
    controls[:, part] = poses.controls
    bones = forward_kinematics(foot, controls)[:, part]
    assert np.abs(bones - poses.bones).max() < 1e-14 * foot.size
    near = branch_clearance(bones, foot.radii[part], branches[poses.place])
    rounding = 1e-11 * foot.size + 1e-14 * branches.radius[poses.place]
    entering = near.distance.min(axis=1) < -rounding
    for place in poses.place[entering]:
        assert (poses.place == place).sum() == 1
        assert every_pose_enters(foot, part, branches[place])
    assert near.distance == pytest.approx(poses.clearance, abs=1e-9 * foot.size)
    assert ((poses.controls >= 0) & (poses.controls <= 1)).all()
    assert (poses.touching == (np.abs(near.distance) <= tolerance(foot))).all()
    assert (poses.tangent <= poses.touching).all()


def test_every_branch_in_reach_is_touched_and_the_thin_one_wrapped():
    poses = posed(PARROT, perches(), finger=3)
    for place in range(6):
        assert poses.touching[poses.place == place].any()
    farthest = poses.wrap[poses.place == 1].max()
    assert math.radians(120) < farthest < math.radians(300)


def bare_toe(omega=2.5, phalanges=4, azimuth=0.0):
    return Foot(rho=1.2, omega=omega, fingers=(Finger("toe", phalanges, azimuth),))


@pytest.mark.parametrize("azimuth", [0.0, math.pi])
@pytest.mark.parametrize("radius", [0.2, 0.3, 0.5, 1.0])
def test_consecutive_tangent_phalanges_turn_by_twice_the_arctangent(azimuth, radius):
    # MODEL.md, section 4, "Conforming wrap": bare bones across the branch.
    foot = bare_toe(azimuth=azimuth)
    ahead = 0.5 * math.cos(azimuth)
    poses = posed(foot, Branch([radius], (ahead, 0, -radius)), levels=13)
    near = branch_clearance(
        poses.bones, foot.radii, Branch(radius, (ahead, 0, -radius))
    )
    pairs = poses.tangent[:, :-1] & poses.tangent[:, 1:]
    inner = (near.t[:, :-1] > 1e-6) & (near.t[:, :-1] < 1 - 1e-6)
    row, k = np.nonzero(pairs & inner)
    assert len(row) > 1
    rest = (1 - near.t[row, k]) * foot.lengths[k]  # from the contact to the joint
    turn = foot.omega * poses.controls[row, k + 1]
    expected = 2 * np.arctan(rest / radius)
    assert turn == pytest.approx(expected, abs=1e-5)
    assert near.t[row, k + 1] * foot.lengths[k + 1] == pytest.approx(rest, abs=1e-5)


def test_a_conforming_wrap_by_hand():
    # First phalanx straight, on top of the branch at x = 0.6 of 1/1.2.
    foot = bare_toe()
    first, second = foot.lengths[:2]
    radius, place = 0.4, 0.6
    turn_2 = 2 * math.atan((first - place) / radius)
    turn_3 = 2 * math.atan((second - (first - place)) / radius)
    poses = posed(foot, Branch([radius], (place, 0, -radius)), levels=7)
    found = poses.controls[
        poses.tangent[:, :3].all(axis=1) & (poses.controls[:, 0] == 0)
    ]
    assert len(found) > 0
    expected = np.array([turn_2, turn_3]) / foot.omega
    assert found[:, 1:3] == pytest.approx(np.tile(expected, (len(found), 1)), abs=1e-6)
    wrap = poses.wrap[poses.tangent[:, :3].all(axis=1)].max()
    assert wrap > turn_2 + turn_3 - math.atan2(place, radius) - 1e-3


def test_wrap_is_the_angle_from_the_line_nearest_to_the_base():
    # One toe flat on top: its contact is where the base is nearest. Wrap 0.
    poses = posed(bare_toe(phalanges=1), Branch([0.5], (0, 0, -0.5)))
    flat = poses.controls[:, 0] == 0
    assert poses.wrap[flat] == pytest.approx(0, abs=1e-7)
    # Ahead at the height of the base: contact on top is a quarter turn on.
    ahead = posed(bare_toe(phalanges=1), Branch([0.3], (0.6, 0, -1e-9 - 0.3)))
    straight = ahead.tangent[:, 0] & (ahead.controls[:, 0] < 1e-6)
    expected = math.atan2(0.6, 0.3)
    assert ahead.wrap[straight] == pytest.approx(expected, abs=1e-6)


def test_wrap_has_no_sense_of_the_axis():
    foot, branches = PARROT, perches()
    flipped = Branch(branches.radius, branches.centre, -branches.axis, branches.length)
    one, other = posed(foot, branches, 2), posed(foot, flipped, 2)
    assert one.controls == pytest.approx(other.controls, abs=1e-9)
    assert one.wrap == pytest.approx(other.wrap, abs=1e-6)


def test_mirrored_fingers_have_mirrored_poses():
    fingers = (Finger("left", 4, 0.3), Finger("right", 4, -0.3))
    foot = PARROT.replace(fingers=fingers)
    branch = Branch([0.2 * SIZE], (0, 0, -0.28 * SIZE))
    left, right = posed(foot, branch, 0), posed(foot, branch, 1)
    assert left.controls == pytest.approx(right.controls, abs=1e-9)
    assert left.bones == pytest.approx(right.bones * (1, -1, 1), abs=1e-9 * SIZE)


def test_poses_scale_with_foot_and_branch():
    # By a power of two every rounding is the same.
    large = PARROT.replace(scale=PARROT.scale * 64, thickness=PARROT.thickness * 64)
    small, other = posed(PARROT, perches(), 1), posed(large, perches(large), 1)
    assert small.controls == pytest.approx(other.controls, abs=1e-9)
    assert (small.tangent == other.tangent).all()


def test_a_batch_of_branches_is_a_loop():
    branches = perches()
    poses = posed(PARROT, branches, 3, levels=4)
    for place in range(6):
        alone = posed(PARROT, branches[[place]], 3, levels=4)
        mine = poses.take(poses.place == place)
        assert mine.controls == pytest.approx(alone.controls, abs=1e-9)


def test_a_branch_that_every_pose_enters_gets_the_straight_one():
    # The base's own skin is in the bark.
    near = Branch([0.5 * SIZE], (0, 0, -0.5 * SIZE))
    poses = posed(PARROT, near)
    assert poses.controls.tolist() == [[0.0, 0.0]]
    assert poses.clearance.min() < 0


def test_a_branch_out_of_reach_is_not_touched():
    poses = posed(PARROT, Branch([SIZE], (0, 0, -9 * SIZE)), finger=3)
    assert len(poses.place) > 1
    assert not poses.touching.any()
    assert (poses.wrap == -np.inf).all()


def test_one_pose_is_kept_for_each_bin():
    poses = posed(PARROT, Branch([0.2 * SIZE], (0, 0, -0.3 * SIZE)), finger=3)
    wrapped = np.isfinite(poses.wrap)
    tips = np.floor(poses.bones[:, -1, 1, :] @ _forward(3) / (0.12 * SIZE))
    bins = np.stack([np.floor(poses.wrap[wrapped] / -WRAP_BIN), tips[wrapped]], axis=1)
    assert len(np.unique(bins, axis=0)) >= wrapped.sum() - 1


def _forward(finger):
    azimuth = PARROT.fingers[finger].azimuth
    return np.array([math.cos(azimuth), math.sin(azimuth), 0.0])


def test_a_finger_of_twelve_phalanges_is_posed_within_its_means():
    foot = Foot(
        rho=1.2, omega=1.5, scale=1.0, thickness=0.1, fingers=(Finger("toe", 12, 0.0),)
    )
    poses = posed(foot, Branch([0.8], (0, 0, -0.9)), levels=33)
    assert poses.tangent.sum(axis=1).max() >= 6


def test_a_contact_is_tangent_for_the_fcl_engine_too():
    foot = dataclasses.replace(PARROT, fingers=PARROT.fingers[3:])
    branch = Branch(0.25 * SIZE, (0, 0, -0.33 * SIZE))
    poses = posed(foot, branch.broadcast((1,)))
    assert poses.tangent.sum() > 10
    report = check_grasp(foot, poses.controls, branch, engine="fcl")
    assert (report.tangent == poses.tangent).all()
