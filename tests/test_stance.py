"""Stances: bones moved by the base, azimuths on their way round, and levers."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from strategies import controls_for, feet, reals

from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.stance import Stance, azimuths_at, levers


def base(seed):
    rng = np.random.default_rng(seed)
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.random(None, rng).as_matrix()
    matrix[:3, 3] = rng.normal(size=3)
    return matrix


def reversed_foot(foot):
    """The foot with every reversible toe at its reversed azimuth."""
    fingers = (
        dataclasses.replace(finger, azimuth=finger.azimuth + finger.reversal)
        for finger in foot.fingers
    )
    return foot.replace(fingers=tuple(fingers))


@given(st.data(), st.integers(0, 99))
def test_bones_are_forward_kinematics_moved_by_the_base(data, seed):
    foot = data.draw(feet())
    controls, pose = data.draw(controls_for(foot)), base(seed)
    bones = Stance(foot, pose, azimuths_at(foot, np.array(0.0)), controls).bones
    local = forward_kinematics(foot, controls)
    for found, expected in zip(bones.reshape(-1, 3), local.reshape(-1, 3), strict=True):
        point = pose @ np.append(expected, 1)
        assert found == pytest.approx(point[:3], rel=1e-9, abs=1e-9 * foot.size)


def test_a_batch_of_stances_is_one_after_the_other():
    foot, rng = Foot.preset("owl"), np.random.default_rng(3)
    poses = np.array([base(seed) for seed in range(4)])
    azimuths = azimuths_at(foot, np.linspace(0, 1, 4))
    controls = rng.random((4, foot.phalanx_count))
    together = Stance(foot, poses, azimuths, controls).bones
    assert together.shape == (4, foot.phalanx_count, 2, 3)
    for i in range(4):
        alone = Stance(foot, poses[i], azimuths[i], controls[i]).bones
        assert together[i] == pytest.approx(alone, abs=1e-15)


def test_reversal_turns_reversible_toes_and_no_others():
    foot = Foot.preset("owl")
    start, middle, end = azimuths_at(foot, np.array([0.0, 0.5, 1.0]))
    assert start.tolist() == [finger.azimuth for finger in foot.fingers]
    assert (end[:3] == start[:3]).all()
    assert end[3] == pytest.approx(foot.fingers[3].reversed_azimuth)
    assert middle[3] == pytest.approx((start[3] + end[3]) / 2)


def test_a_reversed_toe_is_one_at_the_reversed_azimuth():
    foot = Foot.preset("owl")
    controls = np.random.default_rng(1).random(foot.phalanx_count)
    turned = Stance(foot, np.eye(4), azimuths_at(foot, np.array(1.0)), controls)
    assert turned.bones == pytest.approx(
        forward_kinematics(reversed_foot(foot), controls), abs=1e-15
    )


def test_levers_are_sums_of_the_phalanges_between():
    foot = Foot(rho=2.0, scale=8.0, fingers=(Finger("a", 3, 0.0), Finger("b", 1, 1.0)))
    assert foot.lengths.tolist() == [4, 2, 1, 4]
    assert levers(foot).tolist() == [
        [4, 0, 0, 0],
        [6, 2, 0, 0],
        [7, 3, 1, 0],
        [0, 0, 0, 4],
    ]


@given(st.data(), reals(0, 1))
def test_levers_bound_the_distance_from_joint_to_phalanx(data, share):
    foot = data.draw(feet())
    bones = forward_kinematics(foot, data.draw(controls_for(foot)))
    points = bones[:, 0] + share * (bones[:, 1] - bones[:, 0])
    reach, finger = levers(foot), foot.finger_of_phalanx
    for k, point in enumerate(points):
        for j in np.flatnonzero((finger == finger[k]) & (np.arange(len(points)) <= k)):
            apart = np.linalg.norm(point - bones[j, 0])
            assert apart <= reach[k, j] * (1 + 1e-9)
