"""The planner: what it says is so, on any branch, whichever engine looks."""

from __future__ import annotations

import dataclasses
import math
import re
from functools import cache

import numpy as np
import pytest

from zygopin.branch import Branch, branch_axis
from zygopin.contacts import Friction
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Finger, Foot
from zygopin.grasp import check_grasp
from zygopin.hold import check_hold
from zygopin.perch import PROVED, plan_perch
from zygopin.perch_proof import Existence
from zygopin.strength import Strength

PARROT = Foot.preset("parrot")
SIZE = PARROT.size
UNDER = (0.0, 0.0, -1.0)


@cache
def parrots_perch():
    """The parrot on a branch 16 mm thick, its height left to be found."""
    return plan_perch(PARROT, Branch(0.008, UNDER), find_height=True)


def assert_true(plan, accuracy=1e-9):
    """What a plan reports is what FCL finds, and its reason is there or not."""
    foot = plan.report.foot
    other = check_grasp(foot, plan.controls, plan.branch, engine="fcl")
    own = check_grasp(foot, plan.controls, plan.branch)
    assert own.difference(plan.report) == 0
    assert plan.report.difference(other) < accuracy * foot.size
    for flag in ("stable", "grasping", "feasible"):
        assert getattr(plan.report, flag) == getattr(other, flag)
    assert plan.grasping == bool(own.grasping & own.feasible)
    assert (plan.reason is None) == plan.grasping
    if plan.reason:
        assert "\n" not in plan.reason
        assert ": " in plan.reason or "; " in plan.reason  # a remedy


def test_the_parrot_grasps_its_perch_with_four_toes():
    plan = parrots_perch()
    assert plan.grasping
    assert plan.reason is None
    assert plan.report.feasible
    toes = np.unique(PARROT.finger_of_phalanx[plan.report.tangent])
    assert toes.tolist() == [0, 1, 2, 3]
    assert plan.report.scalar_product < -0.5
    assert (plan.wrap > math.radians(60)).all()
    other = check_grasp(PARROT, plan.controls, plan.branch, engine="fcl")
    assert plan.report.difference(other) <= 1e-9


def test_the_height_found_is_below_the_base_by_skin_at_least():
    plan = parrots_perch()
    x, y, z = plan.branch.centre
    assert (x, y) == (0, 0)
    assert -0.008 - 0.6 * SIZE < z <= -0.008 - PARROT.radii.max()


def test_a_plan_for_the_height_found_is_a_grasp_again():
    branch = parrots_perch().branch
    plan = plan_perch(PARROT, branch)
    assert plan.branch is branch
    assert (plan.controls == parrots_perch().controls).all()


def test_the_same_question_has_the_same_answer():
    again = plan_perch(PARROT, Branch(0.008, UNDER), find_height=True)
    assert (again.controls == parrots_perch().controls).all()
    assert (again.branch.centre == parrots_perch().branch.centre).all()


def test_the_height_that_is_given_does_not_matter_where_it_is_to_be_found():
    other = plan_perch(PARROT, Branch(0.008, (0, 0, 7.0)), find_height=True)
    assert other.branch.centre == pytest.approx(parrots_perch().branch.centre)
    assert other.grasping


@pytest.mark.parametrize("factor", [2.0**-7, 2.0**7, 10.0])
def test_a_scaled_plan_is_the_plan_scaled(factor):
    foot = PARROT.replace(
        scale=PARROT.scale * factor, thickness=PARROT.thickness * factor
    )
    branch = parrots_perch().branch
    scaled = Branch(branch.radius * factor, branch.centre * factor)
    plan = plan_perch(foot, scaled)
    assert plan.grasping
    assert plan.controls == pytest.approx(parrots_perch().controls, abs=1e-6)


GRID = [
    ("parrot", 0.05, 0, 0),
    ("parrot", 0.3, 90, 0),
    ("parrot", 0.6, 60, 20),
    ("parrot", 2.0, 120, -30),
    ("owl", 0.1, 20, 10),
    ("owl", 1.0, 90, 25),
    ("anisodactyl", 0.1, 0, 0),
    ("anisodactyl", 0.25, 45, -15),
    ("paper", 0.8, 15, 5),
]


@pytest.mark.parametrize(("name", "radius", "yaw", "pitch"), GRID)
def test_on_any_branch_the_verdict_is_true(name, radius, yaw, pitch):
    foot = Foot.preset(name)
    axis = branch_axis(math.radians(yaw), math.radians(pitch))
    branch = Branch(radius * foot.size, (0, 0, -10 * foot.size), axis)
    plan = plan_perch(foot, branch, find_height=True)
    assert_true(plan)
    assert not plan.report.penetrating.any()
    assert plan.report.touching.any()


