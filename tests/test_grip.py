"""The grip: which phalanges touch, what they face, and whether it is feasible."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.grip import grip_of
from zygopin.obstacle import Sphere
from zygopin.solid_clearance import obstacle_clearance

TOLERANCE = 1e-6
TWO = (Finger("a", 2, 0.0), Finger("b", 2, math.pi))
FINGERS = tuple(Finger(name, 1, 0.0) for name in ("a", "b", "c"))


def grip(*bones, radius=0.5, thickness=0.0):
    """The grip of one bone to each finger on a sphere about the origin."""
    foot = Foot(rho=2.0, scale=2.0, thickness=thickness, fingers=FINGERS[: len(bones)])
    lines = np.array(bones, float)
    near = obstacle_clearance(lines, foot.radii, Sphere(radius, np.zeros(3)))
    return grip_of(foot, lines, near, TOLERANCE)


def tangent(angle, away=0.5):
    """A bone across y that is nearest to the origin midway, at an angle from x."""
    middle = away * np.array([math.cos(angle), 0, math.sin(angle)])
    return middle + np.array([[0, -0.5, 0], [0, 0.5, 0]])


@pytest.mark.parametrize("angle", [0.5, 1.5, 1.6, 3.0])
def test_scalar_product_is_the_cosine_between_two_contacts(angle):
    found = grip(tangent(0.0), tangent(angle))
    assert found.scalar_product == pytest.approx(math.cos(angle))
    assert found.grasping == (angle > math.pi / 2)
    assert found.fingers == ("a", "b")
    assert found.touching.all()
    assert found.feasible
    assert found.clearance == pytest.approx([0, 0], abs=1e-12)
    assert found.point[0] == pytest.approx([0.5, 0, 0])
    assert found.normal[1] == pytest.approx([math.cos(angle), 0, math.sin(angle)])


def test_the_least_product_of_any_two_fingers_counts():
    found = grip(tangent(0.0), tangent(1.0), tangent(2.5))
    assert found.scalar_product == pytest.approx(math.cos(2.5))


def test_one_finger_that_touches_grasps_nothing():
    found = grip(tangent(0.0), tangent(3.0, away=0.6))
    assert found.fingers == ("a",)
    assert math.isnan(found.scalar_product)
    assert found.grasping is False


def test_a_phalanx_that_enters_is_no_touch_and_not_feasible():
    found = grip(tangent(0.0), tangent(3.0, away=0.49))
    assert found.penetrating.tolist() == [False, True]
    assert found.touching.tolist() == [True, False]
    assert not found.feasible


@pytest.mark.parametrize(
    ("away", "touching", "penetrating"),
    [(0.9, True, False), (-0.9, True, False), (1.1, False, False), (-1.1, False, True)],
)
def test_the_tolerance_is_a_band_about_the_surface(away, touching, penetrating):
    found = grip(tangent(0.0, 0.5 + away * TOLERANCE))
    assert found.touching[0] == touching
    assert found.penetrating[0] == penetrating


def test_skins_count_for_the_obstacle_and_between_fingers():
    # Two phalanges of 0.05 m skin: first ones share the base and are not compared.
    foot = Foot(rho=2.0, scale=2.0, thickness=0.1, fingers=TWO)
    bones = np.array([tangent(0.0), tangent(0.0), tangent(3.0), tangent(3.0)])
    bones[1], bones[3] = bones[1] + [0.2, 0, 0], bones[3] + [-0.2, 0, 0]
    near = obstacle_clearance(bones, foot.radii, Sphere(0.45, np.zeros(3)))
    found = grip_of(foot, bones, near, TOLERANCE)
    apart = np.linalg.norm(bones[1, 0] - bones[2, 0]) - foot.radii[[1, 2]].sum()
    assert found.touching.tolist() == [True, False, True, False]
    assert found.finger_clearance == pytest.approx(apart, rel=0.3)
    assert found.feasible


def test_fingers_that_cross_are_not_feasible():
    foot = Foot(rho=2.0, scale=2.0, thickness=0.1, fingers=TWO)
    bones = np.array(
        [tangent(0.0), tangent(1.0, 2.0), tangent(2.0, 2.0), tangent(1.0, 2)]
    )
    near = obstacle_clearance(bones, foot.radii, Sphere(0.1, np.zeros(3)))
    found = grip_of(foot, bones, near, TOLERANCE)
    assert found.finger_clearance == pytest.approx(-2 * foot.radii[1])
    assert not found.feasible


def test_one_finger_has_no_other_to_cross():
    found = grip(tangent(0.0))
    assert found.finger_clearance == math.inf
    assert found.feasible
