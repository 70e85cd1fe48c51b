"""What a grasp bears: the largest pull along a direction, the largest tilt."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

import numpy as np
from numpy.typing import ArrayLike

from zygopin import checks, kinds
from zygopin.contacts import Contacts, Floats
from zygopin.errors import ParameterError
from zygopin.programme import maximise_last
from zygopin.strength import Strength

GRAVITY = 9.81
"""Acceleration of free fall [m/s²], as simulators have it."""

TILT_TOLERANCE = 1e-4
"""Width of the interval to which the largest tilt is narrowed [rad]."""

ROLL, PITCH = np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])
"""Axes about which branch and foot are tilted together: forward, left."""


@dataclass(frozen=True, eq=False)
class PullLimit:
    """The largest pull that the contacts balance, and how they do.

    Attributes:
        direction: Unit direction of the pull, shape (3,).
        force: The largest pull [N] that the inscribed pyramids bear: a hold.
        bound: What the circumscribed pyramids bear [N]: no pull beyond it holds.
        contact_forces: Forces on the foot that balance `force` [N], shape (N, 3).
        residual: What they leave unbalanced [N].
    """

    direction: Floats
    force: float
    bound: float
    contact_forces: Floats
    residual: float

    def __post_init__(self) -> None:
        checks.freeze(self)


@dataclass(frozen=True)
class TiltLimit:
    """How far branch and foot can be tilted until the bird falls off.

    Attributes:
        roll: Largest turns about x, to the right side and to the left [rad].
        pitch: Largest turns about y, nose up and nose down [rad].
    """

    roll: tuple[float, float]
    pitch: tuple[float, float]


def pull_limit(
    contacts: Contacts,
    strength: Strength,
    direction: ArrayLike,
    *,
    point: ArrayLike = (0.0, 0.0, 0.0),
    load: ArrayLike | None = None,
) -> PullLimit:
    """The largest force along a direction before the foot slips: a linear programme.

    Args:
        contacts: The contacts.
        strength: Largest normal force of each, and their friction.
        direction: Direction of the pull on the foot, shape (3,); its length is
            of no account.
        point: Where it pulls [m], shape (3,); by default the foot's base.
        load: Another wrench that acts all the while, such as the weight [N], about
            the contacts' origin, shape (6,).

    Returns:
        The limit; 0 where the contacts cannot even bear the load.

    Raises:
        ParameterError: A direction of length 0, or shapes that do not fit.
    """
    kinds.instance("contacts", contacts, Contacts)
    unit, where = unit_direction(direction), checks.places("point", point)
    checks.shaped("point", where, (3,))
    pull = contacts.wrench_at(unit, where)
    still = np.zeros(6) if load is None else checks.array("load", load, last=6)
    checks.shaped("load", still, (6,))
    force, forces = _largest(contacts, strength, pull, still)
    bound, _ = _largest(contacts, strength, pull, still, around=True)
    left = contacts.wrenches(forces).sum(axis=0) + force * pull
    left += still * (force > 0)
    residual = float(np.linalg.norm(left))
    return PullLimit(unit, force, max(force, bound), forces, residual)


def tilt_limit(
    contacts: Contacts, strength: Strength, mass: float, centre_of_mass: ArrayLike
) -> TiltLimit:
    """How far branch and foot can be tilted together with a body on top.

    The weight turns against them. The wrenches that the contacts bear are a convex
    set that holds 0; its reach along two directions bounds it between them, so no
    tilt is stepped over.

    Args:
        contacts: The contacts.
        strength: Largest normal force of each, and their friction.
        mass: Mass of the body [kg].
        centre_of_mass: Where it is when upright, in the world's frame [m], shape (3,).

    Returns:
        The limits, each to `TILT_TOLERANCE` below the true one of the inscribed
        pyramids; π: it even hangs on; 0: it does not stay on upright.

    Raises:
        ParameterError: A mass that is not positive, or a centre of no shape (3,).
    """
    kinds.instance("contacts", contacts, Contacts)
    weight = GRAVITY * checks.number(
        "mass",
        mass,
        allowed="a positive number of kilograms",
        where=lambda kilograms: 0 < kilograms <= checks.LARGEST,
        remedy="give the body's mass, such as 0.04",
    )
    centre = checks.places("centre_of_mass", centre_of_mass)
    checks.shaped("centre_of_mass", centre, (3,))

    def reach(axis: Floats, angle: float) -> float:
        """How many times the weight is borne at a tilt, at most."""
        down = np.array([0.0, 0.0, -math.cos(angle)])
        down -= math.sin(angle) * np.cross(axis, [0.0, 0.0, -1.0])
        pull = contacts.wrench_at(weight * down, centre)
        return _largest(contacts, strength, pull, np.zeros(6))[0]

    right, left, up, down = (
        _furthest(partial(reach, axis)) for axis in (ROLL, -ROLL, -PITCH, PITCH)
    )
    return TiltLimit(roll=(right, left), pitch=(up, down))


def bearing_forces(
    contacts: Contacts, strength: Strength, load: ArrayLike
) -> Floats | None:
    """The gentlest contact forces that bear a load: the largest normal is least.

    Without a drive; with one, those that ask the least share of its strength, where
    no joint rests on a stop.

    Args:
        contacts: The contacts.
        strength: Largest normal force of each, and their friction.
        load: The wrench on the foot, such as its weight's (`contacts.wrench_at`) [N],
            shape (6,).

    Returns:
        Forces on the foot [N], shape (N, 3); None where it is not borne.

    Raises:
        ParameterError: A load of 0, or of another shape.
    """
    wrench = checks.array("load", load, last=6)
    checks.shaped("load", wrench, (6,))
    if not np.any(wrench):
        raise ParameterError("load", wrench, "not zero", "give what acts on the foot")
    times, forces = _largest(contacts, strength, wrench, np.zeros(6))
    return forces / times if times >= 1 else None


def _furthest(reach: Callable[[float], float]) -> float:
    """The end of the tilts from 0 on at which the weight is borne all the way.

    With reaches s and s' at two tilts Δ apart, convexity bears s·cos(Δ/2) of the
    weight between them, s the smaller.
    """
    angle, share, step = 0.0, reach(0.0), math.pi / 8
    if share < 1:
        return 0.0
    while angle < math.pi and step > TILT_TOLERANCE:
        ahead = min(angle + step, math.pi)
        further = reach(ahead)
        if min(share, further) * math.cos((ahead - angle) / 2) >= 1:
            angle, share, step = ahead, further, 2 * step
        else:
            step /= 2
    return angle


def _largest(
    contacts: Contacts,
    strength: Strength,
    pull: Floats,
    load: Floats,
    *,
    around: bool = False,
) -> tuple[float, Floats]:
    """The largest multiple of a pull that is borne beside a load, and the forces.

    Forces are in units of the largest normal force. Unknowns are the edges' loads
    λ ≥ 0, what motors and stops add, and the multiple: maximise it with
    Σ λ w + multiple·pull + load = 0 and Σ λ ≤ 1 per contact.
    """
    kinds.instance("contacts", contacts, Contacts)
    kinds.instance("strength", strength, Strength)
    edges = strength.friction.forces(contacts.normals, around=around)
    count, sides, _ = edges.shape
    wrenches = contacts.wrenches(edges).reshape(-1, 6).T
    size = float(np.linalg.norm(pull))
    joints, spans = _joint_rows(contacts, strength, edges)
    held = joints.shape[1] - count * sides
    balance = np.hstack([wrenches, np.zeros((6, held)), pull[:, None] / size])
    still = np.hstack([joints, np.zeros((len(joints), 1))])
    limits = {}
    if math.isfinite(strength.normal_force):
        pressed = np.kron(np.eye(count), np.ones(sides))
        limits["A_ub"] = np.hstack([pressed, np.zeros((count, held + 1))])
        limits["b_ub"] = np.ones(count)
    best = maximise_last(
        count * sides + held + 1,
        A_eq=np.vstack([balance, still]),
        b_eq=[*(-load / strength.unit), *np.zeros(len(still))],
        bounds=[(0, None)] * (count * sides) + spans + [(0, None)],
        **limits,
    )
    if best is None:
        return 0.0, np.zeros((count, 3))
    shares = best.unknowns[: count * sides].reshape(count, sides, 1)
    forces = (shares * strength.unit * edges).sum(axis=1)
    return max(0.0, best.value) * strength.unit / size, forces


def _joint_rows(
    contacts: Contacts, strength: Strength, edges: Floats
) -> tuple[Floats, list[tuple[float, float | None]]]:
    """Balance of each joint that a drive moves, over the unit force and the scale.

    Returns:
        Coefficients of the edges' loads, the motors' shares and the stops' torques,
        shape (joints, unknowns); and the bounds of what comes after the edges.
    """
    drive, count = strength.drive, edges.shape[0] * edges.shape[1]
    if drive is None:
        return np.zeros((0, count)), []
    pressed = np.einsum("pni,nmi->pnm", drive.matrix, edges).reshape(-1, count)
    moved = drive.torques / strength.unit
    stops = contacts.scale * np.diag(drive.straight * 1.0 - drive.bent)
    stops = stops[:, drive.straight | drive.bent]
    rows = np.hstack([pressed, moved, stops]) / contacts.scale
    motors = [(float(low), 1.0) for low in drive.low]
    return rows, [*motors, *[(0.0, None)] * stops.shape[1]]


def unit_direction(direction: ArrayLike) -> Floats:
    """A direction of length 1.

    Args:
        direction: The direction, of any length, shape (3,).

    Returns:
        Unit vector, shape (3,).

    Raises:
        ParameterError: It has length 0, or another shape.
    """
    vector = checks.places("direction", direction)
    checks.shaped("direction", vector, (3,))
    length = float(np.linalg.norm(vector))
    if length == 0:
        remedy = "give the direction of the pull, such as 0 0 1 for up"
        raise ParameterError("direction", vector, "not zero", remedy)
    unit: Floats = vector / length
    return unit
