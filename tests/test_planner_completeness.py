"""The planner finds grasps that exist; where it says none exists, none is found."""

from __future__ import annotations

import json
import math
from functools import cache

import numpy as np
import pytest
from click.testing import CliRunner
from planted import planted

from zygopin.branch import Branch, branch_axis
from zygopin.cli import main
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Foot
from zygopin.grasp import check_grasp
from zygopin.perch import PROVED, perch_solutions, plan_perch, search_perch
from zygopin.perch_column import Column
from zygopin.perch_combinations import all_poses, combinations
from zygopin.perch_output import solution_documents, solution_rows
from zygopin.perch_proof import Existence, disproved
from zygopin.perch_surroundings import surrounding_grasp
from zygopin.preference import SHORTLIST, flexion_left
from zygopin.rest import resting_branch

PARROT = Foot.preset("parrot")
SIZE = PARROT.size


def under(foot, share, yaw=0.0, pitch=0.0, gap=0.0):
    """A branch below the base: radius and gap over the foot's size, degrees."""
    angles = {"yaw": math.radians(yaw), "pitch": math.radians(pitch)}
    branch = resting_branch(foot, share * foot.size, **angles)
    return branch.moved_to(branch.centre - [0.0, 0.0, gap * foot.size])


@cache
def ways(prefer="wrap"):
    """The ways in which a parrot grasps an oblique branch, few levels."""
    branch = under(PARROT, 0.3, yaw=30, gap=0.1)
    return perch_solutions(PARROT, branch, prefer=prefer, levels=3)


# Yes where there is one -----------------------------------------------------------


@cache
def grasped(axis, count):
    """Branches that random poses grasp."""
    found = [planted(PARROT, seed, axis, count=60_000) for seed in range(2)]
    made = [
        Branch(each.radius[index], (0, 0, each.height[index]), axis)
        for each in found
        for index in np.flatnonzero(each.grasping)
    ]
    return made[:count]


@pytest.mark.parametrize("axis", [(0.0, 1.0, 0.0), (0.3, 1.0, 0.2), (-0.2, 1.0, -0.4)])
def test_grasps_that_were_planted_are_found(axis):
    branches = grasped(axis, 5)
    assert len(branches) == 5
    for branch in branches:
        assert plan_perch(PARROT, branch).existence is Existence.FOUND


def test_a_grasp_between_the_grid_angles_is_found():
    branch = under(PARROT, 0.25, yaw=25, gap=0.35)
    coarse = search_perch(PARROT, branch, levels=2)
    plan = plan_perch(PARROT, branch, levels=2)
    assert not coarse.grasping
    assert coarse.existence is Existence.UNDECIDED
    assert plan.grasping
    assert check_grasp(PARROT, plan.controls, branch, engine="fcl").grasping


def test_a_grasp_is_found_with_those_of_branches_around():
    branch = Branch(0.42 * SIZE, (0, 0, -0.965 * SIZE), (0.21, 0.9, 0.38))
    assert not search_perch(PARROT, branch).grasping
    plan = plan_perch(PARROT, branch)
    assert plan.existence is Existence.FOUND
    assert check_grasp(PARROT, plan.controls, branch, engine="fcl").grasping


def test_surroundings_of_a_branch_out_of_reach_have_no_grasp():
    assert surrounding_grasp(PARROT, under(PARROT, 2.0)) is None
    for radius in (1e-4, 1.1e-6):
        twig = Branch(radius * SIZE, (0, 0, -3 * SIZE))
        assert surrounding_grasp(PARROT, twig) is None


# No where it is proved ------------------------------------------------------------

NONE = [
    (PARROT, 2.0, 0, 0, 0.0),
    (PARROT, 1.16, 0, 0, 0.0),
    (PARROT, 0.25, 40, 20, 0.0),
    (Foot.preset("owl"), 0.5, 60, 20, 0.1),
    (Foot.preset("anisodactyl"), 1.0, 40, 20, 0.1),
]


@pytest.mark.parametrize(("foot", "share", "yaw", "pitch", "gap"), NONE)
def test_no_search_contradicts_a_proof(foot, share, yaw, pitch, gap):
    branch = under(foot, share, yaw, pitch, gap)
    plan = plan_perch(foot, branch)
    assert plan.existence is Existence.NONE
    assert plan.reason.startswith(f"{PROVED}: ")
    for levels in (5, 8):
        poses = all_poses(foot, branch.broadcast((1,)), levels)
        assert not combinations(foot, poses).grasps.any()


def test_a_proof_never_denies_a_grasp():
    heights = np.linspace(-0.0085, -0.03, 4)
    radius, axis = 0.006, branch_axis(0.4, 0.1)
    column = Column(PARROT, Branch(radius, (0, 0, -1), axis), heights)
    none = disproved(column)
    for height, denied in zip(heights, none, strict=True):
        branch = Branch(radius, (0, 0, height), axis)
        assert not (denied and search_perch(PARROT, branch, levels=5).grasping)


