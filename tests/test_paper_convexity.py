"""The paper's last remark: the ball that is lost, and what holds instead."""

from __future__ import annotations

import math

import pytest
from entry_checks import broken, numbers

from zygopin import counterexample
from zygopin.paper import convexity


@pytest.fixture(scope="module")
def entry():
    """The entry, made once."""
    return convexity.erratum_11()


def test_the_ball_is_lost_where_the_phalanx_is_tangent_again(entry):
    found = numbers(entry)
    length = 2 / (1 + math.sqrt(5))
    # Both tangents from the base touch the ball; they are half of ω apart.
    distance = math.hypot(0.8 * length, found["radius"])
    angle = 2 * math.asin(found["radius"] / distance)
    assert math.degrees(angle) == pytest.approx(15)
    turned = math.radians(30) - math.radians(15) / 2
    gap = distance * math.sin(turned) - found["radius"]
    assert found["gap"] == pytest.approx(gap, abs=1e-12)


def test_the_numbers_are_those_of_the_picture(entry):
    (figure,) = entry.figures
    assert f"radius {numbers(entry)['radius']:.3f}" in figure.caption


def test_a_ball_lost_earlier_does_not_pass(monkeypatch):
    monkeypatch.setattr(
        convexity, "counterexample", lambda foot: counterexample(foot, lost_at=0.4)
    )
    monkeypatch.setattr(convexity, "OBSTACLES", 3)
    wrong = broken(convexity.erratum_11())
    assert {"radius", "lost_kept", "lost_fcl", "gap", "first_gap"} <= wrong


def test_beyond_half_a_turn_the_statement_fails(monkeypatch):
    monkeypatch.setattr(convexity, "WIDE", 1.9 * math.pi)
    measured = convexity._random_obstacles()
    assert {each.name for each in measured if not each.holds} == {"split", "wrong"}
