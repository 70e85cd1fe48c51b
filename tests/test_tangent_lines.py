"""Tangent lines: their equations against distances, their numbers, bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import assume, given
from hypothesis import strategies as st
from strategies import feet, reals

from zygopin import Finger, Foot, ParameterError, branch_axis, forward_kinematics
from zygopin.clearance import branch_clearance
from zygopin.placement import Placement
from zygopin.tangent_lines import (
    control_set,
    line_blocks,
    line_count,
    tangent_lines,
    whole_controls,
)

ACROSS = Placement()


def placements(size):
    """Directions well off the vertical, and places around the foot."""
    place = reals(-1.0, 1.0).map(lambda x: x * size)
    axis = st.builds(branch_axis, reals(-3.0, 3.0), reals(-1.2, 1.2))
    return st.builds(Placement, axis, place, place)


def test_a_straight_toe_lies_on_top_of_any_branch_that_reaches_up_to_it():
    foot = Foot(fingers=(Finger("toe", 1, 0.0),))
    palm, back = (
        {name: float(getattr(lines, name)[row]) for name in ("normal_z", "offset")}
        for lines in [tangent_lines(foot, 0, np.zeros((1, 1)), ACROSS)]
        for row in (0, 1)
    )
    assert palm == {"normal_z": 1.0, "offset": 0.0}  # h + r = 0
    assert back == {"normal_z": -1.0, "offset": 0.0}  # h − r = 0


def test_a_toe_at_45_degrees_by_hand():
    # n = (1, 0, 1)/√2 and x₀ = 0: h/√2 + r = −ε; the foot of the perpendicular from
    # (0, h) is −h/√2 down the bone of length s/ρ.
    foot = Foot(omega=math.pi / 2, thickness=0.1, fingers=(Finger("toe", 1, 0.0),))
    lines = tangent_lines(foot, 0, np.array([[0.5]]), ACROSS)
    np.testing.assert_array_equal(lines.side, [1, -1])
    np.testing.assert_allclose(lines.normal_z, [0.5**0.5, -(0.5**0.5)])
    np.testing.assert_allclose(lines.offset, -0.1 / foot.rho)
    np.testing.assert_allclose(lines.t_rate, -(0.5**0.5) * foot.rho)
    low, high = lines.heights()
    np.testing.assert_allclose(low, -(2**0.5) / foot.rho)
    np.testing.assert_allclose(high, 0, atol=1e-8)


@given(feet(), st.data())
def test_on_its_line_a_phalanx_is_at_distance_zero(foot, data):
    placement = data.draw(placements(foot.size))
    index = data.draw(st.integers(0, len(foot.fingers) - 1))
    count = foot.fingers[index].phalanges
    rank = data.draw(st.integers(1, count))
    given_controls = data.draw(st.lists(reals(0, 1), min_size=rank, max_size=rank))
    lines = tangent_lines(foot, index, np.array([given_controls]), placement)
    assume(len(lines))
    place = foot.finger_slices[foot.fingers[index].name].start + rank - 1
    controls = np.zeros(foot.phalanx_count)
    controls[place - rank + 1 : place + 1] = given_controls
    bones = forward_kinematics(foot, controls)[place : place + 1]
    for row in (0, 1):
        height = data.draw(reals(-3, 3)) * foot.size
        radius = float(lines.offset[row] - lines.normal_z[row] * height)
        if radius < 1e-6 * foot.size:
            continue
        branch = placement.branch(height, radius)
        near = branch_clearance(bones, foot.radii[place : place + 1], branch)
        t = float(lines.t_start[row] + lines.t_rate[row] * height)
        low, high = (float(end[row]) for end in lines.heights())
        # A bone nearly along the axis loses digits as its projection gets short.
        across = np.linalg.norm(np.cross(bones[0, 1] - bones[0, 0], branch.axis))
        assume(across > 1e-3 * foot.lengths[place])
        assert float(near.t[0]) == pytest.approx(t, abs=1e-6, rel=1e-6)
        if 1e-6 < t < 1 - 1e-6:
            assert float(near.distance[0]) == pytest.approx(0, abs=1e-9 * foot.size)
            assert low <= height <= high
        elif not -1e-6 <= t <= 1 + 1e-6:
            assert not low <= height <= high


def test_the_palm_is_the_side_towards_which_the_toe_bends():
    foot = Foot.preset("paper")
    for index in range(4):
        for _ in line_blocks(foot, index, 3, ACROSS):
            pass
        straight = tangent_lines(foot, index, np.zeros((1, 1)), ACROSS)
        assert straight.normal_z[straight.side == 1] > 0


@pytest.mark.parametrize(("levels", "count"), [(2, 2 * 30), ((0, 0.3, 1), 2 * 120)])
def test_every_prefix_has_a_line_on_both_sides(levels, count):
    foot = Foot.preset("paper")
    assert line_count(foot, 2, levels) == count
    for block in (1, 7, 4096):
        blocks = list(line_blocks(foot, 2, levels, ACROSS, block=block))
        seen = {
            (int(r), int(w), int(s))
            for lines in blocks
            for r, w, s in zip(lines.rank, lines.word, lines.side, strict=True)
        }
        assert len(seen) == count == sum(map(len, blocks))
    assert len(blocks) == 1


def test_words_lead_back_to_controls():
    levels = control_set(3)
    controls = whole_controls(levels, 4, np.array([1, 2, 4]), np.array([1, 5, 80]))
    expected = [[0.5, 0, 0, 0], [0.5, 1, 0, 0], [1, 1, 1, 1]]
    np.testing.assert_array_equal(controls, expected)


def test_a_phalanx_along_the_axis_has_no_line():
    foot = Foot.preset("paper")
    along = Placement((math.cos(math.pi / 12), -math.sin(math.pi / 12), 0))
    lines = list(line_blocks(foot, 2, 2, along))
    # Straight from the base on: prefixes of zeros, one for each of four phalanges.
    assert sum(map(len, lines)) == line_count(foot, 2, 2) - 2 * 4


@pytest.mark.parametrize("levels", [(0, 0.5), (0.5, 1), (0.5,), 1, (0, 1, 2), "two"])
def test_a_control_set_holds_0_and_1(levels):
    with pytest.raises(ParameterError, match="level"):
        control_set(levels)


@pytest.mark.parametrize(
    ("placement", "message"),
    [
        ({"axis": (0, 0, 1)}, "off the vertical"),
        ({"axis": (0, 0, 0)}, "positive"),
        ({"axis": (0, 1)}, "shape"),
        ({"axis": ((0, 1, 0), (1, 0, 0))}, "shape"),
        ({"x": math.nan}, "x = nan"),
        ({"y": "far"}, "y = 'far'"),
    ],
)
def test_a_placement_out_of_range_is_refused(placement, message):
    with pytest.raises(ParameterError, match=message):
        Placement(**placement)


def test_more_lines_than_an_index_counts_are_refused():
    foot = Foot(fingers=(Finger("toe", 12, 0.0),))
    with pytest.raises(ParameterError, match="fewer levels"):
        line_count(foot, 0, 100)
