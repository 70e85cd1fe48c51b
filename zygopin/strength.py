"""How hard toes press: each joint by itself, or all of a toe by one tendon."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.contacts import Floats, Friction


@dataclass(frozen=True, eq=False)
class Tendon:
    """Toes each drawn by one tendon: all joints of a toe share its tension.

    The tendon passes each joint at its phalanx's skin radius, so that it bends it with
    tension·radius. A straight joint rests on its stop, which can only close it, a fully
    bent one on the other, which can only open it; no other torque acts.

    Attributes:
        tension: Largest tension of each toe's tendon [N].
        matrix: Closing torques per unit of contact force [m], shape (P, N, 3).
        arms: Moment arm of the tendon at each joint [m], shape (P,).
        finger: Index of each joint's toe, shape (P,).
        straight: Joints at their open stop, shape (P,).
        bent: Joints at their closed stop, shape (P,).
    """

    tension: float
    matrix: Floats
    arms: Floats
    finger: NDArray[np.intp]
    straight: NDArray[np.bool_]
    bent: NDArray[np.bool_]

    def __post_init__(self) -> None:
        checks.freeze(self)


@dataclass(frozen=True)
class Strength:
    """How hard a toe can press.

    Attributes:
        normal_force: Largest normal force of each contact [N].
        friction: Friction of each contact.
        tendon: The toes' tendons, which then bear all that the joints must; None:
            each joint has whatever torque it needs.

    Raises:
        ParameterError: A force that is not positive.
    """

    normal_force: float
    friction: Friction
    tendon: Tendon | None = None

    def __post_init__(self) -> None:
        value = checks.number(
            "toe force",
            self.normal_force,
            allowed="a positive number of newtons",
            where=lambda force: force > 0,
            remedy="give what one phalanx can press, such as 1",
        )
        object.__setattr__(self, "normal_force", value)
