"""The branch: pose, batches, projection, and what no branch may be."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from strategies import reals

from zygopin.branch import Branch, branch_axis, check_base, yaw_and_pitch
from zygopin.errors import ParameterError

AXES = hnp.arrays(np.float64, 3, elements=reals(-1, 1)).filter(
    lambda a: np.abs(a).max() > 1e-3
)


def across(axis):
    """A centre that leaves the base outside."""
    return np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])


@pytest.mark.parametrize(
    ("yaw", "pitch", "axis"),
    [
        (0, 0, (0, 1, 0)),
        (math.pi / 2, 0, (-1, 0, 0)),
        (0, math.pi / 2, (0, 0, 1)),
        (math.pi / 6, 0, (-0.5, math.sqrt(0.75), 0)),
        (math.pi, math.pi / 6, (0, -math.sqrt(0.75), 0.5)),
    ],
)
def test_yaw_and_pitch_by_hand(yaw, pitch, axis):
    assert branch_axis(yaw, pitch) == pytest.approx(axis, abs=1e-15)


@given(reals(-10, 10), reals(-10, 10))
def test_yaw_and_pitch_give_a_unit_axis(yaw, pitch):
    assert np.linalg.norm(branch_axis(yaw, pitch)) == pytest.approx(1, abs=1e-15)


@pytest.mark.parametrize("angles", [(math.nan, 0), (0, math.inf), ("1", 0)])
def test_an_angle_that_is_no_number_is_refused(angles):
    with pytest.raises(ParameterError, match=r"^(yaw|pitch) = "):
        branch_axis(*angles)


@given(AXES, st.sampled_from([1e-300, 1e-160, 1.0, 1e160, 1e300]))
def test_an_axis_of_any_length_is_stored_as_a_unit_vector(axis, length):
    stored = Branch(1e-3, across(axis), axis * length).axis
    assert np.linalg.norm(stored) == pytest.approx(1, abs=1e-15)
    assert np.cross(stored, axis) == pytest.approx(0, abs=1e-14)
    assert stored @ axis > 0


def test_an_infinite_branch_along_y_is_the_default():
    branch = Branch(1, (0, 0, -1))
    assert branch.axis.tolist() == [0, 1, 0]
    assert branch.length is None
    assert branch.half_length == math.inf
    assert branch.batch_shape == ()
    assert type(branch.radius) is float


def test_what_it_is_given_is_copied_and_cannot_be_written():
    centre, radius = np.array([0.0, 0.0, -3.0]), np.array([1.0, 2.0])
    branch = Branch(radius, centre, length=radius)
    centre[2], radius[0] = 0.0, 9.0
    assert branch.centre[2] == -3.0
    assert branch.radius[0] == 1.0
    for name in ("radius", "centre", "axis", "length"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(branch, name)[0] = 1
    with pytest.raises(dataclasses.FrozenInstanceError):
        branch.radius = 2.0


def test_fields_broadcast_against_one_another():
    branch = Branch(np.ones((4, 1)), (0, 0, -2), [(0, 1, 0)] * 3)
    assert branch.batch_shape == (4, 3)
    assert branch.broadcast((2, 4, 3)).batch_shape == (24,)
    with pytest.raises(ValueError, match=r"shape and branch = .* is not broadcastable"):
        branch.broadcast((5,))


def test_an_index_takes_branches_out_of_a_batch():
    radii = np.arange(1.0, 7.0).reshape(2, 3)
    batch = Branch(radii, (0, 0, -9), length=radii)
    assert batch[1, 2].radius == batch[1, 2].length == 6.0
    assert batch[1, 2].centre.tolist() == [0, 0, -9]
    assert batch[1].radius.tolist() == [4, 5, 6]
    assert batch[..., 0].radius.tolist() == [1, 4]
    assert batch[radii > 4].radius.tolist() == [5, 6]
    assert batch[1:, :2].batch_shape == (1, 2)
    assert [branch.radius for branch in batch.broadcast((2, 3))] == [1, 2, 3, 4, 5, 6]
    with pytest.raises(ValueError, match="read-only"):
        batch[1].radius[0] = 1


def test_entries_are_those_of_the_broadcast_branch():
    radii = np.arange(1.0, 4.0)
    batch = Branch(radii, [[(0, 0, -9)], [(0, 0, -8)]])  # (2, 3)
    every, part = batch.broadcast((4, 2, 3)), slice(5, 11)
    some = batch.entries((4, 2, 3), part)
    assert some.batch_shape == (6,)
    assert (some.radius == every.radius[part]).all()
    assert (some.centre == every.centre[part]).all()
    one = Branch(1, (0, 0, -9)).entries((7,), slice(2, 5))
    assert one.batch_shape == ()
    assert one.radius == 1.0


def test_what_is_known_of_a_batch_by_hand():
    batch = Branch([1.0, 2.0], [(0, 0, -3), (1.6, 7, -1.2)], length=[4.0, 6.0])
    assert batch.half_length.tolist() == [2, 3]
    assert batch.largest_extent == pytest.approx(2 + math.sqrt(1.6**2 + 49 + 1.2**2))
    assert batch.least_radius == 1.0
    # The second's axis passes the origin at 2 m, on the bark; its end is at y = 4.
    assert batch.holds_origin.tolist() == [False, False]
    assert Branch(
        [1, 1, 1], [(0, y, -0.5) for y in (0, 2, 4)], length=5
    ).holds_origin.tolist() == [True, True, False]
    for name in ("half_length", "holds_origin"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(batch, name)[0] = 0


def test_one_taken_out_is_one_branch():
    one = Branch(np.array([1.0, 2.0]), (0, 0, -9))[1]
    assert one.batch_shape == ()
    assert type(one.radius) is float
    assert one.length is None


def test_one_branch_has_no_index():
    with pytest.raises(IndexError):
        Branch(1, (0, 0, -9))[0]


@given(AXES, AXES)
def test_the_frame_is_a_rotation_with_the_axis_last(axis, reference):
    frame = Branch(1e-3, across(axis), axis).frame(
        reference / np.linalg.norm(reference)
    )
    assert frame.T @ frame == pytest.approx(np.eye(3), abs=1e-14)
    assert np.linalg.det(frame) == pytest.approx(1)
    unit = axis / np.linalg.norm(axis)
    assert frame[:, 2] == pytest.approx(unit, abs=1e-15)


def test_the_frame_leans_on_its_reference():
    frame = Branch(1, (0, 0, -2)).frame()
    assert frame == pytest.approx(np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0]]).T)
    along = Branch(1, (0, 0, -2)).frame((0, 1, 0))  # no direction across to lean on
    assert np.linalg.det(along) == pytest.approx(1)


@given(AXES, hnp.arrays(np.float64, 3, elements=reals(-5, 5)))
def test_the_base_distance_is_the_least_over_the_axis(axis, centre):
    axis = axis / np.linalg.norm(axis)
    distance = float(np.linalg.norm(np.cross(centre, axis)))
    if distance > 0.01:
        assert Branch(0.01, centre, axis).base_distance() == pytest.approx(distance)


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"radius": 0}, "branch.radius = 0.0 is not a positive number, from"),
        ({"radius": -1}, "branch.radius = -1.0"),
        ({"radius": [1, math.nan]}, r"branch.radius\[1\] = nan is not finite"),
        ({"radius": "thick"}, "branch.radius = 'thick' is not an array of numbers"),
        ({"centre": (0, 0)}, r"branch.centre.shape = \(2,\)"),
        ({"centre": (0, 0, math.inf)}, r"branch.centre\[2\] = inf"),
        ({"axis": (0, 0, 0)}, "branch.axis.norm = 0.0 is not positive: give a direc"),
        ({"axis": (0, math.nan, 0)}, r"branch.axis\[1\] = nan"),
        ({"axis": [(0, 1, 0), (0, 0, 0)]}, r"branch.axis.norm\[1\] = 0.0"),
        ({"length": 0}, "branch.length = 0.0 is not a positive number"),
        ({"length": math.inf}, "branch.length = inf is not finite"),
        ({"radius": [1, 1], "length": [1, 1, 1]}, "radius, centre, axis and length"),
    ],
)
def test_what_is_no_branch_is_one_line(values, message):
    with pytest.raises(ParameterError, match=message) as caught:
        Branch(**{"radius": 1.0, "centre": (0, 0, -2), **values})
    assert "\n" not in str(caught.value)


def test_a_branch_that_holds_the_base_is_refused_for_a_foot_at_the_origin():
    with pytest.raises(
        ParameterError, match=r"axis = 0\.5 is not at least .* move the centre away"
    ):
        check_base(Branch(1, (0, 0, -0.5)))
    with pytest.raises(ParameterError, match=r"axis\[1\] = 1\.0"):
        check_base(Branch([1, 2], (0, 0, -1)))
    with pytest.raises(ParameterError, match="holds the base"):
        check_base(Branch(1, (0, 0, -2)).moved_to((0, 0, 0)))
    with pytest.raises(ParameterError, match="holds the base"):
        check_base(Branch(1, (0, 5, -0.5), length=11))


def test_a_branch_without_a_foot_may_lie_at_the_origin():
    branch = Branch(0.01, (0, 0, 0))
    assert branch.base_distance() == 0.0
    assert branch.moved_to((0, 0, 0.005)).base_distance() == 0.005


@given(reals(1e-6, 1e6), reals(-3, 3))
def test_the_base_may_sit_on_the_bark(radius, pitch):
    # The paper's own branch: axis at x = 0, z = -r; pitched, the same distance away.
    level = Branch(radius, (0, 0, -radius))
    assert level.base_distance() == radius
    check_base(level)
    across = (0, radius * math.sin(pitch), -radius * math.cos(pitch))
    check_base(Branch(radius, across, branch_axis(0, pitch)))


def test_the_base_may_be_within_the_radius_beyond_an_end():
    stump = Branch(1, (0, 5, -0.5), length=9)
    assert stump.base_distance() == 0.5
    check_base(stump)


def test_a_branch_moves_with_everything_else_kept():
    branch = Branch(1, (0, 0, -2), (1, 1, 0), length=3)
    moved = branch.moved_to((0, 0, -4))
    assert moved.centre.tolist() == [0, 0, -4]
    assert (moved.radius, moved.length) == (1, 3)
    assert moved.axis == pytest.approx(branch.axis)


@pytest.mark.parametrize(("yaw", "pitch"), [(0.0, 0.0), (0.6, 0.3), (-1.2, -0.9)])
def test_yaw_and_pitch_are_read_back_from_either_direction(yaw, pitch):
    axis = branch_axis(yaw, pitch)
    assert yaw_and_pitch(axis) == pytest.approx((yaw, pitch), abs=1e-15)
    assert yaw_and_pitch(-2 * axis) == pytest.approx((yaw, pitch), abs=1e-15)
