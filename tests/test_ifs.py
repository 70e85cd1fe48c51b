"""Reachable sets: the recurrence, the contractions' laws, and the certificates."""

from __future__ import annotations

import math
import tracemalloc

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial import cKDTree
from strategies import level_sets, omegas, planar_points, reals

from zygopin.control_system import (
    ControlSystem,
    as_levels,
    depth_bound,
    depth_within,
    grid_bound,
    words,
)
from zygopin.errors import ParameterError
from zygopin.ifs import (
    attractor,
    contraction,
    hutchinson,
    iter_reachable,
    reachable_set,
)

PHI = (1 + math.sqrt(5)) / 2
LAWS = settings(max_examples=40, deadline=None, derandomize=True)


def chain(rho, omega, controls, orientation=0.0):
    """The tip by the recurrence (sys), one phalanx after the other."""
    place, pitch = np.zeros(controls.shape[:-1], complex), orientation
    for rank in range(1, controls.shape[-1] + 1):
        pitch = pitch + omega * controls[..., rank - 1]
        place = place + rho**-rank * np.exp(-1j * pitch)
    return place


def one_sided(points, others):
    """How far points may be from the next of some others."""
    tree = cKDTree(np.column_stack([others.real, others.imag]))
    return tree.query(np.column_stack([points.real, points.imag]))[0].max()


def hausdorff(points, others):
    return max(one_sided(points, others), one_sided(others, points))


def test_the_reference_set_of_finger_3():
    reachable = reachable_set(PHI, math.pi / 6, 33, 4)
    points = reachable.points
    assert points.shape == (1_185_921,)
    parameters = reachable.rho, reachable.omega, reachable.orientation
    assert parameters == (PHI, math.pi / 6, 0)
    assert points.real.min() == pytest.approx(0.653267, abs=1e-6)
    assert points.real.max() == pytest.approx(1.381966, abs=1e-6)
    assert points.imag.min() == pytest.approx(-1.021775, abs=1e-6)
    assert points.imag.max() == 0
    assert points[-1] == pytest.approx(0.653267 - 1.002229j, abs=1e-6)
    assert reachable.depth_bound == pytest.approx(PHI**-3)


@LAWS
@given(st.data())
def test_each_point_is_the_tip_of_its_word(data):
    rho, omega, levels = data.draw(reals(1.01, 4)), data.draw(omegas()), level_sets()
    levels, depth = data.draw(levels), data.draw(st.integers(1, 5))
    turn = data.draw(reals(-7, 7))
    reachable = reachable_set(rho, omega, levels, depth, orientation=turn)
    assert reachable.orientation == turn
    controls = reachable.words(np.arange(len(reachable.points)))
    assert controls.shape == (len(as_levels(levels)) ** depth, depth)
    tips = chain(rho, omega, controls, turn)
    assert np.abs(tips - reachable.points).max() < 1e-13 * depth


def test_words_stand_in_lexicographic_order():
    expected = [[0, 0], [0, 0.5], [0, 1], [0.5, 0], [0.5, 0.5], [0.5, 1]]
    assert words(3, 2, range(6)).tolist() == expected
    assert words([1, 0], 2, [[1], [2]]).tolist() == [[[0, 1]], [[1, 0]]]
    assert words(2, 100, [1]).tolist() == [[0] * 99 + [1]]


@LAWS
@given(planar_points(), planar_points(), reals(0, 1), reals(1.01, 4), omegas())
def test_contractions_shrink_by_rho(one, other, control, rho, omega):
    images = contraction([one, other], control, rho, omega)
    gap = abs(images[0] - images[1])
    assert gap == pytest.approx(abs(one - other) / rho, abs=1e-12)


@pytest.mark.parametrize(
    ("control", "image"),
    [(0, 1 + 0.5j), (1, 0.5 - 1j), ([0, 1], [1 + 0.5j, 0.5 - 1j])],
)
def test_contractions_by_hand(control, image):
    # One length on from 1 + i lies 2 + i: half of it, as it is or a quarter turn down.
    assert contraction(1 + 1j, control, 2, math.pi / 2) == pytest.approx(image)


