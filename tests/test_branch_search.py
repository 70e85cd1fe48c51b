"""All branches of a finite control set: none missed, none invented, laws, refusals."""

from __future__ import annotations

import math
from functools import cache
from itertools import product

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from strategies import feet, reals

from zygopin import (
    Criteria,
    Finger,
    Foot,
    ParameterError,
    Placement,
    UnknownNameError,
    branch_axis,
    check_grasp,
    count_systems,
    forward_kinematics,
    iter_stable_branches,
    stable_branches,
)
from zygopin.clearance import branch_clearance
from zygopin.crossings import SystemCounts

PAPER, PARROT = Foot.preset("paper"), Foot.preset("parrot")
COPLANAR = (1, 3)
TILTED = Placement(branch_axis(0.3, 0.2), 0.1, -0.05)


@cache
def solved(name="paper", pair=COPLANAR, levels=2, tilted=False):
    foot = Foot.preset(name)
    placement = Placement()
    if tilted:
        place = 0.05 * foot.size
        placement = Placement(branch_axis(0.3, 0.2), place, -place)
    return stable_branches(foot, pair, levels, placement=placement)


def ordered(solutions, turned=False):
    """Heights, radii, ranks and t as rows in an order of their own."""
    pair = slice(None, None, -1 if turned else 1)
    columns = (
        solutions.height,
        solutions.radius,
        *solutions.phalanx[:, pair].T,
        *solutions.t[:, pair].T,
    )
    rows = np.round(np.stack(columns, axis=1), 9) + 0.0
    return rows[np.lexsort(rows.T)]


# By hand -------------------------------------------------------------------------


def hand_foot():
    """Toes of lengths 0.8, 0.64: the front one of one phalanx, the back one of two."""
    fingers = (Finger("front", 1, 0.0), Finger("back", 2, math.pi))
    return Foot(rho=1.25, omega=math.pi / 2, fingers=fingers)


def test_a_solution_worked_by_hand():
    # The front toe falls at 45°: h = −r√2. The back toe falls at 45° too, and then
    # straight down, along x = −0.8/√2 from z = −0.8/√2 on: r = 0.8/√2. So h = −0.8;
    # the front toe is touched r/0.8 along, the other (0.8 − 0.8/√2)/0.64 along.
    half = 0.5**0.5
    found = stable_branches(hand_foot(), ("front", "back"), 3)
    word = (found.controls == (0.5, 0.5, 0.5)).all(axis=1)
    (index,) = np.flatnonzero(word & (found.phalanx == (1, 2)).all(axis=1))
    assert found.height[index] == pytest.approx(-0.8)
    assert found.radius[index] == pytest.approx(0.8 * half)
    assert found.t[index] == pytest.approx([half, (0.8 - 0.8 * half) / 0.64])
    assert found.side[index].tolist() == [1, 1]
    assert not found.family[index]
    assert found.stable[index]
    assert found.feasible[index]
    # Normals (1, 1)/√2 and (−1, 0); the first back phalanx is tangent as well, square
    # to the front one. The least product is that of the second.
    assert found.scalar_product[index] == pytest.approx(-half)
    assert found.grasping[index]


def test_a_family_worked_by_hand():
    # Both toes fall at 45° from the base: h = −r√2, touched r/0.8 along, so r ≤ 0.8.
    found = stable_branches(hand_foot(), ("front", "back"), 3)
    word = (found.controls == (0.5, 0.5, 0.0)).all(axis=1)
    (index,) = np.flatnonzero(word & (found.phalanx == (1, 1)).all(axis=1))
    assert found.family[index]
    ends = sorted(found.radii[index])
    assert ends == pytest.approx([0, 0.8], abs=2e-6)
    assert sorted(-found.heights[index]) == pytest.approx([0, 0.8 * 2**0.5], abs=4e-6)
    assert found.radius[index] == pytest.approx(0.4, abs=1e-5)
    assert found.scalar_product[index] == pytest.approx(0, abs=1e-12)