def test_heights_that_a_proof_is_about_are_told():
    plan = plan_perch(PARROT, Branch(2 * SIZE, (0, 0, -9 * SIZE)), find_height=True)
    assert plan.existence is Existence.NONE
    assert plan.column.heights[0] == pytest.approx(-2 * SIZE - PARROT.radii.max())
    count = len(plan.column.heights)
    assert plan.reason.startswith(
        f"no grasp with the toes' palms exists at {count} heights tried: "
    )


def test_feet_without_opposite_toes_grasp_nothing():
    foot = PARROT.replace(fingers=PARROT.fingers[1:3])
    assert plan_perch(foot, under(foot, 0.3)).existence is Existence.NONE


# Finite branches ------------------------------------------------------------------


def test_a_branch_whose_ends_are_out_of_reach_is_as_good_as_endless():
    branch = under(PARROT, 2.0)
    long = Branch(branch.radius, branch.centre, length=3 * SIZE)
    assert plan_perch(PARROT, long).existence is Existence.NONE


def test_a_branch_with_an_end_in_reach_stays_undecided():
    branch = under(PARROT, 2.0)
    short = Branch(branch.radius, branch.centre, length=SIZE)
    plan = plan_perch(PARROT, short, levels=3)
    assert not plan.grasping
    assert plan.existence is Existence.UNDECIDED
    assert not plan.reason.startswith(PROVED)


def test_a_short_branch_beyond_all_toes_is_not_grasped_for_sure():
    plan = plan_perch(
        PARROT, Branch(0.008, (0, 3 * SIZE, -0.01), length=SIZE), levels=3
    )
    assert plan.existence is Existence.NONE


# Preferences and ways -------------------------------------------------------------


@pytest.mark.parametrize(
    ("prefer", "measure"),
    [
        ("margin", lambda plan: flexion_left(plan.report)),
        ("opposition", lambda plan: -float(plan.report.scalar_product)),
    ],
)
def test_what_is_preferred_is_had_most_of(prefer, measure):
    plans = ways(prefer)
    values = [measure(plan) for plan in plans]
    assert values == sorted(values, reverse=True)
    assert values[0] >= max(measure(plan) for plan in ways("wrap"))
    branch = plans[0].branch
    single = plan_perch(PARROT, branch, prefer=prefer, levels=3)
    assert measure(single) >= measure(plan_perch(PARROT, branch, levels=3))


def test_flexion_left_by_hand():
    plan = plan_perch(PARROT, under(PARROT, 0.25))
    left = []
    for part in PARROT.finger_slices.values():
        last = np.flatnonzero(plan.report.tangent[part]).max(initial=-1)
        left += [1 - v for v in plan.controls[part][: last + 1]]
    assert flexion_left(plan.report) == min(left)


def test_ways_are_distinct_and_each_is_a_grasp_by_fcl():
    plans = ways()
    modes = {tuple(plan.report.tangent.tolist()) for plan in plans}
    assert len(modes) == len(plans) > 10
    controls = np.array([plan.controls for plan in plans])
    report = check_grasp(PARROT, controls, plans[0].branch, engine="fcl")
    assert (report.grasping & report.feasible).all()


def test_the_first_way_is_the_plan():
    plan = plan_perch(PARROT, ways()[0].branch, levels=3)
    assert (ways()[0].controls == plan.controls).all()
    assert (ways()[0].wrap == plan.wrap).all()


def test_there_is_no_way_without_a_grasp():
    assert perch_solutions(PARROT, under(PARROT, 2.0)) == ()


def test_rows_and_documents_name_the_tangent_phalanges():
    plan = ways()[0]
    rows, (document,) = solution_rows([plan]), solution_documents([plan])
    ranks = [name.replace("-", "") for name in rows[0][1].split(" · ")]
    assert ranks == ["".join(map(str, each)) for each in document["tangent"].values()]
    count = sum(len(each) for each in document["tangent"].values())
    assert count == plan.report.tangent.sum()
    json.dumps(document, allow_nan=False)


# The command ----------------------------------------------------------------------


def test_the_command_lists_all_ways_within_eighty_columns():
    command = ["perch", "--radius-mm", "24", "--height-mm", "-26", "--all"]
    result = CliRunner().invoke(main, command)
    assert result.exit_code == 0
    assert "ways to grasp it found" in result.stdout
    assert max(map(len, result.stdout.splitlines())) <= 80


def test_the_document_says_what_is_proved(run):
    command = ["perch", "--radius-mm", "69", "--height-mm", "-71", "--all", "--json"]
    result = run(*command)
    assert result.returncode == 1
    document = json.loads(result.stdout)
    assert document["verdict"]["existence"] == "none"
    assert "solutions" not in document
    assert PROVED in result.stderr


# Failure --------------------------------------------------------------------------


@pytest.mark.parametrize("plan", [plan_perch, search_perch, perch_solutions])
def test_bad_input_is_refused_by_all(plan):
    branch = under(PARROT, 0.3)
    with pytest.raises(ParameterError, match="levels"):
        plan(PARROT, branch, levels=1)
    with pytest.raises(ParameterError, match="one branch at a time"):
        plan(PARROT, branch.broadcast((2,)))


def test_an_unknown_preference_names_the_known():
    with pytest.raises(UnknownNameError, match=", ".join(SHORTLIST)):
        perch_solutions(PARROT, under(PARROT, 0.3), prefer="force")