@LAWS
@given(reals(1.01, 4), omegas(), level_sets(), st.integers(1, 3))
def test_the_operator_makes_the_next_set(rho, omega, levels, depth):
    now = reachable_set(rho, omega, levels, depth).points
    after = reachable_set(rho, omega, levels, depth + 1).points
    assert np.abs(hutchinson(now, levels, rho, omega) - after).max() < 1e-12


@LAWS
@given(reals(1.3, 4), omegas(), level_sets(3), st.integers(1, 4))
def test_the_depth_bound_holds_and_is_attained_with_level_0(rho, omega, levels, depth):
    levels = [0.0] if isinstance(levels, int) else levels
    reachable = reachable_set(rho, omega, levels, depth)
    deep = reachable_set(rho, omega, levels, depth + 5)
    distance = hausdorff(reachable.points, deep.points)
    assert distance <= reachable.depth_bound + 1e-12
    if reachable.levels[0] == 0:
        rest = reachable.depth_bound - deep.depth_bound
        assert distance >= rest - 1e-12


@LAWS
@given(st.data())
def test_controls_in_between_stay_within_the_certificates(data):
    rho, omega = data.draw(reals(1.2, 4)), data.draw(omegas())
    inner = data.draw(st.lists(reals(0, 1), max_size=4))
    reachable = reachable_set(rho, omega, [0, *inner, 1], 4)
    rng = np.random.default_rng(data.draw(st.integers(0, 99)))
    short = chain(rho, omega, rng.random((50, 4)))
    long = chain(rho, omega, rng.random((50, 30)))
    assert one_sided(short, reachable.points) <= reachable.grid_bound + 1e-12
    assert one_sided(long, reachable.points) <= reachable.error_bound + 1e-12


def test_the_grid_bound_by_hand():
    system = ControlSystem(2, 1, [0, 0.25, 1])
    assert grid_bound(system, 2) == pytest.approx(0.375 * (1 / 2 + 2 / 4))
    assert grid_bound(ControlSystem(2, 1), 2) == 0


@pytest.mark.parametrize("block", [1, 5, 7, 30, 10_000])
def test_blocks_are_the_set_in_pieces(block):
    reachable = reachable_set(1.5, 2.0, 5, 4, orientation=0.3)
    at, sizes = 0, [5**depth for depth in range(5)]
    for indices, points in iter_reachable(reachable.system, 4, block=block):
        assert indices.start == at
        assert len(points) == len(indices) == max(n for n in sizes if n <= block)
        part = reachable.points[indices.start : indices.stop]
        assert np.abs(points - part).max() < 1e-14
        at = indices.stop
    assert at == len(reachable.points)


@LAWS
@given(reals(1.05, 9), reals(1e-9, 2))
def test_the_attractor_s_depth_is_the_smallest(rho, tolerance):
    depth = depth_within(rho, tolerance)
    assert depth_bound(rho, depth) <= tolerance
    assert depth == 1 or depth_bound(rho, depth - 1) > tolerance


def test_the_attractor_keeps_its_tolerance():
    reachable = attractor(PHI, 1.0, 2, 0.02)
    assert reachable.depth_bound <= 0.02 < PHI * reachable.depth_bound


@pytest.mark.parametrize("given_orientation", [{}, {"orientation": 0.3}])
def test_the_attractor_is_the_reachable_set_of_its_depth(given_orientation):
    found = attractor(PHI, 1.0, 2, 0.02, **given_orientation)
    expected = reachable_set(PHI, 1.0, 2, found.depth, **given_orientation)
    assert (found.points == expected.points).all()