def test_straight_toes_rest_on_branches_of_any_size():
    found = solved()
    straight = (found.controls == 0).all(axis=1) & (found.side == 1).all(axis=1)
    (index,) = np.flatnonzero(straight)
    assert sorted(found.radii[index]) == pytest.approx(
        [1e-6 * found.foot.size, math.inf]
    )
    assert found.height[index] == pytest.approx(-found.radius[index])


# None missed ---------------------------------------------------------------------


def prefixes(foot, finger, levels):
    """Every phalanx and sequence of controls that places it, padded with zeros."""
    count = foot.fingers[finger].phalanges
    for rank in range(1, count + 1):
        for word in product(levels, repeat=rank):
            yield rank, (*word, *(0.0,) * (count - rank))


def distances(foot, finger, levels, placement, heights):
    """Distance of each such phalanx from the axis, less its skin, and t there.

    From forward kinematics and clearances alone: shapes (M, H).
    """
    every = list(prefixes(foot, finger, levels))
    part = foot.finger_slices[foot.fingers[finger].name]
    controls = np.zeros((len(every), foot.phalanx_count))
    controls[:, part] = [word for _, word in every]
    place = part.start + np.array([rank for rank, _ in every]) - 1
    bones = forward_kinematics(foot, controls)[np.arange(len(every)), place]
    thin = 1e-9 * foot.size
    branch = placement.branch(heights, np.full(len(heights), thin))
    near = branch_clearance(
        bones[None].repeat(len(heights), 0), foot.radii[place], branch
    )
    return every, near.distance.T + thin, near.t.T


def constructed(foot, levels, placement):
    """Solutions found by looking for equal distances on a dense grid of heights."""
    heights = np.linspace(-3, 3, 1501) * foot.size + 1e-4 * foot.size
    one = distances(foot, 0, levels, placement, heights)
    other = distances(foot, 1, levels, placement, heights)
    for i, j in product(range(len(one[0])), range(len(other[0]))):
        gap = one[1][i] - other[1][j]
        gap[np.abs(gap) < 1e-12 * foot.size] = 0  # a family: tested elsewhere
        for k in np.flatnonzero(gap[:-1] * gap[1:] < 0):
            yield one[0][i], other[0][j], (heights[k], heights[k + 1])


def refined(foot, words, ranks, bracket, placement):
    """Height, radius and t of a solution, by bisection on the difference."""
    controls = np.concatenate(words)
    starts = [part.start for part in foot.finger_slices.values()]
    place = np.array(ranks) - 1 + starts
    bones = forward_kinematics(foot, controls)[place]
    low, high = bracket

    def near(height):
        branch = placement.branch(height, 1e-9 * foot.size)
        return branch_clearance(bones, foot.radii[place], branch)

    def gap(height):
        return float(np.diff(near(height).distance)[0])

    sign = np.sign(gap(low))
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if gap(middle) * sign > 0 else (low, middle)
    at = near(low)
    return low, float(at.distance[0]) + 1e-9 * foot.size, at.t


@pytest.mark.parametrize(
    ("name", "pair", "levels", "placement"),
    [
        ("paper", ("finger1", "finger3"), (0.0, 1.0), Placement()),
        ("parrot", ("finger1", "finger2"), (0.0, 1.0), None),
    ],
)
def test_every_branch_found_on_a_dense_grid_of_heights_is_listed(
    name, pair, levels, placement
):
    whole = Foot.preset(name)
    if placement is None:
        placement = Placement(branch_axis(0.3, 0.2), 0.05 * whole.size, 0.0)
    found = stable_branches(whole, pair, levels, placement=placement)
    foot, seen, listed = found.foot, 0, set()
    for (i, one), (j, other), bracket in constructed(foot, levels, placement):
        height, radius, t = refined(foot, (one, other), (i, j), bracket, placement)
        branch = placement.branch(height, max(radius, 1e-9 * foot.size))
        inside = np.all((t > 1e-6) & (t < 1 - 1e-6))
        if not inside or radius < 1e-5 * foot.size:
            continue
        if branch.base_distance() < radius * (1 - 1e-9):
            continue
        same = (found.phalanx == (i, j)).all(axis=1)
        same &= (found.controls == (*one, *other)).all(axis=1)
        same &= np.abs(found.height - height) < 1e-6 * foot.size
        same &= np.abs(found.radius - radius) < 1e-6 * foot.size
        assert same.sum() == 1, (i, j, one, other, height, radius)
        listed |= set(np.flatnonzero(same))
        seen += 1
    assert seen >= 5
    # And back: whatever is a single branch inside both bones was found that way.
    inside = np.all((found.t > 1e-4) & (found.t < 1 - 1e-4), axis=1) & ~found.family
    near = np.abs(found.height) < 3 * foot.size
    assert set(np.flatnonzero(inside & near)) <= listed


