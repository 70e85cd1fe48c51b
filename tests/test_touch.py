"""Touch intervals: certified, attained, and lawful; controls for every radius."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from axes import axes_around, distances, one_finger
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import feet, reals

from zygopin import (
    Branch,
    Finger,
    Foot,
    ParameterError,
    touch_intervals,
)

BELOW = Branch(1.0, (0.0, 0.0, -0.6))
PAPER = Foot(omega=math.pi / 3)


def toe(length=1.0, **changes):
    """A bare toe of one phalanx along x."""
    return one_finger(1, rho=2.0, scale=2.0 * length, **changes)


def polar(radius, below):
    """An axis along y, at a distance and an angle below the straight toe [deg]."""
    angle = math.radians(below)
    return Branch(1.0, (radius * math.cos(angle), 0.0, -radius * math.sin(angle)))


def assert_encloses(intervals, found, slack=1e-12):
    """No value of D found, shape (…, F), is beyond the certified bounds."""
    slack = slack * intervals.foot.size
    assert np.all(found >= intervals.least[..., 0] - slack)
    assert np.all(found <= intervals.most[..., 1] + slack)


@pytest.mark.parametrize(
    ("axis", "least", "most"),
    [
        (polar(0.5, 30), 0.0, 0.25),  # under the bone; a foot of perpendicular inside
        (polar(0.5, 120), 0.5 * math.sin(math.radians(60)), 0.5),  # behind the base
        (polar(2.0, 0), 1.0, math.sqrt(3.0)),  # ahead: the tip, then 60° off it
        (polar(2.0, 90), math.sqrt(5.0 - 4 * math.cos(math.pi / 6)), 2.0),
    ],
)
def test_one_phalanx_is_closed_form(axis, least, most):
    found = touch_intervals(toe(omega=math.pi / 3), axis, tolerance=1e-6)
    np.testing.assert_allclose(found.least[0], least, atol=1.1e-6)
    np.testing.assert_allclose(found.most[0], most, atol=1.1e-6)
    assert found.converged.all()


def test_skin_makes_every_radius_smaller_by_its_own():
    skin = toe(omega=math.pi / 3, thickness=0.2)  # the phalanx's: 0.1
    found = touch_intervals(skin, polar(2.0, 0))
    np.testing.assert_allclose(found.least[0], 0.9, atol=1e-3)
    np.testing.assert_allclose(found.most[0], math.sqrt(3.0) - 0.1, atol=1e-3)


def test_a_straight_finger_keeps_farthest_from_an_axis_far_below():
    foot = one_finger(3)
    axis = Branch(1.0, (0.4 * foot.size, 0.0, -5.0))
    found = touch_intervals(foot, axis)
    assert found.most[0, 0] == pytest.approx(5.0, abs=1e-12)
    assert found.most[0, 1] - 5.0 <= 1e-3 * foot.size


def test_coplanar_fingers_of_the_source():
    found = touch_intervals(PAPER, BELOW)
    np.testing.assert_allclose(found.least[0], 0.229, atol=1e-3)
    np.testing.assert_allclose(found.least[2], 0.164, atol=2e-3)
    np.testing.assert_allclose(found.most, 0.6, atol=1e-12)
    levels = np.linspace(0, 1, 301)
    grid = np.stack(np.meshgrid(levels, levels), axis=-1).reshape(-1, 2)
    controls = np.random.default_rng(0).random((len(grid), PAPER.phalanx_count))
    controls[:, :2] = grid
    values = distances(PAPER, controls, BELOW)
    assert_encloses(found, values)
    assert values[:, 0].min() == pytest.approx(found.least[0, 1], abs=1e-3)


@pytest.mark.parametrize("name", ["paper", "parrot", "owl"])
def test_random_controls_are_enclosed_and_witnesses_attain(name):
    foot = Foot.preset(name)
    axes = axes_around(foot, 6)
    found = touch_intervals(foot, axes)
    assert found.converged.all()
    controls = np.random.default_rng(2).random((20_000, 1, foot.phalanx_count))
    controls[::2] = np.clip(2 * controls[::2] - 0.5, 0, 1)
    assert_encloses(found, distances(foot, controls, axes))
    for witness, attained in (
        (found.least_controls, found.least[..., 1]),
        (found.most_controls, found.most[..., 0]),
    ):
        assert np.all((witness >= 0) & (witness <= 1))
        values = distances(foot, witness, axes)
        np.testing.assert_allclose(values, attained, atol=1e-12 * foot.size)
    assert np.all(found.least[..., 0] <= found.least[..., 1])
    assert np.all(found.most[..., 0] <= found.most[..., 1])


@settings(max_examples=12)
@given(feet(), st.integers(0, 10**6))
def test_any_foot_is_enclosed_however_few_the_boxes(foot, seed):
    axes = axes_around(foot, 4, seed)
    found = touch_intervals(foot, axes, max_boxes=100)
    controls = np.random.default_rng(seed).random((300, 1, foot.phalanx_count))
    assert_encloses(found, distances(foot, controls, axes), 1e-11)
    assert np.all(found.converged == (found.width <= 1e-3 * lengths(foot)))


def lengths(foot):
    """Length of each finger [m], (F,)."""
    return np.array([foot.lengths[part].sum() for part in foot.finger_slices.values()])


def test_a_long_finger_says_that_its_bracket_is_wide():
    foot = one_finger(12, rho=1.05, omega=2.5, thickness=0.1)
    axes = axes_around(foot, 8)
    found = touch_intervals(foot, axes, max_boxes=20)
    assert not found.converged.all()
    np.testing.assert_array_equal(found.converged, found.width <= 1e-3 * foot.size)
    controls = np.random.default_rng(0).random((4000, 1, 12))
    assert_encloses(found, distances(foot, controls, axes))
    one = touch_intervals(foot, axes, max_boxes=1)
    assert np.all(one.boxes == 2)
    assert np.all(one.width >= found.width)
    more = touch_intervals(foot, axes, max_boxes=500)
    assert np.all(more.width <= found.width)
    assert np.any(more.boxes > found.boxes)


def test_an_axis_through_the_base_is_never_clear_of_the_skin():
    foot = one_finger(2, thickness=0.1)
    found = touch_intervals(foot, Branch(1.0, (0.0, 0.0, 0.0)))
    skin = foot.radii[0]
    np.testing.assert_allclose(found.least[0], -skin, atol=1e-12)
    np.testing.assert_allclose(found.most[0], -skin, atol=1e-12)
    assert found.out_of_touch(0.01).all()


@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 0, 0), (1, 0, -0.7)])
def test_an_axis_beside_the_plane_is_as_near_as_the_plane(axis):
    foot = one_finger(3, omega=math.pi / 2)
    found = touch_intervals(foot, Branch(1.0, (0.2, 0.3, -0.2), axis))
    np.testing.assert_allclose(found.least[0], 0.3, atol=1e-3)
    assert found.converged.all()


@given(reals(0.01, 100.0), st.integers(0, 3))
@settings(max_examples=8)
def test_intervals_grow_with_the_foot(factor, seed):
    foot = one_finger(3, 0.4, rho=1.3, omega=1.4, thickness=0.1)
    large = foot.replace(scale=factor, thickness=0.1 * factor)
    axes = axes_around(foot, 4, seed)
    found = touch_intervals(foot, axes)
    grown = touch_intervals(large, Branch(1.0, factor * axes.centre, axes.axis))
    np.testing.assert_allclose(grown.least / factor, found.least, atol=1e-9)
    np.testing.assert_allclose(grown.most / factor, found.most, atol=1e-9)


def assert_meet(first, second):
    """Brackets of the same ends overlap."""
    for one, other in ((first.least, second.least), (first.most, second.most)):
        assert np.all(one[..., 0] <= other[..., 1] + 1e-12)
        assert np.all(other[..., 0] <= one[..., 1] + 1e-12)


@given(st.integers(0, 10**6), reals(-3.0, 3.0))
@settings(max_examples=8)
def test_mirrors_turns_and_shifts_along_the_axis_change_nothing(seed, angle):
    foot = one_finger(3, 0.4, 0.2, rho=1.3, omega=1.4, thickness=0.1)
    axes = axes_around(foot, 4, seed)
    found = touch_intervals(foot, axes)
    mirror = np.array([1.0, -1.0, 1.0])
    mirrored = one_finger(3, -0.4, 0.2, rho=1.3, omega=1.4, thickness=0.1)
    across = Branch(1.0, axes.centre * mirror, axes.axis * mirror)
    assert_meet(found, touch_intervals(mirrored, across))
    cosine, sine = math.cos(angle), math.sin(angle)
    turn = np.array([[cosine, -sine, 0], [sine, cosine, 0], [0, 0, 1.0]])
    turned = one_finger(3, 0.4 + angle, 0.2, rho=1.3, omega=1.4, thickness=0.1)
    about = Branch(1.0, axes.centre @ turn.T, axes.axis @ turn.T)
    assert_meet(found, touch_intervals(turned, about))
    along = Branch(1.0, axes.centre + angle * axes.axis, -axes.axis)
    assert_meet(found, touch_intervals(foot, along))


def test_a_longer_bare_finger_comes_nearer_and_keeps_no_farther():
    axes = axes_around(one_finger(1), 8)
    found = [touch_intervals(one_finger(k, omega=1.2), axes) for k in (1, 2, 3, 4)]
    for short, long in pairwise(found):
        assert np.all(long.least[..., 0] <= short.least[..., 1])
        assert np.all(long.most[..., 0] <= short.most[..., 1])


def test_a_batch_equals_its_parts():
    foot = Foot.preset("parrot")
    axes = axes_around(foot, 6)
    grid = Branch(1.0, axes.centre.reshape(2, 3, 3), axes.axis.reshape(2, 3, 3))
    whole = touch_intervals(foot, grid)
    assert whole.least.shape == whole.most.shape == (2, 3, 4, 2)
    assert whole.least_controls.shape == (2, 3, 14)
    assert whole.boxes.shape == whole.converged.shape == (2, 3, 4)
    for place in np.ndindex(2, 3):
        part = touch_intervals(foot, grid[place])
        np.testing.assert_allclose(part.least, whole.least[place], atol=1e-12)
        np.testing.assert_allclose(part.most, whole.most[place], atol=1e-12)


def test_fingers_are_searched_each_by_itself():
    foot = Foot.preset("parrot")
    found = touch_intervals(foot, BELOW.moved_to((0.004, 0, -0.015)))
    alone = foot.replace(fingers=foot.fingers[2:3])
    third = touch_intervals(alone, BELOW.moved_to((0.004, 0, -0.015)))
    np.testing.assert_allclose(third.least[0], found.least[2], atol=1e-15)


def test_radius_and_length_do_not_matter():
    thick = Branch([0.5, 9.0], (0.0, 0.0, -0.6), length=0.01)
    found = touch_intervals(PAPER, thick)
    assert found.least.shape == (4, 2)
    np.testing.assert_array_equal(found.least, touch_intervals(PAPER, BELOW).least)


def test_an_empty_batch_is_allowed():
    found = touch_intervals(PAPER, Branch(1.0, np.zeros((0, 3))))
    assert found.least.shape == (0, 4, 2)
    assert found.least_controls.shape == (0, PAPER.phalanx_count)


def test_results_cannot_be_changed():
    found = touch_intervals(PAPER, BELOW)
    with pytest.raises(ValueError, match="read-only"):
        found.least[0, 0] = 0.0
    BELOW_AXIS = Branch(1.0, (0.0, 0.0, -0.6))
    assert np.array_equal(found.branch.centre, BELOW_AXIS.centre)


def test_verdicts_on_radii_leave_what_is_not_decided_open():
    found = touch_intervals(PAPER, BELOW)
    low, high = found.least[2]
    radii = np.array([0.9 * low, (low + high) / 2, 1.1 * high, 0.6, 0.61])
    touchable, missed = found.touchable(radii)[:, 2], found.out_of_touch(radii)[:, 2]
    assert touchable.tolist() == [False, False, True, True, False]
    assert missed.tolist() == [True, False, False, False, True]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"tolerance": 0.0}, "tolerance = 0"),
        ({"tolerance": math.nan}, "tolerance"),
        ({"max_boxes": 0}, "max_boxes = 0"),
        ({"foot": "parrot"}, "zygopin.Foot"),
        ({"branch": 0.6}, "zygopin.Branch"),
    ],
)
def test_bad_input_is_named(changes, message):
    given = {"foot": PAPER, "branch": BELOW, **changes}
    with pytest.raises(ParameterError, match=message):
        touch_intervals(given.pop("foot"), given.pop("branch"), **given)


def test_bad_radii_are_named():
    found = touch_intervals(PAPER, BELOW)
    for verdict in (found.touchable, found.out_of_touch):
        with pytest.raises(ParameterError, match="radius"):
            verdict(math.nan)


def test_a_toe_may_point_anywhere():
    toes = (Finger("a", 2, 0.3, orientation=0.5), Finger("b", 3, 3.0, orientation=-0.4))
    foot = Foot(fingers=toes, omega=1.0, rho=1.2, thickness=0.05)
    axes = axes_around(foot, 5)
    found = touch_intervals(foot, axes)
    controls = np.random.default_rng(1).random((5000, 1, 5))
    assert_encloses(found, distances(foot, controls, axes))
