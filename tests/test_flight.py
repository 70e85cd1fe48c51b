"""The free foot: where it is, how fast it can be, and flights that are none."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from strikes import random_flight, random_foot

from zygopin.errors import ParameterError, UnknownNameError
from zygopin.finger import Finger
from zygopin.flight import Flight, FreeFlow
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.motion import Law, Motion

FOOT = Foot.preset("owl")
P = FOOT.phalanx_count
FALL = Motion.through([0, 1], [[0, 0, 0], [0, 0, -1]])
SHORT = 1e-6
"""Share of a radian over which chord and arc are the same."""


def toe(*fingers):
    """A foot of straight toes with phalanges of 4, 2 and 1 m."""
    return Foot(rho=2.0, omega=1.5, scale=8.0, fingers=fingers)


def spin(rate, speed=0.0):
    """A base that turns about z while it moves along y, for a second."""
    steps = np.linspace(0, 1, 5)
    turns = Rotation.from_euler("z", rate * steps[:, None]).as_matrix()
    return Motion.through(steps, np.outer(steps, [0, speed, 0]), turns)


def fastest(flow, low, high):
    """Largest mean speed of each phalanx's ends between two instants."""
    first, second = flow.stances(np.array([low, high])).bones
    return np.linalg.norm(second - first, axis=-1).max(axis=-1) / (high - low)


# Where it is ---------------------------------------------------------------------


def test_stances_are_what_motion_controls_and_reversal_say():
    controls = Law.through([0, 1], np.array([np.zeros(P), np.linspace(0, 1, P)]))
    flight = Flight(FALL, controls, Law.through([0, 1], [1.0, 0.0]))
    stance = FreeFlow(FOOT, flight).stances(np.array([0.25, 1.0]))
    azimuths = [finger.azimuth + 0.75 * finger.reversal for finger in FOOT.fingers]
    bones = forward_kinematics(FOOT, np.linspace(0, 0.25, P), azimuths=azimuths)
    assert stance.bones[0] == pytest.approx(bones - [0, 0, 0.25], abs=1e-15)
    bones = forward_kinematics(FOOT, np.linspace(0, 1, P))
    assert stance.bones[1] == pytest.approx(bones - [0, 0, 1.0], abs=1e-15)


def test_one_number_is_the_control_of_all_joints():
    flow = FreeFlow(FOOT, Flight(FALL, 0.3))
    assert flow.controls.at(np.zeros(1)).tolist() == [[0.3] * P]
    by_name = {f.name: [i / 10] * f.phalanges for i, f in enumerate(FOOT.fingers, 1)}
    values = FreeFlow(FOOT, Flight(FALL, by_name)).controls.at(np.zeros(1))[0]
    assert values.tolist() == ((FOOT.finger_of_phalanx + 1) / 10).tolist()


def test_a_flight_starts_and_ends_with_its_motion():
    motion = Motion.through([-2, 3], [[0, 0, 0], [0, 0, 1]])
    flow = FreeFlow(FOOT, Flight(motion))
    assert (flow.start, flow.end) == (-2, 3)
    resting = FreeFlow(FOOT, Flight(Motion.resting()))
    assert (resting.start, resting.end) == (0, math.inf)


def test_breaks_are_those_of_all_three_laws():
    controls = Law.through([0, 0.5, 1], np.zeros((3, P)))
    reversal = Law.through([0, 0.3, 1], [0.0, 1.0, 0.0])
    flow = FreeFlow(FOOT, Flight(FALL, controls, reversal))
    assert flow.next_break(0.0, 1.0) == 0.3
    assert flow.next_break(0.3, 1.0) == 0.5
    assert flow.next_break(0.3, 0.4) == 0.4
    assert flow.next_break(0.5, 1.0) == 1.0
    resting = FreeFlow(FOOT, Flight(Motion.resting()))
    assert resting.next_break(0.0, 7.0) == 7.0


# How fast it can be --------------------------------------------------------------


@given(st.integers(0, 2**32 - 1))
def test_no_phalanx_moves_faster_than_its_bound(seed):
    rng = np.random.default_rng(seed)
    foot = random_foot(rng)
    flow = FreeFlow(foot, random_flight(rng, foot))
    for low, high in np.sort(rng.uniform(flow.start, flow.end, (20, 2)), axis=1):
        high_ = flow.next_break(low, high) if rng.random() < 0.7 else high
        times = np.linspace(low, high_, 9)
        bones = flow.stances(times).bones
        moved = np.linalg.norm(bones - bones[:1], axis=-1).max(axis=-1)
        allowed = flow.speeds(low, high_) * (times - low)[:, None]
        assert (moved <= allowed * (1 + 1e-9) + 1e-12 * foot.size).all()


