"""How strong, stiff and damped a foot is: what a simulation needs beside the masses.

The model of the foot has no forces, so these numbers are chosen, not measured. They
follow from the foot's weight W = M·g, its size L and the time T = √(L/g), in which a
thing falls half that size: a foot four times as large moves alike, half as fast. With
the lever ℓ, the length of the phalanx that a joint moves:

    torque      τ = GRIP·W·ℓ
    stiffness   κ = τ / 1 rad
    armature    a = κ·(T/FREQUENCY)²
    damping     d = κ·T·CLOSING

The lever, and with it all of them, shrinks by ρ from one joint to the next, as the
moment arms of a tendon along similar phalanges do. Every joint is overdamped: for that
its inertia need only be below d²/4κ, about 3·M·ℓ·L, and a toe's is a fraction of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from zygopin.foot import Foot
from zygopin.load import GRAVITY

GRIP = 50.0
"""Force of a phalanx at its end, over the foot's weight.

One foot shall carry the bird, which weighs some fifty times what its phalanges do.
"""

RETURN = 20.0
"""Stiffness of the springs that open a tendon-driven toe, over W·ℓ per radian.

At one radian they take two fifths of the tendon's strength; they open the toes within a
few T, and let them sag by a few hundredths of a radian.
"""

FREQUENCY = 16.0
"""Natural frequency of a joint that moves no more than its armature, over 1/T [rad].

The armature is the muscle and tendon that move with a joint. It also keeps the solver's
masses alike: a last phalanx has a thousandth of its toe's inertia, and with a quarter
of this armature feet slip off their perch.
"""

CLOSING = 0.5
"""Time in which the full torque turns a joint by one radian, over T.

A parrot's foot closes by a right angle in some 40 ms, an owl's in 80 ms.
"""

STEPS = 100
"""Least number of time steps in T: 6 in a radian of the fastest joint's phase."""


@dataclass(frozen=True)
class JointDynamics:
    """What moves a joint, and what resists.

    Attributes:
        stiffness: Torque for each radian off the target κ [N·m/rad]; for one of them
            it is the largest torque τ [N·m].
        spring: Torque per angle of the spring that opens the joint [N·m/rad].
        armature: Inertia that is added to the joint's own a [kg·m²].
        damping: Torque per angular velocity d [N·m·s/rad].
    """

    stiffness: float
    spring: float
    armature: float
    damping: float


def characteristic_time(foot: Foot) -> float:
    """The time T = √(L/g), by which all rates are measured.

    Args:
        foot: The foot; L is its size.

    Returns:
        The time [s].
    """
    return math.sqrt(foot.size / GRAVITY)


def timestep(foot: Foot) -> float:
    """The time step of a simulation: 1, 2 or 5 times a power of ten.

    Args:
        foot: The foot.

    Returns:
        The longest such time that fits STEPS times into T [s].
    """
    longest = characteristic_time(foot) / STEPS
    power = 10.0 ** math.floor(math.log10(longest))
    return max(step * power for step in (1, 2, 5) if step * power <= longest)


def joint_dynamics(foot: Foot, mass: float, lever: float) -> JointDynamics:
    """The laws of this module for one joint.

    Args:
        foot: The foot.
        mass: Mass M of the whole foot [kg].
        lever: Length ℓ of the phalanx that the joint moves [m].

    Returns:
        What drives the joint.
    """
    unit = mass * GRAVITY * lever
    stiffness = GRIP * unit
    time = characteristic_time(foot)
    period = time / FREQUENCY
    return JointDynamics(
        stiffness=stiffness,
        spring=RETURN * unit,
        armature=stiffness * period * period,
        damping=CLOSING * time * stiffness,
    )
