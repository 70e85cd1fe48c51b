"""Figure 4: the section's half-axes by two routes that do not know the ellipse."""

from __future__ import annotations

import math

import numpy as np
import pytest
from entry_checks import broken, check_exhibits, numbers

from zygopin import Foot
from zygopin.paper import branch_section
from zygopin.paper.branch_section import figure_4, hits_branch, section_by_fcl


def test_half_axes_of_figure_4():
    found = numbers(figure_4())
    assert found["half_width"] == pytest.approx(2 / math.sqrt(2 + math.sqrt(3)))
    assert found["half_width_fcl"] == pytest.approx(1.0352761804, abs=1e-9)
    assert found["half_height"] == pytest.approx(1)
    assert found["half_height_fcl"] == pytest.approx(1)


def test_another_splay_is_told(monkeypatch):
    other = Foot.preset("paper").replace(splay=0.25)
    monkeypatch.setattr(branch_section.Foot, "preset", lambda _: other)
    assert {"half_width", "half_width_fcl", "half_width_projected"} == broken(
        figure_4()
    )


def test_fcl_finds_the_section_on_the_cylinder():
    # In the plane x = u·cos Ω: (u·cos Ω)² + (z + 1)² = 1.
    outline = section_by_fcl(24)
    across = outline.real * math.cos(math.pi / 12)
    np.testing.assert_allclose(across**2 + (outline.imag + 1) ** 2, 1, atol=1e-8)
    assert outline[0] == outline[-1]


def test_a_point_hits_the_branch_inside_alone():
    assert hits_branch(np.array([0.999, 0.3, -1.0]))
    assert not hits_branch(np.array([1.001, 0.3, -1.0]))


def test_exhibits(tmp_path):
    check_exhibits(figure_4(), tmp_path)
