"""The closed form: laws of the chain, and the published numbers."""

from __future__ import annotations

import dataclasses
import math
import re

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import controls_for, feet, reals

from zygopin.checks import MOST_TURNED
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Finger, Foot
from zygopin.kinematics import (
    as_controls,
    by_finger,
    forward_kinematics,
    read_controls,
)

PARROT = Foot.preset("parrot")


@st.composite
def posed_feet(draw, batch=()):
    """A foot and controls for it."""
    foot = draw(feet())
    return foot, draw(controls_for(foot, batch))


def one_finger(phalanges, azimuth=0.0, **values):
    orientation = values.pop("orientation", 0.0)
    finger = Finger("toe", phalanges, azimuth, orientation=orientation)
    return Foot(fingers=(finger,), **values)


def about_z(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return points @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]).T


def same(one, other):
    """Whether bones of the parrot are equal to rounding."""
    return np.abs(one - other).max(initial=0) <= 4e-16 * PARROT.size


# Numbers by hand -----------------------------------------------------------------


def test_four_junctions_by_hand():
    # MODEL.md, section 2: golden mean, ω = π/6, v ≡ 1; the finger's plane is xz.
    ends = forward_kinematics(one_finger(4), np.ones(4))[:, 1]
    junctions = [
        0.535233 - 0.309017j,
        0.726216 - 0.639809j,
        0.726216 - 0.875877j,
        0.653267 - 1.002229j,
    ]
    assert ends[:, 0] + 1j * ends[:, 2] == pytest.approx(junctions, abs=1e-6)
    assert (ends[:, 1] == 0).all()


def test_a_straight_finger_ends_at_the_sum_of_its_lengths():
    # 1/2 + 1/4 + 1/8 of 8, along azimuth 30°.
    foot = one_finger(3, math.pi / 6, rho=2.0, scale=8.0)
    tip = forward_kinematics(foot, np.zeros(3))[-1, 1]
    assert tip == pytest.approx((7 * math.sqrt(0.75), 3.5, 0.0))


def test_a_right_angle_turns_straight_down():
    foot = one_finger(2, rho=2.0, scale=4.0, omega=math.pi / 2)
    ends = forward_kinematics(foot, [1.0, 0.0])[:, 1]
    assert ends == pytest.approx(np.array([[0, 0, -2], [0, 0, -3]]), abs=1e-15)


def test_the_orientation_is_an_angle_downward():
    foot = one_finger(1, rho=2.0, scale=2.0, orientation=math.pi / 6)
    end = forward_kinematics(foot, [0.0])[0, 1]
    assert end == pytest.approx((math.sqrt(0.75), 0, -0.5))


# Laws ----------------------------------------------------------------------------


@given(posed_feet((2,)))
def test_bones_are_chains_of_the_foots_lengths_from_the_base(posed):
    foot, controls = posed
    bones = forward_kinematics(foot, controls)
    assert bones.shape == (2, foot.phalanx_count, 2, 3)
    lines = bones[..., 1, :] - bones[..., 0, :]
    lengths = np.linalg.norm(lines, axis=-1)
    assert lengths == pytest.approx(np.broadcast_to(foot.lengths, lengths.shape))
    for part in foot.finger_slices.values():
        chain = bones[:, part]
        assert (chain[:, 0, 0] == 0).all()
        apart = chain[:, 1:, 0] - chain[:, :-1, 1]
        assert np.abs(apart).max(initial=0) <= 1e-14 * foot.size


@given(posed_feet())
def test_a_finger_stays_in_its_plane(posed):
    foot, controls = posed
    bones = forward_kinematics(foot, controls)
    for finger, part in zip(foot.fingers, foot.finger_slices.values(), strict=True):
        across = [-math.sin(finger.azimuth), math.cos(finger.azimuth), 0]
        assert np.abs(bones[part] @ across).max() <= 1e-15 * foot.size


@given(posed_feet())
def test_mirrored_azimuths_mirror_the_foot(posed):
    foot, controls = posed
    azimuths = [finger.azimuth for finger in foot.fingers]
    bones = forward_kinematics(foot, controls, azimuths=azimuths)
    mirrored = forward_kinematics(foot, controls, azimuths=np.negative(azimuths))
    assert (mirrored == bones * (1, -1, 1)).all()


def test_an_azimuth_of_too_many_turns_is_named():
    foot = one_finger(2)
    most = MOST_TURNED
    forward_kinematics(foot, [0, 0], azimuths=[-most])
    complaint = f"azimuths[0] = {2 * most} is not within {most:g}: give radians"
    with pytest.raises(ParameterError, match=f"^{re.escape(complaint)}$"):
        forward_kinematics(foot, [0, 0], azimuths=[2 * most])


def test_fingers_of_equal_length_at_opposite_azimuths_are_mirror_images():
    fingers = (Finger("left", 4, 0.3), Finger("right", 4, -0.3))
    controls = np.random.default_rng(0).random((20, 4))
    bones = forward_kinematics(Foot(fingers=fingers), np.tile(controls, 2))
    assert (bones[:, :4] == bones[:, 4:] * (1, -1, 1)).all()


