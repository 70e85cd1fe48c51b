"""On the very threshold: each verdict holds where its inequality is an equality.

Evidence made by hand, in binary fractions that no rounding moves, takes an engine's
place.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

from zygopin.branch import Branch
from zygopin.clearance import Clearance
from zygopin.contact_products import both_products
from zygopin.engine import Engine
from zygopin.foot import Finger, Foot
from zygopin.grasp import (
    PARAMETER_SLACK,
    Criteria,
    check_grasp,
    classify,
    fingers_apart,
    least_gap,
)

TOLERANCE = 2.0**-10
PAIR = (Finger("front", 1, 0.0), Finger("back", 1, math.pi))


def near(distance=0.0, t=0.5, normal=(0.0, 0.0, 1.0)):
    """What an engine says of two phalanges, each given what it shares."""
    shape = (2,)
    return Clearance(
        distance=np.broadcast_to(distance, shape).astype(float),
        t=np.broadcast_to(t, shape).astype(float),
        point=np.zeros((2, 3)),
        normal=np.broadcast_to(normal, (2, 3)).astype(float),
        lateral=np.ones(shape, dtype=bool),
    )


def judged(evidence, apart=1.0, thickness=0.0):
    """The report on two opposed toes for which the engine says this."""
    foot = Foot(fingers=PAIR, thickness=thickness)
    bones = np.zeros((2, 2, 3))
    bones[:, 1, 0] = 1, -1
    measured = evidence, np.array(apart)
    engine = Engine(
        "by hand", foot, lambda _: bones, lambda *_: measured, both_products
    )
    criteria = Criteria(tolerance=TOLERANCE)
    branch = Branch(1, (0, 0, -2))
    return check_grasp(foot, [0, 0], branch, engine=engine, criteria=criteria)


def beyond(value):
    """The next number away from zero."""
    return np.nextafter(value, math.copysign(math.inf, value))


@pytest.mark.parametrize("distance", [TOLERANCE, -TOLERANCE])
def test_a_clearance_of_the_tolerance_touches_and_does_not_penetrate(distance):
    on, off = judged(near(distance)), judged(near(beyond(distance)))
    assert on.touching.all()
    assert on.stable
    assert on.feasible
    assert not off.touching.any()
    assert off.penetrating.all() == (distance < 0)
    assert off.feasible == (distance > 0)


@pytest.mark.parametrize("t", [-PARAMETER_SLACK, 0.0, 1.0])
def test_the_ends_of_the_bone_and_their_slack_are_tangent(t):
    assert classify(near(t=t), TOLERANCE).tangent.all()


@pytest.mark.parametrize("t", [-2 * PARAMETER_SLACK, 1 + 2 * PARAMETER_SLACK])
def test_beyond_the_slack_a_touch_is_no_tangency(t):
    contacts = classify(near(t=t), TOLERANCE)
    assert contacts.touching.all()
    assert not contacts.tangent.any()


@pytest.mark.parametrize(
    ("product", "grasps"),
    [(-1.0, True), (PARAMETER_SLACK, True), (beyond(PARAMETER_SLACK), False)],
)
def test_a_product_of_the_slack_is_a_grasp(product, grasps):
    report = judged(near(normal=[(1, 0, 0), (product, 0, 0)]))
    assert report.scalar_product == product
    assert report.stable
    assert report.grasping == grasps


@pytest.mark.parametrize(("thickness", "least"), [(0.0, 1), (0.1, -1)])
def test_fingers_at_the_least_gap_do_not_collide(thickness, least):
    gap = least * TOLERANCE
    nearer = np.nextafter(gap, -math.inf)
    assert judged(near(), gap, thickness).feasible
    assert not judged(near(), nearer, thickness).feasible


def test_bare_fingers_a_tolerance_apart_do_not_collide():
    # The front toe's second phalanx hangs straight down, beside the back toe's.
    foot = Foot(fingers=(Finger("front", 2, 0.0), Finger("back", 1, math.pi)))
    first, back = [(0, 0, 0), (2, 0, 0)], [(0, 0, 0), (-1, 0, 0)]
    for gap, apart in ((TOLERANCE, True), (TOLERANCE / 2, False)):
        second = [(gap, 0, 0), (gap, 0, -1)]
        bones = np.array([first, second, back], dtype=float)
        assert least_gap(foot, TOLERANCE) == TOLERANCE
        assert fingers_apart(foot, bones, TOLERANCE) == apart
