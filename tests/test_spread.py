"""What the spread pose gains: by hand, against the exact engine, and its laws."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import controls_for, feet, reals

from zygopin import (
    Branch,
    Finger,
    Foot,
    ParameterError,
    UnknownNameError,
    forward_kinematics,
    spread_study,
    strike_area,
    talon_hull_area,
)
from zygopin.clearance import branch_clearance

OWL = Foot.preset("owl")
TARGET = 0.015
"""Radius of a mouse or so [m]."""

RIGHT = math.pi / 2


def cross(azimuths, reversed_azimuth, **parameters):
    """A foot of one-phalanx toes, 1 m long and bare, the last of which turns."""
    *others, last = (
        Finger(f"toe{i}", 1, azimuth) for i, azimuth in enumerate(azimuths)
    )
    last = dataclasses.replace(last, reversed_azimuth=reversed_azimuth)
    fields = {"rho": 2.0, "scale": 2.0} | parameters
    return Foot(fingers=(*others, last), **fields)


def stadium(length, radius):
    """Area of a stadium."""
    return 2 * radius * length + math.pi * radius**2


@st.composite
def turning_feet(draw):
    """Feet with at least one toe that turns."""
    foot = draw(feet())
    first, *others = foot.fingers
    turned = dataclasses.replace(first, reversed_azimuth=draw(reals(-3, 3)))
    return foot.replace(fingers=(turned, *others))


def test_a_square_hull_worked_by_hand():
    foot = cross((0, RIGHT, 2 * RIGHT, 2 * RIGHT), 3 * RIGHT)
    hulls = talon_hull_area(foot, reversal=[0.0, 0.5, 1.0])
    np.testing.assert_allclose(hulls, [1, 1 + math.sqrt(0.5), 2], rtol=1e-14)
    curled = talon_hull_area(foot.replace(omega=1.0), np.ones(4), reversal=1)
    assert curled == pytest.approx(2 * math.cos(1) ** 2)


def test_a_toe_alone_covers_the_same_wherever_it_is():
    toe = Finger("toe", 3, 0.3, reversed_azimuth=2.0)
    foot = Foot(fingers=(toe,), scale=0.1)
    reversal = np.linspace(0, 1, 5)
    first = strike_area(foot, 0.02, reversal=reversal)
    np.testing.assert_allclose(first, stadium(0.1 / foot.rho, 0.02), rtol=1e-13)
    every = strike_area(foot, 0.02, reversal=reversal, phalanges="all")
    np.testing.assert_allclose(every, stadium(foot.size, 0.02), rtol=1e-13)
    assert talon_hull_area(foot, reversal=reversal).tolist() == [0] * 5


def test_two_toes_worked_by_hand():
    foot, radius = cross((0, RIGHT), 2 * RIGHT), 0.3
    corner = 2 * stadium(1, radius) - radius**2 - 0.75 * math.pi * radius**2
    found = strike_area(foot, radius, reversal=[0, 1])
    np.testing.assert_allclose(found, [corner, stadium(2, radius)], rtol=1e-14)


def test_a_bent_toe_covers_less_and_skin_covers_more():
    foot = cross((0,), 1.0, omega=1.0, thickness=0.2)
    area = strike_area(foot, 0.3, reversal=0, controls=[1.0])
    assert area == pytest.approx(stadium(math.cos(1), 0.3 + 0.1))


@pytest.mark.parametrize("phalanges", ["first", "all"])
@pytest.mark.parametrize("reversal", [0.0, 0.4, 1.0])
def test_balls_let_down_at_random_meet_the_foot_as_often_as_the_area_says(
    phalanges, reversal
):
    # A ball on its way down sweeps an upright cylinder: the exact engine's branch.
    rng = np.random.default_rng(5)
    controls = rng.uniform(0, 0.5, OWL.phalanx_count)
    toe = OWL.fingers[3]
    azimuths = [finger.azimuth for finger in OWL.fingers]
    azimuths[3] += reversal * (toe.reversed_azimuth - toe.azimuth)
    bones = forward_kinematics(OWL, controls, azimuths=azimuths)
    half = 0.12
    places = np.zeros((20_000, 3))
    places[:, :2] = rng.uniform(-half, half, (20_000, 2))
    hits = np.linalg.norm(places, axis=-1) <= TARGET  # these meet the base itself
    swept = Branch(radius=TARGET, centre=places[~hits], axis=(0, 0, 1))
    gaps = branch_clearance(bones, OWL.radii, swept).distance
    counted = OWL.rank_of_phalanx == 1 if phalanges == "first" else slice(None)
    hits[~hits] = (gaps[:, counted] <= 0).any(axis=-1)
    options = {"reversal": reversal, "controls": controls, "phalanges": phalanges}
    expected = float(strike_area(OWL, TARGET, **options)) / (2 * half) ** 2
    deviation = math.sqrt(expected * (1 - expected) / len(hits))
    assert abs(hits.mean() - expected) < 5 * deviation


def turned(foot, part):
    """The foot turned about z, by some part of what its azimuths leave room for."""
    angles = [finger.azimuth for finger in foot.fingers]
    angles += [finger.reversed_azimuth or 0.0 for finger in foot.fingers]
    low, high = -2 * math.pi - min(angles), 2 * math.pi - max(angles)
    turn = 0.999 * (low + part * (high - low))
    fingers = (
        dataclasses.replace(
            finger,
            azimuth=finger.azimuth + turn,
            reversed_azimuth=finger.azimuth + turn + finger.reversal,
        )
        for finger in foot.fingers
    )
    return foot.replace(fingers=tuple(fingers))


def areas(foot, controls, reversal, part):
    """All three areas, for a target whose radius is a part of the foot's size [m²]."""
    options = {"controls": controls, "reversal": reversal}
    radius = part * foot.size
    hull = talon_hull_area(foot, **options)
    kinds = ("first", "all")
    found = (strike_area(foot, radius, phalanges=kind, **options) for kind in kinds)
    return np.array([hull, *found])


