"""Directions of phalanges, and products in pieces: against the plain formulas."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import controls_for, feet

from zygopin.directions import SERIAL, cosine_and_sine, directions, product, running_sum
from zygopin.foot import Finger, Foot


@given(feet().flatmap(lambda foot: st.tuples(st.just(foot), controls_for(foot, (3,)))))
def test_directions_are_cosine_and_sine_of_the_summed_angles(posed):
    foot, controls = posed
    found = directions(foot, controls)
    for finger, part in zip(foot.fingers, foot.finger_slices.values(), strict=True):
        for pose, values in enumerate(controls[:, part]):
            pitch = finger.orientation
            for k, control in enumerate(values, part.start):
                pitch += foot.omega * control
                expected = math.cos(pitch), math.sin(pitch)
                assert found[:, k, pose] == pytest.approx(expected, abs=2e-14)


def test_directions_at_the_poles_of_the_tangent():
    # One phalanx, ω = 3π/2: controls that turn it by 0, π/2, π, 3π/2.
    foot = Foot(omega=1.5 * math.pi, fingers=(Finger("toe", 1, 0.0),))
    found = directions(foot, np.array([[0], [1 / 3], [2 / 3], [1]]))
    assert found[0, 0] == pytest.approx([1, 0, -1, 0], abs=5e-16)
    assert found[1, 0] == pytest.approx([0, 1, 0, -1], abs=5e-16)
    assert found[:, 0, 0].tolist() == [1, 0]


def test_cosine_and_sine_are_numpys_to_rounding():
    angles = np.concatenate([np.linspace(-80, 80, 200_001), np.pi * np.arange(-30, 31)])
    found = cosine_and_sine(angles / 2)
    assert np.abs(found - [np.cos(angles), np.sin(angles)]).max() < 1e-15
    assert cosine_and_sine(np.array(0.25)) == pytest.approx(
        [math.cos(0.5), math.sin(0.5)]
    )


@pytest.mark.parametrize("count", [0, 1, 63, 64, 65, 1000])
@pytest.mark.parametrize("layout", "CF")
def test_products_in_pieces_are_the_product(monkeypatch, count, layout):
    monkeypatch.setattr("zygopin.directions.SERIAL", 64 * 15)
    rng = np.random.default_rng(count)
    matrix, columns = rng.random((3, 5)), rng.random((5, count))
    given = np.asarray(columns, order=layout)
    assert product(matrix, given) == pytest.approx(matrix @ columns, abs=1e-14)
    out = np.empty((3, count), order=layout)
    assert product(matrix, given, out=out) is out
    assert out == pytest.approx(matrix @ columns, abs=1e-14)


def test_a_matrix_too_large_for_one_thread_is_used_all_the_same():
    matrix = np.eye(math.isqrt(SERIAL) + 1)
    columns = np.random.default_rng(0).random((len(matrix), 2))
    assert (product(matrix, columns) == columns).all()


def test_sums_run_along_each_finger_by_hand():
    foot = Foot(fingers=(Finger("one", 1, 0.0), Finger("two", 3, 1.0)))
    rows = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 1, 1, 0], [0, 1, 1, 1]]
    assert running_sum(foot).tolist() == rows
    assert not running_sum(foot).flags.writeable
