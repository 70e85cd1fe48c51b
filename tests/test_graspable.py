"""The radii of perches that a foot grasps: intervals, their ends, their measure."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.strategies import reals
from zygopin import Finger, Foot, search_perch
from zygopin.errors import ParameterError
from zygopin.graspable import GraspableRadii, graspable_radii, true_intervals
from zygopin.rest import resting_branch

PARROT = Foot.preset("parrot")
SMALL = PARROT.replace(fingers=(Finger("back", 3, math.pi), Finger("front", 3, 0.0)))
"""A foot of two short fingers, which is quick."""


@given(st.lists(reals(0.0, 10.0), min_size=2, max_size=8, unique=True))
def test_the_ends_of_known_intervals_are_found(places):
    places = sorted(places)[: len(places) // 2 * 2]
    wanted = list(zip(places[::2], places[1::2], strict=True))
    # Every end and a point of every gap is a sample, so that none can be missed.
    inner = [(a + b) / 2 for a, b in pairwise(places)]
    samples = sorted({-1.0, *places, *inner, 11.0})
    found = true_intervals(lambda x: any(a <= x <= b for a, b in wanted), samples, 1e-9)
    near = [(a, b) for a, b in wanted if b - a > 1e-6]
    wide = [(a, b) for a, b in found if b - a > 1e-6]
    if all(b - a > 1e-6 for a, b in pairwise(places)):
        assert np.array(wide) == pytest.approx(np.array(near), abs=1e-9)


@pytest.mark.parametrize(
    ("known", "expected"),
    [
        ("....", ()),
        ("####", ((0.0, 3.0),)),
        ("#...", ((0.0, 0.5),)),
        ("...#", ((2.5, 3.0),)),
        (".#..", ((0.5, 1.5),)),
        ("#.##", ((0.0, 0.5), (1.5, 3.0))),
    ],
)
def test_runs_of_samples_become_intervals(known, expected):
    def holds(x):
        return known[round(x)] == "#"  # changes at 0.5, 1.5, 2.5

    found = true_intervals(holds, [0.0, 1.0, 2.0, 3.0], 1e-6)
    assert np.array(found) == pytest.approx(np.array(expected), abs=1e-6)
    assert all(holds(end) for ends in found for end in ends)


def test_bisection_ends_where_doubles_end():
    (found,) = true_intervals(lambda x: x < 1.0, [0.0, 2.0], 1e-300)
    assert found == (0.0, math.nextafter(1.0, 0.0))


def test_measures_of_intervals_worked_by_hand():
    made = GraspableRadii(PARROT, 1.0, 8.0, 1e-3, ((1.0, 2.0), (4.0, 8.0)), 0.0, 9)
    assert made.length == 5.0
    assert made.log_length == pytest.approx(2 * math.log(2))
    assert made.share == pytest.approx(2 / 3)


def test_ends_part_what_is_grasped_from_what_is_not():
    found = graspable_radii(SMALL, 0.002, 0.1, levels=4, samples=9, tolerance=1e-6)
    low, high = found.intervals[-1]
    assert 0.002 < high < 0.1

    def grasped(radius):
        return search_perch(SMALL, resting_branch(SMALL, radius), levels=4).grasping

    assert grasped(high)
    assert grasped((low + high) / 2)
    assert not grasped(high + 1e-6)
    assert found.plans >= 9
    assert 0 < found.wrap < 2 * math.pi


@pytest.mark.parametrize("factor", [1e-2, 1e3])
def test_a_similar_foot_grasps_similar_perches(factor):
    large = SMALL.replace(
        scale=factor * SMALL.scale, thickness=factor * SMALL.thickness
    )
    options = {"levels": 3, "samples": 5}
    one = graspable_radii(SMALL, 0.004, 0.05, **options)
    other = graspable_radii(large, 0.004 * factor, 0.05 * factor, **options)
    ends = np.array(one.intervals) * factor
    assert np.array(other.intervals) == pytest.approx(ends, rel=1e-4)
    assert other.share == pytest.approx(one.share, abs=1e-4)
    assert other.wrap == pytest.approx(one.wrap, abs=1e-6)


def test_a_foot_without_opposite_toes_grasps_nothing():
    fingers = tuple(finger for finger in SMALL.fingers if math.cos(finger.azimuth) > 0)
    found = graspable_radii(
        SMALL.replace(fingers=fingers), 0.004, 0.02, levels=2, samples=3
    )
    assert found.intervals == ()
    assert (found.length, found.share, found.wrap) == (0, 0, 0)


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        ((0.02, 0.003), {}, "is not ascending: give the lesser radius first"),
        ((0.0, 0.003), {}, "low = 0.0 is not a positive"),
        ((0.003, math.nan), {}, "high = nan is not finite"),
        ((0.003, 0.02), {"samples": 1}, "samples = 1"),
        ((0.003, 0.02), {"tolerance": 0.0}, "tolerance = 0"),
        ((0.003, 0.02), {"levels": 1}, "levels = 1"),
    ],
)
def test_bad_ranges_are_named(arguments, options, words):
    with pytest.raises(ParameterError, match=words):
        graspable_radii(PARROT, *arguments, **options)
