"""The exact engine: brute force, hand-worked branches, and the laws of distance."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.spatial.transform import Rotation
from strategies import reals

from zygopin.branch import Branch, branch_axis
from zygopin.clearance import branch_clearance, segment_distance, skin_distance
from zygopin.foot import GOLDEN_MEAN, Finger, Foot
from zygopin.kinematics import forward_kinematics

POINTS = hnp.arrays(np.float64, 3, elements=reals(-2, 2))
SEGMENTS = hnp.arrays(np.float64, (2, 3), elements=reals(-2, 2)).filter(
    lambda s: np.linalg.norm(s[1] - s[0]) > 1e-3
)


def solid_distance(points, branch):
    """Signed distance of points (n, 3) to one capped cylinder, by its definition."""
    offset = points - branch.centre
    along = offset @ branch.axis
    side = np.linalg.norm(offset - along[:, None] * branch.axis, axis=1)
    faces = np.stack([side - branch.radius, np.abs(along) - branch.half_length], 1)
    outside = np.linalg.norm(np.maximum(faces, 0), axis=1)
    return outside + np.minimum(faces.max(axis=1), 0)


def least(function, rounds=9, count=31):
    """Least value of a convex function on [0, 1], by sampling ever more densely."""
    low, high = 0.0, 1.0
    for _ in range(rounds):
        t = np.linspace(low, high, count)
        values = function(t)
        best = int(np.argmin(values))
        low, high = t[max(best - 1, 0)], t[min(best + 1, count - 1)]
    return float(values.min())


def brute_clearance(bone, branch):
    line = bone[1] - bone[0]
    return least(lambda t: solid_distance(bone[0] + t[:, None] * line, branch))


def point_to_segment(points, segment):
    line = segment[1] - segment[0]
    t = np.clip((points - segment[0]) @ line / (line @ line), 0, 1)
    return np.linalg.norm(points - segment[0] - t[:, None] * line, axis=1)


def brute_segments(one, other):
    line = one[1] - one[0]
    return least(lambda t: point_to_segment(one[0] + t[:, None] * line, other))


def one_clearance(bone, branch, radius=0.0):
    """The record of a single bone: every field without its last batch axis."""
    record = branch_clearance(np.array([bone], float), np.array([radius]), branch)
    return {name: getattr(record, name)[0] for name in record.__annotations__}


@st.composite
def branches(draw, finite):
    """A branch anywhere, the base outside it."""
    axis = draw(POINTS.filter(lambda a: np.linalg.norm(a) > 0.1))
    across = np.cross(axis, draw(POINTS))
    centre = across / max(np.linalg.norm(across), 1e-3) + draw(reals(-1, 1)) * axis
    axis = axis / np.linalg.norm(axis)
    far = np.linalg.norm(centre - (centre @ axis) * axis)
    radius = max(far * draw(reals(0.02, 1.0)), 1e-3)
    if far < radius:
        centre, radius = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))]), 0.1
    length = draw(reals(0.01, 3)) if finite else None
    return Branch(radius, centre, axis, length)


# Brute force ---------------------------------------------------------------------


@pytest.mark.parametrize("finite", [False, True])
def test_clearance_is_that_of_brute_force(finite):
    rng = np.random.default_rng(finite)
    faces = set()
    for _ in range(200):
        bone = rng.normal(size=(2, 3))
        axis = rng.normal(size=3)
        centre = np.cross(axis, rng.normal(size=3)) + rng.normal() * axis
        length = rng.uniform(0.05, 4) if finite else None
        radius = rng.uniform(0.1, 1) * np.linalg.norm(np.cross(centre, axis))
        radius /= np.linalg.norm(axis)
        branch = Branch(radius, centre, axis, length)
        found = one_clearance(bone, branch)
        assert found["distance"] == pytest.approx(
            brute_clearance(bone, branch), abs=1e-9
        )
        faces.add((bool(found["lateral"]), bool(found["distance"] < 0)))
    if finite:
        assert faces == {(False, False), (False, True), (True, False), (True, True)}


@given(SEGMENTS, st.booleans().flatmap(branches), reals(0, 0.3))
def test_the_record_proves_itself(bone, branch, radius):
    found = one_clearance(bone, branch, radius)
    t = np.clip(found["t"], 0, 1)
    core = bone[0] + t * (bone[1] - bone[0])
    assert np.linalg.norm(found["normal"]) == pytest.approx(1)
    reach = found["distance"] + radius
    assert core - reach * found["normal"] == pytest.approx(found["point"], abs=1e-12)
    assert solid_distance(found["point"][None], branch) == pytest.approx(0, abs=1e-9)
    assert solid_distance(core[None], branch) == pytest.approx(reach, abs=1e-9)
    if found["lateral"]:
        assert found["normal"] @ branch.axis == pytest.approx(0, abs=1e-9)


@settings(max_examples=20)
@given(SEGMENTS, SEGMENTS)
def test_segment_distance_is_that_of_brute_force(one, other):
    expected = brute_segments(one, other)
    assert segment_distance(one, other) == pytest.approx(expected, abs=1e-9)
    assert segment_distance(other, one) == pytest.approx(expected, abs=1e-9)


@settings(max_examples=20)
@given(SEGMENTS, POINTS, reals(-2, 2), reals(0.1, 2), reals(-16, -3))
def test_segments_that_are_nearly_parallel(one, offset, start, length, power):
    # From parallel up to rounding to a millirad apart.
    line = (one[1] - one[0]) / np.linalg.norm(one[1] - one[0])
    begin = one[0] + start * line + offset
    turned = line + 10.0**power * np.cross(line, (0.3, 0.5, 0.8))
    other = np.stack([begin, begin + length * turned])
    expected = brute_segments(one, other)
    assert segment_distance(one, other) == pytest.approx(expected, abs=2e-8)


@pytest.mark.parametrize(
    ("other", "distance"),
    [
        ([(0.5, -1, 0), (0.5, 1, 0)], 0.0),  # crossing
        ([(0.5, -1, 3), (0.5, 1, 3)], 3.0),  # skew
        ([(0.2, 2, 0), (0.8, 2, 0)], 2.0),  # parallel, side by side
        ([(4, 3, 0), (9, 3, 0)], math.hypot(3, 3)),  # parallel, one past the other
        ([(4, 0, 0), (9, 0, 0)], 3.0),  # on one line
        ([(0.5, 0, 0), (0.7, 0, 0)], 0.0),  # one inside the other
        ([(2, 1, 0), (2, 5, 0)], math.sqrt(2)),  # end to end
    ],
)
def test_segment_distance_by_hand(other, distance):
    one = np.array([(0, 0, 0), (1, 0, 0)], float)
    assert segment_distance(one, np.array(other, float)) == pytest.approx(distance)


@pytest.mark.parametrize("slope", [1e-3, 1e-5, 5e-8])
def test_segments_that_cross_at_a_small_angle_meet(slope):
    one = np.array([(-0.5, 0, 0), (0.5, 0, 0)])
    other = np.array([(-0.5, -slope / 2, 0), (0.5, slope / 2, 0)])
    assert segment_distance(one, other) < slope / 5


def test_skin_distance_takes_both_skins_off():
    bones = np.array([[(0, 0, 0), (1, 0, 0)], [(0, 3, 0), (1, 3, 0)]], float)
    pair = (np.array([0]), np.array([1]))
    assert skin_distance(bones, np.array([0.5, 1.0]), pair) == pytest.approx(1.5)
    assert skin_distance(bones, np.array([2.0, 1.5]), pair) == pytest.approx(-0.5)


# By hand -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("bone", "distance", "t", "point", "normal"),
    [
        # Branch of radius 1 along y, its axis at z = -3.
        ([(-1, 0, 0), (3, 0, 0)], 2, 0.25, (0, 0, -2), (0, 0, 1)),
        ([(3, 5, -3), (3, 5, -7)], 2, 0, (1, 5, -3), (1, 0, 0)),  # abreast at t = 0
        ([(0, 0, 0), (0, 4, 0)], 2, 0.5, (0, 2, -2), (0, 0, 1)),  # parallel
        ([(0, 0, 0), (0, 1, -2.5)], -0.5, 1.2, (0, 1, -2), (0, 0, 1)),  # inside
        ([(6, 0, 0), (9, 0, 0)], math.sqrt(45) - 1, -2, None, None),  # off the bone
    ],
)
def test_clearance_by_hand(bone, distance, t, point, normal):
    found = one_clearance(bone, Branch(1, (0, 0, -3)))
    assert found["distance"] == pytest.approx(distance)
    assert found["t"] == pytest.approx(t)
    assert found["lateral"]
    if point:
        assert found["point"] == pytest.approx(point, abs=1e-12)
        assert found["normal"] == pytest.approx(normal, abs=1e-12)


@pytest.mark.parametrize(
    ("bone", "distance", "t", "point", "normal", "lateral"),
    [
        # Branch of radius 1 along y from y = 2 to y = 6, its axis at z = -3.
        ([(-1, 4, 0), (1, 4, 0)], 2, 0.5, (0, 4, -2), (0, 0, 1), True),
        ([(0, -3, -3), (0, -1, -3)], 3, 1, (0, 2, -3), (0, -1, 0), False),  # its end
        ([(-1, -2, 1), (1, -2, 1)], 5, 0.5, (0, 2, -2), (0, -0.8, 0.6), False),  # rim
        ([(0, 0, -3), (0, 2.5, -3)], -0.5, 1, (0, 2, -3), (0, -1, 0), False),  # inside
        ([(0, 1, -2.5), (0, 9, -2.5)], -0.5, None, None, (0, 0, 1), True),  # through
    ],
)
def test_clearance_from_a_finite_branch_by_hand(
    bone, distance, t, point, normal, lateral
):
    found = one_clearance(bone, Branch(1, (0, 4, -3), length=4))
    assert found["distance"] == pytest.approx(distance)
    assert found["normal"] == pytest.approx(normal, abs=1e-9)
    assert found["lateral"] == lateral
    if point:
        assert found["t"] == pytest.approx(t)
        assert found["point"] == pytest.approx(point, abs=1e-9)


def paper_second_phalanx(radius, azimuth=math.pi / 12):
    """Finger 2's second phalanx, closed, on the branch with axis x = 0, z = -r."""
    foot = Foot(fingers=(Finger("toe", 3, azimuth),))
    bones = forward_kinematics(foot, np.ones(3))
    return {
        name: value[1]
        for name, value in vars(
            branch_clearance(bones, foot.radii, Branch(radius, (0, 0, -radius)))
        ).items()
    }


