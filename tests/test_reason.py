"""Why a pose is no grasp: the gravest fact, in millimetres, in one line."""

from __future__ import annotations

import numpy as np
import pytest

from zygopin.branch import Branch
from zygopin.foot import Finger, Foot
from zygopin.grasp import Criteria, check_grasp
from zygopin.reason import touching_fingers, why_not

PAPER = Foot.preset("paper")
STRAIGHT = np.zeros(14)


def reason(foot, controls, branch, **options):
    return why_not(check_grasp(foot, controls, branch, **options))


def test_a_phalanx_in_the_branch_comes_first():
    # Finger 2, closed: the branch of radius 0.1 lies about the middle of phalanx 1.
    branch = Branch(0.1, (0.3, 0.0, 0.05))
    text = reason(PAPER, STRAIGHT, branch)
    assert text == "finger2, finger3 enter the branch, by up to 50 mm"


def test_a_gap_is_told_in_millimetres():
    text = reason(PAPER, STRAIGHT, Branch(0.5, (0, 0, -1.0)))
    assert text == "no toe reaches the branch, the nearest stays 500 mm away"


def test_toes_on_one_side_have_none_opposite():
    branch = Branch(0.1, (0.3, 0.0, -0.1))
    report = check_grasp(PAPER, STRAIGHT, branch)
    assert touching_fingers(report) == {1, 2}
    assert (
        why_not(report) == "only finger2, finger3 touch the branch, and no toe opposite"
    )


def test_straight_toes_on_a_branch_do_not_reach_around():
    text = reason(PAPER, STRAIGHT, Branch(0.5, (0, 0, -0.5)))
    assert text.startswith("contacts of opposing toes reach 0° around the branch of")
    assert "radius 500 mm" in text


def test_the_other_reading_calls_that_a_grasp():
    criteria = Criteria(reading="base_to_tip")
    branch = Branch(0.5, (0, 0, -0.5))
    assert reason(PAPER, STRAIGHT, branch, criteria=criteria) is None


def test_fingers_in_each_other_are_named_before_the_branch():
    twins = (Finger("one", 3, 0.0), Finger("two", 3, 0.0), Finger("back", 3, np.pi))
    foot = Foot(thickness=0.1, fingers=twins)
    text = reason(foot, np.zeros(9), Branch(0.5, (0, 0, -5)))
    assert text.startswith("fingers run into each other, by ")


@pytest.mark.parametrize("azimuth", [0.0, 1.0])
def test_a_foot_without_opposite_fingers_says_so(azimuth):
    foot = Foot(fingers=(Finger("toe", 2, azimuth),))
    text = reason(
        foot,
        np.zeros(2),
        Branch(0.5, (0, 0, -0.5), (-np.sin(azimuth), np.cos(azimuth), 0)),
    )
    assert text == "toe touch the branch, but no two fingers of this foot are opposite"
