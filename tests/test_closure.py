"""Force closure: cases worked by hand, laws, and an independent sampling."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import minimize
from stances import perched, ring

from zygopin.closure import closure_quality, force_closure, least_friction
from zygopin.contacts import Contacts, Friction, branch_contacts


def test_two_opposed_contacts_never_close():
    # Nothing resists a turn about the line between them.
    pair = ring(0, 180)
    assert not force_closure(pair, Friction(1.0))
    assert closure_quality(pair, Friction(1.0)).high == 0
    assert least_friction(pair) == (math.inf, math.inf)


def test_three_around_close_with_any_friction_and_not_without():
    three = ring(0, 120, 240)
    assert force_closure(three, Friction(0.01))
    assert not force_closure(three, Friction(0.0))
    assert least_friction(three)[1] < 1e-5


def test_a_frictionless_cylinder_is_free_to_slide_and_spin():
    many = ring(*range(0, 360, 30), heights=np.linspace(-1, 1, 12))
    assert not force_closure(many, Friction(0.0))
    assert closure_quality(many, Friction(0.0)).high == 0


@pytest.mark.parametrize("half", [50, 60, 80])
def test_contacts_within_an_arc_need_the_friction_of_its_gap(half):
    # At ±h and between them: pushes at ±h that oppose need cones that reach across:
    # the pull along −x is balanced once tan μ ≥ ... n·x = cos h ≤ μ sin h: μ = cot h.
    arc = ring(-half, 0, half)
    low, high = least_friction(arc, edges=64)
    want = 1 / math.tan(math.radians(half))
    assert low <= want * (1 + 1e-5)
    assert want <= high * (1 + 1e-5)
    assert high - low < 0.01 * want


def test_the_quality_of_a_ring_lies_where_the_round_cones_have_it():
    contacts, friction = ring(0, 90, 200, heights=[0, 0.3, -0.2]), Friction(0.6, 24)
    found = closure_quality(contacts, friction)

    def support(direction):
        unit = direction / np.linalg.norm(direction)
        push, twist = unit[:3], unit[3:]
        at = push + np.cross(twist, contacts.points)  # w·unit = force·at
        along = (at * contacts.normals).sum(axis=-1)
        across = np.linalg.norm(at - along[:, None] * contacts.normals, axis=-1)
        return (along + 0.6 * across).max()

    rng = np.random.default_rng(8)
    starts = sorted((support(d), tuple(d)) for d in rng.normal(size=(4000, 6)))[:20]
    ends = [minimize(support, d, method="Nelder-Mead").fun for _, d in starts]
    assert found.low <= min(ends) * (1 + 1e-9)
    assert min(ends) <= found.high * 1.02  # a local search need not reach the least
    assert found.high - found.low < 0.02


def test_more_friction_never_lets_go():
    contacts = branch_contacts(perched().report)
    qualities = [closure_quality(contacts, Friction(mu)) for mu in (0.1, 0.3, 0.9)]
    lows = [quality.low for quality in qualities]
    assert lows == sorted(lows)
    assert all(quality.low <= quality.high for quality in qualities)


def test_the_quality_is_that_of_any_size():
    contacts = branch_contacts(perched().report)
    large = Contacts(
        1000 * contacts.points,
        contacts.normals,
        1000 * contacts.origin,
        1000 * contacts.scale,
    )
    here, there = (closure_quality(c, Friction(0.4)) for c in (contacts, large))
    assert here.low == pytest.approx(there.low, rel=1e-9)
    assert least_friction(large) == least_friction(contacts)


def test_the_mirror_image_holds_as_well():
    contacts = branch_contacts(perched().report)
    mirror = np.array([1.0, -1.0, 1.0])
    image = replace(
        contacts, points=contacts.points * mirror, normals=contacts.normals * mirror
    )
    here, there = (closure_quality(c, Friction(0.4, 16)) for c in (contacts, image))
    assert here.low == pytest.approx(there.low, rel=0.05)
    assert max(here.low, there.low) <= min(here.high, there.high)


def test_closure_and_quality_agree():
    rng = np.random.default_rng(4)
    for _ in range(40):
        count = int(rng.integers(2, 6))
        contacts = ring(*rng.uniform(0, 360, count), heights=rng.normal(size=count))
        friction = Friction(float(rng.uniform(0.05, 0.8)))
        closes = force_closure(contacts, friction)
        low = closure_quality(contacts, friction).low
        assert closes == (low > 0) or low < 1e-6
