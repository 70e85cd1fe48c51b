"""Verdicts: what they mean, and the symmetries that they keep."""

from __future__ import annotations

import contextlib
import dataclasses
import math
from functools import cache
from itertools import pairwise

import numpy as np
import pytest

from zygopin.branch import Branch, branch_axis
from zygopin.clearance import least_skin_distance
from zygopin.engine import make_engine
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Finger, Foot
from zygopin.grasp import (
    BLOCK,
    TOLERANCE,
    Criteria,
    GraspReport,
    check_grasp,
    finger_pairs,
)
from zygopin.kinematics import forward_kinematics

PARROT = Foot.preset("parrot")
FLAGS = ("stable", "grasping", "feasible")
MASKS = (*FLAGS, "touching", "tangent", "penetrating")
NUMBERS = ("clearance", "finger_clearance", "scalar_product", "t")


def coarse(foot):
    """A tolerance so wide that random poses meet every verdict."""
    return Criteria(tolerance=0.03 * foot.size)


def scattered(foot, count, seed):
    """Random controls, and a branch below the foot for each, turned in every way."""
    rng = np.random.default_rng(seed)
    radius = rng.uniform(0.1, 0.6, count) * foot.size
    axis = [branch_axis(*angles) for angles in rng.uniform(-0.6, 0.6, (count, 2))]
    below = rng.uniform(1.1, 1.5, count) * radius / np.cos(0.6)
    centre = np.stack([0.1 * below, 0 * below, -below], axis=1)
    return rng.random((count, foot.phalanx_count)) * 0.5, Branch(radius, centre, axis)


@cache
def sample(name="parrot"):
    """A foot, poses and branches, and the report on them."""
    foot = Foot.preset(name)
    controls, branch = scattered(foot, 1200, seed=1)
    report = check_grasp(foot, controls, branch, criteria=coarse(foot))
    return foot, controls, branch, report


def assert_same(one, other, scale=1.0):
    """Equal verdicts, and numbers equal to rounding, lengths scaled."""
    for name in MASKS:
        assert (getattr(one, name) == getattr(other, name)).all(), name
    size = one.foot.size
    for name, unit in zip(NUMBERS, (size, size, 1.0, None), strict=True):
        first, second = getattr(one, name), getattr(other, name)
        if unit is None:  # t: where it counts
            first, second = first[one.touching], second[one.touching]
            unit = 1 + np.abs(first)
        elif unit == size:
            first = first * scale
            unit = size * scale
        both = np.isfinite(first)
        assert (both == np.isfinite(second)).all(), name
        assert (np.abs(first - second) / unit)[both].max(initial=0) < 1e-9, name


@pytest.mark.parametrize("name", ["parrot", "anisodactyl"])
def test_the_sample_meets_every_verdict_both_ways(name):
    report = sample(name)[3]
    for mask in MASKS:
        share = getattr(report, mask).mean()
        assert 0.002 < share < 0.998, (mask, share)


# The definitions -----------------------------------------------------------------


@pytest.mark.parametrize("name", ["parrot", "paper", "anisodactyl"])
def test_verdicts_follow_from_the_evidence(name):
    # MODEL.md, section 5, phalanx by phalanx and pair by pair.
    foot, _, _, report = sample(name)
    for index in range(len(report.stable)):
        tangent, normal = report.tangent[index], report.normal[index]
        products = [
            normal[k] @ normal[m]
            for i, j in foot.opposable_pairs
            for k in np.flatnonzero(tangent & (foot.finger_of_phalanx == i))
            for m in np.flatnonzero(tangent & (foot.finger_of_phalanx == j))
        ]
        assert report.stable[index] == bool(products)
        if products:
            assert report.scalar_product[index] == pytest.approx(min(products))
            assert report.grasping[index] == (min(products) <= 1e-9)
        else:
            assert np.isnan(report.scalar_product[index])
            assert not report.grasping[index]


