"""The flight of an attack: where it goes, how fast, and what the toes do meanwhile."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zygopin import Attack, Foot, ParameterError
from zygopin.stance import azimuths_at

OWL = Foot.preset("owl")


def test_the_base_comes_straight_down_on_the_target_at_its_speed():
    target = np.array([0.1, -0.2, 0.3])
    flight = Attack(speed=2.5, slope=math.radians(50)).flight(OWL, target)
    start, turn, end = flight.motion.times
    positions = flight.motion.at(flight.motion.times)[:, :3, 3]
    level, down = np.diff(positions, axis=0)
    assert level[1:] == pytest.approx([0, 0])
    assert math.atan2(-down[2], down[0]) == pytest.approx(math.radians(50))
    assert np.linalg.norm(level) == pytest.approx(2.5 * (turn - start))
    assert np.linalg.norm(down) == pytest.approx(2.5 * (end - turn))
    beyond = target - positions[1]
    assert np.cross(beyond, down) == pytest.approx(np.zeros(3), abs=1e-12)
    assert 0 < np.dot(beyond, down) < np.dot(down, down)


def test_the_toes_open_and_turn_before_the_way_down():
    flight = Attack(opened=0.2, reversal=0.75).flight(OWL)
    controls, reversal = flight.controls, flight.reversal
    times = flight.motion.times
    assert controls.at(times)[0] == pytest.approx(np.full(14, 0.6))
    assert controls.at(times)[1:] == pytest.approx(np.full((2, 14), 0.2))
    assert reversal.at(times) == pytest.approx([0, 0.75, 0.75])
    turned = azimuths_at(OWL, np.array(0.75)) - azimuths_at(OWL, np.array(0.0))
    assert turned == pytest.approx([0, 0, 0, 0.75 * math.radians(105)])


def test_a_large_target_is_begun_outside():
    flight = Attack().flight(OWL, radius=2.0)
    start = flight.motion.at(flight.motion.times[:1])[0, :3, 3]
    assert np.linalg.norm(start) > 2.0 + OWL.size


@pytest.mark.parametrize(
    ("values", "name"),
    [
        ({"speed": 0}, "speed"),
        ({"slope": 0}, "slope"),
        ({"slope": 2}, "slope"),
        ({"opened": 1.5}, "opened"),
        ({"reversal": math.nan}, "reversal"),
    ],
)
def test_bad_input_is_named(values, name):
    with pytest.raises(ParameterError, match=f"^{name} = "):
        Attack(**values)
    with pytest.raises(ParameterError, match=r"target"):
        Attack().flight(OWL, (0, 0))


@pytest.mark.parametrize("radius", [-1.0, math.nan])
def test_a_radius_that_is_no_length_is_named(radius):
    with pytest.raises(ParameterError, match=r"^radius = "):
        Attack().flight(OWL, radius=radius)