@pytest.mark.parametrize(
    ("flight", "expected"),
    [
        (Flight(spin(0.0, 3.0)), [3, 3, 3]),
        (Flight(spin(2.0)), [8, 12, 14]),
        (Flight(spin(2.0, 3.0)), [11, 15, 17]),
        (Flight(FALL, Law.through([0, 1], [[0, 0, 0], [1, 0, 0]])), [7, 10, 11.5]),
        (Flight(FALL, Law.through([0, 1], [[0, 0, 0], [0, 1, 0]])), [1, 4, 5.5]),
        (Flight(FALL, Law.through([0, 1], [[0, 0, 0], [0, 0, 1]])), [1, 1, 2.5]),
        (Flight(FALL, Law.through([0, 1], [[0, 0, 0], [1, 1, 1]])), [7, 13, 17.5]),
    ],
)
def test_straight_toe_is_as_fast_as_its_bound_by_hand(flight, expected):
    # ω = 1.5 rad; levers of 4, 6 and 7 m from the base, 2 and 3, and 1 m.
    flow = FreeFlow(toe(Finger("a", 3, 0.0)), flight)
    assert flow.speeds(0.0, SHORT) == pytest.approx(expected)
    assert fastest(flow, 0.0, SHORT) == pytest.approx(expected, rel=1e-4)


def test_a_toe_that_turns_is_as_fast_as_its_bound_by_hand():
    foot = toe(Finger("a", 2, 0.0, reversed_azimuth=0.5), Finger("b", 1, 1.0))
    still = Motion.through([0, 1], np.zeros((2, 3)))
    flow = FreeFlow(foot, Flight(still, reversal=Law.through([0, 1], [1.0, 0.0])))
    assert flow.speeds(0.0, 1.0) == pytest.approx([2, 3, 0])
    assert fastest(flow, 0.0, SHORT) == pytest.approx([2, 3, 0], rel=1e-4)


def test_speeds_are_those_of_the_stretch():
    flow = FreeFlow(
        toe(Finger("a", 1, 0.0)),
        Flight(Motion.through([0, 1, 2], [[0, 0, 0], [0, 0, 1], [0, 0, 6]])),
    )
    assert flow.speeds(0.0, 1.0) == pytest.approx([1])
    assert flow.speeds(1.0, 2.0) == pytest.approx([5])
    assert flow.speeds(0.9, 1.1) == pytest.approx([5])


# Bad input -----------------------------------------------------------------------


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"controls": 1.5}, r"controls = 1.5 is not in \[0, 1\]"),
        ({"controls": [0, 1]}, r"controls.shape = \(2,\) is not of shape \(…, 14\)"),
        ({"controls": np.zeros((2, P))}, r"controls.shape = \(2, 14\) is not \(14,\)"),
        ({"controls": math.nan}, "controls = nan is not finite"),
        ({"controls": None}, "controls = None"),
        ({"controls": True}, "controls = True"),
        ({"controls": "open"}, "controls = 'open'"),
        (
            {"controls": Law.through([0, 1], np.full((2, P), 1.5))},
            r"controls over time\[0, 0\] = 1.5 is not in \[0, 1\]",
        ),
        (
            {"controls": Law.of(lambda t: np.full(P, 2 * t), end=1, rate=2)},
            r"controls over time\[257, 0\] = 1.00",
        ),
        (
            {"controls": Law.through([0, 1], np.zeros((2, 3)))},
            r"controls.shape = \(3,\) is not \(14,\)",
        ),
        ({"reversal": 1.5}, r"reversal = 1.5 is not in \[0, 1\]"),
        ({"reversal": None}, "reversal = None"),
        ({"reversal": Law.through([0, 1], [0, -0.1])}, "reversal over time"),
        (
            {"reversal": Law.through([0, 1], [[0], [0.1]])},
            r"reversal.shape = \(1,\) is not \(\)",
        ),
        ({"motion": "down"}, "motion = 'str' is not a Motion"),
        ({"motion": None}, "motion = 'NoneType' is not a Motion"),
    ],
)
def test_bad_flights_are_named(changes, message):
    with pytest.raises(ParameterError, match=message) as caught:
        FreeFlow(FOOT, Flight(**{"motion": FALL, **changes}))
    assert "\n" not in str(caught.value)


def test_unknown_fingers_and_what_is_no_flight_are_named():
    with pytest.raises(UnknownNameError, match="finger 'thumb'"):
        FreeFlow(FOOT, Flight(FALL, {"thumb": [0.0]}))
    with pytest.raises(ParameterError, match="flight = 'Motion' is not a Flight"):
        FreeFlow(FOOT, FALL)


@pytest.mark.parametrize("name", ["motion", "controls", "reversal"])
def test_what_ends_too_early_is_named(name):
    laws = {"controls": np.zeros((2, P)), "reversal": np.zeros(2)}
    span = [0, 0.5] if name == "motion" else [-1, 2]
    given = {"motion": Motion.through(span, np.zeros((2, 3)))}
    if name != "motion":
        given[name] = Law.through([0, 0.5], laws[name])
    flow = FreeFlow(FOOT, Flight(**given))
    flow.check_defined(0.0, 0.5)
    with pytest.raises(ParameterError, match=f"span of {name} = .*holds 0 to 1.5 s"):
        flow.check_defined(0.0, 1.5)
    with pytest.raises(ParameterError, match=f"span of {name}"):
        flow.check_defined(-0.1, 0.5)
