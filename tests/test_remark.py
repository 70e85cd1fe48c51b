"""Contact kept while toes close: closed forms, dense sampling, and the theorem."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from strategies import reals

from zygopin import (
    Box,
    Branch,
    Capsule,
    Closing,
    ConvexMesh,
    Finger,
    Flight,
    Foot,
    FootModel,
    Motion,
    Sphere,
    contact_kept,
    counterexample,
    forward_kinematics,
    obstacle_clearance,
    simulate_strike,
)
from zygopin.engagement import engaged_junctions
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.phalanx_sweep import merged

PAPER, OWL = Foot.preset("paper"), Foot.preset("owl")
FIRSTS = [part.start for part in PAPER.finger_slices.values()]
KINDS = ("sphere", "box", "capsule", "branch", "stump", "mesh")


def solid(kind, centre, size, seed):
    """A convex obstacle of any shape."""
    rng = np.random.default_rng(seed)
    turn = Rotation.random(None, rng).as_matrix()
    sides = size * rng.uniform(0.2, 1.0, 3)
    made = {
        "sphere": lambda: Sphere(size, centre),
        "box": lambda: Box(sides, centre, turn),
        "capsule": lambda: Capsule(sides[0], centre + np.outer((-1, 1), turn[0])),
        "branch": lambda: Branch(sides[0], centre, turn[0]),
        "stump": lambda: Branch(sides[0], centre, turn[0], sides[1]),
        "mesh": lambda: ConvexMesh(centre + size * rng.normal(size=(12, 3))),
    }
    return made[kind]()


def sampled(foot, obstacle, values, **pose):
    """Clearances of first phalanges by the foot's kinematics, shape (n, F)."""
    controls = np.repeat(values[:, None], foot.phalanx_count, axis=1)
    bones = forward_kinematics(foot, controls, **pose)
    near = obstacle_clearance(bones, foot.radii, obstacle).distance
    return near[:, [part.start for part in foot.finger_slices.values()]]


def inside(values, intervals):
    """Which values are in some interval."""
    found = np.zeros(len(values), bool)
    for low, high in intervals:
        found |= (low <= values) & (values <= high)
    return found


@st.composite
def cases(draw, low=0.1, high=2 * math.pi - 0.05):
    """A foot and a convex obstacle near it."""
    omega = draw(reals(low, high).filter(lambda x: x != math.pi))
    foot = PAPER.replace(omega=omega, thickness=draw(st.just(0.0) | reals(0.0, 0.3)))
    centre = np.array([draw(reals(-0.9, 0.9)) for _ in range(3)])
    kind, seed = draw(st.sampled_from(KINDS)), draw(st.integers(0, 2**32))
    return foot, solid(kind, centre, draw(reals(0.05, 0.6)), seed)


# The intervals -------------------------------------------------------------------


@given(cases())
@settings(max_examples=25)
def test_intervals_are_where_dense_sampling_finds_contact(case):
    foot, obstacle = case
    found, values = contact_kept(foot, obstacle), np.linspace(0, 1, 101)
    gaps = sampled(foot, obstacle, values)
    rounding = 1e-9
    for finger, gap in zip(foot.fingers, gaps.T, strict=True):
        contact = inside(values, found.intervals[finger.name])
        assert np.all(gap[contact] <= 2 * found.tolerance + rounding)
        assert np.all(gap[~contact] > found.tolerance - rounding)


@given(cases(high=math.pi - 1e-3))
@settings(max_examples=25)
def test_a_finger_meets_a_convex_obstacle_in_one_interval(case):
    foot, obstacle = case
    values = np.linspace(0, 1, 151)
    for contact in (sampled(foot, obstacle, values) <= 0).T:
        changes = np.diff(contact.astype(int))
        assert np.sum(changes == 1) + contact[0] <= 1
    found = contact_kept(foot, obstacle)
    assert all(len(each) <= 1 for each in found.intervals.values())


@given(cases(high=math.pi - 1e-3))
@settings(max_examples=25)
def test_a_finger_keeps_contact_if_and_only_if_it_has_it_at_both_ends(case):
    foot, obstacle = case
    found = contact_kept(foot, obstacle)
    ends = sampled(foot, obstacle, np.array([0.0, 1.0]))
    near = found.tolerance
    assume(not np.any((ends > near / 2) & (ends < 3 * near)))
    kept = [each == ((0.0, 1.0),) for each in found.intervals.values()]
    np.testing.assert_array_equal(kept, np.all(ends <= near, axis=0))


@given(cases(low=math.pi + 1e-3))
@settings(max_examples=25)
def test_beyond_half_a_turn_a_second_interval_needs_both_ends(case):
    foot, obstacle = case
    for found in contact_kept(foot, obstacle).intervals.values():
        assert len(found) <= 2
        if len(found) == 2:
            assert (found[0][0], found[1][1]) == (0.0, 1.0)