def test_masks_follow_from_clearance_and_t():
    report = sample()[3]
    near = np.abs(report.clearance) <= report.tolerance
    assert (report.touching == near).all()
    on_bone = (report.t >= -1e-9) & (report.t <= 1 + 1e-9)
    assert (report.tangent == (near & on_bone)).all()
    assert (report.penetrating == (report.clearance < -report.tolerance)).all()
    clear = ~report.penetrating.any(1) & (report.finger_clearance >= -report.tolerance)
    assert (report.feasible == clear).all()


def clasping(lower=0.1):
    """Two toes round a branch: across at the base, then straight down."""
    fingers = (Finger("front", 3, 0.0), Finger("back", 3, math.pi))
    foot = Foot(rho=1.2, omega=math.pi / 2, fingers=fingers)
    radius = 1 / 1.2  # the first phalanx's length
    controls = {"front": [0, 1, 0], "back": [0, 1, 0]}
    return foot, controls, Branch(radius, (0, 0, -radius - lower))


def test_toes_that_clasp_a_perch_from_both_sides_grasp_it():
    report = check_grasp(*clasping())
    assert report.tangent.tolist() == [False, False, True] * 2
    # Third phalanx: from z = -1/1.44 down by 1/1.728; contact at z = -0.9333.
    t = (1 / 1.2 + 0.1 - 1 / 1.44) * 1.728
    assert report.t[2] == pytest.approx(t)
    assert report.scalar_product == pytest.approx(-1)
    assert report.scalar_product_base_to_tip == pytest.approx(1)
    assert report.stable
    assert report.grasping
    assert report.feasible
    other = check_grasp(*clasping(), criteria=Criteria(reading="base_to_tip"))
    assert other.stable
    assert not other.grasping


@pytest.mark.parametrize("radius", [2.0, 1e3])
def test_toes_flat_on_a_huge_trunk_grasp_it_in_the_other_reading_alone(radius):
    trunk = Branch(radius, (0, 0, -radius))
    report = check_grasp(Foot(), np.zeros(14), trunk)
    assert report.stable
    assert not report.grasping
    assert report.scalar_product == pytest.approx(1)
    # Fingers 1 and 3 are coplanar: straight, they point opposite ways.
    assert report.scalar_product_base_to_tip == pytest.approx(-1)
    criteria = Criteria(reading="base_to_tip")
    other = check_grasp(Foot(), np.zeros(14), trunk, criteria=criteria)
    assert other.grasping
    assert (other.scalar_product == report.scalar_product).all()


def test_a_quarter_turn_apart_is_enough():
    # Toes at 45° down on either side of the top: normals a quarter turn apart.
    fingers = (
        Finger("front", 1, 0.0, orientation=math.pi / 4),
        Finger("back", 1, math.pi, orientation=math.pi / 4),
    )
    foot = Foot(rho=2.0, scale=4.0, fingers=fingers)
    report = check_grasp(foot, np.zeros(2), Branch(1, (0, 0, -math.sqrt(2))))
    assert report.t == pytest.approx(0.5)
    assert report.scalar_product == pytest.approx(0, abs=1e-12)
    assert report.grasping
    wider = check_grasp(
        foot.replace(
            fingers=tuple(dataclasses.replace(f, orientation=0.7) for f in fingers)
        ),
        np.zeros(2),
        Branch(1, (0, 0, -1 / math.cos(0.7))),
    )
    assert wider.stable
    assert not wider.grasping
    assert wider.scalar_product == pytest.approx(math.cos(1.4))


@pytest.mark.parametrize(
    ("past", "tangent"), [(1e-6, True), (0.0, True), (-1e-6, False)]
)
def test_a_touch_at_the_tip_is_tangency_only_if_the_bone_gets_that_far(past, tangent):
    foot = Foot(rho=2.0, scale=2.0, fingers=(Finger("toe", 1, 0.0),))  # from 0 to 1
    report = check_grasp(foot, [0.0], Branch(3, (1 - past, 0, -3)))
    assert report.touching.all()
    assert report.tangent.tolist() == [tangent]


