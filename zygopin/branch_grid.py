"""Parallel branches over a grid of heights and radii."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike

from zygopin import checks, kinds
from zygopin.branch import Branch
from zygopin.errors import ParameterError
from zygopin.projection import Complexes, Floats, ProjectedFinger

MOST_BRANCHES = 2**22
"""Branches of one grid: the arrays of an answer then take about two gigabytes."""


@dataclass(frozen=True, eq=False)
class BranchGrid:
    """Infinite branches of one direction, centred above or below one point.

    Attributes:
        heights: z of the centres, strictly rising or falling [m], shape (H,).
        radii: Strictly rising radii [m], shape (R,).
        axis: Direction of all the branches, made a unit vector, shape (3,).
        offset: x and y of the centres [m].
    """

    heights: Floats
    radii: Floats
    axis: Floats
    offset: Floats

    def __init__(
        self,
        heights: ArrayLike,
        radii: ArrayLike,
        axis: ArrayLike = (0.0, 1.0, 0.0),
        offset: ArrayLike = (0.0, 0.0),
    ) -> None:
        level = _monotone("heights", heights)
        thick = _monotone("radii", radii)
        across = checks.array("offset", offset)
        checks.shaped("offset", across, (2,))
        for end in level[[0, -1]]:
            first = Branch(float(thick[0]), (*across, end), axis)
        checks.shaped("axis", first.axis, (3,))
        if len(thick) > 1 and thick[1] < thick[0]:
            raise ParameterError("radii", thick, "rising", "sort them")
        if len(level) * len(thick) > MOST_BRANCHES:
            asked = f"{len(level)} x {len(thick)}"
            allowed = f"at most {MOST_BRANCHES} cells"
            raise ParameterError("grid", asked, allowed, "ask for fewer")
        for name, value in (
            ("heights", level),
            ("radii", thick),
            ("axis", first.axis),
            ("offset", across),
        ):
            object.__setattr__(self, name, checks.read_only(value))

    @property
    def shape(self) -> tuple[int, int]:
        """(H, R)."""
        return len(self.heights), len(self.radii)

    def at(self, rows: ArrayLike, columns: ArrayLike) -> Branch:
        """Some of the branches.

        Args:
            rows: Indices of heights, shape (…).
            columns: Indices of radii, shape (…).

        Returns:
            A batch of branches, shape (…).
        """
        level = checks.indices("rows", rows, len(self.heights))
        height, radius = (
            self.heights[level],
            self.radii[checks.indices("columns", columns, len(self.radii))],
        )
        across = np.broadcast_to(self.offset, (*height.shape, 2))
        centre = np.concatenate([across, height[..., None]], axis=-1)
        return Branch(radius, centre, self.axis)

    def rows(self, which: slice) -> BranchGrid:
        """The grid of some of the heights.

        Args:
            which: Their indices.
        """
        kinds.instance("which", which, slice)
        return BranchGrid(self.heights[which], self.radii, self.axis, self.offset)

    def line(self, finger: ProjectedFinger) -> tuple[complex, complex]:
        """Where a finger sees the centres: origin and step, centre = origin + z·step.

        Args:
            finger: The finger, seen along the axis.
        """
        origin = finger.flat(np.array([*self.offset, 0.0]))
        return complex(origin), complex(finger.flat(np.array([0.0, 0.0, 1.0])))

    def centres(self, finger: ProjectedFinger) -> Complexes:
        """Centres in a finger's plane, shape (H,)."""
        origin, step = self.line(finger)
        return np.asarray(origin + self.heights * step)

    @cached_property
    def base_distance(self) -> Floats:
        """Distance of the base from the axes [m], shape (H,)."""
        points = np.concatenate(
            [
                np.broadcast_to(self.offset, (len(self.heights), 2)),
                self.heights[:, None],
            ],
            axis=1,
        )
        flat = points - (points @ self.axis)[:, None] * self.axis
        return np.asarray(np.linalg.norm(flat, axis=1))

    @property
    def valid(self) -> np.ndarray[tuple[int, int], np.dtype[np.bool_]]:
        """Which branches do not hold the foot's base inside them, shape (H, R)."""
        return np.asarray(self.base_distance[:, None] >= self.radii)


def _monotone(name: str, values: ArrayLike) -> Floats:
    """A strictly monotone list of numbers."""
    found = np.atleast_1d(checks.array(name, values))
    steps = np.diff(found)
    listed = found.ndim == 1 and found.size > 0
    if not (listed and ((steps > 0).all() or (steps < 0).all())):
        remedy = "list each value once, in order"
        raise ParameterError(name, values, "strictly rising or falling", remedy)
    return found
