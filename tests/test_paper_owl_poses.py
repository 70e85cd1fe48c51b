"""The owl's foot in two poses: areas worked out otherwise, and the toe that turns."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from entry_checks import broken, numbers, with_other_feet

from zygopin import Finger, Foot
from zygopin.paper import owl_poses, turning_toe
from zygopin.paper.strike_grid import struck_area


def shoelace(degrees):
    """Area of the talons' polygon with toe 4 at an azimuth, over s²."""
    azimuths = np.radians([15, 165, degrees, 345])
    lengths = [sum(1.18**-k for k in range(1, count + 1)) for count in (3, 2, 5, 4)]
    x, y = lengths * np.cos(azimuths), lengths * np.sin(azimuths)
    return abs(x @ np.roll(y, -1) - y @ np.roll(x, -1)) / 2


def toe_3_turns(foot):
    """The foot with toe 3 for the one that turns."""
    one, two, three, four = foot.fingers
    three = replace(three, reversed_azimuth=math.pi)
    four = replace(four, reversed_azimuth=None)
    return foot.replace(fingers=(one, two, three, four))


def test_hulls_are_polygons():
    found = numbers(owl_poses.figure_6())
    assert found["hull_zygodactyl"] == pytest.approx(shoelace(195), rel=1e-12)
    assert found["hull_spread"] == pytest.approx(shoelace(300), rel=1e-12)
    assert found["gain_hull"] == pytest.approx(
        shoelace(300) / shoelace(195) - 1, rel=1e-12
    )
    assert found["share_hull"] == pytest.approx(shoelace(300) / shoelace(255), rel=1e-8)


def test_the_hull_is_largest_at_a_right_angle():
    areas = [shoelace(degrees) for degrees in range(195, 301)]
    assert range(195, 301)[int(np.argmax(areas))] == 255
    for key in ("hull", "first", "all"):
        found = numbers(owl_poses.figure_6())[f"best_{key}"]
        assert math.degrees(found) == pytest.approx(60, abs=0.01)


def test_a_lone_toe_strikes_a_stadium():
    foot = Foot(rho=1.5, fingers=(Finger("toe", 3, 0.4),))
    length = sum(1.5**-k for k in (1, 2, 3))
    area, error = struck_area(foot, 0.2, 0.0)
    assert area == pytest.approx(0.4 * length + math.pi * 0.04, abs=error)
    assert error < 0.01 * area


def test_another_splay_is_another_figure(monkeypatch):
    with_other_feet(monkeypatch, owl_poses, lambda foot: foot.replace(splay=0.3))
    wrong = broken(owl_poses.figure_6())
    assert {"azimuth_zygodactyl", "hull_zygodactyl", "best_hull"} <= wrong


def test_toe_3_does_not_pass_for_the_one_that_turns(monkeypatch):
    with_other_feet(monkeypatch, turning_toe, toe_3_turns)
    wrong = broken(turning_toe.erratum_14())
    assert {"phalanges", "toe_3_spread", "forward_spread"} <= wrong
