"""The Illinois method: roots in brackets, each function in its own."""

from __future__ import annotations

import numpy as np

from zygopin.illinois import crossings

SHIFTS = np.array([0.1, 0.5, 2.0, 7.9])


def cubes(index, place):
    """place³ less a shift of each function's own."""
    return place**3 - SHIFTS[index]


def solved(steps, ends=(0.0, 2.0)):
    """What the method finds for all functions."""
    low, high = (np.full(len(SHIFTS), end) for end in ends)
    every = np.arange(len(SHIFTS))
    values = cubes(every, low), cubes(every, high)
    return crossings(cubes, (low, high), values, np.full(len(SHIFTS), 1e-13), steps)


def test_each_function_is_solved_in_its_own_bracket():
    for ends in ((0.0, 2.0), (2.0, 0.0)):
        place, found = solved(60, ends)
        assert found.all()
        np.testing.assert_allclose(place, np.cbrt(SHIFTS), rtol=1e-12)


def test_too_few_steps_are_told():
    place, found = solved(2)
    assert not found.any()
    assert np.all(place == 2.0)


def test_a_kink_does_not_stop_it():
    def kinked(_, place):
        return np.where(place < 0.7, 1e-3 * (place - 0.7), 50 * (place - 0.7))

    ends = np.zeros(1), np.ones(1)
    values = tuple(kinked(None, end) for end in ends)
    place, found = crossings(kinked, ends, values, np.full(1, 1e-13), 200)
    assert found.all()
    assert abs(place[0] - 0.7) < 1e-9


def test_no_function_is_no_work():
    nothing = np.zeros(0)
    place, found = crossings(cubes, (nothing, nothing), (nothing, nothing), nothing, 5)
    assert place.shape == found.shape == (0,)
