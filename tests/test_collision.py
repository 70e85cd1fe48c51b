"""The FCL engine against the exact one, as closely as FCL can answer."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from zygopin import clearance, collision
from zygopin.branch import Branch
from zygopin.foot import Finger, Foot
from zygopin.kinematics import forward_kinematics

SIZES = {"parrot": Foot.preset("parrot"), "paper": Foot.preset("paper")}
SIZES["tiny"] = SIZES["parrot"].replace(scale=1.2e-5, thickness=1.8e-6)
SIZES["huge"] = SIZES["parrot"].replace(scale=1.2e3, thickness=1.8e2)

END_ACCURACY = 5e-3
"""FCL's capsule against cylinder, over the foot's size: 3e-7 in the median, a tail
measured up to 2.7e-3."""


def scattered(foot, count, seed, lengths=None):
    """Random poses of a foot, each with a branch of its own near it."""
    rng = np.random.default_rng(seed)
    size = foot.size
    bones = forward_kinematics(foot, rng.random((count, foot.phalanx_count)))
    radius = rng.uniform(0.02, 1.0, count) * size
    axis = rng.normal(size=(count, 3))
    axis /= np.linalg.norm(axis, axis=1, keepdims=True)
    across = np.cross(axis, rng.normal(size=(count, 3)))
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    away = (radius * rng.uniform(1, 1.8, count))[:, None]
    along = rng.normal(size=(count, 1)) * size / 2
    length = None if lengths is None else rng.uniform(*lengths, count) * size
    return bones, Branch(radius, away * across + along * axis, axis, length)


def both(foot, bones, branch):
    return [
        engine.branch_clearance(bones, foot.radii, branch)
        for engine in (clearance, collision)
    ]


def assert_same(foot, exact, other):
    assert np.abs(exact.distance - other.distance).max() < 1e-9 * foot.size
    assert np.abs(exact.point - other.point).max() < 1e-9 * foot.size
    assert np.abs(exact.normal - other.normal).max() < 1e-9
    assert (exact.lateral == other.lateral).all()
    # t runs to hundreds where a bone is nearly along the axis.
    apart = np.abs(exact.t - other.t) / np.maximum(1, np.abs(exact.t))
    assert apart.max() < 1e-9


@pytest.mark.parametrize("name", SIZES)
def test_on_infinite_branches_they_agree_in_everything(name):
    foot = SIZES[name]
    bones, branch = scattered(foot, 1000, seed=1)
    exact, other = both(foot, bones, branch)
    assert_same(foot, exact, other)
    penetrating = exact.distance < -0.01 * foot.size
    assert 0.05 < penetrating.mean() < 0.95


def test_one_branch_for_all_is_as_good_as_one_for_each():
    foot = SIZES["parrot"]
    bones, branches = scattered(foot, 40, seed=2)
    single = branches[3]
    exact, other = both(foot, bones, single)
    assert_same(foot, exact, other)
    repeated = collision.branch_clearance(bones, foot.radii, single.broadcast((40,)))
    for name in other.__annotations__:
        assert (getattr(other, name) == getattr(repeated, name)).all()


def test_batches_of_both_broadcast():
    foot = SIZES["paper"]
    bones, _ = scattered(foot, 3, seed=3)
    heights = np.array([-0.5, -0.45, -0.55])
    branch = Branch(np.linspace(0.2, 0.4, 4)[:, None], [0, 0, 1] * heights[:, None])
    exact, other = both(foot, bones, branch)
    assert other.distance.shape == (4, 3, 14)
    assert other.point.shape == (4, 3, 14, 3)
    assert_same(foot, exact, other)


def test_an_empty_batch_is_an_empty_answer():
    foot = SIZES["paper"]
    pairs = (np.array([0]), np.array([3]))
    none = np.empty((0, 14, 2, 3))
    branch = Branch(1, (0, 0, -1))
    assert collision.branch_clearance(none, foot.radii, branch).t.shape == (0, 14)
    assert collision.least_skin_distance(none, foot.radii, pairs).shape == (0,)


def test_ends_out_of_reach_cost_no_accuracy():
    foot = SIZES["parrot"]
    bones, branch = scattered(foot, 200, seed=4, lengths=(8.0, 9.0))
    exact, other = both(foot, bones, branch)
    assert exact.lateral.all()
    assert_same(foot, exact, other)


def test_where_the_side_is_nearest_ends_in_reach_cost_none_either():
    foot = SIZES["parrot"]
    bones, branch = scattered(foot, 300, seed=5, lengths=(0.3, 2.0))
    exact, other = both(foot, bones, branch)
    side = exact.lateral & (exact.distance > 0)
    assert side.mean() > 0.2
    assert np.abs(exact.distance - other.distance)[side].max() < 1e-9 * foot.size
    assert np.abs(exact.normal - other.normal)[side].max() < 1e-9


@pytest.mark.parametrize("name", ["parrot", "paper", "tiny"])
def test_where_an_end_is_nearest_they_agree_as_far_as_fcl_can(name):
    foot = SIZES[name]
    bones, branch = scattered(foot, 1000, seed=6, lengths=(0.05, 1.5))
    exact, other = both(foot, bones, branch)
    apart = exact.distance + foot.radii > 1e-3 * foot.size
    ends = ~exact.lateral & apart
    assert ends.mean() > 0.2
    off = np.abs(exact.distance - other.distance)[ends] / foot.size
    assert np.median(off) < 1e-6
    assert np.quantile(off, 0.99) < 1e-4
    assert off.max() < END_ACCURACY
    assert (exact.lateral == other.lateral)[apart].mean() > 0.999


def test_no_bone_is_on_another_side_of_the_bark():
    foot = SIZES["parrot"]
    bones, branch = scattered(foot, 1000, seed=7, lengths=(0.05, 1.5))
    exact, other = both(foot, bones, branch)
    clear = np.abs(exact.distance) > END_ACCURACY * foot.size
    same = np.sign(exact.distance) == np.sign(other.distance)
    assert same[clear].all()
    assert 0.02 < (exact.distance[clear] < 0).mean() < 0.9


def test_a_bone_through_an_end_is_at_least_as_deep_as_its_deepest_point():
    # The exact engine tells the depth of the deepest point, FCL how far the bone
    # must move to come out: never less.
    foot = SIZES["paper"]
    bones, branch = scattered(foot, 400, seed=8, lengths=(0.05, 1.0))
    exact, other = both(foot, bones, branch)
    inside = exact.distance < -1e-3
    assert inside.sum() > 100
    assert (other.distance - exact.distance)[inside].max() < 1e-6


@pytest.mark.parametrize("name", SIZES)
def test_distances_between_skins_agree(name):
    foot = SIZES[name]
    bones, _ = scattered(foot, 60, seed=9)
    pairs = np.triu_indices(foot.phalanx_count, 1)
    exact = clearance.skin_distance(bones, foot.radii, pairs)
    least = collision.least_skin_distance(bones, foot.radii, pairs)
    assert least.shape == (60,)
    assert np.abs(exact.min(axis=1) - least).max() < 1e-9 * foot.size
    for column, pair in enumerate(zip(*pairs, strict=True)):
        one = tuple(np.array([index]) for index in pair)
        other = collision.least_skin_distance(bones, foot.radii, one)
        assert np.abs(exact[:, column] - other).max() < 1e-9 * foot.size


def test_without_pairs_nothing_is_near():
    foot = SIZES["paper"]
    bones, _ = scattered(foot, 3, seed=9)
    none = np.zeros(0, dtype=int), np.zeros(0, dtype=int)
    for engine in (clearance, collision):
        assert np.isposinf(engine.least_skin_distance(bones, foot.radii, none)).all()


@pytest.mark.parametrize("engine", [clearance, collision])
def test_both_queries_at_once_are_each_by_itself(engine):
    foot = SIZES["parrot"]
    bones, branch = scattered(foot, 300, seed=12)
    pairs = np.triu_indices(foot.phalanx_count, 1)
    for poses in (bones, bones[0], bones.reshape(3, 100, -1, 2, 3)[:, :1]):
        some = branch if poses.ndim == 4 else branch[:5]
        near, apart = engine.distances(poses, foot.radii, some, pairs)
        alone = engine.branch_clearance(poses, foot.radii, some)
        for field in dataclasses.fields(near):
            assert (getattr(near, field.name) == getattr(alone, field.name)).all()
        least = engine.least_skin_distance(poses, foot.radii, pairs)
        assert (apart == least).all()
        assert apart.shape == poses.shape[:-3]
        exact = clearance.skin_distance(poses, foot.radii, pairs).min(axis=-1)
        assert np.abs(apart - exact).max() < 1e-9 * foot.size


@pytest.mark.parametrize(
    "branch",
    [
        Branch(0.5, (0, 0, -1.0)),  # the bone crosses its axis
        Branch(0.5, (0.7, 0, -1.0), axis=(0, 0, 1)),  # parallel to it
        Branch(0.5, (0.7, 0, -1.0), axis=(0, 0, 1), length=1.0),
        Branch(0.5, (0.0, 0, -3.0), axis=(0, 0, 1), length=1.0),  # on its axis, beyond
        Branch(0.5, (0.0, 0, -3.0), axis=(0, 0, 1), length=2.0),  # and at its end
        Branch(0.5, (0.5, 0, -1.0)),  # touching at a tip
    ],
)
def test_degenerate_bones_have_an_answer(branch):
    finger = Finger("toe", 1, 0.0, orientation=np.pi / 2)
    foot = Foot(rho=2.0, scale=4.0, fingers=(finger,))
    bones = forward_kinematics(foot, np.zeros(1))
    exact, other = both(foot, bones, branch)
    assert other.distance == pytest.approx(exact.distance, abs=1e-6)
    assert np.linalg.norm(other.normal) == pytest.approx(1)


@pytest.mark.parametrize("length", [1.0, 1e-2, 1e-4])
@pytest.mark.parametrize("height", [1e-6, 1e-9, 0.0, -1e-9, -1e-6])
def test_a_bone_that_touches_an_end_is_neither_deep_nor_far(length, height):
    stump = Branch(0.5, (0, 0, -length / 2), axis=(0, 0, 1), length=length)
    bones = np.array([[(0.1, -0.2, 0.0), (0.15, -0.1, 0.3)]]) + np.array((0, 0, height))
    exact, other = (
        engine.branch_clearance(bones, np.zeros(1), stump)
        for engine in (clearance, collision)
    )
    assert exact.distance == pytest.approx(height, abs=1e-15)
    assert other.distance == pytest.approx(height, abs=1e-14)


def test_fcl_objects_may_touch_to_rounding():
    foot = Foot(fingers=(Finger("toe", 1, 0.0),))
    bones = forward_kinematics(foot, np.zeros(1))
    exact, other = both(foot, bones, Branch(0.5, (0.3, 0, -0.5)))
    assert exact.distance == 0
    assert_same(foot, exact, other)
