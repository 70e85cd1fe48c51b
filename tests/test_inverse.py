"""Which controls reach a point: against all words, and against random controls."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from strategies import level_sets, omegas, planar_points, reals

from zygopin.control_boxes import BoxSearch, descend
from zygopin.control_system import ControlSystem
from zygopin.errors import ParameterError
from zygopin.ifs import reachable_set
from zygopin.inverse import contains, find_word, nearest_reachable
from zygopin.word_answer import Goal, arc_discs, tip

PHI = (1 + math.sqrt(5)) / 2
FINGER = ControlSystem(PHI, math.pi / 6, 33)
ANY_CONTROL = ControlSystem(PHI, math.pi / 6)
LAWS = settings(max_examples=60, deadline=None, derandomize=True)


@st.composite
def queries(draw):
    """A small reachable set and a target, some of them on the set."""
    reachable = reachable_set(
        draw(reals(1.05, 4)),
        draw(omegas()),
        draw(level_sets()),
        draw(st.integers(1, 5)),
        orientation=draw(reals(-4, 4)),
    )
    word = draw(st.integers(0, len(reachable.points) - 1))
    target = draw(planar_points() | st.just(complex(reachable.points[word])))
    return reachable, target


@LAWS
@given(queries())
def test_the_nearest_point_is_the_nearest_of_all(query):
    reachable, target = query
    least = np.abs(reachable.points - target).min()
    answer = nearest_reachable(target, reachable.system, reachable.depth)
    assert answer.distance == pytest.approx(least, abs=1e-12)
    assert least - 1e-10 <= answer.lower_bound <= least
    assert answer.controls.shape == (reachable.depth,)
    assert np.isin(answer.controls, reachable.levels).all()


@LAWS
@given(queries(), reals(0.01, 3))
def test_a_word_is_found_where_there_is_one_and_only_there(query, factor):
    reachable, target = query
    least = np.abs(reachable.points - target).min()
    tolerance = max(least * factor, 1e-9)
    if abs(tolerance - least) < 1e-11:
        return
    arguments = target, reachable.system, reachable.depth
    answer = find_word(*arguments, tolerance=tolerance)
    expected = "reachable" if least < tolerance else "not_reachable"
    assert answer.verdict == expected
    assert contains(*arguments, tolerance=tolerance) is bool(least < tolerance)
    assert answer.lower_bound <= least
    distance = abs(tip(reachable.system, answer.controls) - target)
    assert answer.distance == pytest.approx(distance, abs=1e-13)


def test_depth_5_with_33_levels():
    rng = np.random.default_rng(4)
    for controls in rng.integers(0, 33, (5, 5)) / 32:
        answer = find_word(tip(FINGER, controls), FINGER, 5, tolerance=1e-9)
        assert answer.verdict == "reachable"
    far = find_word(2j, FINGER, 5, tolerance=1e-3)
    assert far.verdict == "not_reachable"
    assert 1e-3 < far.lower_bound <= far.distance


def test_a_search_cut_short_says_so():
    target = tip(FINGER, np.array([0.5, 0.25, 0.125, 0.5, 1.0])) + 1e-5j
    answer = find_word(target, FINGER, 5, tolerance=1e-9, max_nodes=10)
    assert answer.verdict == "undecided"
    assert answer.lower_bound <= 1e-9 < answer.distance
    assert contains(target, FINGER, 5, tolerance=1e-9, max_nodes=10) is None


@LAWS
@given(reals(1.05, 4), omegas(), st.integers(1, 6), st.integers(0, 99))
def test_discs_hold_all_that_follows(rho, omega, depth, seed):
    system = ControlSystem(rho, omega)
    centres, radii = arc_discs(system, depth)
    for controls in np.random.default_rng(seed).random((20, depth)):
        for done in range(depth + 1):
            pitch = omega * controls[:done].sum()
            step = rho**-done * np.exp(-1j * pitch)
            place = tip(system, controls[:done]) if done else 0
            rest = tip(system, controls) - place - centres[done] * step
            assert abs(rest) <= radii[done] + 1e-12


@settings(max_examples=15, deadline=None, derandomize=True)
@given(reals(1.2, 4), omegas(), st.integers(1, 4), st.integers(0, 99))
def test_the_interval_reaches_what_controls_reach(rho, omega, depth, seed):
    system = ControlSystem(rho, omega, orientation=0.4)
    controls = np.random.default_rng(seed).random(depth)
    target = tip(system, controls)
    answer = find_word(target, system, depth, tolerance=1e-6, max_nodes=20_000)
    assert answer.verdict == "reachable"
    assert ((answer.controls >= 0) & (answer.controls <= 1)).all()


@settings(max_examples=20, deadline=None, derandomize=True)
@given(reals(1.2, 4), omegas(), st.integers(1, 4), planar_points())
def test_no_controls_come_nearer_than_the_interval_s_bound(rho, omega, depth, target):
    system = ControlSystem(rho, omega)
    rng = np.random.default_rng(5)
    starts = rng.random((20, depth))
    tips = [tip(system, controls) for controls in descend(system, target, starts)]
    least = np.abs(np.array(tips) - target).min()
    answer = nearest_reachable(target, system, depth, tolerance=0.01, max_nodes=20_000)
    assert answer.lower_bound <= least + 1e-12
    assert answer.lower_bound <= answer.distance
    verdict = find_word(target, system, depth, tolerance=0.01, max_nodes=20_000).verdict
    assert verdict != "not_reachable" or least > 0.01


@LAWS
@given(
    st.tuples(reals(1.05, 4), omegas(), st.none(), reals(-4, 4)),
    st.integers(2, 6),
    planar_points(),
    st.integers(0, 99),
)
def test_no_tip_of_a_box_is_nearer_than_its_bound(parameters, depth, target, seed):
    system, rng = ControlSystem(*parameters), np.random.default_rng(seed)
    goal = Goal(target, depth, tolerance=1e-9, max_nodes=1, nearest=True)
    ends = np.sort(rng.random((2, 8, depth - 1)), axis=0)
    middle, half = ends.mean(axis=0), np.ptp(ends, axis=0) / 2
    half *= 10.0 ** -rng.integers(0, 4, (8, 1))
    bounds = BoxSearch(system, goal).bounded(middle, half).bound
    for box, bound in enumerate(bounds):
        within = rng.uniform(-1, 1, (200, depth - 1)) * half[box] + middle[box]
        first = np.clip(np.round(rng.uniform(-0.5, 1.5, 200), 1), 0, 1)
        tips = [tip(system, word) for word in np.column_stack([within, first])]
        assert bound <= np.abs(np.array(tips) - target).min()


@settings(max_examples=30, deadline=None, derandomize=True)
@given(reals(1.1, 2), reals(0.3, 2), st.integers(2, 5), reals(-3.2, 3.2))
def test_the_interval_s_nearest_point_is_proved_outside_of_the_set(
    rho, omega, depth, direction
):
    system = ControlSystem(rho, omega)
    target = 1.3 * system.tail(0) * np.exp(1j * direction)
    answer = nearest_reachable(target, system, depth, max_nodes=50_000)
    assert answer.verdict == "not_reachable"
    assert answer.distance - answer.lower_bound <= 1.01e-9
    rng = np.random.default_rng(7)
    for start in rng.random((5, depth)):
        found = minimize(
            lambda controls: abs(tip(system, controls) - target),
            start,
            bounds=[(0, 1)] * depth,
        )
        assert found.fun >= answer.lower_bound


def test_descent_never_loses():
    rng = np.random.default_rng(6)
    starts, target = rng.random((50, 4)), 0.9 - 0.5j
    ends = descend(ANY_CONTROL, target, starts)
    for start, end in zip(starts, ends, strict=True):
        before = abs(tip(ANY_CONTROL, start) - target)
        assert abs(tip(ANY_CONTROL, end) - target) <= before + 1e-14


def test_one_phalanx_by_hand():
    nearest = nearest_reachable(-1j, ControlSystem(2, math.pi / 2), 1)
    assert nearest.controls.tolist() == [1]
    assert nearest.distance == pytest.approx(0.5)
    half = nearest_reachable(1 - 1j, ControlSystem(2, math.pi / 2, 3), 1)
    assert half.controls.tolist() == [0.5]


@pytest.mark.parametrize("system", [FINGER, ANY_CONTROL])
@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"target": complex(math.nan, 0)}, "target = .*nan.* is not finite"),
        ({"target": [1, 2]}, r"target.shape = \(2,\)"),
        ({"target": "here"}, "target = 'here' is not complex numbers"),
        ({"depth": 0}, "depth = 0"),
        ({"depth": 900}, "length of the last phalanx = .* is not at least"),
        ({"tolerance": 0}, "tolerance = 0 is not a finite number > 0"),
        ({"max_nodes": 0}, "max_nodes = 0"),
    ],
)
def test_bad_input_is_named(system, change, message):
    values = {"target": 1.0, "depth": 3, "tolerance": 1e-3} | change
    with pytest.raises(ParameterError, match=message) as caught:
        find_word(values.pop("target"), system, **values)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("levels", [3, None])
def test_a_proof_near_rho_1_is_as_sharp_as_any(levels):
    # Five phalanges of nearly length 1; an endless toe would be of length 1e15.
    system = ControlSystem(1 + 1e-15, 1.0, levels)
    found = find_word(7.0, system, 5, tolerance=0.1)
    assert found.verdict == "not_reachable"
    assert 1 < found.lower_bound <= 2
