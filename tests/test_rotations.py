"""Rotations: what is one, the nearest to one, and the turns between them."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from zygopin import ParameterError
from zygopin.rotations import (
    angles_between,
    as_rotations,
    quaternions,
    turns_between,
)

QUARTER = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])


def test_what_was_written_with_six_digits_becomes_a_rotation():
    true = Rotation.from_rotvec([[0.3, -0.2, 0.9], [2.0, 1.0, 0.5]]).as_matrix()
    found = as_rotations("turns", np.round(true, 7))
    np.testing.assert_allclose(found, true, atol=2e-7)
    np.testing.assert_allclose(
        found @ found.swapaxes(-1, -2), [np.eye(3)] * 2, atol=1e-14
    )


def test_angles_of_tiny_turns_and_of_half_ones_are_exact():
    angles = np.array([1e-12, 1e-6, 0.5, math.pi / 2, 3.0, math.pi])
    steps = Rotation.from_rotvec(np.outer(angles, [0.6, 0.0, 0.8])).as_matrix()
    for angle, step in zip(angles, steps, strict=True):
        (found,) = angles_between(np.stack([QUARTER, QUARTER @ step]))
        assert found == pytest.approx(angle, rel=1e-9, abs=2e-16)


def test_a_turn_has_constant_speed():
    turn = turns_between(np.array([0.0, 2.0]), np.stack([np.eye(3), QUARTER]))
    (middle,) = turn(np.array([0.5]))
    expected = Rotation.from_euler("z", 22.5, degrees=True).as_matrix()
    np.testing.assert_allclose(middle, expected, atol=1e-14)


def test_quaternions_are_scipy_s_for_turns_of_any_size():
    units = np.random.default_rng(5).normal(size=(2, 500, 4))
    turns = Rotation.from_quat(units.reshape(-1, 4)).as_matrix().reshape(2, 500, 3, 3)
    found = quaternions(turns)
    expected = Rotation.from_matrix(turns.reshape(-1, 3, 3)).as_quat()
    np.testing.assert_allclose(found.reshape(-1, 4), expected, rtol=0, atol=1e-15)
    assert np.all(np.take_along_axis(found, abs(found).argmax(-1)[..., None], -1) > 0)


def test_quaternions_of_half_turns_and_a_quarter_one_are_exact():
    half = np.stack([np.diag(signs) for signs in ((1, 1, 1), (1, -1, -1), (-1, -1, 1))])
    expected = [[0, 0, 0, 1], [1, 0, 0, 0], [0, 0, 1, 0]]
    np.testing.assert_array_equal(quaternions(half.astype(float)), expected)
    root = math.sqrt(0.5)
    np.testing.assert_allclose(quaternions(QUARTER), [0, 0, root, root], atol=1e-16)


@pytest.mark.parametrize(
    ("matrix", "message"),
    [
        (1.001 * np.eye(3), "error of turn"),
        (np.zeros((3, 3)), "error of turn"),
        (1e300 * np.eye(3), "error of turn"),
        (np.diag([1.0, 1.0, -1.0]), "determinant of turn = -1.0"),
    ],
)
def test_what_is_no_rotation_is_named(matrix, message):
    with pytest.raises(ParameterError, match=message):
        as_rotations("turn", matrix)
