"""A finger seen along an axis: lengths, angles and sides as in space."""

from __future__ import annotations

import math

import numpy as np
import pytest
from axes import one_finger
from hypothesis import given
from hypothesis import strategies as st
from tangencies import projected, random_controls, random_view

from zygopin import Branch, Finger, Foot
from zygopin.kinematics import forward_kinematics
from zygopin.projection import BEHIND, ProjectedFinger, wrap_angle

SEEDS = st.integers(0, 10**6)
Y = np.array([0.0, 1.0, 0.0])


@given(SEEDS)
def test_the_chain_in_the_plane_is_the_one_in_space(seed):
    foot, axis, centre = random_view(seed)
    finger, rng = projected(foot, axis), np.random.default_rng(seed)
    controls = random_controls(rng, 20, foot.phalanx_count)
    bones = forward_kinematics(foot, controls)
    seen = finger.flat(bones)
    pitch = finger.orientation + foot.omega * np.cumsum(controls, axis=-1)
    steps = finger.lengths * finger.direction(pitch)
    margin = 1e-12 * foot.size
    assert np.allclose(seen[..., 1] - seen[..., 0], steps, atol=margin)
    away = bones - centre
    away = away - (away @ axis)[..., None] * axis
    distance = np.linalg.norm(away, axis=-1)
    assert np.allclose(np.abs(seen - finger.flat(centre)), distance, atol=margin)


@given(SEEDS)
def test_a_pitch_is_found_again_from_its_direction(seed):
    foot, axis, _ = random_view(seed)
    finger, rng = projected(foot, axis), np.random.default_rng(seed)
    pitch = rng.uniform(-math.pi, math.pi, 50)
    direction = finger.direction(pitch)
    found, stretch = finger.pitch(direction * rng.uniform(0.1, 9.0, 50))
    assert np.allclose(found, pitch, atol=1e-9 / finger.least_stretch)
    assert np.allclose(stretch, np.abs(direction), atol=1e-9)
    assert (stretch >= finger.least_stretch * (1 - 1e-9)).all()


def test_the_least_stretch_is_attained():
    finger = projected(*random_view(4)[:2])
    pitch = np.linspace(-math.pi, math.pi, 100_001)
    least = np.abs(finger.direction(pitch)).min()
    assert finger.least_stretch == pytest.approx(least, rel=1e-6)


@given(SEEDS, st.sampled_from([-1, 1]))
def test_the_straight_finger_points_along_one_and_flexion_is_clockwise(seed, sense):
    foot, axis, _ = random_view(seed)
    finger = projected(foot, sense * axis)
    pitch = np.linspace(-3, 3, 41)
    direction = finger.direction(pitch)
    assert finger.direction(np.zeros(1))[0].real > 0
    assert abs(finger.direction(np.zeros(1))[0].imag) < 1e-12
    assert (np.angle(direction[1:] / direction[:-1]) < 0).all()


def test_numbers_of_an_oblique_view_by_hand():
    # Azimuth 60 degrees seen along y: forward by cos 60, and down stays down.
    finger = projected(one_finger(1, math.pi / 3), Y)
    assert finger.forward == pytest.approx(0.5)
    assert finger.shear == pytest.approx(0.0)
    assert finger.drop == pytest.approx(1.0)
    assert finger.least_stretch == pytest.approx(0.5)
    # An axis in the xy-plane's normal's slope: (0, 1, 1)/sqrt 2 shortens z.
    finger = projected(one_finger(1), np.array([0.0, 1.0, 1.0]) / math.sqrt(2))
    assert (finger.forward, finger.drop) == pytest.approx((1.0, math.sqrt(0.5)))


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 0, 1), (0.6, 0, 0.8)])
def test_an_axis_in_the_finger_s_plane_sees_it_edgewise(axis):
    finger = projected(one_finger(2), np.array(axis, float))
    assert finger.edgewise
    assert finger.least_stretch == pytest.approx(0.0, abs=1e-12)
    assert not projected(one_finger(2), Y).edgewise


def test_mirrored_fingers_are_one_chain_and_others_are_not():
    def chain(count, azimuth=0.0, orientation=0.0, **changes):
        return projected(one_finger(count, azimuth, orientation, **changes), Y)

    one = chain(3, 0.2)
    for other in (chain(3, -0.2), chain(5, math.pi - 0.2), chain(1, math.pi + 0.2)):
        assert one.same_chain(other)
        assert other.same_chain(one)
    different = [chain(3, 0.3), chain(3, 0.2, 0.1), chain(3, 0.2, omega=1.0)]
    different += [chain(3, 0.2, rho=1.3), chain(3, 0.2, thickness=0.1)]
    different.append(projected(one_finger(3, 0.2), np.array([0.0, 0.8, 0.6])))
    for other in different:
        assert not one.same_chain(other)


def test_equal_fingers_of_one_foot_are_one_chain():
    fingers = (Finger("a", 2, 0.0), Finger("b", 2, 0.0))
    foot = Foot(fingers=fingers)
    one, other = (ProjectedFinger.of(foot, i, Y) for i in (0, 1))
    assert one.same_chain(other)


def test_wraps_by_hand():
    # The base lies above the centre -i; clockwise from there is flexion's sense.
    normal = np.array([1j, 1.0, -1j, -1.0, np.exp(1j * (math.pi / 2 + 0.7)), -1 + 1j])
    wrap = wrap_angle(3 * normal, np.full(6, -2j))
    expected = [0, math.pi / 2, math.pi, -math.pi / 2, -0.7, -math.pi / 4]
    assert wrap == pytest.approx(expected)


@given(SEEDS)
def test_wraps_lie_in_their_range_and_turn_with_the_plane(seed):
    rng = np.random.default_rng(seed)
    normal, centre = (rng.standard_normal(99) + 1j * rng.standard_normal(99),) * 2
    normal = normal * np.exp(1j * rng.uniform(-9, 9, 99))
    wrap = wrap_angle(normal, centre)
    assert ((wrap >= BEHIND) & (wrap < BEHIND + 2 * math.pi)).all()
    turn = np.exp(1j * rng.uniform(-9, 9))
    both = wrap_angle(normal * turn, centre * turn)
    assert np.allclose(np.exp(1j * both), np.exp(1j * wrap))


def test_a_branch_seen_along_its_axis_keeps_its_distance():
    foot, axis, centre = random_view(8)
    seen = abs(projected(foot, axis).flat(centre))
    assert seen == pytest.approx(Branch(1.0, centre, axis).base_distance())