@pytest.mark.parametrize("radius", [0.08, 0.15])
def test_bare_toes_keep_apart_too(radius):
    # Coplanar toes would cross below the branch, at a distance that is never < 0.
    foot = PARROT.replace(thickness=0.0)
    plan = plan_perch(foot, Branch(radius * SIZE, UNDER), find_height=True)
    assert_true(plan)
    assert plan.grasping
    assert plan.report.finger_clearance > plan.report.tolerance


def test_the_sense_of_the_axis_does_not_matter():
    centre = parrots_perch().branch.centre
    one, other = (
        plan_perch(PARROT, Branch(0.008, centre, sense * branch_axis(0.35)))
        for sense in (1, -1)
    )
    assert other.controls == pytest.approx(one.controls, abs=1e-9)
    assert_true(one)


@pytest.mark.parametrize("radius", [1.0, 1e4])
def test_a_wall_is_touched_but_not_grasped(radius):
    plan = plan_perch(PARROT, Branch(radius, (0, 0, -2 * radius)), find_height=True)
    assert plan.report.stable
    assert not plan.grasping
    assert "reach 0° around the branch" in plan.reason
    assert "a grasp needs 90°: take a thinner branch, such as one of" in plan.reason


# Finite branches -----------------------------------------------------------------


def test_a_short_perch_under_the_foot_is_grasped():
    branch = parrots_perch().branch
    plan = plan_perch(PARROT, Branch(0.008, branch.centre, length=0.010))
    assert plan.grasping
    assert_true(plan, accuracy=1e-4)  # FCL's, where an end is nearest


def test_a_perch_off_to_the_side_is_reached_by_some_toes_alone():
    z = parrots_perch().branch.centre[2]
    left = plan_perch(PARROT, Branch(0.008, (0, 0.008, z), length=0.010), levels=5)
    toes = set(PARROT.finger_of_phalanx[left.report.touching].tolist())
    assert 1 in toes  # finger 2 lies on that side
    assert len(toes) < 4
    assert_true(left, accuracy=1e-4)
    assert not left.report.penetrating.any()


def test_a_perch_beyond_all_toes_is_reached_by_none():
    z = parrots_perch().branch.centre[2]
    plan = plan_perch(PARROT, Branch(0.008, (0, 0.04, z), length=0.010), levels=4)
    assert not plan.report.touching.any()
    assert plan.reason.startswith("no toe reaches the branch")


# Reasons -------------------------------------------------------------------------


def reason(branch, foot=PARROT, **options):
    plan = plan_perch(foot, branch, levels=5, **options)
    assert_true(plan)
    proved = plan.existence is Existence.NONE
    assert proved == plan.reason.startswith(PROVED)
    return re.sub(
        "^no grasp with the toes' palms exists( at [0-9]+ heights tried)?: ",
        "",
        plan.reason,
    )


def test_a_branch_too_far_off_says_how_far():
    # The longest toe, straight down: finger 4, its first joint closed.
    gap = 1 - 0.008 - SIZE * math.sin(PARROT.omega) - PARROT.radii[-1]
    text = reason(Branch(0.008, (0, 0, -1)))
    stated = float(re.search(r"the nearest stays (\S+) mm away", text).group(1)) / 1e3
    assert gap - 1e-4 < stated < gap + 0.1 * SIZE  # toes must keep apart too
    assert text.endswith("move the branch under the foot, nearer to the base")


def test_a_branch_above_is_not_reached():
    assert "no toe reaches" in reason(Branch(0.008, (0, 0, 0.02)))


def test_a_branch_in_front_has_no_toe_opposite():
    text = reason(Branch(0.004, (0.03, 0, -0.007)))
    assert text.startswith("only finger3 touch the branch, and no toe opposite: ")
    assert text.endswith("move the branch under the foot, nearer to the base")


def test_a_branch_behind_has_no_toe_opposite():
    text = reason(Branch(0.004, (-0.035, 0, -0.007)))
    assert text.startswith("only finger4 touch the branch, and no toe opposite: ")


def test_a_branch_in_the_skin_is_entered():
    text = reason(Branch(0.008, (0, 0, -0.008)))
    assert text.startswith("finger1, finger2, finger3, finger4 enter the branch, by up")
    assert text.endswith("move the branch down or away from the base")


def test_a_branch_that_opposing_toes_meet_with_their_tips_says_so():
    text = reason(Branch(1.0, (0, 0, -1.0 - 0.08 * SIZE)))
    assert text.startswith("finger1, finger2, finger3, finger4 touch the branch, but")
    assert "opposite ones not along a phalanx: move the branch under" in text