def test_a_toe_on_the_end_of_a_branch_touches_but_is_not_tangent():
    foot = Foot(rho=2.0, scale=4.0, fingers=(Finger("toe", 1, 0.0),))  # from 0 to 2
    stump = Branch(0.5, (2.5, 0, 0), axis=(1, 0, 0), length=1)
    report = check_grasp(foot, [0.0], stump)
    assert report.touching.all()
    assert not report.tangent.any()


def test_fingers_that_cross_are_infeasible_bare_or_not():
    # Two toes side by side, turned across each other beyond their first phalanx.
    fingers = (Finger("a", 2, 0.0), Finger("b", 2, math.pi))
    branch = Branch(0.1, (0, 0, 5))
    for thickness in (0.0, 0.05):
        foot = Foot(omega=2.6, rho=1.1, thickness=thickness, fingers=fingers)
        crossing = check_grasp(foot, [1 / 2.6, 1, 1 / 2.6, 1], branch)
        assert not crossing.feasible
        assert not crossing.penetrating.any()
        assert check_grasp(foot, np.zeros(4), branch).feasible
    bare = check_grasp(foot.replace(thickness=0.0), [1 / 2.6, 1, 1 / 2.6, 1], branch)
    assert bare.finger_clearance == pytest.approx(0, abs=1e-12)


def test_a_second_phalanx_may_not_cross_a_first():
    # Down and back at 120°, then straight up through the other toe's first phalanx.
    fingers = (Finger("a", 2, 0.0), Finger("b", 1, math.pi))
    foot = Foot(omega=2.7, rho=1.1, fingers=fingers)
    controls = [math.radians(120) / 2.7, math.radians(150) / 2.7, 0.0]
    report = check_grasp(foot, controls, Branch(0.1, (0, 0, 5)))
    assert report.finger_clearance == pytest.approx(0, abs=1e-12)
    assert not report.feasible


def test_a_foot_of_one_finger_is_never_stable():
    foot = Foot(fingers=(Finger("toe", 2, 0.0),))
    for engine in ("exact", "fcl"):
        report = check_grasp(foot, [0, 0], Branch(1, (0, 0, -1)), engine=engine)
        assert report.tangent.any()
        assert not report.stable
        assert not report.grasping
        assert report.feasible
        assert report.finger_clearance == np.inf
        assert np.isnan(report.scalar_product)
        assert report.difference(report) == 0


# Symmetries ----------------------------------------------------------------------


@pytest.mark.parametrize("factor", [1e-3, 3.0, 1e4])
def test_foot_and_branch_scaled_together_keep_their_verdict(factor):
    foot, controls, branch, report = sample()
    larger = foot.replace(scale=foot.scale * factor, thickness=foot.thickness * factor)
    scaled = Branch(branch.radius * factor, branch.centre * factor, branch.axis)
    other = check_grasp(larger, controls, scaled, criteria=coarse(larger))
    assert_same(report, other, factor)


@pytest.mark.parametrize("angle", [-1.0, 0.4, math.pi])
def test_foot_and_branch_turned_together_keep_their_verdict(angle):
    # By less than would turn a forward toe back, or by half a turn.
    foot, controls, branch, report = sample()
    fingers = tuple(
        dataclasses.replace(f, azimuth=(f.azimuth + angle) % (2 * math.pi))
        for f in foot.fingers
    )
    c, s = math.cos(angle), math.sin(angle)
    turn = np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]])  # for rows
    turned = Branch(branch.radius, branch.centre @ turn, branch.axis @ turn)
    other = check_grasp(
        foot.replace(fingers=fingers), controls, turned, criteria=coarse(foot)
    )
    assert_same(report, other)
    assert np.abs(other.normal - report.normal @ turn).max() < 1e-9


