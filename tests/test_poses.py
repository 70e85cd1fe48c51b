"""Named poses: what they set, and that `perch` is a grasp."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from zygopin.foot import Foot
from zygopin.grasp import Criteria, check_grasp
from zygopin.names import moving_joints
from zygopin.perch import plan_perch
from zygopin.poses import ANGLE_DIGITS, named_poses, standard_branch


def test_a_toe_that_turns_is_ahead_where_the_foot_is_spread():
    foot = Foot.preset("owl")
    poses = named_poses(foot)
    assert list(poses) == ["rest", "closed", "perch", "zygodactyl", "spread"]
    assert all([*pose] == [*moving_joints(foot)] for pose in poses.values())
    assert set(poses["rest"].values()) == {0.0}
    assert poses["zygodactyl"] == poses["rest"]
    assert poses["closed"]["finger2_joint3"] == foot.omega
    assert poses["closed"]["finger4_reversal"] == 0.0
    turned = poses["rest"] | {"finger4_reversal": foot.fingers[3].reversal}
    assert poses["spread"] == turned


def test_a_foot_that_cannot_grasp_has_no_perch():
    straight = ["zygodactyl", "spread"]
    assert list(named_poses(Foot.preset("paper"))) == ["rest", "closed", *straight]


def test_three_toes_ahead_are_not_zygodactyl():
    poses = named_poses(Foot.preset("anisodactyl"))
    assert list(poses) == ["rest", "closed", "perch", "spread"]
    assert poses["spread"] == poses["rest"]


@pytest.mark.parametrize("name", ["parrot", "owl", "anisodactyl"])
def test_the_perch_is_a_grasp_of_the_standard_branch(name):
    foot = Foot.preset(name)
    angles = named_poses(foot)["perch"]
    controls = [
        angles[f"{finger.name}_joint{k}"] / foot.omega
        for finger in foot.fingers
        for k in range(1, finger.phalanges + 1)
    ]
    branch = plan_perch(foot, standard_branch(foot), find_height=True).branch
    assert branch.radius == foot.size / 4
    rounding = 10.0**-ANGLE_DIGITS * foot.size * 5  # five joints, each by half a digit
    criteria = replace(Criteria(), tolerance=rounding)
    report = check_grasp(foot, np.array(controls), branch, criteria=criteria)
    assert report.grasping
    assert report.feasible