def test_the_true_section_touches_the_second_phalanxs_line_off_the_bone():
    # Row 13 of the errata: v = 1, ω = π/6, Ω = π/12, golden mean.
    x1 = np.exp(-1j * math.pi / 6) / GOLDEN_MEAN
    angle = math.pi / 3
    # Projected along y lengths in x shrink by cos Ω; n is across the projection.
    start = complex(x1.real * math.cos(math.pi / 12), x1.imag)
    line = complex(math.cos(angle) * math.cos(math.pi / 12), -math.sin(angle))
    normal = 1j * line / abs(line)
    along = (normal.conjugate() * start).real  # n·x = n·c + r, c = (0, -r)
    radius = along / (1 - normal.imag)
    assert radius == pytest.approx(0.5868, abs=5e-5)
    found = paper_second_phalanx(radius)
    assert found["t"] == pytest.approx(-0.024, abs=5e-4)
    assert found["distance"] > 0  # the bone itself does not reach


def test_the_circles_own_reading_touches_at_the_junction():
    # Row 13: a finger in the xz-plane gives 1/φ, t = 0.
    found = paper_second_phalanx(1 / GOLDEN_MEAN, azimuth=0.0)
    assert found["distance"] == pytest.approx(0, abs=1e-15)
    assert found["t"] == pytest.approx(0, abs=1e-12)


