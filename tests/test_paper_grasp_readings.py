"""What the scalar product is of: poses astride a branch."""

from __future__ import annotations

import math

import numpy as np
import pytest
from entry_checks import broken, check_exhibits, numbers

from zygopin import Foot
from zygopin.paper import grasp_readings
from zygopin.paper.grasp_cases import astride, perch, trunk, verdicts
from zygopin.paper.grasp_readings import scalar_product


def test_trunk_and_perch_are_told_apart_in_opposite_ways():
    found = numbers(scalar_product())
    assert (found["trunk_grasping"], found["trunk_grasping_base_to_tip"]) == (0, 1)
    assert (found["perch_grasping"], found["perch_grasping_base_to_tip"]) == (1, 0)
    # tan α' = √3/cos 15°: cos 2α' = (1 − tan²)/(1 + tan²).
    square = 3 / ((2 + math.sqrt(3)) / 4)
    assert found["perch_normals"] == pytest.approx((1 - square) / (1 + square))
    assert found["perch_base_to_tip"] == pytest.approx(0.5)


def test_tangents_in_the_plane_are_not_the_normals():
    # At θ = 45° and 135°: (k² − 1)/(k² + 1) with k = 1/cos 15°.
    found = numbers(scalar_product())
    k = 4 / (math.sqrt(6) + math.sqrt(2))
    assert found["plane_perpendicular"] == pytest.approx((k**2 - 1) / (k**2 + 1))
    angle = np.linspace(0, 2 * np.pi, 601)
    tangent = -k * np.sin(angle) + 1j * np.cos(angle)
    unit = tangent / np.abs(tangent)
    plane = (unit[:, None] * np.conj(unit)).real
    apart = np.abs(plane - np.cos(angle[:, None] - angle)).max()
    assert apart == pytest.approx(2 * math.tan(math.pi / 24) ** 2, rel=1e-3)
    assert found["plane"] <= 2 * math.tan(math.pi / 24) ** 2


def test_readings_that_are_swapped_are_told(monkeypatch):
    def swapped(case, reading="section"):
        other = "base_to_tip" if reading == "section" else "section"
        return verdicts(case, other)

    monkeypatch.setattr(grasp_readings, "verdicts", swapped)
    assert broken(scalar_product()) == {
        "trunk_grasping",
        "trunk_grasping_base_to_tip",
        "perch_grasping",
        "perch_grasping_base_to_tip",
    }


@pytest.mark.parametrize("t", [0.5, 0.6, 0.7])
@pytest.mark.parametrize("closed", [(0.5,), (1.0, 1.0)])
def test_poses_astride_touch_where_they_should(closed, t):
    case = astride(Foot.preset("paper"), closed, t)
    report = verdicts(case)
    rank = case.foot.rank_of_phalanx == len(closed)
    np.testing.assert_allclose(report.clearance[rank], 0, atol=1e-12)
    np.testing.assert_allclose(report.t[rank], t, atol=1e-9)


def test_exhibits(tmp_path):
    check_exhibits(scalar_product(), tmp_path)
    assert trunk().branch.radius > 20 > perch().branch.radius
