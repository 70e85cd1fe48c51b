"""The grasping condition at zero."""

from __future__ import annotations

import math

import pytest
from entry_checks import broken, check_exhibits, numbers

from zygopin.paper import zero_product
from zygopin.paper.grasp_cases import quarter_turn
from zygopin.paper.zero_product import erratum_8


def test_the_quarter_turn():
    found = numbers(erratum_8())
    rho = (1 + math.sqrt(5)) / 2
    assert found["t_finger1"] == pytest.approx((0.65 - 1 / rho) / (1 / rho))
    # ρ⁻² + ρ⁻³ = ρ⁻¹ for the golden mean.
    assert found["t_finger3"] == pytest.approx((0.65 - 1 / rho) * rho**4)
    assert (found["in_words"], found["by_formula"]) == (1, 0)


def test_a_branch_that_is_moved_is_told(monkeypatch):
    case = quarter_turn()
    moved = case.branch.moved_to(case.branch.centre - (0.001, 0.0, 0.0))
    off = type(case)(case.foot, case.controls, moved, case.pitch, case.seen)
    monkeypatch.setattr(zero_product, "quarter_turn", lambda: off)
    assert {"clearance", "clearance_fcl", "in_words"} <= broken(erratum_8())


def test_exhibits(tmp_path):
    check_exhibits(erratum_8(), tmp_path)