def test_a_toe_that_comes_round_meets_a_box_twice():
    foot = PAPER.replace(omega=1.9 * math.pi, splay=0.0)
    box = Box((0.2, 0.2, 0.6), (0.4, 0.0, 0.0))
    found = contact_kept(foot, box).intervals["finger3"]
    corner = math.atan(0.3 / 0.3) / foot.omega  # its inner corners, at 45°
    assert len(found) == 2
    assert found[0] == pytest.approx((0.0, corner), abs=1e-5)
    assert found[1] == pytest.approx((2 / 1.9 - corner, 1.0), abs=1e-5)


@given(cases(), st.integers(0, 2**32))
@settings(max_examples=15)
def test_an_obstacle_that_holds_the_base_is_never_lost(case, seed):
    foot, obstacle = case
    rng = np.random.default_rng(seed)
    middle = getattr(obstacle, "centre", None)
    if middle is None:
        corners = getattr(obstacle, "ends", None)
        middle = (obstacle.vertices if corners is None else corners).mean(axis=0)
    base = np.eye(4)
    base[:3, :3], base[:3, 3] = Rotation.random(None, rng).as_matrix(), middle
    found = contact_kept(foot, obstacle, base=base)
    assert found.kept
    assert found.lost_at == math.inf
    assert set(found.intervals.values()) == {((0.0, 1.0),)}


@given(cases(), st.integers(0, 2**32))
@settings(max_examples=20)
def test_foot_and_obstacle_moved_together_change_nothing(case, seed):
    foot, obstacle = case
    assume(isinstance(obstacle, Sphere))
    rng, base = np.random.default_rng(seed), np.eye(4)
    base[:3, :3], base[:3, 3] = (
        Rotation.random(None, rng).as_matrix(),
        rng.normal(size=3),
    )
    moved = Sphere(obstacle.radius, base[:3, :3] @ obstacle.centre + base[:3, 3])
    first, second = contact_kept(foot, obstacle), contact_kept(foot, moved, base=base)
    for name in first.intervals:
        np.testing.assert_allclose(
            first.intervals[name], second.intervals[name], atol=1e-3
        )


def test_azimuths_turn_the_toes():
    found = contact_kept(
        OWL, Sphere(0.005, (0.02, 0, 0)), azimuths=[0.0, 2.0, 3.0, 4.0]
    )
    assert found.intervals["finger1"]
    assert not any(found.intervals[f"finger{number}"] for number in (2, 3, 4))


def test_fingers_keep_together_what_none_keeps_alone():
    pitches = {"low": 0.0, "middle": -0.15, "high": -0.3}
    fingers = (Finger(name, 2, 0.0, pitch) for name, pitch in pitches.items())
    foot = PAPER.replace(fingers=tuple(fingers), omega=0.45)
    place = 0.5 * np.exp(-0.1j)
    ball = Sphere(0.5 * math.sin(0.1), (place.real, 0.0, place.imag))
    found = contact_kept(foot, ball)
    for name, pitch in pitches.items():
        expected = np.clip(np.array([0.0, 0.2]) - pitch, 0, 0.45) / 0.45
        assert found.intervals[name][0] == pytest.approx(expected, abs=1e-4)
    assert found.together == ((0.0, 1.0),)
    assert found.kept
    assert found.lost_at == math.inf


def test_union_of_intervals_worked_by_hand():
    assert merged([(0.5, 0.7), (0.0, 0.2), (0.2, 0.3), (0.6, 0.65)]) == (
        (0.0, 0.3),
        (0.5, 0.7),
    )
    assert merged([]) == ()


def test_a_flat_face_beside_a_toes_plane_is_told_at_once():
    foot = PAPER.replace(splay=0.0)
    for gap, kept in ((0.0, True), (2.1e-6, False), (3e-5, False)):
        box = Box((1, 1, 4), (0.6, 0.5 + gap * foot.size, 0))
        assert contact_kept(foot, box).kept is kept


# The counterexample --------------------------------------------------------------


def test_the_counterexample_worked_by_hand():
    found = counterexample(PAPER)
    place = 0.8 / PAPER.rho
    radius = place * math.tan(math.pi / 24)
    assert (found.finger.name, found.lost_at) == ("finger4", 0.5)
    assert found.obstacle.radius == pytest.approx(radius)
    azimuth = math.pi * 13 / 12
    expected = place * math.cos(azimuth), place * math.sin(azimuth), -radius
    np.testing.assert_allclose(found.obstacle.centre, expected, atol=1e-15)
    distance = math.hypot(*expected)
    assert 2 * math.asin(radius / distance) == pytest.approx(
        found.lost_at * math.pi / 6
    )