def test_the_first_phalanx_penetrates_the_captions_branch():
    foot = Foot()
    bones = forward_kinematics(foot, np.ones(14))
    near = branch_clearance(bones, foot.radii, Branch(0.58, (0, 0, -0.58)))
    assert near.distance[2] < -0.05  # finger 2, first phalanx


@given(SEGMENTS, reals(0.1, 1), reals(-1.5, 1.5), reals(-1.3, 1.3), reals(0.01, 0.99))
def test_a_branch_on_the_line_of_a_bone_is_tangent_to_it(bone, radius, yaw, pitch, t):
    # Linear condition: n·x = n·c + r with n across bone and axis.
    axis = branch_axis(yaw, pitch)
    normal = np.cross(axis, bone[1] - bone[0])
    if np.linalg.norm(normal) < 1e-3:
        return
    normal /= np.linalg.norm(normal)
    centre = bone[0] + t * (bone[1] - bone[0]) - radius * normal + 0.7 * axis
    if np.linalg.norm(np.cross(centre, axis)) < radius:
        return
    found = one_clearance(bone, Branch(radius, centre, axis))
    assert found["distance"] == pytest.approx(0, abs=1e-12)
    assert found["t"] == pytest.approx(t, abs=1e-7)
    assert found["normal"] == pytest.approx(normal, abs=1e-9)
    assert normal @ bone[0] == pytest.approx(normal @ centre + radius, abs=1e-12)