@given(posed_feet(), reals(-3, 3))
def test_turned_azimuths_turn_the_foot(posed, angle):
    foot, controls = posed
    azimuths = np.array([finger.azimuth for finger in foot.fingers])
    turned = forward_kinematics(foot, controls, azimuths=azimuths + angle)
    expected = about_z(forward_kinematics(foot, controls), angle)
    assert np.abs(turned - expected).max() <= 1e-14 * foot.size


@given(posed_feet(), reals(0.01, 1.0))
def test_bones_scale_with_the_foot(posed, factor):
    foot, controls = posed
    scale = min(max(foot.scale * factor, 1e-6), 1e6)
    other = foot.replace(scale=scale, thickness=0.0)
    expected = forward_kinematics(foot, controls) * (scale / foot.scale)
    bones = forward_kinematics(other, controls)
    assert np.abs(bones - expected).max() <= 1e-14 * other.size


@given(st.integers(2, 8), reals(1.01, 3), reals(0.05, 6), reals(-1, 1), st.randoms())
def test_beyond_its_first_phalanx_a_finger_is_a_turned_copy_1_over_rho(
    count, rho, omega, orientation, random
):
    # f_v(x) = exp(-iωv)/ρ (x + 1): MODEL.md, section 3.
    foot = one_finger(count, rho=rho, omega=omega, orientation=orientation)
    shorter = one_finger(count - 1, rho=rho, omega=omega, orientation=orientation)
    controls = np.array([random.random() for _ in range(count)])
    whole, rest = (
        bones[..., 0] + 1j * bones[..., 2]
        for bones in (
            forward_kinematics(foot, controls),
            forward_kinematics(shorter, controls[1:]),
        )
    )
    turn = np.exp(-1j * omega * controls[0]) / rho
    assert whole[1:] - whole[0, 1] == pytest.approx(turn * rest, abs=1e-14)


@given(posed_feet())
def test_only_what_lies_beyond_a_joint_follows_it(posed):
    foot, controls = posed
    bones = forward_kinematics(foot, controls)
    for part in foot.finger_slices.values():
        changed = controls.copy()
        changed[part.stop - 1] = 1 - changed[part.stop - 1]
        others = np.arange(foot.phalanx_count) != part.stop - 1
        moved = forward_kinematics(foot, changed)
        assert (moved[others] == bones[others]).all()


# Batches -------------------------------------------------------------------------


def test_a_batch_is_a_loop():
    controls = np.random.default_rng(1).random((3, 4, 14))
    bones = forward_kinematics(PARROT, controls)
    assert bones.shape == (3, 4, 14, 2, 3)
    for index in np.ndindex(3, 4):
        assert same(bones[index], forward_kinematics(PARROT, controls[index]))
    assert forward_kinematics(PARROT, np.empty((0, 14))).shape == (0, 14, 2, 3)


def test_controls_and_azimuths_broadcast():
    rng = np.random.default_rng(2)
    controls, azimuths = rng.random((5, 1, 14)), rng.uniform(-3, 3, (4, 4))
    bones = forward_kinematics(PARROT, controls, azimuths=azimuths)
    assert bones.shape == (5, 4, 14, 2, 3)
    one = forward_kinematics(PARROT, controls[3, 0], azimuths=azimuths[2])
    assert same(bones[3, 2], one)


@pytest.mark.parametrize("azimuths", [None, [0, 0.1, 0.2, 0.3]])
def test_bones_may_be_written_to_an_array_there_is(azimuths):
    controls = np.random.default_rng(4).random((2, 5, 14))
    out = np.full((2, 5, 14, 2, 3), np.nan)
    found = forward_kinematics(PARROT, controls, azimuths=azimuths, out=out)
    assert found is out
    assert (out == forward_kinematics(PARROT, controls, azimuths=azimuths)).all()


@pytest.mark.parametrize(
    ("out", "words"),
    [
        (np.empty((14, 2, 3)), r"out.shape = \(14, 2, 3\).*\(5, 14, 2, 3\)"),
        (
            np.empty((5, 14, 2, 3), np.float32),
            r"^out = .*float32.* is not of float64, in C order, and writeable: make it "
            r"with numpy.empty$",
        ),
        (np.empty((5, 14, 2, 3), order="F"), "in C order"),
        (np.broadcast_to(0.0, (5, 14, 2, 3)), "writeable"),
        ([[0.0]], "^out = 'list' is not a ndarray"),
    ],
)
def test_an_array_that_cannot_be_written_to_is_refused(out, words):
    with pytest.raises(ParameterError, match=words):
        forward_kinematics(PARROT, np.zeros((5, 14)), out=out)


@pytest.mark.parametrize("azimuths", [None, [0, 1, 2, 3]])
def test_no_threads_at_all_are_refused(azimuths):
    with pytest.raises(ParameterError, match=r"^threads = 0 is not an integer from 1"):
        forward_kinematics(PARROT, np.zeros(14), azimuths=azimuths, threads=0)