def test_toes_that_cannot_close_ask_for_a_thicker_branch_or_more_omega():
    foot = Foot.preset("paper")
    text = reason(Branch(0.1, UNDER), foot, find_height=True)
    assert "take a thicker branch, such as one of" in text


def test_a_branch_that_no_height_brings_near_asks_for_a_larger_foot():
    text = reason(Branch(0.008, (1.0, 0, -0.02)), find_height=True)
    assert "no toe reaches the branch, the nearest stays" in text
    assert text.endswith("take a larger foot, or a longer or less steep branch")


def test_joints_that_hardly_close_find_no_branch_that_would_do():
    stiff = PARROT.replace(omega=0.05, fingers=PARROT.fingers[:2])
    text = reason(Branch(0.008, UNDER), stiff, find_height=True)
    assert "a grasp needs 90°: take a branch across the foot, or a foot whose" in text


def test_toes_in_one_plane_run_into_each_other():
    fingers = [
        dataclasses.replace(PARROT.fingers[i % 4], name=f"finger{i}") for i in range(6)
    ]
    foot = PARROT.replace(fingers=fingers)
    text = reason(parrots_perch().branch, foot)
    assert text.startswith("fingers run into each other, by ")
    assert text.endswith("take more splay, a thinner skin or another branch")


def test_a_foot_without_opposable_fingers_says_so():
    foot = PARROT.replace(fingers=PARROT.fingers[1:3])
    text = reason(parrots_perch().branch, foot)
    assert text.startswith("finger2, finger3 touch the branch, but no two fingers")
    lone = PARROT.replace(fingers=(Finger("toe", 3, 0.0),))
    assert "no two fingers of this foot are opposite" in reason(
        Branch(0.008, UNDER), lone, find_height=True
    )


# Failure -------------------------------------------------------------------------


def test_a_vertical_branch_has_no_height_to_be_found():
    upright = Branch(0.008, (0.02, 0, 0), axis=(0, 0, 1))
    with pytest.raises(
        ParameterError, match="is not across the z axis: give the branch a slope"
    ):
        plan_perch(PARROT, upright, find_height=True)
    assert_true(plan_perch(PARROT, upright, levels=4))


@pytest.mark.parametrize("shape", [(1,), (2, 3)])
def test_a_batch_of_branches_is_refused(shape):
    batch = Branch(np.full(shape, 0.008), UNDER)
    with pytest.raises(ParameterError, match="plan for one branch at a time"):
        plan_perch(PARROT, batch)


@pytest.mark.parametrize("find_height", [False, True])
def test_a_branch_that_holds_the_base_is_refused(find_height):
    with pytest.raises(ParameterError, match="the branch holds the base inside it"):
        plan_perch(PARROT, Branch(0.008, (0, 0, -0.003)), find_height=find_height)


@pytest.mark.parametrize("levels", [1, 34, 2.5, None])
def test_levels_out_of_range_are_refused(levels):
    with pytest.raises(ParameterError, match=r"levels = .* an integer from 2 to 33"):
        plan_perch(PARROT, Branch(0.008, UNDER), levels=levels)


# Preferences ---------------------------------------------------------------------


@pytest.mark.parametrize("share", [0.2, 0.35])
def test_what_is_preferred_is_had_at_least_as_much(share):
    foot = Foot.preset("owl")
    branch = Branch(share * foot.size, (0, 0, -1.2 * share * foot.size))
    firm = Strength(1.0, Friction(0.5))
    plans = {
        prefer: plan_perch(foot, branch, find_height=True, prefer=prefer, strength=firm)
        for prefer in ("wrap", "quality", "pull")
    }
    holds = {key: check_hold(plan.report, firm) for key, plan in plans.items()}
    assert all(plan.grasping for plan in plans.values())
    for key, hold in holds.items():
        assert hold.quality.low <= holds["quality"].quality.low, key
        assert hold.pull.force <= holds["pull"].pull.force, key
    assert plans["wrap"].wrap.sum() >= max(plan.wrap.sum() for plan in plans.values())


def test_a_preference_that_does_not_exist_names_those_that_do():
    foot = Foot.preset("parrot")
    with pytest.raises(UnknownNameError, match="wrap, quality, pull"):
        plan_perch(foot, Branch(0.008, (0, 0, -0.01)), prefer="force")


def test_without_a_grasp_the_preference_makes_no_difference():
    foot = Foot.preset("paper")
    branch = Branch(0.4, (0, 0, -0.5))
    plans = [plan_perch(foot, branch, prefer=prefer) for prefer in ("wrap", "pull")]
    assert plans[0].controls.tolist() == plans[1].controls.tolist()
    assert plans[1].reason is not None
