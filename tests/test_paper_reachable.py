"""The report on reachable sets and their limit."""

from __future__ import annotations

import math

import numpy as np
import pytest
from entry_checks import broken, numbers
from PIL import Image

from zygopin.paper import reachable

PHI = (1 + math.sqrt(5)) / 2


def test_contractions_shrink_by_rho_and_forget_where_they_start():
    entry = reachable.contractions()
    assert entry.holds
    # One point of the start is the farthest from 0: its images stay in step.
    assert numbers(entry)["approach"] == pytest.approx(1, abs=1e-9)


def test_an_operator_that_shrinks_less_fails(monkeypatch):
    slack = lambda *given: 1.1 * hutchinson(*given)  # noqa: E731
    hutchinson = reachable.hutchinson
    monkeypatch.setattr(reachable, "hutchinson", slack)
    assert broken(reachable.contractions()) == {"approach"}
    assert broken(reachable.proposition_1()) == {"operator", "invariance"}


def test_both_parts_of_the_proposition_hold():
    entry = reachable.proposition_1()
    assert entry.holds
    assert numbers(entry)["invariance"] == pytest.approx(PHI**-17, rel=1e-9)


def test_v0_read_as_a_control_fails(monkeypatch):
    turned = reachable.reachable_set

    def as_control(rho, omega, *rest, orientation=0.0):
        return turned(rho, omega, *rest, orientation=omega * orientation)

    monkeypatch.setattr(reachable, "reachable_set", as_control)
    assert broken(reachable.proposition_1()) == {"orientation"}


def test_finite_sums_are_off_the_attractor():
    entry = reachable.erratum_5()
    assert entry.holds
    # 1/φ + 1/φ² + … = φ, and 1 + 2 + 4 + 8 + 16 sums.
    assert numbers(entry)["base_one_level"] == pytest.approx(PHI, abs=1e-11)
    assert numbers(entry)["sums_off"] == 31
    assert 1.08 < numbers(entry)["base_two_levels"] < 1.09
    assert 0.9 < numbers(entry)["base_interval"] <= numbers(entry)["base_two_levels"]


def test_the_sums_are_those_of_short_fingers():
    sums = reachable.finite_sums(2)
    turn = np.exp(-1j * math.pi / 6)
    ones = [1 / PHI, turn / PHI]
    twos = [
        1 / PHI + 1 / PHI**2,
        1 / PHI + turn / PHI**2,
        turn / PHI + turn / PHI**2,
        turn / PHI + turn**2 / PHI**2,
    ]
    assert np.abs(np.sort_complex(sums) - np.sort_complex([0, *ones, *twos])).max() < (
        1e-15
    )


@pytest.mark.parametrize("make", [reachable.proposition_1, reachable.erratum_5])
def test_their_figures_are_drawn(make, tmp_path):
    (figure,) = make().figures
    figure.write(tmp_path / figure.name)
    with Image.open(tmp_path / figure.name) as image:
        assert min(image.size) > 600
