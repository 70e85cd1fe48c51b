"""How closing toes move: velocities, bounds, and steps that miss nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import reals
from strikes import KINDS, make_obstacle, random_foot

from zygopin import Finger, Foot
from zygopin.advancement import steps_by_bend, steps_by_speed
from zygopin.clearance import skin_distance
from zygopin.grasp import finger_pairs
from zygopin.kinematics import forward_kinematics
from zygopin.solid_clearance import obstacle_clearance
from zygopin.stance import Stance, azimuths_at
from zygopin.toe_motion import ToeMotion, steps_between, steps_to_solid

SEEDS = st.integers(0, 10_000)


class Toes:
    """A random foot whose joints turn at random rates."""

    def __init__(self, seed):
        self.rng = np.random.default_rng(seed)
        self.foot = random_foot(self.rng)
        count = self.foot.phalanx_count
        self.start = self.rng.random(count) * 0.5
        self.rates = self.rng.random(count) * self.rng.integers(0, 2, count) * 0.5
        self.azimuths = azimuths_at(self.foot, np.array(0.0))

    def stance(self, time):
        controls = self.start + time * self.rates
        return Stance(self.foot, np.eye(4), self.azimuths, controls)

    def motion(self, time=0.0):
        return ToeMotion.of(self.stance(time), self.foot.omega * self.rates)


@given(SEEDS)
def test_velocities_are_the_derivative_of_the_bones(seed):
    toes, step = Toes(seed), 1e-5
    after, before = toes.stance(0.3 + step).bones, toes.stance(0.3 - step).bones
    found = toes.motion(0.3).velocities
    size = toes.foot.size
    np.testing.assert_allclose(found, (after - before) / (2 * step), atol=1e-7 * size)


@given(SEEDS)
def test_no_point_is_faster_or_bends_more_than_its_bound(seed):
    toes = Toes(seed)
    motion, size = toes.motion(), toes.foot.size
    for time in np.linspace(0, 1, 7):
        later = toes.motion(time)
        speed = np.linalg.norm(later.velocities, axis=-1).max(axis=1)
        assert (speed <= motion.speeds + 1e-12 * size).all()
        change = toes.motion(time + 1e-5).velocities - later.velocities
        bend = np.linalg.norm(change, axis=-1).max(axis=1) / 1e-5
        assert (bend <= motion.bends * (1 + 1e-6) + 1e-9 * size).all()


def test_one_phalanx_by_hand():
    foot = Foot(rho=2, omega=1.5, fingers=(Finger("a", 1, azimuth=0.0),))
    stance = Stance(foot, np.eye(4), np.zeros(1), np.zeros(1))
    motion = ToeMotion.of(stance, np.array([1.5]))
    assert motion.velocities[0] == pytest.approx(np.array([[0, 0, 0], [0, 0, -0.75]]))
    assert motion.speeds == pytest.approx([0.75])
    assert motion.bends == pytest.approx([0.5 * 1.5**2])


@given(SEEDS, st.integers(0, 4))
def test_pieces_make_up_the_bones_and_move_with_them(seed, cuts):
    toes = Toes(seed)
    motion = toes.motion()
    at = np.append(0.0, 4.0 ** np.arange(-float(cuts), 1.0))
    which = np.arange(toes.foot.phalanx_count)
    pieces = motion.pieces(which, at)
    shape = (len(which), len(at) - 1)
    bones = pieces.bones.reshape(*shape, 2, 3)
    np.testing.assert_allclose(bones[:, 0, 0], motion.bones[:, 0])
    np.testing.assert_allclose(bones[:, -1, 1], motion.bones[:, 1])
    np.testing.assert_allclose(bones[:, 1:, 0], bones[:, :-1, 1])
    speed = np.linalg.norm(pieces.velocities, axis=-1).max(axis=1)
    assert (speed <= pieces.speeds + 1e-12 * toes.foot.size).all()
    assert (pieces.speeds.reshape(shape)[:, -1] <= motion.speeds + 1e-15).all()
    assert (pieces.bends.reshape(shape)[:, -1] <= motion.bends + 1e-15).all()


@given(SEEDS)
def test_no_clearance_is_gone_within_its_step(seed):
    toes = Toes(seed)
    foot, rng = toes.foot, toes.rng
    kind = KINDS[int(rng.integers(len(KINDS)))]
    below = np.array([0, 0, -0.6]) * foot.size
    obstacle = make_obstacle(kind, 0.2 * foot.size, below, rng)
    motion = toes.motion()
    near = obstacle_clearance(motion.bones, foot.radii, obstacle)
    floors = near.distance - rng.random(foot.phalanx_count) * 0.2 * foot.size
    steps = steps_to_solid(motion, foot.radii, near, floors)
    assert (steps > 0).all()
    for share in (0.1, 0.5, 0.9, 1.0):
        for phalanx in np.flatnonzero(steps < 1):
            bones = toes.stance(share * steps[phalanx]).bones
            later = obstacle_clearance(bones, foot.radii, obstacle).distance[phalanx]
            assert later >= floors[phalanx] - 1e-9 * foot.size


@given(SEEDS)
def test_no_two_toes_meet_within_their_step(seed):
    toes = Toes(seed)
    foot, pairs = toes.foot, finger_pairs(toes.foot)
    motion = toes.motion()
    floors = skin_distance(motion.bones, foot.radii, pairs) - 0.1 * foot.size
    distances, steps = steps_between(motion, foot.radii, pairs, floors)
    np.testing.assert_allclose(
        distances, floors + 0.1 * foot.size, atol=1e-9 * foot.size
    )
    for pair in np.flatnonzero(steps < 1):
        for share in (0.3, 1.0):
            bones = toes.stance(share * steps[pair]).bones
            later = skin_distance(bones, foot.radii, pairs)[pair]
            assert later >= floors[pair] - 1e-9 * foot.size


def test_bones_that_cross_can_come_no_nearer():
    foot = Foot.preset("owl")
    bones = forward_kinematics(foot, np.zeros(14))
    bones[5] = bones[0] + [0, 0, 1e-3] * np.array([[-1], [1]])
    motion = ToeMotion(bones, np.ones((14, 2, 3)), *np.ones((3, 14)))
    pair = (np.array([0]), np.array([5]))
    deep = -(foot.radii[0] + foot.radii[5]) - 1e-9
    _, steps = steps_between(motion, foot.radii, pair, np.array([deep]))
    assert steps[0] == math.inf


@given(reals(1e-3, 10), reals(-5, 5), reals(0, 5))
def test_a_falling_distance_is_gone_at_the_root(distance, slope, bend):
    (step,) = steps_by_bend(*np.array([[distance], [slope], [bend]]))
    if math.isinf(step):
        assert slope >= 0
        assert bend == 0
        return
    left = distance + slope * step - bend * step**2 / 2
    assert left == pytest.approx(0, abs=1e-9 * (distance + abs(slope) * step))
    before = np.linspace(0, step, 50)[:-1]
    assert (distance + slope * before - bend * before**2 / 2 > 0).all()


def test_what_does_not_change_limits_no_step():
    none, infinite = np.zeros(2), np.array([1.0, math.inf])
    assert (steps_by_speed(infinite, none) == math.inf).all()
    assert (steps_by_bend(infinite, none, none) == math.inf).all()
    assert steps_by_bend(*np.array([[-1.0], [-1.0], [1.0]])) == [0.0]