@pytest.mark.parametrize("name", ["parrot", "anisodactyl"])
def test_the_mirror_image_has_the_same_verdict(name):
    foot, controls, branch, report = sample(name)
    mirror = np.array([1.0, -1.0, 1.0])
    fingers = tuple(dataclasses.replace(f, azimuth=-f.azimuth) for f in foot.fingers)
    other = check_grasp(
        foot.replace(fingers=fingers),
        controls,
        Branch(branch.radius, branch.centre * mirror, branch.axis * mirror),
        criteria=coarse(foot),
    )
    assert_same(report, other)
    assert np.abs(other.normal - report.normal * mirror).max() < 1e-9


def test_the_order_of_the_fingers_does_not_matter():
    foot, controls, branch, report = sample()
    order = [2, 0, 3, 1]
    shuffled = foot.replace(fingers=tuple(foot.fingers[i] for i in order))
    named = {n: controls[:, s] for n, s in foot.finger_slices.items()}
    other = check_grasp(shuffled, named, branch, criteria=coarse(foot))
    for flag in FLAGS:
        assert (getattr(other, flag) == getattr(report, flag)).all()


def test_a_wider_tolerance_never_loses_a_contact():
    foot, controls, branch, _ = sample()
    tolerances = [0.001, 0.01, 0.03, 0.1]
    reports = [
        check_grasp(foot, controls, branch, criteria=Criteria(tolerance=x * foot.size))
        for x in tolerances
    ]
    for narrow, wide in pairwise(reports):
        for mask in ("touching", "tangent", "stable", "grasping", "feasible"):
            assert (getattr(narrow, mask) <= getattr(wide, mask)).all()
        assert (narrow.penetrating >= wide.penetrating).all()
    assert reports[0].stable.sum() < reports[-1].stable.sum()


def test_a_thinner_foot_penetrates_no_more():
    foot, controls, branch, report = sample()
    bare = check_grasp(
        foot.replace(thickness=0.0), controls, branch, criteria=coarse(foot)
    )
    assert (bare.penetrating <= report.penetrating).all()
    assert bare.clearance == pytest.approx(report.clearance + foot.radii)


# Engines -------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["parrot", "paper", "anisodactyl"])
def test_both_engines_give_one_verdict(name):
    foot, controls, branch, report = sample(name)
    part = slice(0, 200)
    other = check_grasp(
        foot, controls[part], branch[part], engine="fcl", criteria=coarse(foot)
    )
    exact = check_grasp(foot, controls[part], branch[part], criteria=coarse(foot))
    assert_same(exact, other)
    assert (exact.stable == report.stable[part]).all()
    assert exact.difference(other) < 1e-9 * foot.size
    assert exact.difference(other) == other.difference(exact)


def test_the_difference_is_the_largest_of_any_clearance():
    report = check_grasp(*clasping())
    moved = report.clearance.copy()
    moved[4] += 0.25
    assert dataclasses.replace(report, clearance=moved).difference(report) == 0.25
    apart = dataclasses.replace(report, finger_clearance=report.finger_clearance - 0.5)
    assert apart.difference(report) == pytest.approx(0.5)


def test_an_engine_may_be_made_once():
    foot, controls, branch = clasping()
    engine = make_engine("fcl", foot)
    assert engine.name == "fcl"
    assert check_grasp(foot, controls, branch, engine=engine).grasping


# Batches -------------------------------------------------------------------------


def assert_equal(one, other):
    """Equal to the last bit."""
    for field in dataclasses.fields(GraspReport):
        first, second = getattr(one, field.name), getattr(other, field.name)
        if isinstance(first, np.ndarray):
            assert np.array_equal(first, second, equal_nan=True), field.name


