"""Back toes as the paper prints them: up, or straight down."""

from __future__ import annotations

import cmath
import math

import pytest
from entry_checks import broken, numbers

from zygopin.foot import GOLDEN_MEAN
from zygopin.paper import back_toes


def curled(start):
    """Tip of a toe of 5 phalanges, all controls 1, by the geometric series."""
    ratio = cmath.exp(-1j * math.pi / 6) / GOLDEN_MEAN
    return cmath.exp(-1j * start) * ratio * (1 - ratio**5) / (1 - ratio)


def test_a_half_turn_in_the_plane_lifts_the_tip():
    found = numbers(back_toes.erratum_2())
    assert found["z_printed"] == pytest.approx(curled(math.pi).imag, abs=1e-14)
    assert found["z_printed"] > 1
    assert found["z_ours"] == pytest.approx(curled(0).imag, abs=1e-14)


def test_the_printed_sum_is_the_series():
    for start in (0.0, math.pi, math.pi**2 / 6):
        tip = back_toes.back_toe(start, 1.0)[-1]
        assert tip == pytest.approx(curled(start), abs=1e-14)


def test_six_half_turns_of_omega_are_one():
    found = numbers(back_toes.erratum_3())
    assert math.degrees(found["angle"]) == pytest.approx(94.2478, abs=1e-4)
    straight = sum(GOLDEN_MEAN**-k for k in range(1, 6))
    assert found["six"] == pytest.approx(-straight, abs=1e-14)
    assert found["x_printed"] == pytest.approx(
        straight * math.cos(math.radians(94.24777960769379)), abs=1e-14
    )


def test_a_forward_toe_does_not_pass_for_the_printed_one(monkeypatch):
    monkeypatch.setattr(back_toes, "HALF_TURN", 0.0)
    assert {"z_printed", "point_reflection"} <= broken(back_toes.erratum_2())


def test_a_half_turn_does_not_pass_for_the_printed_angle(monkeypatch):
    monkeypatch.setattr(back_toes, "PRINTED", math.pi)
    assert {"x_printed", "x_fk"} <= broken(back_toes.erratum_3())
