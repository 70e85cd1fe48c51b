"""Areas of unions of stadiums: by hand, by chance, by a fine raster, and their laws."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import reals

from zygopin.stadiums import Stadiums

R, LENGTH = 0.3, 2.0
ONE = 2 * R * LENGTH + math.pi * R**2
"""Area of one stadium of this radius around a segment of this length."""


def union(*segments, radius=R):
    """Area of the union of stadiums around segments given by their ends."""
    radii = np.broadcast_to(radius, len(segments))
    return Stadiums.around(np.array(segments, dtype=complex), radii).area()


def lens(apart, radius):
    """Area that two discs of one radius share."""
    half = apart / 2
    return 2 * radius**2 * math.acos(half / radius) - apart * math.sqrt(
        radius**2 - half**2
    )


BY_HAND = {
    "one": (ONE, [(0, LENGTH)]),
    "one the other way": (ONE, [(LENGTH, 0)]),
    "upright": (ONE, [(1j, 1j * (1 + LENGTH))]),
    "all but upright": (ONE, [(0, 1e-310 + 1j * LENGTH)]),
    "all but a disc": (math.pi * R**2, [(0, 1e-310j), (1e-200, 0)]),
    "a disc": (math.pi * R**2, [(1, 1)]),
    "collinear": (ONE, [(0, 1.5), (1, LENGTH)]),
    "end to end": (ONE, [(0, 1), (1, LENGTH)]),
    "the same twice": (ONE, [(0, LENGTH), (LENGTH, 0)]),
    "one within": (ONE, [(0, LENGTH), (1, 1.5)]),
    "apart": (2 * ONE, [(0, LENGTH), (1j, LENGTH + 1j)]),
    "side by side": (2 * ONE, [(0, LENGTH), (2j * R, LENGTH + 2j * R)]),
    "a cross": (2 * ONE - 4 * R**2, [(-1, 1), (-1j, 1j)]),
    "a corner": (
        2 * ONE - R**2 - 0.75 * math.pi * R**2,
        [(0, LENGTH), (0, 1j * LENGTH)],
    ),
    "two discs": (2 * math.pi * R**2 - lens(0.4, R), [(0, 0), (0.4j, 0.4j)]),
    "overlapping sides": (
        2 * ONE - (2 * R - 0.2) * LENGTH - lens(0.2, R),
        [(0, LENGTH), (0.2j, LENGTH + 0.2j)],
    ),
}


@pytest.mark.parametrize("turn", [0.0, 0.4, math.pi / 2, math.pi])
@pytest.mark.parametrize("name", BY_HAND)
def test_areas_worked_by_hand_however_they_are_turned(name, turn):
    area, segments = BY_HAND[name]
    turned = np.array(segments) * np.exp(1j * turn)
    assert union(*turned) == pytest.approx(area, rel=1e-14)


def test_discs_of_different_radii_that_hold_one_another():
    assert union((0, 0), (0.1, 0.1), radius=(1, 0.2)) == pytest.approx(math.pi)


def test_bare_segments_have_no_area():
    assert union((0, 1), (1j, 1), (2, 2), radius=0.0) == 0


def sets(least=1, most=7):
    """Some stadiums: segments and radii; places repeat, so that shapes coincide."""
    place = st.builds(complex, reals(-1, 1), reals(-1, 1))
    place |= st.sampled_from([0, 1, 1j, 0.5, -0.5j])
    one = st.tuples(place, place, st.sampled_from([0.25, 0.5]) | reals(0.01, 0.6))
    return st.lists(one, min_size=least, max_size=most).map(
        lambda each: (np.array([e[:2] for e in each], complex), [e[2] for e in each])
    )


def area(segments, radii):
    """Area of a union."""
    return Stadiums.around(segments, np.array(radii)).area()


@given(sets(), reals(-4, 4), st.builds(complex, reals(-3, 3), reals(-3, 3)))
@settings(max_examples=60, deadline=None)
def test_motion_and_order_change_nothing_and_size_goes_by_its_square(
    given_set, turn, to
):
    segments, radii = given_set
    found = area(segments, radii)
    moved = segments * np.exp(1j * turn) + to
    assert area(moved, radii) == pytest.approx(found, rel=1e-11)
    assert area(segments.conj()[::-1, ::-1], radii[::-1]) == pytest.approx(found)
    larger = area(1e6 * segments, 1e6 * np.array(radii))
    assert larger == pytest.approx(1e12 * found, rel=1e-11)


@given(sets(), sets())
@settings(max_examples=40, deadline=None)
def test_a_union_holds_its_parts_and_no_more(one, other):
    both = area(np.concatenate([one[0], other[0]]), one[1] + other[1])
    parts = area(*one), area(*other)
    assert max(parts) - 1e-12 <= both <= sum(parts) + 1e-12
    twice = area(np.concatenate([one[0], one[0]]), one[1] * 2)
    assert twice == pytest.approx(parts[0], rel=1e-12)


def covered(points, segments, radii):
    """Which points a union holds, by the distance to each segment."""
    inside = np.zeros(points.shape, bool)
    for (start, end), radius in zip(segments, radii, strict=True):
        step = end - start
        along = np.real(np.conj(step) * (points - start)) / (abs(step) ** 2 or 1)
        nearest = start + np.clip(along, 0, 1) * step
        inside |= abs(points - nearest) <= radius
    return inside


def drawn(seed, count):
    """Random stadiums within a square of half-width 2."""
    rng = np.random.default_rng(seed)
    ends = rng.uniform(-1.4, 1.4, (count, 2, 2))
    return ends[..., 0] + 1j * ends[..., 1], rng.uniform(0.05, 0.6, count), rng


@pytest.mark.parametrize(("seed", "count"), [(0, 2), (1, 4), (2, 14)])
def test_points_thrown_at_random_hit_as_often_as_the_area_says(seed, count):
    segments, radii, rng = drawn(seed, count)
    places = rng.uniform(-2, 2, (200_000, 2))
    hits = covered(places[:, 0] + 1j * places[:, 1], segments, radii)
    expected = area(segments, radii) / 16
    deviation = math.sqrt(expected * (1 - expected) / len(hits))
    assert abs(hits.mean() - expected) < 5 * deviation


def test_cells_of_a_fine_raster_add_up_to_the_area():
    segments, radii, _ = drawn(3, 6)
    cell = 4 / 2000
    axis = np.arange(-2 + cell / 2, 2, cell)
    hits = covered(axis + 1j * axis[:, None], segments, radii)
    # Cells' centres err by less than a cell's width along the whole outline.
    outline = np.sum(2 * abs(segments[:, 0] - segments[:, 1]) + 2 * np.pi * radii)
    assert abs(hits.sum() * cell**2 - area(segments, radii)) < outline * cell / 20


def test_many_stadiums_are_cut_in_blocks():
    grid = [complex(x, y) for x in range(12) for y in range(12)]
    found = union(*((place, place + 0.4) for place in grid), radius=0.2)
    assert found == pytest.approx(144 * (0.16 + math.pi * 0.04), rel=1e-13)
