"""The Hausdorff distance: a metric, exact, with the points that attain it."""

from __future__ import annotations

import time

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from zygopin.errors import ParameterError
from zygopin.hausdorff import directed_distance, hausdorff_distance

FEW = settings(max_examples=40, deadline=None)
COORDINATE = st.integers(-8, 8).map(float)


def clouds(dimension=2):
    """Small clouds on a lattice: many ties and repetitions."""
    shape = st.tuples(st.integers(1, 9), st.just(dimension))
    return hnp.arrays(np.float64, shape, elements=COORDINATE)


def by_definition(first, second):
    distances = np.linalg.norm(first[:, None] - second[None], axis=-1)
    return max(distances.min(1).max(), distances.min(0).max())


def test_worked_by_hand():
    found = hausdorff_distance([[0, 0], [1, 0]], [[0, 0], [4, 4]])
    assert found.value == 5.0
    assert found.indices == (1, 1)
    np.testing.assert_array_equal(found.points, [[1, 0], [4, 4]])


def test_one_sided_distance_depends_on_the_side():
    part, whole = [[0.0, 0, 0]], [[0, 0, 0], [0, 3, 4]]
    assert directed_distance(part, whole).value == 0
    assert directed_distance(whole, part).value == 5
    assert directed_distance(whole, part).indices == (1, 0)


@FEW
@given(clouds(3), clouds(3))
def test_it_is_the_definition(first, second):
    found = hausdorff_distance(first, second)
    assert found.value == pytest.approx(by_definition(first, second), abs=1e-14)


@FEW
@given(clouds(), clouds())
def test_the_points_attain_it_and_stand_at_their_indices(first, second):
    found = hausdorff_distance(first, second)
    ends = first[found.indices[0]], second[found.indices[1]]
    np.testing.assert_array_equal(found.points, ends)
    assert found.value == pytest.approx(np.linalg.norm(ends[0] - ends[1]), abs=1e-14)


@FEW
@given(clouds(), clouds(), clouds())
def test_it_is_a_metric_on_sets(first, second, third):
    def distance(a, b):
        return hausdorff_distance(a, b).value

    assert distance(first, first[::-1]) == 0
    assert distance(first, second) == distance(second, first)
    via = distance(first, second) + distance(second, third)
    assert distance(first, third) <= via + 1e-12


@FEW
@given(clouds(), clouds(), st.integers(-9, 9))
def test_it_scales_with_the_unit(first, second, power):
    factor = 2.0**power
    scaled = hausdorff_distance(factor * first, factor * second)
    assert scaled.value == factor * hausdorff_distance(first, second).value


@FEW
@given(clouds(), clouds())
def test_complex_numbers_are_points_of_the_plane(first, second):
    numbers = [cloud[:, 0] + 1j * cloud[:, 1] for cloud in (first, second)]
    assert hausdorff_distance(*numbers).value == hausdorff_distance(first, second).value


def test_a_million_equal_points_are_one():
    begin = time.perf_counter()
    found = hausdorff_distance(np.zeros((10**6, 2)), [[3.0, 4.0]])
    assert found.value == 5
    assert found.indices == (0, 0)
    assert time.perf_counter() - begin < 5


def test_a_hundred_thousand_points_take_less_than_seconds():
    first, second = np.random.default_rng(0).normal(size=(2, 10**5, 3))
    begin = time.perf_counter()
    found = hausdorff_distance(first, second)
    assert time.perf_counter() - begin < 5
    ends = first[found.indices[0]], second[found.indices[1]]
    assert found.value == pytest.approx(np.linalg.norm(ends[0] - ends[1]))


def test_it_owns_its_points():
    cloud = np.zeros((1, 2))
    found = hausdorff_distance(cloud, [[3, 4]])
    cloud[:] = 9
    np.testing.assert_array_equal(found.points, [[0, 0], [3, 4]])
    with pytest.raises(ValueError, match="read-only"):
        found.points[0] = 1


@pytest.mark.parametrize(
    ("first", "second", "words"),
    [
        ([[0, np.nan]], [[0, 0]], "first[0, 1] = nan is not finite"),
        ([[0, 0]], [[0, 0, 0]], "second.shape = (1, 3) is not of the first"),
        ([[0, 0]], np.empty((0, 2)), "second.shape = (0, 2) is not of the form"),
        ([0.0, 1.0], [[0, 0]], "first.shape = (2,) is not of the form (N, D)"),
        ([["a"]], [[0, 0]], "is not an array of numbers"),
    ],
)
def test_bad_clouds_are_named_in_one_line(first, second, words):
    with pytest.raises(ParameterError) as caught:
        hausdorff_distance(first, second)
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
