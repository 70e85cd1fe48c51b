"""Reachable sets in space, against Pinocchio, and the way back from a point."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import feet

from zygopin import Foot, forward_kinematics, preset_names, to_urdf
from zygopin.errors import DescriptionError, ParameterError, UnknownNameError
from zygopin.reach import (
    find_finger,
    finger_length,
    finger_reach,
    levels_within,
    to_plane,
    to_space,
)
from zygopin.reach_inverse import inverse_reach
from zygopin.validation import (
    CHECKS,
    ValidationRow,
    iter_validation,
    row_count,
    validate_foot,
)

PAPER = Foot.preset("paper")
OWL = Foot.preset("owl")

SPREAD = ("grid", "words")
"""Checks that a toe goes through at its reversed azimuth too."""


def tip(foot, finger, controls):
    """The tip of one finger, the others straight [m]."""
    every = np.zeros(foot.phalanx_count)
    part = foot.finger_slices[find_finger(foot, finger).name]
    every[part] = controls
    return forward_kinematics(foot, every)[part.stop - 1, 1]


def test_fingers_have_names_and_numbers_from_one():
    assert find_finger(PAPER, 3) is find_finger(PAPER, "finger3")
    assert find_finger(Foot.preset("anisodactyl"), 1).name == "hallux"


def test_length_worked_by_hand():
    assert finger_length(PAPER, 1) == pytest.approx(1.0, rel=1e-15)  # 1/φ + 1/φ²
    assert finger_length(OWL, 1) == pytest.approx(0.03 * (1 / 1.18 + 1 / 1.18**2))


def test_plane_to_space_worked_by_hand():
    foot = Foot(splay=math.pi / 6, scale=2.0)
    np.testing.assert_allclose(to_space(foot, 2, 1 - 1j), [3**0.5, 1, -2])
    np.testing.assert_allclose(to_space(foot, 1, 1 - 1j), [-(3**0.5), 1, -2])


@given(feet(), st.integers(0, 4), st.complex_numbers(max_magnitude=10))
@settings(max_examples=40, deadline=None)
def test_space_and_plane_are_a_round_trip(foot, place, point):
    finger = foot.fingers[place % len(foot.fingers)].name
    plane, aside = to_plane(foot, finger, to_space(foot, finger, point))
    assert abs(plane - point) <= 1e-14 * (1 + abs(point))
    assert abs(aside) <= 1e-14 * foot.scale * (1 + abs(point))


@given(feet(), st.integers(0, 4))
@settings(max_examples=30, deadline=None)
def test_points_are_where_the_words_put_the_tip(foot, place):
    finger = foot.fingers[place % len(foot.fingers)]
    reach = finger_reach(foot, finger.name, 3)
    words = reach.plane.words(np.arange(len(reach.plane.points)))
    controls = np.zeros((len(words), foot.phalanx_count))
    part = foot.finger_slices[finger.name]
    controls[:, part] = words
    tips = forward_kinematics(foot, controls)[:, part.stop - 1, 1]
    assert np.abs(tips - reach.in_space()).max() <= 1e-13 * finger_length(
        foot, finger.name
    )


def test_bounds_are_in_metres():
    reach = finger_reach(OWL, 3, 5)
    assert reach.depth_bound == pytest.approx(0.03 * 1.18**-4 / 0.18)
    weight = sum(j * 1.18**-j for j in range(1, 5))
    assert reach.grid_bound == pytest.approx(0.03 * math.pi / 2 / 8 * weight)
    assert np.abs(reach.points).max() == pytest.approx(finger_length(OWL, 3))


@pytest.mark.parametrize(
    ("phalanges", "points", "count"),
    [(2, 40_000, 33), (3, 40_000, 33), (4, 40_000, 14), (5, 40_000, 8), (1, 7, 7)],
)
def test_levels_that_fit_worked_by_hand(phalanges, points, count):
    assert levels_within(phalanges, points) == count


@pytest.mark.parametrize("name", preset_names())
def test_every_preset_stands_against_pinocchio(name):
    foot = Foot.preset(name)
    found = validate_foot(foot, levels=6, samples=300)
    assert found.ok
    names = [(row.finger, row.check, row.pose) for row in found.rows]
    expected = []
    for finger in foot.fingers:
        turns = finger.reversed_azimuth is not None
        own = "zygodactyl" if turns else None
        expected += [(finger.name, check, own) for check in CHECKS]
        expected += [(finger.name, check, "spread") for check in SPREAD if turns]
    assert names == expected
    assert len(names) == row_count(foot) == (18 if name == "owl" else 16)


def test_a_validation_says_what_it_took():
    rows = {(r.finger, r.check): r for r in validate_foot(PAPER, samples=10).rows}
    sizes = [(row.levels, row.configurations) for row in rows.values()]
    assert sizes[::4] == [(33, 1089), (33, 35937), (14, 38416), (8, 32768)]
    assert rows["finger3", "random"].configurations == 10
    assert rows["finger3", "grid"].bound == pytest.approx(1e-12 * 1.381966, rel=1e-6)
    phi = PAPER.rho
    assert rows["finger3", "limit"].bound == pytest.approx(phi**-4 / (phi - 1))
    assert rows["finger3", "limit"].value == pytest.approx(0.236068, abs=1e-6)


@given(feet())
@settings(max_examples=5, deadline=None)
def test_any_foot_stands_against_pinocchio(foot):
    found = validate_foot(foot, levels=3, samples=20)
    assert found.ok, [row for row in found.rows if not row.ok]


@pytest.mark.parametrize("factor", [1 + 1e-9, 0.99])
def test_a_wrong_angle_in_the_urdf_is_found_out(factor):
    wrong = to_urdf(PAPER.replace(omega=factor * PAPER.omega))
    found = validate_foot(PAPER, levels=3, samples=20, urdf=wrong)
    assert not found.ok
    failed = {(row.finger, row.check) for row in found.rows if not row.ok}
    expected = {(f.name, check) for f in PAPER.fingers for check in ("grid", "words")}
    assert failed >= expected


def test_a_wrong_length_in_the_urdf_is_found_out():
    wrong = to_urdf(OWL.replace(rho=1.1801))
    assert not validate_foot(OWL, levels=3, samples=20, urdf=wrong).ok


def urdf_with_reversal(foot, change):
    """The URDF of a foot whose last toe turns to another azimuth."""
    *others, toe = foot.fingers
    turned = dataclasses.replace(toe, reversed_azimuth=toe.reversed_azimuth + change)
    return to_urdf(foot.replace(fingers=(*others, turned)))


@pytest.mark.parametrize("mirrored", [False, True])
@pytest.mark.parametrize("change", [1e-9, -0.2])
def test_a_wrong_reversal_in_the_urdf_fails_in_the_spread_pose(mirrored, change):
    *others, toe = OWL.fingers
    back = dataclasses.replace(toe, reversed_azimuth=toe.azimuth - toe.reversal)
    foot = OWL.replace(fingers=(*others, back)) if mirrored else OWL
    assert validate_foot(foot, levels=3, samples=9).ok
    wrong = urdf_with_reversal(foot, change)
    found = validate_foot(foot, levels=3, samples=9, urdf=wrong)
    failed = {(row.finger, row.check, row.pose) for row in found.rows if not row.ok}
    assert failed == {("finger4", check, "spread") for check in SPREAD}


def test_a_reversal_that_starts_off_the_azimuth_fails_in_the_zygodactyl_pose():
    text = to_urdf(OWL)
    place = text.index("finger4_reversal")
    wrong = text[:place] + text[place:].replace('lower="0.0"', 'lower="0.1"', 1)
    found = validate_foot(OWL, levels=3, samples=9, urdf=wrong)
    failed = {row.pose for row in found.rows if not row.ok}
    assert failed == {"zygodactyl"}


def test_random_controls_are_of_the_callers_generator():
    def values(seed):
        rng = np.random.default_rng(seed)
        rows = validate_foot(PAPER, levels=2, samples=9, rng=rng).rows
        return [row.value for row in rows if row.check == "random"]

    assert values(1) == values(1)
    assert values(1) != values(2)


def test_a_row_is_judged_by_its_bound_or_its_slack():
    row = ValidationRow("a", "grid", 2, 4, value=1.0, bound=1.0)
    assert row.ok
    assert not dataclasses.replace(row, value=1.1).ok
    assert dataclasses.replace(row, value=0.5).ok
    assert not dataclasses.replace(row, value=0.5, slack=0.1).ok
    assert dataclasses.replace(row, value=0.95, slack=0.1).ok
    assert not dataclasses.replace(row, value=math.nan).ok


@pytest.mark.parametrize("foot", [PAPER, OWL], ids=["paper", "owl"])
@pytest.mark.parametrize("finger", [1, 2, 3, 4])
def test_a_point_that_the_tip_takes_is_reached(foot, finger):
    rng = np.random.default_rng(finger)
    point = tip(foot, finger, rng.uniform(size=find_finger(foot, finger).phalanges))
    found = inverse_reach(foot, finger, point)
    assert found.verdict == "reachable"
    assert found.residual <= found.tolerance
    np.testing.assert_allclose(tip(foot, finger, found.controls), found.tip)
    assert found.residual == pytest.approx(np.linalg.norm(found.tip - point), abs=1e-15)
    assert abs(found.out_of_plane) <= 1e-15


def test_a_point_beside_the_plane_is_projected():
    reached = tip(PAPER, 3, [0.2, 0.4, 0.1, 0.9])
    left = np.array([math.sin(math.pi / 12), math.cos(math.pi / 12), 0.0])
    found = inverse_reach(PAPER, 3, reached + 0.25 * left)
    assert found.out_of_plane == pytest.approx(0.25)
    assert found.residual == pytest.approx(0.25)
    assert found.lower_bound == pytest.approx(0.25)
    assert found.verdict == "not_reachable"
    assert inverse_reach(PAPER, 3, reached + 1e-8 * left).verdict == "reachable"


def test_a_point_beyond_the_tip_is_proved_out_of_reach():
    straight = tip(PAPER, 2, [0, 0, 0])
    found = inverse_reach(PAPER, 2, 2 * straight)
    assert found.verdict == "not_reachable"
    np.testing.assert_allclose(found.controls, 0, atol=0.02)
    length = finger_length(PAPER, 2)
    assert found.lower_bound <= length * (1 + 1e-12)
    assert found.residual == pytest.approx(length, rel=2e-3)


def test_levels_restrict_the_controls():
    point = tip(PAPER, 3, [0.25, 0.5, 1.0, 0.0])
    found = inverse_reach(PAPER, 3, point, levels=5)
    assert found.verdict == "reachable"
    np.testing.assert_allclose(found.controls, [0.25, 0.5, 1.0, 0.0], atol=1e-12)
    off = inverse_reach(PAPER, 3, tip(PAPER, 3, [0.1, 0.6, 0.8, 0.3]), levels=2)
    assert set(off.controls) <= {0.0, 1.0}
    assert off.verdict == "not_reachable"


def test_answers_are_read_only():
    found = inverse_reach(PAPER, 1, [0, 0, 0])
    for values in (found.controls, found.tip):
        with pytest.raises(ValueError, match="read-only"):
            values[0] = 0.5


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (lambda: find_finger(PAPER, 5), ParameterError, "finger = 5 is not an integer"),
        (lambda: find_finger(PAPER, "fingr3"), UnknownNameError, "mean 'finger3'?"),
        (lambda: finger_reach(PAPER, 3, 1), ParameterError, "number of levels = 1"),
        (lambda: finger_reach(PAPER, 3, depth=0), ParameterError, "depth = 0 is not"),
        (lambda: finger_reach(PAPER, 3, depth=9), ParameterError, "bytes"),
        (lambda: levels_within(5, 31), ParameterError, "at least 2^5 = 32"),
        (lambda: inverse_reach(PAPER, 3, [0, 1]), ParameterError, "of shape (…, 3)"),
        (lambda: inverse_reach(PAPER, 3, [[0, 1, 2]]), ParameterError, "one point at"),
        (
            lambda: inverse_reach(PAPER, 3, [0, 0, math.nan]),
            ParameterError,
            "point[2] = nan is not finite",
        ),
        (
            lambda: inverse_reach(PAPER, 3, [0, 0, 0], tolerance=0),
            ParameterError,
            "tolerance = 0",
        ),
        (lambda: validate_foot(PAPER, levels=1), ParameterError, "levels = 1 is not"),
        (lambda: iter_validation(PAPER, samples=0), ParameterError, "samples = 0"),
        (
            lambda: validate_foot(PAPER, urdf="<robot"),
            DescriptionError,
            "the URDF is not XML",
        ),
        (
            lambda: validate_foot(PAPER, urdf=to_urdf(Foot.preset("anisodactyl"))),
            DescriptionError,
            "links named finger1_phalanx1",
        ),
    ],
)
def test_bad_input_is_named_in_one_line(call, error, words):
    with pytest.raises(error) as caught:
        call()
    assert words in str(caught.value)
    assert "\n" not in str(caught.value)
