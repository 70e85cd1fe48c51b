"""Branches under the base: the source's numbers, its readings, and the true section."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zygopin import (
    Finger,
    Foot,
    ParameterError,
    UnknownNameError,
    branch_axis,
    check_grasp,
    forward_kinematics,
    resting_radii,
)
from zygopin.clearance import branch_clearance
from zygopin.placement import Placement
from zygopin.resting import resting_branches
from zygopin.resting_equations import SECTIONS

PAPER, PARROT = Foot.preset("paper"), Foot.preset("parrot")
WIDTH = {"geometric": lambda c: 1 / c, "printed": lambda c: c, "circle": lambda _: 1}


def closed(found, rank):
    """The palm's solution of one phalanx with all controls 1 up to it."""
    word = (found.controls[:, :rank] == 1).all(axis=1)
    rows = np.flatnonzero(word & (found.phalanx == rank) & (found.side == 1))
    assert len(rows) == 1
    return float(found.radius[rows[0]]), float(found.t[rows[0]]), rows[0]


@pytest.mark.parametrize(
    ("section", "radius", "t"),
    [
        ("printed", 0.6512, 0.024),
        ("circle", 2 / (1 + math.sqrt(5)), 0.0),
        ("geometric", 0.5868, -0.024),
    ],
)
@pytest.mark.parametrize("finger", ["finger1", "finger3"])
def test_the_captions_radius_in_three_readings(section, radius, t, finger):
    # MODEL.md, section 7, row 13: v ≡ 1, the second phalanx.
    found = resting_radii(PAPER, finger, 2, section=section)
    got, at, row = closed(found, 2)
    assert got == pytest.approx(radius, abs=5e-5)
    assert at == pytest.approx(t, abs=5e-4)
    assert found.on_bone[row] == (section != "geometric")


def test_the_circle_of_the_caption_by_hand():
    # x₁ = e^{−iπ/6}/φ, n = e^{iπ/6}·… = (sin π/3, cos π/3): n·x₁ = (1/φ)·sin(π/6), and
    # r·(1 − cos π/3) = n·x₁: r = 1/φ. It touches where the phalanx begins.
    radius, t, _ = closed(resting_radii(PAPER, 3, 2, section="circle"), 2)
    assert radius == pytest.approx(1 / PAPER.rho)
    assert t == pytest.approx(0, abs=1e-12)


def test_the_captions_true_branch_is_just_off_the_bone_and_entered_by_the_first():
    radius, _, _ = closed(resting_radii(PAPER, 3, 2), 2)
    controls = np.zeros(14)
    controls[5:7] = 1
    branch = Placement().branch(-radius, radius)
    report = check_grasp(PAPER, controls, branch)
    assert report.clearance[5] < -0.01  # the first phalanx
    assert not report.tangent[6]
    # The straight toe goes on along the tangent: it does not touch inside either.
    assert abs(report.t[6] + 0.0242) < 1e-3
    assert not resting_branches(PAPER, (1, 3), (0, 1)).phalanx.tolist().count([2, 2])


def ellipse_gap(foot, finger, controls, rank, radius, wide):
    """Least distance from the line of a bone, in its plane, to an ellipse's points.

    By points of the ellipse alone: half-axes wide·r and r around (0, −r).
    """
    part = foot.finger_slices[foot.fingers[finger].name]
    whole = np.zeros(foot.phalanx_count)
    whole[part] = controls
    azimuth = foot.fingers[finger].azimuth
    bone = forward_kinematics(foot, whole)[part.start + rank - 1]
    plane = bone @ np.array([[math.cos(azimuth), 0], [math.sin(azimuth), 0], [0, 1]])
    line = (plane[1] - plane[0]) / np.linalg.norm(plane[1] - plane[0])
    angle = np.linspace(0, 2 * math.pi, 20_001)
    points = np.stack(
        [wide * radius * np.cos(angle), radius * np.sin(angle) - radius], 1
    )
    from_start = points - plane[0]
    distance = from_start @ (-line[1], line[0])
    side = np.sign(distance[np.argmax(np.abs(distance))])
    nearest = np.argmin(distance * side)
    at = from_start[nearest] @ line / foot.lengths[part][rank - 1]
    return float(distance[nearest] * side), float(at)


