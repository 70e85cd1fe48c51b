"""Nets of sets: true points, and one near each point of the set."""

from __future__ import annotations

import math

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from strategies import level_sets, omegas, reals
from test_ifs import one_sided

from zygopin.control_system import ControlSystem
from zygopin.ifs import hutchinson, reachable_set
from zygopin.nets import (
    Grid,
    around_image,
    attractor_net,
    base_net,
    image_net,
)

LAWS = settings(max_examples=30, deadline=None, derandomize=True)


def assert_near(points, net):
    """Points are in marked cells, or on their borders, or else within the spread."""
    marked, places = net.marked.ravel(), net.grid.places(points)
    around = 1e-9 * np.array([1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j])
    inside = [marked[net.grid.index(places + aside)] for aside in around]
    outside = points[~np.any(inside, axis=0)]
    if len(outside):
        assert one_sided(outside, net.points) <= net.spread + 1e-12
    assert one_sided(points, net.points) <= net.resolution + 1e-12


@LAWS
@given(st.data())
def test_a_net_of_each_generation_is_near_all_its_points(data):
    rho, omega = data.draw(reals(1.05, 3)), data.draw(omegas())
    levels, fineness = data.draw(level_sets()), data.draw(st.integers(1, 4))
    turn, size = data.draw(reals(-4, 4)), data.draw(reals(0.02, 0.5))
    system = ControlSystem(rho, omega, levels, turn)
    net = base_net()
    for depth in range(1, 6):
        net = image_net(system, net, around_image(system, net, size), fineness)
        points = reachable_set(rho, omega, levels, depth, orientation=turn).points
        assert one_sided(net.points, points) <= 1e-12 * depth  # they are true
        assert_near(points, net)


@LAWS
@given(st.data())
def test_the_images_of_an_attractors_net_are_near_it(data):
    rho, omega = data.draw(reals(1.1, 3)), data.draw(omegas())
    levels, fineness = data.draw(level_sets()), data.draw(st.integers(1, 4))
    system = ControlSystem(rho, omega, levels)
    reach = 1.1 * system.tail(0)
    count = data.draw(st.integers(10, 60))
    grid = Grid(-reach * (1 + 1j), 2 * reach / count, (count, count))
    net = attractor_net(system, grid, fineness)
    points = net.points
    for _ in range(3):
        points = hutchinson(points, levels, rho, omega)[:200_000]
        assert_near(points, net)


def test_a_straight_finger_by_hand():
    # ω = 0 keeps fingers straight: with ρ = 2 each is 1 − 2^−k long, and R∞ = {1}.
    system = ControlSystem(2, 1e-300, [0, 1])
    net = image_net(system, base_net(), around_image(system, base_net(), 0.1), 2)
    assert net.points == [0.5]
    assert net.marked.sum() == 1
    assert net.spread == math.sqrt(2) * (1 + 1e-6) * 0.1 / 2
    grid = Grid(-2 - 2j, 0.1, (40, 40))
    assert np.abs(attractor_net(system, grid, 2).points - 1).max() <= 1e-15