@pytest.mark.parametrize("name", ["paper", "parrot", "owl"])
@pytest.mark.parametrize("pair", [(1, 2), (1, 3), (4, 2), (4, 3)])
@pytest.mark.parametrize("tilted", [False, True])
def test_solutions_are_stable_by_the_exact_engine(name, pair, tilted):
    found = solved(name, pair, 3, tilted)
    assert len(found)
    assert found.stable.all()
    assert found.residual.max() <= 1e-12 * found.foot.size
    assert (np.abs(found.t - 0.5) <= 0.5 + 1e-8).all()
    assert (found.radius > 0).all()
    report = check_grasp(found.foot, found.controls, found.branches)
    assert (report.grasping == found.grasping).all()
    other = Criteria("base_to_tip")
    report = check_grasp(found.foot, found.controls, found.branches, criteria=other)
    assert (report.grasping == found.grasping_base_to_tip).all()
    assert (report.feasible == found.feasible).all()
    starts = [part.start for part in found.foot.finger_slices.values()]
    places = found.phalanx - 1 + starts
    assert np.take_along_axis(report.tangent, places, axis=1).all()
    t = np.take_along_axis(report.t, places, axis=1)
    np.testing.assert_allclose(t, found.t, atol=1e-9)


@given(feet(), st.data())
def test_solutions_of_any_foot_are_stable(foot, data):
    pairs = foot.opposable_pairs
    assume(pairs)
    pair = tuple(index + 1 for index in data.draw(st.sampled_from(pairs)))
    axis = branch_axis(data.draw(reals(-3, 3)), data.draw(reals(-1.2, 1.2)))
    x, y = (data.draw(st.just(0.0) | reals(-1, 1)) * foot.size for _ in "xy")
    found = stable_branches(foot, pair, 2, placement=Placement(axis, x, y))
    # t is of no use where a bone is nearly parallel to the axis, or the branch far.
    near = np.abs(found.height) < 1e3 * foot.size
    assert found.stable[near].all()
    assert found.residual[near].max(initial=0) <= 1e-9 * foot.size
    assert found.counts.systems == count_systems(foot, pair)


def test_a_straight_toe_never_enters_the_branch_beyond_its_tangent_phalanx():
    found = solved("parrot", COPLANAR, 3)
    report = check_grasp(found.foot, found.controls, found.branches)
    for finger, part in enumerate(found.foot.finger_slices.values()):
        rank = np.arange(1, part.stop - part.start + 1)
        beyond = rank >= found.phalanx[:, finger, None]
        assert (report.clearance[:, part][beyond] >= -1e-12).all()


def test_fcl_finds_every_contact_of_the_papers_pair():
    found = solved()
    assert len(found) == 17
    assert found.fcl_difference().max() <= 1e-12
    second = check_grasp(found.foot, found.controls, found.branches, engine="fcl")
    assert second.stable.all()
    assert (second.feasible == found.feasible).all()


@pytest.mark.parametrize("name", ["paper", "parrot"])
def test_fcl_finds_the_contacts_of_a_sample_of_many(name):
    found = solved(name, COPLANAR, 5)
    sample = np.random.default_rng(1).permutation(len(found))[:150]
    far = found.fcl_difference()[sample] / found.foot.size
    assert far.max() <= 1e-9


