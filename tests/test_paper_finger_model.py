"""The report on one finger: hand-worked numbers, and readings that must fail."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from entry_checks import broken, numbers
from PIL import Image

from zygopin import Foot
from zygopin.paper import finger_model

PHI = (1 + math.sqrt(5)) / 2


def test_the_turn_of_the_notation_s_last_phalanx_is_omega():
    entry = finger_model.figure_1()
    assert numbers(entry)["turn"] == pytest.approx(math.radians(30))
    assert numbers(entry)["inner_angle"] == pytest.approx(math.radians(150))
    assert entry.holds


def test_the_closed_finger_is_the_one_worked_by_hand():
    entry = finger_model.control_system()
    tip = sum(PHI**-k * cmath.exp(-1j * k * math.pi / 6) for k in range(1, 5))
    assert numbers(entry)["x4_re"] == pytest.approx(tip.real, abs=1e-14)
    assert numbers(entry)["x4_im"] == pytest.approx(tip.imag, abs=1e-14)
    assert numbers(entry)["x4_re"] == pytest.approx(0.653267, abs=5e-7)
    assert numbers(entry)["x4_im"] == pytest.approx(-1.002229, abs=5e-7)
    assert entry.holds


def test_the_sum_is_that_of_the_system():
    foot = Foot(rho=2.0, omega=math.pi / 2)
    found = finger_model.summed(foot, np.array([1.0, 1.0, 0.0]))
    assert np.abs(found - [0, -0.5j, -0.25 - 0.5j, -0.375 - 0.5j]).max() < 1e-15


def test_a_finger_that_turns_the_other_way_fails(monkeypatch):
    mirrored = lambda *given: np.conj(summed(*given))  # noqa: E731
    summed = finger_model.summed
    monkeypatch.setattr(finger_model, "summed", mirrored)
    assert broken(finger_model.control_system()) == {"by_definition", "miniature"}
    assert broken(finger_model.figure_1()) == {"turn"}


def test_another_joint_limit_fails(monkeypatch):
    wrong = Foot.preset("paper").replace(omega=0.5)
    monkeypatch.setattr(finger_model.Foot, "preset", lambda _: wrong)
    assert broken(finger_model.control_system()) == {"x4_re", "x4_im"}


def test_the_notation_is_drawn(tmp_path):
    (figure,) = finger_model.figure_1().figures
    figure.write(tmp_path / figure.name)
    with Image.open(tmp_path / figure.name) as image:
        assert image.width > 700
