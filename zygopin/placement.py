"""Where the branches of one search lie: a direction, and a vertical line of centres."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.branch import Branch
from zygopin.errors import ParameterError

STEEPEST = 1e-3
"""Cosine of a branch's pitch below which its height says nothing of where it is."""


@dataclass(frozen=True, eq=False)
class Placement:
    """Where the branches of one search lie: all but their height and radius.

    Attributes:
        axis: Direction, not vertical; stored as a unit vector, shape (3,).
        x: Forward place of the centre [m].
        y: Place of the centre to the left [m].
    """

    axis: ArrayLike = (0.0, 1.0, 0.0)
    x: float = 0.0
    y: float = 0.0

    def __post_init__(self) -> None:
        place = [checks.number(name, getattr(self, name)) for name in ("x", "y")]
        axis = checks.array("axis", self.axis, last=3)
        checks.shaped("axis", axis, (3,))
        unit = Branch(1.0, (*place, 0.0), axis).axis
        for name, value in zip(("axis", "x", "y"), (unit, *place), strict=True):
            object.__setattr__(self, name, value)
        remedy = "give a branch that rises less: its height must mean something"
        if self.level <= STEEPEST:
            raise ParameterError("axis", unit, "off the vertical", remedy)

    @property
    def centre(self) -> NDArray[np.float64]:
        """The centre at height zero [m], shape (3,)."""
        return np.array([self.x, self.y, 0.0])

    @property
    def level(self) -> float:
        """Cosine of the branches' pitch: their axis' distance per unit of height."""
        return float(np.hypot(*np.asarray(self.axis)[:2]))

    def branch(self, height: ArrayLike, radius: ArrayLike) -> Branch:
        """The branches of given heights and radii.

        Args:
            height: z of the centre [m], shape (…).
            radius: Radius [m], shape (…).

        Returns:
            The branch, or the batch of them.

        Raises:
            ParameterError: A radius is not positive, or a number not finite.
        """
        up = checks.array("height", height)[..., None] * (0.0, 0.0, 1.0)
        return Branch(radius, self.centre + up, self.axis)
