"""The report on slips that change no result."""

from __future__ import annotations

import math

import numpy as np
import pytest
from entry_checks import broken, check_texts, numbers, with_other_feet

from zygopin.paper import small_slips

PHI = (1 + math.sqrt(5)) / 2


def test_each_is_shown_by_a_number_worked_by_hand():
    entry = small_slips.smaller_slips()
    assert entry.holds
    found = numbers(entry)
    assert found["strictness"] == pytest.approx(1 / PHI)
    # Between turns of 30° and 60° on a circle of radius 1/φ.
    chord = abs(np.exp(1j * math.pi / 3) - np.exp(1j * math.pi / 6)) / PHI
    assert found["free_start"] == pytest.approx(chord)
    assert found["past_the_fold"] == pytest.approx(math.radians(270 - 180))
    check_texts(entry)


def test_a_smaller_turn_is_not_past_the_fold(monkeypatch):
    monkeypatch.setattr(small_slips, "WIDE", 0.75 * math.pi)
    assert broken(small_slips.smaller_slips()) == {"past_the_fold"}


def test_other_phalanges_fold_alike(monkeypatch):
    with_other_feet(monkeypatch, small_slips, lambda foot: foot.replace(rho=1.2))
    assert broken(small_slips.smaller_slips()) == set()
