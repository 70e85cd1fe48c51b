"""The two curves of the tangency system."""

from __future__ import annotations

import math

import numpy as np
import pytest
from entry_checks import broken, numbers

from zygopin import Branch, Foot
from zygopin.paper import curves
from zygopin.paper.curves import ellipse_parametrisation, phalanx_parametrisation
from zygopin.paper.finger_plane import (
    angle_modulo_pi,
    bark_gap,
    in_plane,
    in_space,
    phalanx_lines,
    widths,
)


def test_phalanges_and_ellipses_hold():
    assert set(numbers(phalanx_parametrisation())) == {"start", "end", "between"}
    assert len(numbers(ellipse_parametrisation())) == 3


def test_the_printed_half_axes_are_told(monkeypatch):
    monkeypatch.setattr(
        curves, "widths", lambda foot: {"true": widths(foot)["printed"]}
    )
    assert {"on_the_cylinder", "tangent"} <= broken(ellipse_parametrisation())


def test_a_phalanx_that_is_not_mirrored_is_told(monkeypatch):
    def unmirrored(foot, _, controls):
        return phalanx_lines(foot, "finger3", controls)

    monkeypatch.setattr(curves, "phalanx_lines", unmirrored)
    assert broken(phalanx_parametrisation()) == {"end", "between", "start"}


def test_the_plane_and_back():
    foot = Foot.preset("paper")
    numbers_there = np.array([0.3 - 0.2j, -1 + 1j])
    np.testing.assert_allclose(
        in_plane(foot, in_space(foot, numbers_there)), numbers_there
    )
    assert in_space(foot, 1.0)[0] == pytest.approx(math.cos(math.pi / 12))


def test_junctions_of_the_closed_finger():
    # MODEL.md, section 2: x₁ and x₂ for all controls 1.
    start, step = phalanx_lines(Foot.preset("paper"), "finger3", np.ones(4))
    assert start[1] == pytest.approx(0.535233 - 0.309017j, abs=1e-6)
    assert (start + step)[1] == pytest.approx(0.726216 - 0.639809j, abs=1e-6)
    mirrored, _ = phalanx_lines(Foot.preset("paper"), "finger1", np.ones(2))
    assert mirrored[1] == pytest.approx(-0.535233 - 0.309017j, abs=1e-6)


def test_distances_and_angles():
    branch = Branch(0.5, (0.0, 7.0, -1.0))
    assert bark_gap(np.array([3.0, 0.0, 3.0]), branch) == pytest.approx(4.5)
    assert angle_modulo_pi(1j, -1 + 1j) == pytest.approx(math.pi / 4)
    assert angle_modulo_pi(-2.0, 3.0) == 0