@given(turning_feet(), st.data(), reals(0, 1), reals(0, 1), reals(0.01, 2))
@settings(max_examples=25, deadline=None)
def test_turning_the_foot_changes_nothing(foot, data, turn, reversal, part):
    controls = data.draw(controls_for(foot))
    found = areas(turned(foot, turn), controls, reversal, part)
    expected = areas(foot, controls, reversal, part)
    np.testing.assert_allclose(found, expected, rtol=1e-9, atol=1e-13 * foot.size**2)


@given(turning_feet(), st.data(), reals(0, 1), reals(0.01, 2))
@settings(max_examples=25, deadline=None)
def test_areas_go_by_the_square_of_the_size(foot, data, reversal, part):
    controls = data.draw(controls_for(foot))
    small = foot.replace(scale=1.0, thickness=foot.thickness / foot.scale * 0.99)
    large = small.replace(scale=1e3, thickness=1e3 * small.thickness)
    one, other = (areas(each, controls, reversal, part) for each in (small, large))
    np.testing.assert_allclose(other, 1e6 * one, rtol=1e-9, atol=1e-6)


@given(turning_feet(), st.data(), reals(0, 1), reals(0.01, 2), reals(1, 2))
@settings(max_examples=25, deadline=None)
def test_more_phalanges_and_larger_targets_are_met_more_often(
    foot, data, reversal, part, factor
):
    controls = data.draw(controls_for(foot))
    options = {"reversal": reversal, "controls": controls}
    radius = min(part * foot.size, 1e5)  # far from the largest allowed
    first = strike_area(foot, radius, **options)
    every = strike_area(foot, radius, phalanges="all", **options)
    larger = strike_area(foot, factor * radius, **options)
    assert first <= min(every, larger) * (1 + 1e-12)
    assert first >= math.pi * radius**2 * (1 - 1e-12)


def test_batches_of_reversals_and_controls():
    rng = np.random.default_rng(0)
    controls, reversal = rng.uniform(size=(3, 1, 14)), np.array([0.0, 0.7])
    hulls = talon_hull_area(OWL, controls, reversal=reversal)
    strikes = strike_area(OWL, TARGET, reversal=reversal, controls=controls)
    assert hulls.shape == strikes.shape == (3, 2)
    alone = strike_area(OWL, TARGET, reversal=0.7, controls=controls[2, 0])
    assert alone.shape == ()
    assert strikes[2, 1] == alone
    straight = talon_hull_area(OWL, np.zeros(14), reversal=1)
    assert talon_hull_area(OWL, reversal=1) == straight