def test_as_many_words_are_streamed_as_an_index_can_count():
    system = ControlSystem(2, math.pi / 2, 2)
    indices, points = next(iter_reachable(system, 62, block=4))
    assert indices == range(4)
    straight = 1 - 2.0**-60  # a tail of two phalanges follows
    tail = [3 / 4, 1 / 2 - 1j / 4, -3j / 4, -1j / 2 - 1 / 4]
    assert points == pytest.approx(straight + 2.0**-60 * np.array(tail))
    with pytest.raises(ParameterError, match="number of words = 9223372036854775808 "):
        iter_reachable(system, 63)


def test_a_large_set_takes_no_more_memory_than_its_points():
    tracemalloc.start()
    reachable = reachable_set(PHI, 1.0, 64, 3, orientation=1.0)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 1.3 * reachable.points.nbytes


def test_results_are_read_only():
    reachable = reachable_set(PHI, 1.0, [0, 1], 2)
    for values in (reachable.points, reachable.levels):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"rho": 1}, "rho = 1 is not a number above 1"),
        ({"omega": math.pi}, "omega = 3.14159.* is not in .0, 2π. and different"),
        ({"omega": math.nan}, "omega = nan"),
        ({"levels": 1}, "number of levels = 1 is not an integer from 2"),
        ({"levels": [0, 1.5]}, r"levels\[1\] = 1.5 is not in \[0, 1\]"),
        ({"levels": []}, r"levels.shape = \(0,\)"),
        ({"depth": 0}, "depth = 0 is not an integer from 1 to 1000"),
        ({"depth": -2}, "depth = -2"),
        ({"orientation": math.inf}, "orientation = inf"),
        (
            {"depth": 20},
            "number of words = [0-9]{31} is not at most [0-9]*: take fewer levels or "
            "phalanges, or draw the set as a raster$",
        ),
        (
            {"depth": 9},
            r"memory for 46411484401953 points \[bytes\] = 742583750431248 "
            "is not at most [0-9]*: stream them with iter_reachable",
        ),
        ({"max_bytes": 100}, r"\[bytes\] = 17424 is not at most 100"),
    ],
)
def test_bad_input_is_named(change, message):
    given_values = {"rho": PHI, "omega": 1.0, "levels": 33, "depth": 2} | change
    with pytest.raises(ParameterError, match=message) as caught:
        reachable_set(**given_values)
    assert "\n" not in str(caught.value)


def in_two_levels(points):
    return hutchinson(points, 2, PHI, 1.0)


def test_other_bad_input_is_named():
    reachable = reachable_set(PHI, 1.0, [0.1, 1], 2)
    with pytest.raises(ParameterError, match=r"first and last level = \(0.1, 1.0\)"):
        _ = reachable.error_bound
    with pytest.raises(ParameterError, match=r"indices\[1\] = 4 is not in \[0, 3\]"):
        reachable.words([0, 4])
    with pytest.raises(ParameterError, match="integers"):
        reachable.words([0.5])
    with pytest.raises(ParameterError, match="levels = None is not a finite"):
        iter_reachable(ControlSystem(PHI, 1.0), 2)
    for block in (0, 2**40 + 1):
        message = f"^block = {block} is not an integer from 1 to {2**40}"
        with pytest.raises(ParameterError, match=message):
            iter_reachable(reachable.system, 2, block=block)
    for given_points in (lambda x: contraction(x, 0.5, PHI, 1.0), in_two_levels):
        with pytest.raises(ParameterError, match=r"^points\[0\] = .*nan"):
            given_points([math.nan])
    with pytest.raises(
        ParameterError,
        match=r"^control = 2.0 is not in \[0, 1\]: 0 is the straight joint, 1 the fu",
    ):
        contraction(1j, 2, PHI, 1.0)
    with pytest.raises(ParameterError, match=r"^control = 'half' is not an array"):
        contraction(1j, "half", PHI, 1.0)
    with pytest.raises(ParameterError, match="tolerance = 0"):
        attractor(PHI, 1.0, 2, 0)