@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_a_batch_is_a_loop(engine):
    foot, controls, branch, _ = sample()
    options = {"engine": make_engine(engine, foot), "criteria": coarse(foot)}
    batch = check_grasp(foot, controls[:8].reshape(2, 4, 14), branch[0], **options)
    assert batch.stable.shape == (2, 4)
    for index in range(8):
        one = check_grasp(foot, controls[index], branch[0], **options)
        assert one.stable.shape == ()
        place = divmod(index, 4)
        assert batch.clearance[place] == pytest.approx(one.clearance, abs=1e-15)
        for flag in FLAGS:
            assert getattr(batch, flag)[place] == getattr(one, flag)


@pytest.mark.parametrize("single", [True, False])
def test_more_than_a_block_is_the_same_in_parts(single):
    foot, controls, branches, _ = sample()
    count = BLOCK + 700
    many = np.resize(controls, (count, 14))
    branch = branches[0] if single else branches[np.arange(count) % len(controls)]
    whole = check_grasp(foot, many, branch, criteria=coarse(foot))
    assert whole.branch is branch
    assert whole.controls.shape == (count, 14)
    for part in (slice(0, 50), slice(BLOCK - 20, BLOCK + 20), slice(count - 30, None)):
        local = branch if single else branch[part]
        alone = check_grasp(foot, many[part], local, criteria=coarse(foot))
        for field in dataclasses.fields(GraspReport):
            expected = getattr(alone, field.name)
            if isinstance(expected, np.ndarray):
                found = getattr(whole, field.name)[part]
                assert found.shape == expected.shape
                assert found == pytest.approx(expected, abs=1e-14, nan_ok=True)


@pytest.mark.parametrize("count", [3, BLOCK])
def test_controls_and_branches_broadcast_whatever_their_number(count):
    radii = np.full((count, 1), 0.3)
    branch = Branch(radii, (0, 0, -0.5))
    foot, controls = Foot(), np.linspace(0, 0.5, 28).reshape(2, 14)
    report = check_grasp(foot, controls, branch)
    assert (report.controls == controls).all()
    assert (report.bones == forward_kinematics(foot, controls)).all()
    apart = least_skin_distance(report.bones[0], foot.radii, finger_pairs(foot))
    assert report.finger_clearance == pytest.approx(np.tile(apart, (count, 1)))
    assert report.clearance.shape == report.controls.shape == (count, 2, 14)
    assert report.bones.shape == (count, 2, 14, 2, 3)
    assert report.feasible.shape == (count, 2)
    assert (report.clearance == report.clearance[:1]).all()


@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_an_empty_batch_is_an_empty_report(engine):
    report = check_grasp(
        PARROT, np.empty((0, 14)), Branch(1, (0, 0, -1)), engine=engine
    )
    assert report.stable.shape == (0,)
    assert report.difference(report) == 0.0


def test_a_report_cannot_be_written():
    report = check_grasp(*clasping())
    for field in dataclasses.fields(report):
        value = getattr(report, field.name)
        if isinstance(value, np.ndarray):
            with pytest.raises(ValueError, match="read-only"):
                value[...] = 0
    with pytest.raises(dataclasses.FrozenInstanceError):
        report.stable = True


def test_a_report_keeps_no_hold_on_the_callers_controls():
    controls = np.zeros(14)
    report = check_grasp(PARROT, controls, Branch(1, (0, 0, -1.1)))
    controls[0] = 1.0
    assert report.controls[0] == 0.0


# Failure -------------------------------------------------------------------------


def test_the_default_tolerance_is_relative_to_the_foot():
    report = check_grasp(PARROT, np.zeros(14), Branch(1, (0, 0, -2)))
    assert report.tolerance == TOLERANCE * PARROT.size
    criteria = Criteria(tolerance=1e-4)
    report = check_grasp(PARROT, np.zeros(14), Branch(1, (0, 0, -2)), criteria=criteria)
    assert report.tolerance == 1e-4


