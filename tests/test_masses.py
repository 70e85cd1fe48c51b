"""Masses and inertias: how links join into one body."""

from __future__ import annotations

import math
from xml.etree import ElementTree as ET

import pytest
from hypothesis import given
from hypothesis import strategies as st

from zygopin.description import to_urdf
from zygopin.foot import Foot
from zygopin.masses import Inertial, link_inertials


def thin_rod(mass, length):
    """A rod from its frame's origin along x: m·ℓ²/12 about its middle."""
    return Inertial(mass, length / 2, 0.0, mass * length * length / 12)


positive = st.floats(1e-6, 1e6, allow_subnormal=False)
inertials = st.builds(Inertial, positive, st.floats(-1e3, 1e3), positive, positive)


def test_two_half_rods_are_a_rod():
    half = thin_rod(3.0, 2.0)
    whole = half.joined(half.moved(2.0))
    assert whole == thin_rod(6.0, 4.0)


def test_a_rod_about_its_end_by_hand():
    # m·ℓ²/3 = 3·4/3
    assert thin_rod(3.0, 2.0).about(0.0) == pytest.approx(4.0, rel=1e-15)
    assert thin_rod(3.0, 2.0).about(1.0) == pytest.approx(1.0, rel=1e-15)


@given(inertials, inertials, st.floats(-1e3, 1e3))
def test_joining_adds_masses_and_moments_about_any_axis(one, other, x):
    both = one.joined(other)
    assert both == other.joined(one)
    assert both.mass == one.mass + other.mass
    assert both.axial == one.axial + other.axial
    assert math.isclose(both.about(x), one.about(x) + other.about(x), rel_tol=1e-9)


def test_a_link_has_the_numbers_of_the_urdf():
    foot = Foot.preset("parrot")
    text = to_urdf(foot)
    link = link_inertials(ET.fromstring(text))["finger2_phalanx3"]  # noqa: S314
    assert f'<mass value="{link.mass!r}"/>' in text
    assert f'ixx="{link.axial!r}"' in text
    assert f'iyy="{link.transverse!r}"' in text
    assert link.centre == pytest.approx(foot.lengths[4] / 2, rel=1e-14)
