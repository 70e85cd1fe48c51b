"""Records of arrays: rows of them, and several as one."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from zygopin.records import joined, taken


@dataclass(frozen=True)
class Sample:
    name: str
    values: np.ndarray
    points: np.ndarray


def sample(start, count):
    values = np.arange(start, start + count)
    return Sample("one", values, np.stack([values, -values], axis=1))


def test_rows_are_taken_of_every_array_and_the_rest_is_kept():
    some = taken(sample(0, 5), np.array([3, 1]))
    assert some.name == "one"
    np.testing.assert_array_equal(some.values, [3, 1])
    np.testing.assert_array_equal(some.points, [[3, -3], [1, -1]])
    assert len(taken(some, slice(0)).points) == 0


def test_parts_joined_are_the_whole():
    whole = sample(0, 5)
    again = joined([taken(whole, slice(2)), taken(whole, slice(2, None))])
    np.testing.assert_array_equal(again.values, whole.values)
    np.testing.assert_array_equal(again.points, whole.points)