def test_a_tolerance_of_numpys_is_a_number():
    foot, controls, branches, _ = sample()
    criteria = Criteria(tolerance=np.float64(0.03) * foot.size)
    many = check_grasp(foot, controls[:1100], branches[:1100], criteria=criteria)
    assert type(many.tolerance) is float
    assert many.tolerance == criteria.tolerance == 0.03 * foot.size


def test_a_tolerance_above_a_tenth_of_the_foot_is_refused():
    message = "^tolerance = 0.5 is not at most .* m, 10% of the foot: a contact is a t"
    with pytest.raises(ParameterError, match=message):
        Criteria(tolerance=0.5).metres(PARROT)


@pytest.mark.parametrize(
    ("radius", "height", "judged"),
    [(4.9e5, 5e5, True), (5.1e5, 5.2e5, False), (1.1e-6, 1, True), (9e-7, 1, False)],
)
def test_branches_are_judged_from_a_millionth_to_a_million_of_the_foot(
    radius, height, judged
):
    size = PARROT.size
    branch = Branch(radius * size, (0, 0, -height * size))
    refused = contextlib.nullcontext() if judged else pytest.raises(ParameterError)
    with refused:
        check_grasp(PARROT, np.zeros(14), branch)


@pytest.mark.parametrize(
    ("branch", "message"),
    [
        (
            Branch(1e9, (0, 0, -1e9)),
            "^extent of the branch = 2000000000.0 is not at most [0-9.e+]+ m for this "
            "foot: move it nearer, or take a thinner one$",
        ),
        (
            Branch(1, [(0, 0, -2), (0, 0, -1e9)]),
            r"^extent of the branch\[1\] = 1000000001.0 is not",
        ),
        (
            Branch(1e-9, (0, 0, -0.02)),
            "^branch.radius = 1e-09 is not at least [0-9.e-]+ m for it: "
            "take a thicker one$",
        ),
    ],
)
def test_a_branch_that_rounding_or_tolerance_would_judge_is_refused(branch, message):
    with pytest.raises(ParameterError, match=message):
        check_grasp(PARROT, np.zeros(14), branch)


@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_a_branch_that_holds_the_base_is_refused(engine):
    one, batch = Branch(1, (0, 0, -0.5)), Branch([1, 2], (0, 0, -1))
    with pytest.raises(
        ParameterError, match=r"axis = 0\.5 is not at least .* move the centre away"
    ):
        check_grasp(PARROT, np.zeros(14), one, engine=engine)
    with pytest.raises(ParameterError, match=r"axis\[1\] = 1\.0"):
        check_grasp(PARROT, np.zeros(14), batch, engine=engine)


def test_an_engine_of_another_foot_is_refused():
    engine = make_engine("exact", Foot.preset("owl"))
    message = "^engine.foot = 'owl' is not the foot: make the engine for this foot$"
    with pytest.raises(ParameterError, match=message):
        check_grasp(PARROT, np.zeros(14), Branch(0.01, (0, 0, -0.02)), engine=engine)


@pytest.mark.parametrize("value", [0, -1, math.nan, math.inf, "1", True])
def test_a_bad_tolerance_is_one_line(value):
    with pytest.raises(
        ParameterError, match=r"^tolerance = .* is not a positive number: give metres"
    ):
        Criteria(tolerance=value)


def test_unknown_names_are_refused_with_a_suggestion():
    with pytest.raises(UnknownNameError, match=r"^unknown reading 'sections': did"):
        Criteria(reading="sections")
    with pytest.raises(UnknownNameError, match="engine 'exat': did you mean 'exact'"):
        check_grasp(*clasping(), engine="exat")


def test_batches_that_differ_are_refused():
    branch = Branch(np.ones(5), (0, 0, -1))
    with pytest.raises(ParameterError, match="batch shapes of controls and branch"):
        check_grasp(PARROT, np.zeros((3, 14)), branch)
