"""Clearance to any solid: two engines, brute force, an optimiser, and the laws."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation
from strategies import reals

from zygopin.branch import Branch
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.obstacle import Box, Capsule, ConvexMesh, Sphere
from zygopin.solid_clearance import obstacle_clearance

CUBE = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float)
SEGMENTS = hnp.arrays(np.float64, (2, 3), elements=reals(-2, 2)).filter(
    lambda s: np.linalg.norm(s[1] - s[0]) > 1e-3
)
KINDS = ("sphere", "capsule", "box", "mesh", "branch", "stump")
ROUND = ("sphere", "capsule")


def solid(kind, seed=0, scale=1.0, turn=None, shift=(0.0, 0.0, 0.0)):
    """An obstacle near the origin, scaled, then moved rigidly."""
    rng = np.random.default_rng(seed)
    own = Rotation.random(None, rng).as_matrix()
    ends, points = rng.normal(size=(2, 3)) * 0.5, rng.normal(size=(30, 3)) * 0.4
    turn = np.eye(3) if turn is None else turn

    def placed(x):
        return scale * np.asarray(x) @ turn.T + shift

    centre, axis = placed((0.1, -0.2, 0.1)), turn @ own[0]
    made = {
        "sphere": lambda: Sphere(0.5 * scale, centre),
        "capsule": lambda: Capsule(0.3 * scale, placed(ends)),
        "box": lambda: Box(np.array([0.5, 0.8, 0.3]) * scale, centre, turn @ own),
        "mesh": lambda: ConvexMesh(placed(points)),
        "branch": lambda: Branch(0.3 * scale, centre, axis),
        "stump": lambda: Branch(0.3 * scale, centre, axis, 0.8 * scale),
    }
    return made[kind]()


def scattered(count, seed):
    """Bones around the origin, one to a row: (count, 1, 2, 3)."""
    rng = np.random.default_rng(seed)
    start = rng.normal(size=(count, 3)) * 0.7
    return np.stack([start, start + rng.normal(size=(count, 3)) * 0.4], 1)[:, None]


def gap(bones, obstacle, **options):
    """Distances of bare bones (…, 1, 2, 3)."""
    return obstacle_clearance(bones, [0.0], obstacle, **options).distance[..., 0]


def one(bone, obstacle, radius=0.0, **options):
    """The record of a single bone: every field without its last batch axis."""
    record = obstacle_clearance([bone], [radius], obstacle, **options)
    return {name: getattr(record, name)[0] for name in record.__annotations__}


def point_gap(points, obstacle):
    """Signed distance of points (n, 3) to a solid, by its definition.

    For a mesh minus the depth inside, and outside only a lower bound.
    """
    if isinstance(obstacle, Sphere):
        return np.linalg.norm(points - obstacle.centre, axis=1) - obstacle.radius
    if isinstance(obstacle, Capsule):
        start, line = obstacle.ends[0], obstacle.ends[1] - obstacle.ends[0]
        t = np.clip((points - start) @ line / (line @ line), 0, 1)[:, None]
        return np.linalg.norm(points - start - t * line, axis=1) - obstacle.radius
    if isinstance(obstacle, Box):
        local = np.abs((points - obstacle.centre) @ obstacle.rotation)
        past = local - obstacle.size / 2
        outside = np.linalg.norm(np.maximum(past, 0), axis=1)
        return outside + np.minimum(past.max(axis=1), 0)
    return (points @ obstacle.planes[:, :3].T - obstacle.planes[:, 3]).max(axis=1)


def sampled(bone, obstacle, rounds=12, count=31):
    """Least signed distance along a bone, by sampling ever more densely."""
    low, high = 0.0, 1.0
    for _ in range(rounds):
        t = np.linspace(low, high, count)
        values = point_gap(bone[0] + t[:, None] * (bone[1] - bone[0]), obstacle)
        best = int(np.argmin(values))
        low, high = t[max(best - 1, 0)], t[min(best + 1, count - 1)]
    return float(values.min())


def optimised(bone, vertices):
    """Distance from a bone to the hull of some points, as a quadratic programme."""
    count = len(vertices)
    matrix = np.column_stack([bone[1] - bone[0], -vertices.T])
    found = minimize(
        lambda x: float(((bone[0] + matrix @ x) ** 2).sum()),
        np.r_[0.5, np.full(count, 1 / count)],
        jac=lambda x: 2 * matrix.T @ (bone[0] + matrix @ x),
        bounds=[(0, 1)] * (count + 1),
        constraints={"type": "eq", "fun": lambda x: x[1:].sum() - 1},
        method="SLSQP",
        options={"ftol": 1e-16, "maxiter": 500},
    )
    return math.sqrt(found.fun)


# Independent routes --------------------------------------------------------------


@pytest.mark.parametrize("kind", ["sphere", "capsule", "box"])
def test_clearance_is_that_of_dense_sampling(kind):
    obstacle, bones = solid(kind), scattered(150, seed=1)
    expected = [sampled(bone, obstacle) for bone in bones[:, 0]]
    assert gap(bones, obstacle) == pytest.approx(expected, abs=1e-12)
    assert 0.02 < np.mean(np.less(expected, 0)) < 0.5


def test_clearance_from_a_mesh_is_that_of_an_optimiser_and_of_its_planes():
    obstacle, bones = solid("mesh"), scattered(60, seed=2)
    found = gap(bones, obstacle)
    for bone, distance in zip(bones[:, 0], found, strict=True):
        if distance > 0:
            expected = optimised(bone, obstacle.vertices)
            assert distance == pytest.approx(expected, abs=1e-7)
        else:
            assert distance == pytest.approx(sampled(bone, obstacle), abs=1e-12)
    assert 0.1 < (found > 0).mean() < 0.9


@pytest.mark.parametrize("scale", [1e-5, 1.0, 1e3])
@pytest.mark.parametrize("kind", KINDS)
def test_the_engines_agree_outside(kind, scale):
    # FCL's search stalls on one bone in a thousand near a box or mesh, 6e-4 off.
    obstacle, bones = solid(kind, scale=scale), scattered(300, seed=3) * scale
    exact, other = (
        obstacle_clearance(bones, [0.0], obstacle, engine=name)
        for name in ("exact", "fcl")
    )
    clear = exact.distance > 1e-3 * scale
    off = np.abs(exact.distance - other.distance)[clear] / scale
    assert clear.mean() > 0.3
    assert np.quantile(off, 0.9) < 1e-12 if kind != "stump" else np.median(off) < 1e-6
    assert off.max() < 1e-3
    share = 0.98 if kind in ("box", "mesh") else 1.0
    if kind != "stump":
        turned = np.abs(exact.normal - other.normal)[clear]
        assert np.quantile(turned, share) < 1e-9
        moved = np.abs(exact.point - other.point)[clear]
        assert np.quantile(moved, share) < 1e-9 * scale


@pytest.mark.parametrize("kind", KINDS)
def test_the_engines_agree_inside_as_far_as_they_mean_the_same(kind):
    obstacle, bones = solid(kind), scattered(300, seed=4)
    exact, other = (gap(bones, obstacle, engine=name) for name in ("exact", "fcl"))
    inside = exact < -1e-6
    assert inside.sum() > 10
    assert (other[inside] - exact[inside]).max() < 1e-6
    if kind in (*ROUND, "branch"):
        assert other[inside] == pytest.approx(exact[inside], abs=1e-12)


@pytest.mark.parametrize("thickness", [1.0, 1e-3, 1e-6])
@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_near_a_touch_both_engines_are_true(thickness, engine):
    # A bone that stands on a plate, a little above its top or below.
    plate = Box((1, 1, thickness), (0, 0, -thickness / 2))
    rng = np.random.default_rng(5)
    start = np.append(rng.uniform(-0.3, 0.3, 2), 0.0)
    for height in (1e-3, 1e-6, 1e-9, 0.0, -1e-9, -0.01 * thickness):
        bone = np.array([start, start + np.array((0.1, 0.2, 0.3))])
        bone[:, 2] += height
        found = one(bone, plate, engine=engine)
        assert found["distance"] == pytest.approx(height, abs=1e-14)
        if abs(height) > 1e-7:
            assert found["normal"] == pytest.approx((0, 0, 1), abs=1e-6)


# By hand -------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("obstacle", "bone", "distance", "t", "point", "normal"),
    [
        # A ball of radius 1 at z = -2.
        (Sphere(1, (0, 0, -2)), [(-1, 0, 0), (1, 0, 0)], 1, 0.5, (0, 0, -1), (0, 0, 1)),
        (Sphere(1, (0, 0, -2)), [(0, 0, 0), (0, 0, -1.5)], -0.5, 4 / 3, None, None),
        (Sphere(1, (0, 0, -2)), [(3, 4, -2), (6, 8, -2)], 4, -1, (0.6, 0.8, -2), None),
        (Sphere(1, (0, 0, -2)), [(-1, 0, -2), (1, 0, -2)], -1, 0.5, None, None),
        # A capsule of radius 1 about the y axis from 0 to 2.
        (
            Capsule(1, [(0, 0, 0), (0, 2, 0)]),
            [(-1, 1, 3), (1, 1, 3)],
            2,
            0.5,
            (0, 1, 1),
            (0, 0, 1),
        ),
        (
            Capsule(1, [(0, 0, 0), (0, 2, 0)]),
            [(-1, 6, 3), (1, 6, 3)],
            4,
            0.5,
            (0, 2.8, 0.6),
            (0, 0.8, 0.6),
        ),
        # A box from -1 to 1 along x, -2 to 2 along y, -3 to 3 along z.
        (Box((2, 4, 6), (0, 0, 0)), [(4, 0, 0), (5, 0, 1)], 3, None, (1, 0, 0), None),
        (Box((2, 4, 6), (0, 0, 0)), [(4, 6, -1), (4, 6, 1)], 5, None, None, None),
        (
            Box((2, 4, 6), (0, 0, 0)),
            [(-2, 3, 4), (2, 3, 4)],
            math.sqrt(2),
            None,
            None,
            (0, math.sqrt(0.5), math.sqrt(0.5)),
        ),
        (Box((2, 4, 6), (0, 0, 0)), [(0.5, 0, 0), (4, 0, 0)], -0.5, -1 / 7, None, None),
        (Box((2, 4, 6), (0, 0, 0)), [(0, 0, 0), (0, 0, 9)], -1, None, None, None),
    ],
)
@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_clearance_by_hand(obstacle, bone, distance, t, point, normal, engine):
    found = one(bone, obstacle, 0.25, engine=engine)
    if engine == "exact" or distance > 0 or isinstance(obstacle, Sphere):
        assert found["distance"] == pytest.approx(distance - 0.25, abs=1e-12)
    else:
        assert found["distance"] <= distance - 0.25 + 1e-12
    assert found["lateral"]
    if t is not None and (engine == "exact" or distance > 0):
        assert found["t"] == pytest.approx(t, abs=1e-9)
    if point is not None:
        assert found["point"] == pytest.approx(point, abs=1e-9)
    if normal is not None:
        assert found["normal"] == pytest.approx(normal, abs=1e-9)
    assert np.linalg.norm(found["normal"]) == pytest.approx(1)


def test_a_turned_box_by_hand():
    # A cube of edge √2 on its edge: its top is the line above the y axis at z = 1.
    turn = Rotation.from_euler("y", math.pi / 4).as_matrix()
    box = Box([math.sqrt(2)] * 3, (0, 0, 0), turn)
    found = one([(-1, 0.3, 3), (1, 0.3, 3)], box)
    assert found["distance"] == pytest.approx(2)
    assert found["t"] == pytest.approx(0.5)
    assert found["point"] == pytest.approx((0, 0.3, 1))
    assert found["normal"] == pytest.approx((0, 0, 1))


def test_a_mesh_of_a_cube_is_a_box():
    turn = Rotation.from_euler("xyz", (0.4, 1.1, -2.0)).as_matrix()
    size, centre = np.array([0.5, 0.9, 0.3]), np.array([0.2, -0.1, 0.3])
    mesh = ConvexMesh((CUBE - 0.5) * size @ turn.T + centre)
    bones = scattered(400, seed=6)
    box, same = (
        obstacle_clearance(bones, [0.1], x) for x in (Box(size, centre, turn), mesh)
    )
    assert box.distance == pytest.approx(same.distance, abs=1e-13)
    outside = box.distance > 0
    assert box.normal[outside] == pytest.approx(same.normal[outside], abs=1e-9)


def test_a_capsule_with_a_long_core_is_a_branch():
    axis, centre = np.array([0.6, 0.0, 0.8]), np.array([0.1, 0.4, -0.2])
    branch = Branch(0.3, centre, axis)
    capsule = Capsule(0.3, [centre - 500 * axis, centre + 500 * axis])
    bones = scattered(400, seed=7)
    one_, other = (obstacle_clearance(bones, [0.1], x) for x in (branch, capsule))
    assert one_.distance == pytest.approx(other.distance, abs=1e-12)
    assert one_.t == pytest.approx(other.t, rel=1e-6, abs=1e-9)


def test_a_short_capsule_is_nearly_a_sphere():
    capsule = Capsule(0.5, [(0, 0, -1e-9), (0, 0, 1e-9)])
    bones = scattered(100, seed=8)
    expected = gap(bones, Sphere(0.5, (0, 0, 0)))
    assert gap(bones, capsule) == pytest.approx(expected, abs=2e-9)


# Laws ----------------------------------------------------------------------------


@given(SEGMENTS, st.sampled_from(KINDS), reals(0, 0.3))
def test_the_record_proves_itself(bone, kind, radius):
    obstacle = solid(kind)
    found = one(bone, obstacle, radius)
    t = np.clip(found["t"], 0, 1)
    core = bone[0] + t * (bone[1] - bone[0])
    depth = found["distance"] + radius
    assert np.linalg.norm(found["normal"]) == pytest.approx(1)
    assert core - depth * found["normal"] == pytest.approx(found["point"], abs=1e-7)
    if not isinstance(obstacle, Branch):
        surface, there = point_gap(np.stack([found["point"], core]), obstacle)
        assert surface == pytest.approx(0, abs=1e-9)
        if depth < 0 or not isinstance(obstacle, ConvexMesh):
            assert there == pytest.approx(depth, abs=1e-9)


@pytest.mark.parametrize("engine", ["exact", "fcl"])
@given(SEGMENTS, st.sampled_from(("sphere", "capsule", "box")), reals(0.05, 0.95))
@settings(max_examples=30)
def test_off_the_bone_t_is_where_its_line_is_nearest(engine, bone, kind, cut):
    # A bone that ends before its line's nearest point knows where that is.
    obstacle = solid(kind)
    whole = one(bone, obstacle)
    if not 0.1 < whole["t"] < 0.9 or whole["distance"] < 1e-3:
        return
    end = bone[0] + cut * whole["t"] * (bone[1] - bone[0])
    found = one([bone[0], end], obstacle, engine=engine)
    line = (end - bone[0])[None]
    nearest = point_gap(bone[0] + found["t"] * line, obstacle)[0]
    assert nearest <= whole["distance"] + 1e-6
    assert found["t"] >= 1 - 1e-6


@given(st.sampled_from(KINDS), st.integers(0, 2**32 - 1))
@settings(max_examples=30)
def test_moving_bones_and_obstacle_together_changes_nothing(kind, seed):
    rng = np.random.default_rng(seed)
    turn, shift = Rotation.random(None, rng).as_matrix(), rng.normal(size=3)
    bones = scattered(20, seed=9)
    there = gap(bones @ turn.T + shift, solid(kind, turn=turn, shift=shift))
    assert there == pytest.approx(gap(bones, solid(kind)), abs=1e-12)


@pytest.mark.parametrize("engine", ["exact", "fcl"])
@pytest.mark.parametrize("kind", ["sphere", "capsule", "box", "mesh", "branch"])
def test_far_from_the_origin_all_is_as_at_it(kind, engine):
    bones, shift = scattered(40, seed=10), np.array([3e3, -2e3, 1e3])
    here = obstacle_clearance(bones, [0.0], solid(kind))
    there = obstacle_clearance(
        bones + shift, [0.0], solid(kind, shift=shift), engine=engine
    )
    clear = here.distance > 0
    assert clear.sum() > 10
    off = np.abs(here.distance - there.distance)[clear]
    assert np.quantile(off, 0.9) < 1e-11
    assert there.point[clear] == pytest.approx(here.point[clear] + shift, abs=1e-2)


@given(st.sampled_from(KINDS), reals(-6, 6))
@settings(max_examples=30)
def test_everything_scales(kind, power):
    scale, bones = 10.0**power, scattered(20, seed=11)
    large = gap(bones * scale, solid(kind, scale=scale)) / scale
    assert large == pytest.approx(gap(bones, solid(kind)), abs=1e-11)


@given(SEGMENTS, st.sampled_from(KINDS), SEGMENTS, reals(0, 1))
def test_clearance_is_convex_and_lipschitz_in_the_bones_place(bone, kind, way, part):
    # So it is continuous across a touch, with a slope of one at most.
    obstacle, step = solid(kind), way[1]
    steps = (0 * step, part * step, step)
    start, between, end = (one(bone + s, obstacle)["distance"] for s in steps)
    assert abs(end - start) <= np.linalg.norm(step) + 1e-12
    assert between <= (1 - part) * start + part * end + 1e-7


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_across_a_touch_the_sign_turns_once(kind, engine):
    obstacle = solid(kind)
    bone = np.array([(-0.3, 0.1, 2.05), (0.2, -0.4, 2.0)])
    low, high = 0.0, 2.0
    for _ in range(60):
        way = (low + high) / 2
        clear = one(bone - (0, 0, way), obstacle)["distance"] > 0
        low, high = (way, high) if clear else (low, way)
    for step in (1e-3, 1e-5, 1e-7):
        for sign in (1, -1):
            moved = bone - (0, 0, low - sign * step)
            found = one(moved, obstacle, engine=engine)["distance"]
            assert np.sign(found) == sign
            assert abs(found) <= step * (1 + 1e-6)


@given(SEGMENTS, st.sampled_from(KINDS), reals(0, 1))
def test_skin_is_taken_off_and_a_turned_bone_is_the_same(bone, kind, radius):
    obstacle = solid(kind)
    bare, thick = one(bone, obstacle), one(bone[::-1], obstacle, radius)
    assert thick["distance"] == pytest.approx(bare["distance"] - radius, abs=1e-7)


# Batches and bad input -----------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_a_batch_is_a_loop(kind, engine):
    rng = np.random.default_rng(12)
    bones, radii = rng.normal(size=(2, 3, 4, 2, 3)), np.array([0.0, 0.1, 0.2, 0.0])
    obstacle = solid(kind)
    batch = obstacle_clearance(bones, radii, obstacle, engine=engine)
    assert batch.distance.shape == batch.t.shape == batch.lateral.shape == (2, 3, 4)
    assert batch.point.shape == batch.normal.shape == (2, 3, 4, 3)
    for i, j in np.ndindex(2, 3):
        single = obstacle_clearance(bones[i, j], radii, obstacle)
        clear = single.distance + radii > 0.01
        near = batch.distance[i, j][clear]
        assert near == pytest.approx(single.distance[clear], abs=1e-3)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_an_empty_batch_is_an_empty_answer(kind, engine):
    none = np.empty((0, 4, 2, 3))
    found = obstacle_clearance(none, np.zeros(4), solid(kind), engine=engine)
    assert found.distance.shape == (0, 4)
    assert found.point.shape == (0, 4, 3)


@pytest.mark.parametrize("engine", ["exact", "fcl"])
@pytest.mark.parametrize("kind", KINDS)
def test_a_bone_through_the_middle_has_a_normal(kind, engine):
    obstacle = solid(kind)
    centre = getattr(obstacle, "centre", None)
    middle = obstacle.ends.mean(axis=0) if kind == "capsule" else centre
    middle = obstacle.vertices.mean(axis=0) if kind == "mesh" else middle
    for way in np.eye(3):
        found = one([middle - way, middle + way], obstacle, engine=engine)
        assert np.linalg.norm(found["normal"]) == pytest.approx(1)
        assert found["distance"] < 0
        assert np.isfinite(found["t"])


@pytest.mark.parametrize(
    ("bones", "radii", "message"),
    [
        (np.zeros((2, 3)), [0.0], r"bones.shape = \(2, 3\)"),
        (np.ones((2, 2, 3)), [0.0], r"bones.shape = \(2, 2, 3\)"),
        ([[(0, 0, 0), (0, 0, 0)]], [0.0], r"length of bones\[0\] = 0.0"),
        ([[(0, 0, 0), (0, 0, math.nan)]], [0.0], r"bones\[0, 1, 2\] = nan"),
        ([[(0, 0, 0), (0, 0, 1)]], [-1.0], r"radii\[0\] = -1.0 is not at least 0"),
        ([[(0, 0, 0), (0, 0, 1)]], 0.0, r"radii.shape = \(\)"),
        ([[(0, 0, 0), (0, 0, 1)]], [math.inf], r"radii\[0\] = inf"),
    ],
)
@pytest.mark.parametrize("engine", ["exact", "fcl", None])
def test_what_is_no_foot_is_one_line(bones, radii, message, engine):
    with pytest.raises(ParameterError, match=message) as caught:
        obstacle_clearance(bones, radii, solid("box"), engine=engine)
    assert "\n" not in str(caught.value)


def test_an_engine_or_an_obstacle_that_does_not_exist_is_refused():
    bones = [[(0, 0, 0), (1, 0, 0)]]
    with pytest.raises(UnknownNameError, match="choose one of exact, fcl"):
        obstacle_clearance(bones, [0.0], solid("box"), engine="bullet")
    with pytest.raises(ParameterError, match="a Branch, Sphere, Box"):
        obstacle_clearance(bones, [0.0], "box")
    with pytest.raises(ParameterError, match="one branch at a time"):
        obstacle_clearance(bones, [0.0], Branch([1, 2], (0, 0, -9)))