def test_masked_controls_are_read_as_what_they_hold():
    hidden = np.ma.array([2.0] + [0.0] * 13, mask=[True] + [False] * 13)
    with pytest.raises(ParameterError, match=r"controls\[0\] = 2.0"):
        forward_kinematics(PARROT, hidden)


def test_azimuths_place_the_fingers():
    foot = PARROT
    fingers = tuple(
        dataclasses.replace(f, azimuth=0.1 * i) for i, f in enumerate(foot.fingers)
    )
    controls = np.random.default_rng(3).random(14)
    expected = forward_kinematics(foot.replace(fingers=fingers), controls)
    bones = forward_kinematics(foot, controls, azimuths=[0, 0.1, 0.2, 0.1 * 3])
    assert same(bones, expected)


# Controls ------------------------------------------------------------------------


@pytest.mark.parametrize("batch", [(), (6,), (2, 3)])
def test_controls_by_finger_are_the_array(batch):
    values = np.random.default_rng(4).random((*batch, 14))
    named = {n: values[..., s] for n, s in reversed(PARROT.finger_slices.items())}
    assert (as_controls(PARROT, named) == values).all()


def test_each_fingers_controls_may_have_their_own_batch():
    named = by_finger(PARROT, np.linspace(0, 1, 14))
    named["finger2"] = np.random.default_rng(5).random((6, 3))
    controls = as_controls(PARROT, named)
    assert controls.shape == (6, 14)
    assert (controls[:, 2:5] == named["finger2"]).all()
    assert (controls[:, 5:] == np.linspace(0, 1, 14)[5:]).all()


def test_by_finger_undoes_itself():
    values = np.linspace(0, 1, 14)
    named = by_finger(PARROT, values)
    assert list(named) == ["finger1", "finger2", "finger3", "finger4"]
    assert named["finger1"] == [0, 1 / 13]
    assert (as_controls(PARROT, named) == values).all()


def test_controls_are_copied():
    values = np.zeros(14)
    controls = as_controls(PARROT, values)
    controls[0] = 1.0
    assert values[0] == 0.0


@pytest.mark.parametrize("batch", [(), (3,), (2, 3)])
def test_controls_that_are_fine_are_read_where_they_are(batch):
    values = np.zeros((*batch, 14))
    values[..., 0] = 1.0
    assert read_controls(PARROT, values) is values
    assert as_controls(PARROT, values) is not values


def changed(**values):
    named = {**by_finger(PARROT, np.zeros(14)), **values}
    return {name: value for name, value in named.items() if value is not None}


@pytest.mark.parametrize(
    ("controls", "message"),
    [
        ([0.0] * 13 + [1.5], r"^controls\[13\] = 1.5 is not in \[0, 1\]: 0 is the str"),
        ([-1e-9] + [0.0] * 13, r"^controls\[0\] = -1e-09 is not in \[0, 1\]"),
        ([[0.0] * 14, [0.0] * 13 + [math.nan]], r"^controls\[1, 13\] = nan is not fin"),
        ([0.0] * 13, r"controls.shape = \(13,\) is not of shape \(…, 14\): give 14"),
        (0.5, r"controls.shape = \(\) is not of shape"),
        ("high", "controls = 'high' is not an array of numbers"),
        (changed(finger1=[0.0]), r"controls\[finger1\].shape = \(1,\).*give 2 numbers"),
        (changed(finger2=None), r"controls\[finger2\] = None is not given: give 3"),
        (changed(finger3=[0, 0, 0, 2]), r"^controls\[8\] = 2.0 is not in"),
        (changed(finger4=[0, 0, 0, 0, "a"]), r"controls\[finger4\] = .*numbers"),
        (
            changed(finger1=np.zeros((2, 2)), finger2=np.zeros((3, 3))),
            "batch shapes of controls = .* is not broadcastable: give them equal",
        ),
    ],
)
def test_bad_controls_are_one_line(controls, message):
    with pytest.raises(ParameterError, match=message) as caught:
        forward_kinematics(PARROT, controls)
    assert "\n" not in str(caught.value)


def test_an_unknown_finger_is_refused_with_a_suggestion():
    with pytest.raises(
        UnknownNameError, match=r"^unknown finger 'finger5': did you mean 'f"
    ):
        forward_kinematics(PARROT, changed(finger5=[0.0]))


@pytest.mark.parametrize(
    ("azimuths", "message"),
    [
        ([0, 1, 2], r"azimuths.shape = \(3,\) is not of shape \(…, 4\)"),
        ([0, 1, 2, math.inf], r"azimuths\[3\] = inf is not finite"),
        (np.zeros((3, 4)), "batch shapes of controls and azimuths"),
    ],
)
def test_bad_azimuths_are_one_line(azimuths, message):
    with pytest.raises(ParameterError, match=message):
        forward_kinematics(PARROT, np.zeros((2, 14)), azimuths=azimuths)