def test_a_family_touches_from_end_to_end():
    found = solved("paper", COPLANAR, 3)
    for index in np.flatnonzero(found.family):
        ends = np.clip(found.heights[index], *(np.array([-9, 9]) * found.foot.size))
        for share in (1e-4, 0.3, 1 - 1e-4):
            height = ends[0] + share * (ends[1] - ends[0])
            whole = np.clip(found.heights[index], -1e3, 1e3)
            slope = np.diff(np.clip(found.radii[index], 0, 1e3)) / np.diff(whole)
            radius = found.radius[index] + slope[0] * (height - found.height[index])
            branch = found.placement.branch(height, radius)
            report = check_grasp(found.foot, found.controls[index], branch)
            assert report.stable, (index, share)


# Laws ----------------------------------------------------------------------------


@pytest.mark.parametrize("name", ["paper", "parrot"])
@pytest.mark.parametrize("factor", [1e-3, 7.0])
def test_lengths_scale_with_the_foot(name, factor):
    foot, small = Foot.preset(name), solved(name, COPLANAR, 3)
    scaled = foot.replace(scale=factor * foot.scale, thickness=factor * foot.thickness)
    large = stable_branches(scaled, COPLANAR, 3)
    assert large.counts == small.counts
    np.testing.assert_array_equal(large.controls, small.controls)
    for field in ("height", "radius", "heights", "radii"):
        expected = factor * getattr(small, field)
        size = large.foot.size
        np.testing.assert_allclose(getattr(large, field), expected, atol=1e-9 * size)
    for field in ("grasping", "grasping_base_to_tip", "feasible", "phalanx", "side"):
        np.testing.assert_array_equal(getattr(large, field), getattr(small, field))


@pytest.mark.parametrize("name", ["paper", "parrot"])
def test_a_mirrored_foot_has_the_mirrored_branches(name):
    foot = Foot.preset(name)
    mirrored = tuple(
        Finger(f.name, f.phalanges, math.pi - f.azimuth) for f in foot.fingers
    )
    there = Placement(branch_axis(0.2, 0.1), 0.04 * foot.size, 0.02 * foot.size)
    x, y, z = np.asarray(there.axis)
    back = Placement((-x, y, z), -there.x, there.y)
    first = stable_branches(foot, (1, 2), 3, placement=there)
    second = stable_branches(foot.replace(fingers=mirrored), (1, 2), 3, placement=back)
    np.testing.assert_allclose(ordered(first), ordered(second), atol=2e-9)
    assert first.feasible.sum() == second.feasible.sum()


def test_the_order_of_the_pair_does_not_matter():
    one, other = solved("parrot", (1, 3), 3), solved("parrot", (3, 1), 3)
    np.testing.assert_allclose(ordered(one), ordered(other, turned=True), atol=2e-9)
    assert one.counts == other.counts


def test_more_levels_only_add_branches():
    few = {tuple(row) for row in ordered(solved("parrot", COPLANAR, 3))}
    many = {tuple(row) for row in ordered(solved("parrot", COPLANAR, 5))}
    assert few < many


def test_levels_by_number_and_by_value_agree():
    one, other = solved(levels=3), stable_branches(PAPER, COPLANAR, (1, 0, 0.5, 0.5))
    np.testing.assert_array_equal(one.height, other.height)


# Counts, blocks, memory ----------------------------------------------------------


@pytest.mark.parametrize(
    ("pair", "levels", "count"),
    [((1, 3), 2, 4 * 6 * 30), ((4, 2), 3, 4 * 363 * 39), ((1, 3), 5, 93600)],
)
def test_systems_are_counted_before_and_after(pair, levels, count):
    assert count_systems(PAPER, pair, levels) == count
    assert solved("paper", pair, levels).counts.systems == count


def test_singular_systems_of_straight_toes_are_counted():
    # One phalanx each, controls 0 and 1: four lines each way, of slopes 1, cos, −1,
    # −cos twice. Each has one of the same slope, and all go through h = r = 0.
    fingers = (Finger("front", 1, 0.0), Finger("back", 1, math.pi))
    foot = Foot(omega=1.0, fingers=fingers)
    counts = stable_branches(foot, (1, 2)).counts
    assert counts == SystemCounts(systems=16, same_line=4)
    thick = stable_branches(foot.replace(thickness=0.1), (1, 2)).counts
    assert thick.same_line == 4
    assert counts.singular == 4


