"""Poses to start a simulation from: toes that do not run into each other."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zygopin.foot import Finger, Foot
from zygopin.keyframes import keyframes
from zygopin.names import moving_joints
from zygopin.poses import named_poses
from zygopin.presets import preset_names


@pytest.mark.parametrize("name", preset_names())
def test_only_closed_may_differ_from_the_named_poses(name):
    foot = Foot.preset(name)
    found, named = keyframes(foot, foot.radii), named_poses(foot)
    assert [*found] == [*named]
    assert all([*pose] == [*moving_joints(foot)] for pose in found.values())
    assert all(found[pose] == named[pose] for pose in named if pose != "closed")


@pytest.mark.parametrize("name", ["parrot", "owl", "anisodactyl"])
def test_closed_stops_in_proportion_where_solid_toes_meet(name):
    foot = Foot.preset(name)
    angles = {*keyframes(foot, foot.radii)["closed"].values()} - {0.0}
    (angle,) = angles
    assert 0.3 * foot.omega < angle < 0.7 * foot.omega


def test_bare_bones_that_never_cross_close_fully():
    foot = Foot.preset("paper")
    assert keyframes(foot, foot.radii)["closed"] == named_poses(foot)["closed"]


def test_two_facing_rods_meet_in_the_plane_between_them():
    # Rods of 0.5 m and 0.25 m, each turned down by a: mirror images, which meet when an
    # end, at x = 0.5·cos a + 0.25·cos 2a, is within a radius of the plane between.
    fingers = (Finger("fore", 2, 0.0), Finger("hind", 2, math.pi))
    foot = Foot(rho=2.0, omega=1.4, scale=1.0, thickness=0.05, fingers=fingers)
    angle = keyframes(foot, foot.radii)["closed"]["fore_joint1"]
    ends = 0.5 * np.cos(angle) + 0.25 * np.cos(2 * angle)
    assert ends >= 0.0125  # 0.05/2²
    further = angle + 1.4 / 100
    assert 0.5 * np.cos(further) + 0.25 * np.cos(2 * further) < 0.0125
