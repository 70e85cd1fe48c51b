"""Laws and motions: their values, the bounds on their rates, and bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from strategies import reals

from zygopin.errors import ParameterError
from zygopin.motion import Law, Motion

SEEDS = st.integers(0, 2**32 - 1)
QUARTER = Rotation.from_euler("z", 90, degrees=True).as_matrix()
TWO = [[0.0, 0, 0], [0, 0, 1]]


def instants(rng, count):
    """Ascending instants, at uneven steps."""
    return rng.normal() + np.cumsum(rng.uniform(0.01, 2.0, count))


def waypoints(rng, count):
    """A motion through random poses, and the poses."""
    times, places = instants(rng, count), rng.normal(size=(count, 3))
    turns = Rotation.random(count, rng)
    return Motion.through(times, places, turns.as_matrix()), times, places, turns


def pose(place=(0, 0, 0), angle=0.0):
    matrix = np.eye(4)
    matrix[:3, :3] = Rotation.from_euler("z", angle).as_matrix()
    matrix[:3, 3] = place
    return matrix


def swing(time):
    return pose((math.sin(time), 0, 0), 2 * time)


# Values --------------------------------------------------------------------------


def test_law_through_samples_is_theirs_and_straight_between():
    law = Law.through([0, 1, 3], [[0.0, 1.0], [0.5, 0.0], [0.5, 1.0]])
    values = law.at(np.array([0.0, 0.5, 1.0, 2.0, 3.0]))
    assert values == pytest.approx(
        np.array([[0, 1], [0.25, 0.5], [0.5, 0], [0.5, 0.5], [0.5, 1]])
    )
    assert law.rates.tolist() == [[0.5, 1.0], [0.0, 0.5]]


def test_rate_is_the_largest_of_the_stretches_between_two_instants():
    law = Law.through([0, 1, 2, 3], [0.0, 1.0, 1.5, 1.5])
    assert law.rate(0.0, 1.0) == 1.0
    assert law.rate(1.0, 2.0) == 0.5
    assert law.rate(0.5, 1.5) == 1.0
    assert law.rate(2.0, 2.0) == 0.0
    assert law.rate(0.0, 3.0) == 1.0


def test_law_of_a_function_is_the_function():
    law = Law.of(lambda t: [math.sin(t), t], end=2.0, rate=1.0)
    assert law.at(np.array([0.3])) == pytest.approx(np.array([[math.sin(0.3), 0.3]]))
    assert law.at(np.empty(0)).shape == (0, 2)


def test_a_constant_is_defined_always_and_has_no_rate():
    law = Law.constant([0.2, 0.4])
    assert law.at(np.array([-1e9, 1e9])).tolist() == [[0.2, 0.4]] * 2
    assert law.rate(-5.0, 5.0).tolist() == [0.0, 0.0]


@given(SEEDS, reals(0, 1))
def test_motion_through_waypoints_is_a_line_and_a_turn_about_one_axis(seed, share):
    motion, times, places, turns = waypoints(np.random.default_rng(seed), 4)
    time = times[1] + share * (times[2] - times[1])
    found = motion.at(np.array([time]))[0]
    turn = (turns[1].inv() * turns[2]).as_rotvec()
    middle = turns[1] * Rotation.from_rotvec(share * turn)
    assert found[:3, 3] == pytest.approx(places[1] + share * (places[2] - places[1]))
    assert found[:3, :3] == pytest.approx(middle.as_matrix(), abs=1e-9)
    assert found[3].tolist() == [0, 0, 0, 1]


def test_motion_without_rotations_keeps_the_worlds_axes():
    motion = Motion.through([0, 2], [[0, 0, 0], [4, 0, 0]])
    expected = np.eye(4)
    expected[0, 3] = 1
    assert motion.at(np.array([0.5]))[0] == pytest.approx(expected)
    assert motion.bounds(0, 2) == (2.0, 0.0)


def test_resting_base_stays_at_its_pose():
    motion = Motion.resting(pose((1, 2, 3), 0.4))
    assert motion.at(np.array([-7.0, 7.0])) == pytest.approx(
        np.array([pose((1, 2, 3), 0.4)] * 2)
    )
    assert motion.bounds(-7, 7) == (0.0, 0.0)
    assert Motion.resting().at(np.zeros(1))[0].tolist() == np.eye(4).tolist()


# Bounds --------------------------------------------------------------------------


@given(SEEDS)
def test_bounds_of_waypoints_are_bounds_and_reached(seed):
    rng = np.random.default_rng(seed)
    motion, times, _, _ = waypoints(rng, 5)
    pairs = np.sort(rng.uniform(times[0], times[-1], (40, 2)), axis=1)
    for low, high in pairs[np.diff(pairs)[:, 0] > 1e-6]:
        first, second = motion.at(np.array([low, high]))
        speed, turn_rate = motion.bounds(low, high)
        moved = np.linalg.norm(second[:3, 3] - first[:3, 3])
        turned = Rotation.from_matrix(first[:3, :3].T @ second[:3, :3]).magnitude()
        assert moved <= speed * (high - low) * (1 + 1e-9)
        assert turned <= turn_rate * (high - low) * (1 + 1e-9) + 1e-12
    first, second = motion.at(times[:2])
    speed, _ = motion.bounds(*times[:2])
    moved = np.linalg.norm(second[:3, 3] - first[:3, 3])
    assert moved == pytest.approx(speed * (times[1] - times[0]))


def test_a_bound_given_for_a_function_is_kept_up_to_rounding():
    motion = Motion.of(swing, end=3.0, speed=1.0, turn_rate=2.0)
    speed, turn_rate = motion.bounds(0.0, 3.0)
    assert speed == pytest.approx(1.0, rel=1e-5)
    assert speed >= 1.0
    assert turn_rate == pytest.approx(2.0, rel=1e-5)
    assert motion.times.tolist() == [0.0, 3.0]
    assert motion.at(np.array([1.1]))[0] == pytest.approx(swing(1.1))


# Bad input -----------------------------------------------------------------------


def failing(error, after=-1.0):
    def function(time):
        if time > after:
            raise error
        return np.eye(4)

    return function


@pytest.mark.parametrize(
    ("times", "places", "message"),
    [
        ([0, 0], TWO, r"times\[1\] = 0.0 is not ascending: sort them"),
        ([1, 0], TWO, "ascending"),
        ([0], TWO[:1], r"times.shape = \(1,\) is not \(n,\), n ≥ 2"),
        ([0, np.nan], TWO, r"times\[1\] = nan is not finite"),
        ("ab", TWO, "times = 'ab' is not an array of numbers"),
        ([0, 1, 2], TWO, r"positions.shape = \(2, 3\) is not \(3, 3\)"),
        ([0, 1], [[0, 0], [1, 1]], r"positions.shape = \(2, 2\) is not \(2, 3\)"),
        ([0, 1], [[0, 0, 0], [0, 0, np.inf]], "finite"),
    ],
)
def test_bad_waypoints_are_named(times, places, message):
    with pytest.raises(ParameterError, match=message):
        Motion.through(times, places)


@pytest.mark.parametrize(
    ("second", "message"),
    [
        (np.diag([1, 1, 1.1]), r"error of rotations\[1\] = 0.21"),
        (np.diag([1, 1, -1.0]), r"determinant of rotations\[1\] = -1.0 is not 1"),
        (np.zeros((3, 3)), "orthonormal"),
        (1e200 * np.eye(3), "orthonormal"),
        (QUARTER + 2e-6, "orthonormal"),
    ],
)
def test_what_is_no_rotation_is_named(second, message):
    with pytest.raises(ParameterError, match=message):
        Motion.through([0, 1], TWO, [np.eye(3), second])
    bad = np.eye(4)
    bad[:3, :3] = second
    with pytest.raises(ParameterError, match=r"orthonormal|determinant"):
        Motion.resting(bad)


def test_rotations_written_with_six_digits_pass():
    turn = Rotation.from_euler("xyz", [0.3, 1.1, -0.4]).as_matrix()
    motion = Motion.through([0, 1], TWO, [np.eye(3), turn.round(6)])
    assert motion.at(np.ones(1))[0, :3, :3] == pytest.approx(turn, abs=2e-6)


@pytest.mark.parametrize(
    ("function", "message"),
    [
        (failing(ZeroDivisionError("no")), r"motion\(0\) = 'ZeroDivisionError: no'"),
        (failing(ValueError("half"), 0.5), r"motion\(0.501953\) = 'ValueError: half'"),
        (lambda _: np.eye(3), r"motion.shape = \(3, 3\) is not \(4, 4\)"),
        (lambda t: np.eye(4 if t < 0.5 else 3), r"motion\(0.5\).shape = \(3, 3\)"),
        (lambda t: pose((0, 0, 0 if t < 1 else np.nan)), r"motion\(1\)\[2, 3\] = nan"),
        (lambda _: None, r"motion\(0\) = None is not an array of numbers"),
        (lambda _: 2 * np.eye(4), "orthonormal"),
        (lambda t: pose((2 * t, 0, 0)), "speed = 1.0 is not at least the 2"),
        (lambda t: pose((t > 0.5, 0, 0)), "speed = 1.0 is not at least the 512"),
        (lambda t: pose(angle=t), "turn_rate = 0.0 is not at least the 1"),
        (3, "motion = 3 is not a function"),
    ],
)
def test_a_function_that_is_no_motion_is_named(function, message):
    with pytest.raises(ParameterError, match=message) as caught:
        Motion.of(function, end=1.0, speed=1.0)
    assert "\n" not in str(caught.value)


def test_a_function_that_changes_its_shape_between_probes_is_named():
    motion = Motion.of(
        lambda t: np.eye(4) if t * 512 % 1 == 0 else np.eye(3), end=1.0, speed=0.0
    )
    with pytest.raises(ParameterError, match=r"motion\(0.3\).shape = \(3, 3\)"):
        motion.at(np.array([0.3]))


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"end": 0.0}, "end = 0.0 is not a time > 0"),
        ({"end": np.nan}, "end = nan"),
        ({"speed": -1.0}, "speed = -1.0 is not at least 0"),
        ({"speed": np.inf}, "speed = inf is not finite"),
        ({"speed": [1, 1, 1]}, r"speed.shape = \(3,\) is not \(\)"),
        ({"turn_rate": None}, "turn_rate = None"),
    ],
)
def test_bad_bounds_of_a_motion_are_named(changes, message):
    with pytest.raises(ParameterError, match=message):
        Motion.of(pose, **{"end": 1.0, "speed": 1.0, **changes})


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Law.through([0, 1], [0, 1, 2]), r"values.shape = \(3,\) is not \(2\)"),
        (lambda: Law.through([0, 1], 3.0), "values.shape"),
        (lambda: Law.through([0, 1], ["a", "b"]), "values"),
        (lambda: Law.through([1, 1], [0, 1]), "ascending"),
        (lambda: Law.constant("a"), "value = 'a'"),
        (lambda: Law.of(lambda t: t, end=1, rate=0.5), "rate = 0.5 is not at least"),
        (lambda: Law.of(lambda t: [t, 0], end=1, rate=[0.5, 1]), r"rate\[0\] = 0.5"),
        (lambda: Law.of(lambda t: [t, 0], end=1, rate=[1, 1, 1]), r"rate.shape = \(3,"),
        (lambda: Law.of(lambda t: [0] * (1 + (t > 0.5)), end=1, rate=1), "shape"),
        (lambda: Law.of(lambda _: None, end=1, rate=1), r"law\(0\) = None"),
        (lambda: Law.of(lambda t: 1 / t, end=1, rate=1), "ZeroDivisionError"),
    ],
)
def test_bad_laws_are_named(make, message):
    with pytest.raises(ParameterError, match=message):
        make()


def test_a_position_in_the_last_row_is_named():
    transposed = pose((1, 2, 3), 0.4).T
    with pytest.raises(ParameterError, match=r"last row of pose.*1.0 is not"):
        Motion.resting(transposed)
    with pytest.raises(ParameterError, match=r"last row of motion.*1.0 is not"):
        Motion.of(lambda _: transposed, end=1.0, speed=0.0)


def test_a_pose_at_rest_is_a_matrix():
    with pytest.raises(ParameterError, match=r"pose.shape = \(3, 3\) is not \(4, 4\)"):
        Motion.resting(np.eye(3))


def test_laws_and_motions_are_read_only():
    law, motion = Law.through([0, 1], [0, 1]), Motion.resting()
    for values in (law.times, law.rates, motion.times, motion.speeds):
        assert not values.flags.writeable
