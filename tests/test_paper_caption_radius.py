"""Figure 5 and the radius of its caption."""

from __future__ import annotations

import math

import pytest
from entry_checks import broken, check_exhibits, numbers

from zygopin import Foot
from zygopin.paper import caption_radius, closed_toes
from zygopin.paper.caption_radius import erratum_13, figure_5
from zygopin.paper.closed_toes import by_hand, by_scipy, nearest_radius

FOOT = Foot.preset("paper")


def test_the_three_radii():
    found = numbers(erratum_13())
    assert found["radius_circle"] == pytest.approx((math.sqrt(5) - 1) / 2)
    assert found["radius_printed"] == pytest.approx(0.6512, abs=5e-5)
    assert found["radius_true"] == pytest.approx(0.5868, abs=5e-5)
    assert found["t_printed"] > 0 > found["t_true"]
    # x₁ = (cos Ω·√3/2, −1/2)/ρ on the circle around (0, −r) of radius r.
    x, z = math.cos(math.pi / 12) * math.sqrt(3) / 2 / FOOT.rho, -0.5 / FOOT.rho
    assert found["junction"] == pytest.approx((x**2 + z**2) / (-2 * z))


def test_the_figures_foot_enters_its_branch():
    found = numbers(figure_5())
    assert found["first_phalanx"] == pytest.approx(-0.0831, abs=5e-5)
    assert found["second_phalanx"] == pytest.approx(7.1e-5, abs=1e-6)


@pytest.mark.parametrize("width", [0.5, 1.0, 1.3])
def test_hand_and_scipy_agree_on_any_ellipse(width):
    assert by_hand(FOOT, width) == pytest.approx(by_scipy(FOOT, width), abs=1e-9)


def test_the_nearest_tangent_radius_is_the_circles():
    assert nearest_radius(FOOT, 0.58) == pytest.approx(1 / FOOT.rho)
    assert nearest_radius(FOOT, 0.66) == pytest.approx(0.65117, abs=1e-5)


def test_readings_that_are_swapped_are_told(monkeypatch):
    swapped = {"printed": "geometric", "circle": "circle", "true": "printed"}
    monkeypatch.setattr(closed_toes, "READINGS", swapped)
    assert {"radius_printed", "radius_true", "t_true"} <= broken(erratum_13())


def test_a_caption_that_fits_would_be_told(monkeypatch):
    monkeypatch.setattr(caption_radius, "CAPTION", 0.65)
    assert "off_printed" in broken(erratum_13())


def test_exhibits(tmp_path):
    check_exhibits(figure_5(), tmp_path)