def test_parallel_lines_have_no_branch():
    # Skins of different radii on straight toes: the second phalanx is off the first.
    fingers = (Finger("front", 2, 0.0), Finger("back", 1, math.pi))
    foot = Foot(omega=1.0, thickness=0.1, fingers=fingers)
    assert stable_branches(foot, (1, 2)).counts.parallel > 0


def test_phalanges_along_the_axis_are_counted_as_such():
    along = Placement((math.cos(math.pi / 12), -math.sin(math.pi / 12), 0))
    found = stable_branches(PAPER, (2, 1), placement=along)
    assert found.counts.along_axis == 2 * 2 * 28  # finger 1's two straight ones
    assert found.counts.systems == count_systems(PAPER, (2, 1))
    assert (found.height == found.height).all()


def test_a_pair_all_along_the_axis_has_no_branch():
    fingers = (Finger("front", 1, 0.0), Finger("back", 1, math.pi))
    foot = Foot(omega=1e-9, fingers=fingers)
    found = stable_branches(foot, (1, 2), placement=Placement((1, 0, 0)))
    assert found.counts.along_axis > 0
    assert found.counts.systems == 16


def test_a_branch_that_would_hold_the_base_is_left_out_and_counted():
    # Toes that fall straight down hold a branch between them, the base inside it.
    fingers = (Finger("front", 2, 0.0), Finger("back", 2, math.pi))
    foot = Foot(rho=2.0, omega=math.pi / 2, fingers=fingers)
    found = stable_branches(foot, (1, 2))
    down = (found.controls == (0, 1, 0, 1)).all(axis=1)
    assert not down.any()
    assert found.counts.base_inside > 0


@pytest.mark.parametrize("block", [1, 10, 10**6])
def test_blocks_are_the_whole(block):
    whole = solved(levels=3)
    blocks = list(iter_stable_branches(PAPER, COPLANAR, 3, block=block))
    for field in ("height", "controls", "t", "grasping", "radii"):
        parts = np.concatenate([getattr(part, field) for part in blocks])
        np.testing.assert_array_equal(parts, getattr(whole, field))
    counts = sum((part.counts for part in blocks), SystemCounts())
    assert counts == whole.counts
    assert max(map(len, blocks)) <= block


def test_more_than_memory_allows_is_refused_with_its_number():
    found = solved(levels=3)
    with pytest.raises(ParameterError, match="iter_stable_branches") as caught:
        stable_branches(PAPER, COPLANAR, 3, max_bytes=10_000)
    assert f"{len(found)} solutions of 5760 systems" in str(caught.value)
    held = sum(x.nbytes for x in vars(found).values() if isinstance(x, np.ndarray))
    enough = 2 * (held + 32 * len(found))
    assert len(stable_branches(PAPER, COPLANAR, 3, max_bytes=enough)) == len(found)


def test_solutions_are_read_only():
    found = solved()
    with pytest.raises(ValueError, match="read-only"):
        found.height[0] = 0


@pytest.mark.parametrize(
    ("pair", "error", "message"),
    [
        ((1, 4), ParameterError, "finger1 and finger4"),
        ((1, 1), ParameterError, "not opposable"),
        ((1, 5), ParameterError, "finger = 5"),
        ((1,), ParameterError, "two fingers"),
        ("13", ParameterError, "two fingers"),
        (("finger1", "thumb"), UnknownNameError, "thumb"),
    ],
)
def test_fingers_that_are_no_pair_are_refused(pair, error, message):
    with pytest.raises(error, match=message):
        stable_branches(PAPER, pair)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"levels": (0, 0.5)}, "add 0 and 1"),
        ({"levels": 1}, "number of levels"),
        ({"placement": (0, 1, 0)}, "Placement"),
        ({"block": 0}, "block"),
    ],
)
def test_bad_input_is_refused_before_any_work(options, message):
    with pytest.raises(ParameterError, match=message):
        iter_stable_branches(PAPER, COPLANAR, **options)