# Laws ----------------------------------------------------------------------------


@given(SEGMENTS, branches(finite=False), reals(0, 0.5))
def test_thickness_only_turns_the_radius_into_radius_plus_skin(bone, branch, skin):
    # The wider branch may hold the base: build it from one that does not.
    thin = Branch(branch.radius / 2, branch.centre, branch.axis)
    skin = skin * thin.radius
    wide = Branch(thin.radius + skin, branch.centre, branch.axis)
    thick, bare = one_clearance(bone, thin, skin), one_clearance(bone, wide)
    assert thick["distance"] == pytest.approx(bare["distance"], abs=1e-14)
    assert thick["t"] == bare["t"]
    assert (thick["normal"] == bare["normal"]).all()


@given(SEGMENTS, st.booleans().flatmap(branches), st.integers(0, 2**32 - 1))
def test_turning_bones_and_branch_together_changes_nothing(bone, branch, seed):
    turn = Rotation.random(None, np.random.default_rng(seed)).as_matrix()
    moved = Branch(
        branch.radius, turn @ branch.centre, turn @ branch.axis, branch.length
    )
    one, other = one_clearance(bone, branch), one_clearance(bone @ turn.T, moved)
    assert other["distance"] == pytest.approx(one["distance"], abs=1e-12)
    assert other["distance"] < 9


@given(SEGMENTS, st.booleans().flatmap(branches))
def test_the_axis_has_no_sense_and_the_bone_no_direction_for_the_distance(bone, branch):
    flipped = Branch(branch.radius, branch.centre, -branch.axis, branch.length)
    there, back = one_clearance(bone, branch), one_clearance(bone[::-1], flipped)
    assert back["distance"] == pytest.approx(there["distance"], abs=1e-12)


@given(SEGMENTS, branches(finite=False), reals(-3, 3))
def test_an_infinite_branch_may_slide_along_its_axis(bone, branch, way):
    moved = branch.moved_to(branch.centre + way * branch.axis)
    one, other = one_clearance(bone, branch), one_clearance(bone, moved)
    assert other["distance"] == pytest.approx(one["distance"], abs=1e-12)


@given(SEGMENTS, st.booleans().flatmap(branches), POINTS, reals(0, 1))
def test_clearance_is_convex_and_lipschitz_in_the_bones_place(bone, branch, way, part):
    # Moving the bone is moving the centre the other way.
    def clearance(offset):
        return float(one_clearance(bone + offset, branch)["distance"])

    start, end = clearance(0 * way), clearance(way)
    assert abs(end - start) <= np.linalg.norm(way) + 1e-12
    between = clearance(part * way)
    assert between <= (1 - part) * start + part * end + 1e-12