@pytest.mark.parametrize("section", SECTIONS)
@pytest.mark.parametrize("finger", [1, 2])
def test_radii_are_those_of_the_ellipse_in_the_fingers_plane(section, finger):
    # The ellipse by its points: no support function, no projection.
    name = PAPER.fingers[finger].name
    found = resting_radii(PAPER, name, 3, section=section)
    wide = WIDTH[section](abs(math.cos(PAPER.fingers[finger].azimuth)))
    rows = np.flatnonzero(np.abs(found.t) < 3)
    for row in np.random.default_rng(0).permutation(rows)[:40]:
        rank, radius = int(found.phalanx[row]), float(found.radius[row])
        if not math.isfinite(radius):
            continue
        gap, at = ellipse_gap(PAPER, finger, found.controls[row], rank, radius, wide)
        # Points 3e-4 apart: the gap is flat to second order there, t is not.
        assert gap == pytest.approx(0, abs=1e-6 * radius)
        reach = wide * radius / PAPER.lengths[PAPER.finger_slices[name]][rank - 1]
        assert at == pytest.approx(found.t[row], abs=1e-3 * (1 + reach))


@pytest.mark.parametrize("name", ["paper", "parrot", "owl"])
@pytest.mark.parametrize("axis", [(0, 1, 0), branch_axis(0.4, 0.3)])
def test_true_radii_touch_the_cylinder_with_the_base_on_its_bark(name, axis):
    foot, placement = Foot.preset(name), Placement(axis)
    for finger, part in zip(foot.fingers, foot.finger_slices.values(), strict=True):
        found = resting_radii(foot, finger.name, 3, axis=axis)
        rows = found.on_bone & np.isfinite(found.radius)
        rows &= (found.radius > 1e-5 * foot.size) & (found.radius < 100 * foot.size)
        radius = found.radius[rows]
        branches = placement.branch(-radius / placement.level, radius)
        np.testing.assert_allclose(branches.base_distance(), radius, rtol=1e-12)
        controls = np.zeros((rows.sum(), foot.phalanx_count))
        controls[:, part] = found.controls[rows]
        near = branch_clearance(
            forward_kinematics(foot, controls), foot.radii, branches
        )
        place = (found.phalanx[rows] - 1 + part.start)[:, None]
        gap = np.take_along_axis(near.distance, place, 1)
        assert np.abs(gap).max(initial=0) < 1e-11 * foot.size
        t = np.take_along_axis(near.t, place, 1)[:, 0]
        np.testing.assert_allclose(t, found.t[rows], atol=1e-8)


def test_no_radius_is_missed():
    # Every phalanx of every word: the gap to the branch under the base, over radii.
    foot = Foot.preset("parrot")
    part = foot.finger_slices["finger2"]
    found = resting_radii(foot, "finger2", 3)
    radii = np.geomspace(1e-3, 30, 4001) * foot.size
    branches = Placement().branch(-radii, radii)[:, None]
    seen = 0
    for rank in (1, 2, 3):
        for word in np.ndindex(*(3,) * rank):
            controls = np.zeros(foot.phalanx_count)
            controls[part.start : part.start + rank] = np.array(word) / 2
            place = part.start + rank - 1
            bone = forward_kinematics(foot, controls)[None, None, place : place + 1]
            near = branch_clearance(bone, foot.radii[place : place + 1], branches)
            gap, t = near.distance[:, 0, 0], near.t[:, 0, 0]
            inside = (t > 1e-3) & (t < 1 - 1e-3)
            for k in np.flatnonzero(
                (gap[:-1] * gap[1:] < 0) & inside[:-1] & inside[1:]
            ):
                same = (found.controls == controls[part]).all(axis=1)
                same &= (found.phalanx == rank) & (found.radius >= radii[k])
                assert (same & (found.radius <= radii[k + 1])).sum() == 1
                seen += 1
    assert seen > 5


