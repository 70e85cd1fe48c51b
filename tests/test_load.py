"""Pull and tilt limits: by hand, by laws, and by another solver."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import minimize
from stances import perched, ring

from zygopin.contacts import Contacts, Friction, branch_contacts
from zygopin.errors import ParameterError
from zygopin.load import GRAVITY, bearing_forces, pull_limit, tilt_limit
from zygopin.strength import Strength

THREE = ring(0, 120, 240)


def strength(mu, edges=32, force=1.0):
    return Strength(force, Friction(mu, edges))


def test_along_the_axis_friction_alone_holds():
    # Three contacts, each at most 1 N: 3·μ.
    limit = pull_limit(THREE, strength(0.5), [0, 0, 2])
    assert limit.force <= 1.5 * (1 + 1e-12)
    assert limit.bound >= 1.5
    assert limit.force == pytest.approx(1.5, rel=0.01)


def test_across_the_axis_by_hand():
    # Pulled along x, the two behind push with cos 60° and rub with μ·sin 60° each.
    want = 2 * (0.5 + 0.5 * math.sin(math.radians(60)))
    limit = pull_limit(THREE, strength(0.5), [1, 0, 0])
    assert limit.force <= want * (1 + 1e-12)
    assert want <= limit.bound * (1 + 1e-12)
    assert limit.bound - limit.force < 0.02
    assert limit.residual < 1e-12


def test_without_friction_only_what_lies_behind_holds():
    assert pull_limit(THREE, strength(0), [0, 0, 1]).bound == 0
    assert pull_limit(THREE, strength(0), [-1, 0, 0]).force == pytest.approx(1)
    assert pull_limit(THREE, strength(0), [1, 0, 0]).force == pytest.approx(1)


def test_contacts_above_the_equator_hold_nothing_against_a_pull_up():
    # On a branch along z pulled along +x, with all contacts facing +x.
    above = ring(-60, -20, 20, 60)
    assert pull_limit(above, strength(0.5), [1, 0, 0]).bound == 0
    assert pull_limit(above, strength(0.5), [-1, 0, 0]).force > 3


def test_a_pull_off_centre_must_be_twisted_back():
    # At (0, 1, 0) along x on frictionless contacts: its torque cannot be balanced.
    limit = pull_limit(THREE, strength(0), [1, 0, 0], point=[0, 1, 0])
    assert limit.bound == 0
    assert pull_limit(THREE, strength(0.5), [1, 0, 0], point=[0, 1, 0]).force > 0.4


def test_a_load_takes_its_share():
    load = [0, 0, 0.6, 0, 0, 0]
    limit = pull_limit(THREE, strength(0.5), [0, 0, 1], load=load)
    assert limit.force == pytest.approx(0.9, rel=0.02)
    too_much = pull_limit(THREE, strength(0.5), [0, 0, 1], load=[0, 0, 2, 0, 0, 0])
    assert (too_much.force, too_much.bound) == (0, 0)


def test_forces_lie_in_their_cones_and_balance_the_pull():
    contacts = branch_contacts(perched().report)
    rng = np.random.default_rng(1)
    for direction in rng.normal(size=(10, 3)):
        limit = pull_limit(contacts, strength(0.4, 8, 0.3), direction)
        forces = limit.contact_forces
        along = (forces * contacts.normals).sum(axis=-1)
        across = np.linalg.norm(forces - along[:, None] * contacts.normals, axis=-1)
        assert along.max() <= 0.3 * (1 + 1e-9)
        assert (across <= 0.4 * along + 1e-12).all()
        unit = direction / np.linalg.norm(direction)
        left = contacts.wrenches(forces).sum(axis=0)
        left += contacts.wrench_at(limit.force * unit, [0, 0, 0])
        assert np.abs(left).max() < 1e-9
        assert limit.residual < 1e-9


def test_a_solver_of_round_cones_agrees():
    contacts, mu = ring(0, 100, 230, heights=[0, 0.4, -0.3]), 0.5
    pull = contacts.wrench_at([0.6, 0, 0.8], [0, 0, 0])

    def balance(x):
        forces = x[:-1].reshape(3, 3)
        return contacts.wrenches(forces).sum(axis=0) + x[-1] * pull

    def room(x):
        forces = x[:-1].reshape(3, 3)
        along = (forces * contacts.normals).sum(axis=-1)
        across = forces - along[:, None] * contacts.normals
        cone = (mu * along) ** 2 - (across**2).sum(axis=-1)
        return np.concatenate([cone, along, 1 - along])

    start = np.append(0.5 * contacts.normals.ravel(), 0.0)
    result = minimize(
        lambda x: -x[-1],
        start,
        method="SLSQP",
        constraints=[
            {"type": "eq", "fun": balance},
            {"type": "ineq", "fun": room},
        ],
        options={"maxiter": 500, "ftol": 1e-12},
    )
    limit = pull_limit(contacts, strength(mu, 64), [0.6, 0, 0.8])
    assert result.success
    assert limit.force <= -result.fun + 1e-6
    assert -result.fun <= limit.bound + 1e-6
    assert limit.bound - limit.force < 0.01


def test_limits_grow_with_the_force_and_not_with_the_size():
    contacts = branch_contacts(perched().report)
    large = Contacts(
        9 * contacts.points, contacts.normals, 9 * contacts.origin, 9 * contacts.scale
    )
    one = pull_limit(contacts, strength(0.4, 8, 1), [1, 2, 3]).force
    assert pull_limit(contacts, strength(0.4, 8, 5), [1, 2, 3]).force == pytest.approx(
        5 * one
    )
    assert pull_limit(large, strength(0.4, 8, 1), [1, 2, 3]).force == pytest.approx(one)


def test_a_direction_of_length_zero_is_refused():
    with pytest.raises(ParameterError, match=r"direction = .*not zero"):
        pull_limit(THREE, strength(0.5), [0, 0, 0])


@pytest.mark.parametrize(
    ("option", "value"),
    [
        ("point", np.zeros((2, 3))),
        ("point", [0, 0]),
        ("point", [0, 0, math.nan]),
        ("load", np.zeros((2, 6))),
        ("load", [0, 0, 1]),
    ],
)
def test_a_pull_has_one_point_and_one_load(option, value):
    with pytest.raises(ParameterError, match=option) as caught:
        pull_limit(THREE, strength(0.5), [0, 0, 1], **{option: value})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("force", [0, -1, math.nan])
def test_a_toe_presses_with_a_positive_force(force):
    with pytest.raises(ParameterError, match="toe force"):
        Strength(force, Friction(0.5))


def test_the_gentlest_forces_bear_the_load_and_no_gentler_ones_do():
    contacts = branch_contacts(perched().report)
    weight = contacts.wrench_at([0, 0.1, -0.4], [0, 0, 0.02])
    forces = bearing_forces(contacts, strength(0.5, 8, 5.0), weight)
    assert contacts.wrenches(forces).sum(axis=0) == pytest.approx(-weight, abs=1e-12)
    most = (forces * contacts.normals).sum(axis=-1).max()
    assert bearing_forces(contacts, strength(0.5, 8, most * 1.001), weight) is not None
    assert bearing_forces(contacts, strength(0.5, 8, most * 0.999), weight) is None


@pytest.mark.parametrize("load", [np.zeros(6), np.ones(5), np.ones((2, 6))])
def test_a_load_is_a_wrench(load):
    with pytest.raises(ParameterError, match="load"):
        bearing_forces(THREE, strength(0.5), load)


# Tilt ----------------------------------------------------------------------------


def ball_joint(radius=1.0):
    """Contacts all around a branch along y, wide apart: they hold in any tilt."""
    turn = np.array([[1.0, 0, 0], [0, 0, 1], [0, -1, 0]])
    flat = ring(0, 120, 240, 60, 180, 300, heights=[3, 3, 3, -3, -3, -3])
    return Contacts(flat.points @ turn.T, flat.normals @ turn.T, scale=radius)


def test_strong_toes_hang_upside_down():
    limit = tilt_limit(ball_joint(), strength(0.8, 8, 100), 1, [0, 0, 2])
    assert limit.roll == (math.pi, math.pi)
    assert limit.pitch == (math.pi, math.pi)


def test_weak_toes_do_not_even_stand():
    contacts = branch_contacts(perched().report)
    limit = tilt_limit(contacts, strength(0.5, 8, 1e-3), 1, [0, 0, 0.1])
    assert limit.roll == limit.pitch == (0, 0)


def test_a_block_on_a_flat_slides_at_the_angle_of_friction():
    # Four contacts that face up under a low weight: tan(angle) = μ, along an edge of
    # the pyramid.
    corners = np.array([[1.0, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]])
    flat = Contacts(corners, np.tile([0.0, 0, 1], (4, 1)))
    limit = tilt_limit(flat, strength(0.3, 4, 100), 1, [0, 0, 1e-6])
    for angle in (*limit.roll, *limit.pitch):
        assert math.tan(angle) == pytest.approx(0.3, abs=3e-4)


def test_a_block_tips_over_its_edge():
    # Height 2 over a half width of 1: tan(angle) = 1/2, before it slides.
    corners = np.array([[1.0, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]])
    flat = Contacts(corners, np.tile([0.0, 0, 1], (4, 1)))
    limit = tilt_limit(flat, strength(0.9, 4, 100), 1, [0, 0, 2])
    for angle in (*limit.roll, *limit.pitch):
        assert math.tan(angle) == pytest.approx(0.5, abs=3e-4)


def test_signs_of_roll_and_pitch():
    # The weight hangs over the edge on the left: leaning right takes it in.
    corners = np.array([[1.0, 1, 0], [1, -1, 0], [-1, 1, 0], [-1, -1, 0]])
    flat = Contacts(corners, np.tile([0.0, 0, 1], (4, 1)))
    left = tilt_limit(flat, strength(5, 4, 100), 1, [0, 0.5, 1])
    right, to_left = left.roll
    assert math.tan(right) == pytest.approx(1.5, abs=2e-3)
    assert math.tan(to_left) == pytest.approx(0.5, abs=2e-3)
    front = tilt_limit(flat, strength(5, 4, 100), 1, [0.5, 0, 1])
    nose_up, nose_down = front.pitch
    assert math.tan(nose_up) == pytest.approx(1.5, abs=2e-3)
    assert math.tan(nose_down) == pytest.approx(0.5, abs=2e-3)


def test_every_smaller_tilt_is_borne():
    contacts = branch_contacts(perched().report)
    firm, mass, centre = strength(0.5, 8, 0.2), 0.04, np.array([0, 0, 0.03])
    end = tilt_limit(contacts, firm, mass, centre).roll[0]
    assert 0 < end < math.pi
    for angle in np.linspace(0, end, 15):
        down = [0, -math.sin(angle), -math.cos(angle)]
        borne = pull_limit(contacts, firm, down, point=centre).force
        assert borne >= mass * GRAVITY * (1 - 1e-9)
    down = [0, -math.sin(end + 0.01), -math.cos(end + 0.01)]
    assert pull_limit(contacts, firm, down, point=centre).force < mass * GRAVITY


@pytest.mark.parametrize("mass", [0, -1, math.inf])
def test_a_body_has_a_positive_mass(mass):
    with pytest.raises(ParameterError, match="mass"):
        tilt_limit(THREE, strength(0.5), mass, [0, 0, 1])
