"""How hard toes press: a bound on each contact, and on what moves their joints."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.contacts import Floats, Friction


@dataclass(frozen=True, eq=False)
class Drive:
    """What moves the toes' joints, and how strong it is; no other torque acts.

    The balance of joint k: Σ matrix[k]·forces + Σ torques[k]·u + stop = 0, with the
    motors' shares u between low and 1. The stop of a straight joint can only close it,
    that of a fully bent one only open it; other joints have none.

    Attributes:
        matrix: Closing torques per unit of contact force [m], shape (P, N, 3).
        torques: Closing torque of each of U motors at full strength at each joint
            [N·m], shape (P, U).
        low: Least share of each motor, 0 where it only closes, shape (U,).
        straight: Joints at their open stop, shape (P,).
        bent: Joints at their closed stop, shape (P,).
    """

    matrix: Floats
    torques: Floats
    low: Floats
    straight: NDArray[np.bool_]
    bent: NDArray[np.bool_]

    def __post_init__(self) -> None:
        checks.freeze(self)


@dataclass(frozen=True)
class Strength:
    """How hard a foot can hold.

    Attributes:
        normal_force: Largest normal force of each contact [N]; infinite where the
            drive alone bounds it.
        friction: Friction of each contact.
        drive: What moves the joints; None: each has whatever torque it needs.

    Raises:
        ParameterError: A force that is not positive, or infinite without a drive.
    """

    normal_force: float
    friction: Friction
    drive: Drive | None = None

    def __post_init__(self) -> None:
        kinds.instance("friction", self.friction, Friction)
        if self.drive is not None:
            kinds.instance("drive", self.drive, Drive)
        if self.drive is not None and self.normal_force == math.inf:
            return
        value = checks.number(
            "toe force",
            self.normal_force,
            allowed="a positive number of newtons",
            where=lambda force: 0 < force <= checks.LARGEST,
            remedy="give what one phalanx can press, such as 1",
        )
        object.__setattr__(self, "normal_force", value)

    @property
    def unit(self) -> float:
        """The force in whose multiples a programme counts [N]."""
        return self.normal_force if math.isfinite(self.normal_force) else 1.0
