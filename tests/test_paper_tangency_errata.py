"""The printed argument and the printed range."""

from __future__ import annotations

import math

import pytest
from entry_checks import broken, numbers

from zygopin.paper import tangency_errata
from zygopin.paper.tangency_errata import erratum_6, erratum_7


def test_the_angle_of_one_case():
    # φ(½)·e^{2iω}: phalanges 1 and 2 seen from the second, ω = 30°.
    rho = (1 + math.sqrt(5)) / 2
    across, along = 0.5 / rho, math.sqrt(3) / 2 / rho + 0.5 / rho**2
    found = numbers(erratum_6())
    assert found["one_case"] == pytest.approx(math.atan(across / along))
    assert found["least"] <= found["median"] <= found["largest"]


def test_a_position_taken_for_a_direction_is_told(monkeypatch):
    # As if the printed condition held: every angle is zero.
    monkeypatch.setattr(
        tangency_errata, "angle_modulo_pi", lambda one, other: abs(one * other) * 0
    )
    assert broken(erratum_6()) == {"least", "one_case", "chords"}


def test_the_angles_of_the_system():
    found = numbers(erratum_7())
    assert 0 <= found["least"] < math.pi < found["largest"] < 2 * math.pi
    assert found["opposite"] >= 1 - 1e-9
