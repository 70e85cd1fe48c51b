"""Bounds on junctions: they hold for every pose, and are nearly as tight as can be."""

from __future__ import annotations

import math

import numpy as np
import pytest
from axes import one_finger
from tangencies import projected, random_controls, random_view

from zygopin.junction_hull import junction_hull

Y = np.array([0.0, 1.0, 0.0])


def junctions(finger, controls, rank):
    """Junction before phalanx `rank` and that phalanx's pitch, in n poses."""
    turns = finger.omega * np.cumsum(controls[:, :rank], axis=1)
    pitch = finger.orientation + turns
    steps = finger.lengths[: rank - 1] * finger.direction(pitch[:, : rank - 1])
    return steps.sum(axis=1), pitch[:, rank - 1]


def view(seed):
    foot, axis, _ = random_view(seed)
    return projected(foot, axis)


@pytest.mark.parametrize("seed", range(30))
def test_every_pose_is_held(seed):
    finger, rng = view(seed), np.random.default_rng(seed)
    controls = random_controls(rng, 300, len(finger.lengths))
    for rank in range(1, len(finger.lengths) + 1):
        place, pitch = junctions(finger, controls, rank)
        hull, none = junction_hull(finger, rank), np.zeros(len(pitch))
        assert hull.holds(place, none, pitch, none).all()
        # Wider ranges, and places that are off by no more than the margin.
        spread = 10 ** rng.uniform(-6, 0.5, len(pitch))
        off = spread * rng.uniform(-1, 1, len(pitch))
        margin = rng.random(len(pitch))
        moved = place + margin * np.exp(2j * np.pi * rng.random(len(pitch)))
        assert hull.holds(moved, margin + 1e-12, pitch + off, spread).all()


@pytest.mark.parametrize("seed", range(30, 36))
def test_places_outside_the_hull_of_all_poses_are_not_held(seed):
    finger, rng = view(seed), np.random.default_rng(seed)
    rank, size = len(finger.lengths), finger.lengths.sum()
    place, _ = junctions(finger, random_controls(rng, 20_000, rank), rank)
    middle = finger.orientation + rank * finger.omega / 2
    way = np.exp(1j * rng.uniform(0, 2 * np.pi, 40))
    reach = (place * way.conj()[:, None]).real.max(axis=1)
    # Random poses come near the hull; fixed directions miss 0.5 % of the distance.
    beyond = (reach + 0.1 * size) * way
    half = rank * finger.omega / 2 * np.ones(40)
    pitch = np.full(40, middle)
    held = junction_hull(finger, rank).holds(beyond, np.zeros(40), pitch, half)
    assert not held.any()


def test_one_link_by_hand():
    # A phalanx of length 1, a joint of at most 90 degrees each: its end is on an arc.
    finger = projected(one_finger(2, rho=2.0, scale=2.0, omega=math.pi / 2), Y)
    hull, half = junction_hull(finger, 2), math.sqrt(0.5)
    place = np.array([1.0, -1j, half * (1 - 1j), -1.0, 1j, 1.01 * half * (1 - 1j)])
    pitch, none = np.full(6, math.pi / 2), np.zeros(6)
    held = hull.holds(place, none, pitch, none)
    assert held.tolist() == [True, True, True, False, False, False]
    # Behind a straight phalanx comes no more than one joint's turn.
    assert not hull.holds(place[:1], none[:1], np.array([1.6]), none[:1])
    assert not hull.holds(place[:1], none[:1], np.array([-0.01]), none[:1])
    assert not hull.holds(place[1:2], none[:1], np.array([1.5]), none[:1])


def test_the_first_junction_is_the_base():
    finger = view(1)
    hull, pitch = junction_hull(finger, 1), np.full(3, finger.orientation)
    place, margin = np.array([0j, 0.2 + 0j, 0.2j]), np.array([0.0, 0.1, 0.21])
    assert hull.holds(place, margin, pitch, np.zeros(3)).tolist() == [True, False, True]


def test_nothing_asked_is_nothing_held():
    none = np.zeros(0)
    assert junction_hull(view(2), 1).holds(none + 0j, none, none, none).shape == (0,)
