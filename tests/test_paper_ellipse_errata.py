"""The printed half-axes and the printed centre, by numbers worked here anew."""

from __future__ import annotations

import math

import pytest
from entry_checks import broken, check_exhibits, numbers

from zygopin.paper import ellipse_errata
from zygopin.paper.ellipse_errata import ellipse_centre, erratum_4
from zygopin.paper.finger_plane import widths


def test_printed_ellipses_leave_the_bark():
    found = numbers(erratum_4())
    # sin²15° = (1 − cos 30°)/2; Ω·cos Ω with cos 15° = (√6 + √2)/4.
    assert found["printed"] == pytest.approx((1 - math.sqrt(3) / 2) / 2)
    cosine = (math.sqrt(6) + math.sqrt(2)) / 4
    assert found["printed_once"] == pytest.approx(1 - math.pi / 12 * cosine)


def test_the_printed_ellipse_taken_for_the_true_one_is_told(monkeypatch):
    def swapped(foot):
        found = widths(foot)
        return {**found, "true": found["printed"], "printed": found["true"]}

    monkeypatch.setattr(ellipse_errata, "widths", swapped)
    assert broken(erratum_4()) == {"true", "printed", "fcl_beyond"}


def test_the_printed_centre_is_off_the_axis():
    # p = (−cos Ω, ·, 1) and the axis at (0, ·, −1): √(cos²Ω + 4) − 1.
    found = numbers(ellipse_centre())
    assert found["top"] == pytest.approx(math.sqrt(4.5 + math.sqrt(3) / 4) - 1)
    assert found["farthest"] > found["top"]


def test_exhibits(tmp_path):
    check_exhibits(erratum_4(), tmp_path)