@given(SEGMENTS, branches(finite=True))
def test_a_longer_branch_is_never_farther(bone, branch):
    lengths = np.array([1.0, 1.5, 4.0, 1e6]) * branch.length
    longer = Branch(branch.radius, branch.centre, branch.axis, lengths[:, None])
    nested = branch_clearance(bone[None], np.zeros(1), longer[:, 0]).distance
    assert (np.diff(nested, axis=0) <= 1e-12).all()


def test_very_long_is_infinite():
    rng = np.random.default_rng(7)
    bones = rng.normal(size=(200, 1, 2, 3))
    infinite = Branch(0.5, (0, 0, -1), (1, 1, 0.2))
    long = Branch(0.5, (0, 0, -1), (1, 1, 0.2), length=100)
    one, other = (branch_clearance(bones, np.zeros(1), b) for b in (infinite, long))
    for name in one.__annotations__:
        assert (getattr(one, name) == getattr(other, name)).all()


def test_a_bone_through_the_axis_has_a_normal_across_both():
    found = one_clearance([(0, 0, 0), (0, 0, -4)], Branch(1, (0, 0, -2)))
    assert found["distance"] == -1
    assert found["t"] == pytest.approx(0.5)
    assert np.abs(found["normal"]) == pytest.approx((1, 0, 0))


def test_a_bone_along_the_axis_has_a_normal_too():
    branch = Branch(0.5, (0, 0, -3), (0, 0, 1), length=2)
    for bone in ([(0, 0, -1), (0, 0, -3)], [(0, 0, -2.9), (0, 0, -3.1)]):
        found = one_clearance(bone, branch)
        assert np.linalg.norm(found["normal"]) == pytest.approx(1)
        assert found["distance"] == pytest.approx(-0.5)


@pytest.mark.parametrize(("slope", "t"), [(1e-11, 2e11), (1e-7, 2e7), (1e-13, 0.5)])
def test_a_bone_is_parallel_to_the_axis_up_to_rounding_only(slope, t):
    # It sinks towards an axis 2 below, which its line meets 2 / slope further on.
    found = one_clearance([(0, 0, 0), (0, 1, -slope)], Branch(1, (0, 0, -2)))
    assert found["t"] == pytest.approx(t)
    assert found["distance"] == pytest.approx(1 - slope * min(t, 1), abs=1e-15)


def test_a_bone_just_off_a_thin_axis_has_the_normal_of_its_side():
    branch = Branch(1e-3, (0, 0, -2))
    for side in (1e-11, -1e-11):
        found = one_clearance([(side, 0, -1), (side, 0, -3)], branch)
        assert found["normal"] == pytest.approx((math.copysign(1, side), 0, 0))


def test_a_short_bone_nearly_along_the_axis_has_a_normal_across_both():
    # The bone leaves the axis in the plane of y and z, so x is across both.
    bone = [(0, 0, -2), (0, 1e-3, -2 + 1e-10)]
    found = one_clearance(bone, Branch(1, (0, 0, -2)))
    assert np.abs(found["normal"]) == pytest.approx((1, 0, 0))


# Batches -------------------------------------------------------------------------


@pytest.mark.parametrize("length", [None, np.full((4, 1), 0.7)])
def test_a_batch_is_a_loop(length):
    foot = Foot.preset("paper")
    rng = np.random.default_rng(8)
    bones = forward_kinematics(foot, rng.random((3, 14)))
    radius = rng.uniform(0.1, 0.4, (4, 1))
    branch = Branch(radius, (0.1, 0.2, -0.6), (0.1, 1, 0.2), length)
    batch = branch_clearance(bones, foot.radii, branch)
    assert batch.distance.shape == (4, 3, 14)
    assert batch.normal.shape == batch.point.shape == (4, 3, 14, 3)
    for i, j in np.ndindex(4, 3):
        one = branch_clearance(bones[j], foot.radii, branch[i, 0])
        for name in one.__annotations__:
            assert (getattr(batch, name)[i, j] == getattr(one, name)).all()