def test_the_owl_s_spread_pose_beats_the_zygodactyl_one_but_is_not_the_widest():
    study = spread_study(OWL, TARGET)
    curves = study.hull, study.strike_first, study.strike_all
    assert study.reversal.shape == (181,)
    gains = [curve.gain for curve in curves]
    assert gains == pytest.approx([0.244333, 0.043418, 0.035350], abs=1e-6)
    # The toe turns by 105°; after 60° it stands square to toes 1 and 3, which are
    # in one plane: half way between its neighbours.
    for curve in curves:
        assert not curve.spread_is_best
        assert curve.best_reversal == pytest.approx(60 / 105, abs=1e-6)
        assert curve.best_area >= curve.areas.max()
        assert curve.spread == curve.areas[-1] < curve.best_area
        assert not curve.areas.flags.writeable
    millimetres = [curve.zygodactyl * 1e6 for curve in curves]
    assert millimetres == pytest.approx([5076.3, 3933.9, 9889.7], abs=0.1)


def test_a_spread_pose_that_is_the_widest_is_called_so():
    foot = cross((0, RIGHT, 2 * RIGHT, 2.5 * RIGHT), 3 * RIGHT)
    study = spread_study(foot, 0.1, steps=7)
    for curve in (study.hull, study.strike_first, study.strike_all):
        assert curve.spread_is_best
        assert curve.best_reversal == pytest.approx(1, abs=1e-6)
        assert curve.gain > 0


def test_a_maximum_between_the_steps_is_found():
    foot = cross((0, RIGHT, 2 * RIGHT, 2.2 * RIGHT), 3.9 * RIGHT)
    coarse, fine = (spread_study(foot, 0.1, steps=n).hull for n in (4, 1001))
    assert coarse.best_reversal == pytest.approx(0.8 / 1.7, abs=1e-6)
    assert coarse.best_area == pytest.approx(fine.best_area, rel=1e-12)
    assert coarse.best_area == pytest.approx(2, rel=1e-12)


def test_areas_of_nothing_gain_nothing():
    alone = Foot(fingers=(Finger("toe", 2, 0.0, reversed_azimuth=1.0),))
    study = spread_study(alone, 0.0, steps=3)
    assert study.hull.gain == study.strike_all.gain == 0
    assert study.hull.spread_is_best
    opened = cross((0, 2 * RIGHT, 2 * RIGHT), 3 * RIGHT)
    assert spread_study(opened, 0.1, steps=3).hull.gain == math.inf


PARROT = Foot.preset("parrot")
REMEDY = "give a finger its reversed_azimuth, or take the preset owl"


@pytest.mark.parametrize(
    ("call", "error", "words"),
    [
        (
            lambda: talon_hull_area(PARROT, reversal=1),
            ParameterError,
            f"toes of parrot that can turn = 0 is not at least 1: {REMEDY}",
        ),
        (lambda: strike_area(PARROT, 0.01, reversal=1), ParameterError, REMEDY),
        (lambda: spread_study(PARROT, 0.01), ParameterError, REMEDY),
        (
            lambda: talon_hull_area(OWL, reversal=[0, 1.5]),
            ParameterError,
            "reversal[1] = 1.5 is not in [0, 1]: 0 is the zygodactyl pose",
        ),
        (
            lambda: talon_hull_area(OWL, reversal=math.nan),
            ParameterError,
            "reversal = nan is not finite",
        ),
        (
            lambda: strike_area(OWL, -1, reversal=0),
            ParameterError,
            "radius = -1 is not in [0, 1e+06]: give metres",
        ),
        (
            lambda: strike_area(OWL, math.inf, reversal=0),
            ParameterError,
            "radius = inf",
        ),
        (
            lambda: strike_area(OWL, 1, reversal=0, phalanges="last"),
            UnknownNameError,
            "unknown phalanges 'last': choose one of first, all",
        ),
        (
            lambda: strike_area(OWL, 1, reversal=0, controls=[2.0] * 14),
            ParameterError,
            "controls[0] = 2.0 is not in [0, 1]",
        ),
        (
            lambda: strike_area(OWL, 1, reversal=[0, 0, 1], controls=np.zeros((2, 14))),
            ParameterError,
            "batch shapes of controls and azimuths",
        ),
        (lambda: spread_study(OWL, "x"), ParameterError, "radius = 'x'"),
        (lambda: spread_study(OWL, 0.01, steps=1), ParameterError, "steps = 1 is not"),
        (
            lambda: spread_study(OWL, 0.01, controls=np.zeros((2, 14))),
            ParameterError,
            "controls.shape = (2, 14) is not of shape (P,): give one pose",
        ),
    ],
)
def test_bad_values_are_named_in_one_line(call, error, words):
    with pytest.raises(error) as caught:
        call()
    assert words in str(caught.value)
    assert len(str(caught.value).splitlines()) == 1
