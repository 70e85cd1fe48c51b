"""One row of an atlas as steps: branches by growing radius, and the poses on them."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.atlas import Atlas
from zygopin.atlas_regions import Cell, Region, has_pose, region_map
from zygopin.branch import Branch
from zygopin.errors import ParameterError
from zygopin.kinematics import forward_kinematics

MOST_STEPS = 48
"""Branches of a scene; rows with more radii are thinned: about two megabytes."""

STEP = 0.35
"""How long each branch is shown [s]."""

ROUNDING = 1e-9
"""How far over the foot's size a branch may be too near to the base to rest on."""


@dataclass(frozen=True, eq=False)
class Row:
    """Branches by growing radius, at one height or right under the base.

    Attributes:
        atlas: The atlas.
        cells: Rows and columns of the branches.
        height: Their height [m]; None: as high as the base allows.
    """

    atlas: Atlas
    cells: tuple[Cell, ...]
    height: float | None

    @classmethod
    def at(cls, atlas: Atlas, height: float | None) -> Row:
        """The branches of a row; those that hold the base are left out.

        Args:
            atlas: The atlas.
            height: z of their centres [m], the nearest of the grid's; None: for each
                radius the highest that a base with its skin can rest on.

        Returns:
            The row, thinned to `MOST_STEPS`.

        Raises:
            ParameterError: No branch leaves the base free.
        """
        grid = atlas.grid
        if height is None:
            # A foot at rest has its skin between its base and the bark.
            room = grid.base_distance[:, None] - grid.radii - atlas.foot.radii.max()
            room[(room < -ROUNDING * atlas.foot.size) | ~grid.valid] = np.inf
            room[grid.heights > 0] = np.inf
            rows, level = np.argmin(room, axis=0), None
            usable = np.isfinite(room.min(axis=0))
        else:
            row = int(np.argmin(np.abs(grid.heights - checks.number("height", height))))
            rows, level = np.full(grid.shape[1], row), float(grid.heights[row])
            usable = grid.valid[row]
        columns = np.flatnonzero(usable)
        if not len(columns):
            remedy = "choose one farther below the base"
            allowed = "a height with branches that do not hold the base"
            raise ParameterError("height", height, allowed, remedy)
        count = min(len(columns), MOST_STEPS)
        places = np.linspace(0, len(columns) - 1, count).round().astype(int)
        cells = tuple((int(rows[k]), int(k)) for k in columns[places])
        return cls(atlas, cells, level)

    @cached_property
    def regions(self) -> list[Region]:
        """The most that is shown for each branch."""
        found = region_map(self.atlas)
        return [Region(int(found[cell])) for cell in self.cells]

    @cached_property
    def posed(self) -> list[bool]:
        """Which branches have a pose."""
        found = has_pose(self.atlas)
        return [bool(found[cell]) for cell in self.cells]

    @cached_property
    def times(self) -> NDArray[np.float64]:
        """When each branch is shown first [s]."""
        return np.array([STEP * k for k in range(len(self.cells))])

    def ends(self, step: int) -> tuple[float, float]:
        """From when until when a branch is shown [s]."""
        last = step == len(self.cells) - 1
        start = float(self.times[step])
        return start, start + (1e3 if last else STEP)

    def branch(self, step: int) -> Branch:
        """One of the branches."""
        return self.atlas.branch(*self.cells[step])

    def radius(self, step: int) -> float:
        """Radius of one of the branches [m]."""
        return float(self.atlas.grid.radii[self.cells[step][1]])

    @cached_property
    def bones(self) -> NDArray[np.float64]:
        """Bones of the poses, where there is none those before, (n, P, 2, 3) [m]."""
        foot = self.atlas.foot
        controls = np.zeros((len(self.cells), foot.phalanx_count))
        shown = np.zeros(foot.phalanx_count)
        for step, cell in enumerate(self.cells):
            for poses in (self.atlas.stable_controls, self.atlas.controls):
                if np.isfinite(poses[cell]).all():
                    shown = poses[cell]
            controls[step] = shown
        return forward_kinematics(foot, controls)

    @property
    def changes(self) -> list[int]:
        """Steps at which another region begins, the first among them."""
        regions = self.regions
        return [k for k in range(len(regions)) if not k or regions[k - 1] != regions[k]]