def test_pairs_rest_on_the_same_branch():
    found = resting_branches(PAPER, (1, 3), 5)
    assert len(found) > 20
    assert found.stable.all()
    assert found.residual.max() < 1e-9 * PAPER.size
    single = ~found.family
    np.testing.assert_allclose(found.height, -found.radius)
    assert single.sum() == len(found) - 1  # both toes straight: any radius
    report = check_grasp(found.foot, found.controls, found.branches, engine="fcl")
    assert report.stable.all()


def test_a_straight_toe_goes_with_every_radius_of_the_other():
    found = resting_branches(PAPER, ("finger1", "finger3"), 3)
    radii = resting_radii(PAPER, "finger3", 3)
    wanted = radii.on_bone & (radii.radius > 1e-5)
    straight = (found.controls[:, :2] == 0).all(axis=1) & ~found.family
    straight &= (found.phalanx[:, 0] == 1) & (found.controls[:, 2:] != 0).any(axis=1)
    got = np.sort(found.radius[straight & (found.side[:, 0] == 1)])
    np.testing.assert_allclose(got, np.sort(radii.radius[wanted]))


def test_all_matches_are_found():
    one, other = resting_radii(PAPER, 1, 5), resting_radii(PAPER, 3, 5)
    size = PAPER.size
    pairs = 0
    for r in one.radius[one.on_bone]:
        for q in other.radius[other.on_bone]:
            free = math.isnan(r) or math.isnan(q)
            pairs += free or abs(r - q) <= 1e-9 * size
    assert len(resting_branches(PAPER, (1, 3), 5)) == pairs


def test_readings_agree_where_the_fingers_are_in_the_xz_plane():
    flat = PAPER.replace(splay=0.0)
    radii = [
        np.sort(resting_radii(flat, 3, 3, section=section).radius)
        for section in SECTIONS
    ]
    np.testing.assert_allclose(radii[1], radii[0], rtol=1e-9)
    np.testing.assert_allclose(radii[2], radii[0], rtol=1e-9)


def test_other_readings_are_judged_on_the_true_cylinder():
    printed = resting_branches(PAPER, (1, 3), 2, section="printed")
    both = (printed.phalanx == 2).all(axis=1)
    assert printed.radius[both] == pytest.approx([0.6512], abs=5e-5)
    assert printed.t[both][0] == pytest.approx([0.024, 0.024], abs=5e-4)
    assert not printed.stable[both]
    assert printed.residual[both] > 0.03


def test_radii_scale_with_the_foot():
    one = resting_radii(PARROT, 3, 3)
    large = PARROT.replace(scale=5 * PARROT.scale, thickness=5 * PARROT.thickness)
    other = resting_radii(large, 3, 3)
    np.testing.assert_allclose(other.radius, 5 * one.radius)
    np.testing.assert_allclose(other.t, one.t, atol=1e-9)


def test_equations_are_counted():
    found = resting_branches(PAPER, (1, 3), 2)
    assert found.counts.systems == 2 * 6 + 2 * 30
    # One for each phalanx of the straight toes, on the palm.
    assert found.counts.same_line == 2 + 4
    # A skin lifts the base off what straight toes lie on.
    thick = resting_branches(PAPER.replace(thickness=0.1), (1, 3), 2)
    assert thick.counts.same_line == 0
    assert thick.counts.parallel >= 2 + 4


@pytest.mark.parametrize(
    ("options", "error", "message"),
    [
        ({"section": "oval"}, UnknownNameError, "section 'oval'"),
        ({"section": "printed", "axis": (1, 1, 0)}, ParameterError, "geometric"),
        ({"axis": (0, 0, 1)}, ParameterError, "vertical"),
        ({"levels": (0, 0.5)}, ParameterError, "add 0 and 1"),
        ({"finger": "thumb"}, UnknownNameError, "thumb"),
    ],
)
def test_bad_input_is_refused(options, error, message):
    arguments = {"finger": 3, "levels": 2, **options}
    with pytest.raises(error, match=message):
        resting_radii(PAPER, **arguments)


def test_more_equations_than_memory_holds_are_refused():
    foot = Foot(fingers=(Finger("toe", 12, 0.0), Finger("back", 1, math.pi)))
    with pytest.raises(ParameterError, match="take fewer levels"):
        resting_radii(foot, "toe", 9)
