"""Strength, stiffness and damping: their laws of scale."""

from __future__ import annotations

import math

import pytest
from hypothesis import given
from strategies import reals

from zygopin.dynamics import (
    CLOSING,
    FREQUENCY,
    GRIP,
    STEPS,
    characteristic_time,
    joint_dynamics,
    timestep,
)
from zygopin.foot import Finger, Foot
from zygopin.load import GRAVITY

SCALES = reals(-6, 5).map(lambda x: 10.0**x)


def one_toe(scale):
    """A foot of one phalanx of length scale/2, which is its size."""
    return Foot(rho=2.0, scale=scale, fingers=(Finger("toe", 1, 0.0),))


def test_a_joint_by_hand():
    # L = 9.81 m, so T = 1 s; M = 2 kg, ℓ = 0.5 m: W·ℓ = 9.81 N·m.
    foot = one_toe(2 * 9.81)
    assert characteristic_time(foot) == pytest.approx(1.0, rel=1e-15)
    drive = joint_dynamics(foot, mass=2.0, lever=0.5)
    assert drive.stiffness == pytest.approx(490.5)
    assert drive.spring == pytest.approx(196.2)
    assert drive.armature == pytest.approx(490.5 / 256)
    assert drive.damping == pytest.approx(245.25)


@given(SCALES)
def test_a_foot_four_times_as_large_moves_alike_but_half_as_fast(scale):
    small, large = one_toe(scale), one_toe(4 * scale)
    one = joint_dynamics(small, 1.0, small.size)
    other = joint_dynamics(large, 64.0, large.size)
    times = (
        lambda drive: drive.damping / drive.stiffness,
        lambda drive: math.sqrt(drive.armature / drive.stiffness),
    )
    assert other.stiffness == pytest.approx(256 * one.stiffness, rel=1e-12)
    for time in times:
        assert time(other) == pytest.approx(2 * time(one), rel=1e-12)
        assert time(one) / characteristic_time(small) == pytest.approx(
            time(joint_dynamics(small, 7.0, 3.0)) / characteristic_time(small)
        )


@given(SCALES)
def test_the_time_step_is_round_and_short_enough(scale):
    foot = one_toe(scale)
    step, longest = timestep(foot), characteristic_time(foot) / STEPS
    assert longest / 2.5 < step * (1 + 1e-12)
    assert step <= longest
    assert f"{step:.0e}"[0] in "125"
    assert step == pytest.approx(float(f"{step:.0e}"), rel=1e-12)


@pytest.mark.parametrize("name", ["parrot", "owl", "anisodactyl", "paper"])
def test_every_joint_is_overdamped(name):
    # The inertia of the whole foot, stretched out about the joint, is an upper bound.
    foot = Foot.preset(name)
    mass, lever = 1.0, float(foot.lengths.min())
    drive = joint_dynamics(foot, mass, lever)
    own = mass * lever * lever  # a phalanx that weighs as much as the foot
    critical = 2 * math.sqrt(drive.stiffness * (drive.armature + own))
    assert drive.damping > critical
    longest = float(foot.lengths.max())
    toe = mass / 2 * foot.size**2 / 3  # half the foot's mass, a rod of its size
    base = joint_dynamics(foot, mass, longest)
    assert base.damping > 2 * math.sqrt(base.stiffness * (base.armature + toe))


def test_constants_agree_with_the_laws_in_words():
    assert pytest.approx(CLOSING**2 * GRIP / 4) == 3.125  # "about 3·M·ℓ·L"
    assert FREQUENCY / STEPS < 1 / 6
    assert GRAVITY == 9.81