@given(
    st.sampled_from(["paper", "paper-figure", "parrot", "owl"]),
    reals(0.3, 0.6),
    st.integers(1, 4),
)
@settings(max_examples=15)
def test_contact_ends_where_the_closed_form_says(name, lost_at, finger):
    found = counterexample(Foot.preset(name), finger=finger, lost_at=lost_at)
    contact = found.contact
    assert contact.intervals[found.finger.name][0] == pytest.approx(
        (0.0, lost_at), abs=1e-4
    )
    assert contact.lost_at == pytest.approx(lost_at, abs=1e-4)
    assert not contact.kept
    assert contact.keeps(0.0, lost_at)
    assert not contact.keeps(0.0, lost_at + 1e-3)


@pytest.mark.parametrize("name", ["paper", "owl"])
def test_a_strike_in_the_papers_reading_loses_the_ball(name):
    foot = Foot.preset(name)
    found, height = counterexample(foot), foot.size
    descent = Motion.through([0, 1], [(0, 0, height), (0, 0, -height)])
    closing = Closing(reading="paper", shape="linear")
    strike = simulate_strike(foot, found.obstacle, Flight(descent), closing=closing)
    engaged = strike.events[0]
    assert (engaged.finger, engaged.phalanx) == (found.finger.name, 1)
    assert engaged.time == pytest.approx(0.5, abs=1e-5)
    values = strike.controls[strike.modes == "closing"][:, 0]
    firsts = [part.start for part in foot.finger_slices.values()]
    gaps = strike.clearance[strike.modes == "closing"][:, firsts].min(axis=1)
    lost = values > found.lost_at + 1e-3
    assert np.all(gaps[lost] > strike.tolerance)
    assert np.all(gaps[values < found.lost_at - 1e-3] <= strike.tolerance)
    assert lost.any()
    base = strike.base[strike.modes == "closing"][0]
    contact = contact_kept(foot, found.obstacle, base=base)
    assert contact.lost_at == pytest.approx(found.lost_at, abs=1e-3)


# A toe with all controls equal ---------------------------------------------------


@pytest.mark.parametrize("name", ["paper", "owl", "anisodactyl"])
def test_junctions_are_those_of_both_kinematics(name):
    foot, values = Foot.preset(name), np.linspace(0, 1, 7)
    controls = np.repeat(values[:, None], foot.phalanx_count, axis=1)
    routes = forward_kinematics(foot, controls), FootModel(foot).forward(controls)
    for finger, part in zip(foot.fingers, foot.finger_slices.values(), strict=True):
        points = engaged_junctions(foot, finger, values)
        flat = np.array([math.cos(finger.azimuth), math.sin(finger.azimuth), 0])
        for bones in routes:
            ends = bones[:, part, 1]
            np.testing.assert_allclose(points[:, 1:].real, ends @ flat, atol=1e-12)
            np.testing.assert_allclose(points[:, 1:].imag, ends[..., 2], atol=1e-12)


def test_junctions_worked_by_hand():
    points = engaged_junctions(PAPER, PAPER.fingers[2], [1.0])[0]
    expected = [0, 0.535233 - 0.309017j, 0.726216 - 0.639809j, 0.726216 - 0.875877j]
    np.testing.assert_allclose(points[:4], expected, atol=1e-6)
    assert points[4] == pytest.approx(0.653267 - 1.002229j, abs=1e-6)


# Bad input -----------------------------------------------------------------------


def test_bad_values_are_named():
    ball = Sphere(0.1, (0.3, 0, 0))
    with pytest.raises(ParameterError, match="obstacle"):
        contact_kept(PAPER, "ball")
    with pytest.raises(ParameterError, match=r"tolerance = .* is not at least"):
        contact_kept(PAPER, ball, tolerance=1e-12)
    with pytest.raises(ParameterError, match="azimuths"):
        contact_kept(PAPER, ball, azimuths=[0.0, 1.0])
    with pytest.raises(ParameterError, match="pose"):
        contact_kept(PAPER, ball, base=np.eye(3))
    with pytest.raises(ParameterError, match="lost_at = 1 is not in"):
        counterexample(PAPER, lost_at=1)
    with pytest.raises(UnknownNameError, match="thumb"):
        counterexample(PAPER, finger="thumb")


def test_a_foot_too_thick_for_a_ball_is_refused():
    with pytest.raises(ParameterError, match="skin of the first phalanx"):
        counterexample(PAPER.replace(thickness=0.5))


def test_a_ball_that_another_toe_keeps_is_refused():
    wide = PAPER.replace(splay=0.0, thickness=0.1)
    with pytest.raises(ParameterError, match="v at which other meets it"):
        counterexample(wide.replace(fingers=twins()), lost_at=0.6)


def twins():
    """Two fingers one above the other, so that the upper one meets the ball later."""
    lower = PAPER.fingers[0]
    return Finger("other", 2, lower.azimuth, orientation=-0.1), lower
