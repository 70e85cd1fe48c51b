"""The grid of a sweep: which quantities of foot and branch vary, and over what."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from zygopin import checks, kinds
from zygopin.branch import Branch, branch_axis
from zygopin.errors import ParameterError
from zygopin.finger import MAX_PHALANGES
from zygopin.foot import Foot
from zygopin.rest import resting_branch

MOST_CELLS = 10_000_000
"""Cells of a grid: their results take a few gigabytes."""


class Quantity(NamedTuple):
    """A quantity that a sweep can vary.

    Attributes:
        unit: Its unit, as netCDF files have it; empty: a label.
        words: What it is.
    """

    unit: str
    words: str


FOOT_QUANTITIES = {
    "rho": Quantity("1", "ratio of the lengths of a phalanx and the next"),
    "omega": Quantity("rad", "largest joint angle"),
    "splay": Quantity("rad", "angle between the fingers' planes and the xz-plane"),
    "scale": Quantity("m", "length scale of the phalanges"),
    "thickness": Quantity("m", "radius of the skin before scaling"),
    "phalanges": Quantity("", "numbers of phalanges of the fingers, in order"),
}
"""What varies the foot, under the names of its fields."""

BRANCH_QUANTITIES = {
    "radius": Quantity("m", "radius of the branch"),
    "height": Quantity("m", "z of the branch's centre"),
    "yaw": Quantity("rad", "turn of the branch about z from across the foot"),
    "pitch": Quantity("rad", "rise of the branch to the left"),
}
"""What varies the branch."""

QUANTITIES = FOOT_QUANTITIES | BRANCH_QUANTITIES

REST, FOUND = "rest", "found"
"""Heights by name: the base sits on the bark; where the branch is grasped best."""

DEFAULTS: dict[str, Any] = {"height": REST, "yaw": 0.0, "pitch": 0.0}
"""The branch where nothing else is said."""

_COUNTS = re.compile(r"\d{1,2}(-\d{1,2})*")

Value = float | str


@dataclass(frozen=True)
class SweepGrid:
    """A foot, what is fixed, and what varies; cells are numbered in C order.

    Attributes:
        foot: The foot that the sweep starts from.
        fixed: Quantities of one value, by name [SI].
        axes: Quantities that vary, by name, each with its values [SI], in the order
            of the dimensions.
    """

    foot: Foot
    fixed: Mapping[str, Value]
    axes: Mapping[str, tuple[Value, ...]]

    @classmethod
    def of(cls, foot: Foot, grid: Mapping[str, Any]) -> SweepGrid:
        """A grid from what a caller gives.

        Args:
            foot: The foot that the sweep starts from.
            grid: Quantities by name [SI]: a number, or numbers in a sequence;
                phalanges as `2-3-4-5` or (2, 3, 4, 5), or a list of such; a height may
                be `rest` or `found`.

        Returns:
            The grid.

        Raises:
            UnknownNameError: There is no quantity or height of that name.
            ParameterError: A value is no finite number, occurs twice, or the radius
                is missing.
        """
        kinds.instance("foot", foot, Foot)
        if not isinstance(grid, Mapping):
            remedy = "give names of quantities and their values"
            raise ParameterError("grid", grid, "a mapping", remedy)
        if "radius" not in grid:
            remedy = "give metres, such as [0.004, 0.008]"
            raise ParameterError("grid['radius']", None, "given", remedy)
        fixed, axes = dict(DEFAULTS), {}
        for name, given in grid.items():
            kinds.one_of("quantity of a sweep", name, QUANTITIES)
            values, single = _parsed(foot, name, given)
            if single:
                fixed[name] = values[0]
            else:
                fixed.pop(name, None)
                axes[name] = values
        made = cls(foot, fixed, axes)
        checks.integer("number of cells", made.count, 1, MOST_CELLS)
        return made

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values along each dimension."""
        return tuple(map(len, self.axes.values()))

    @property
    def count(self) -> int:
        """Number of cells."""
        return math.prod(self.shape)

    @property
    def width(self) -> int:
        """Most phalanges that any finger has in any cell."""
        given = self.axes.get("phalanges", (self.fixed.get("phalanges"),))
        own = [finger.phalanges for finger in self.foot.fingers]
        return max(
            max(own if text is None else phalanx_counts(str(text))) for text in given
        )

    def cell(self, index: int) -> dict[str, Value]:
        """What varies, in one cell.

        Args:
            index: The cell's number.

        Returns:
            The value of each dimension [SI].
        """
        places = np.unravel_index(index, self.shape) if self.axes else ()
        return {
            name: values[int(place)]
            for (name, values), place in zip(self.axes.items(), places, strict=True)
        }


def phalanx_counts(text: str) -> tuple[int, ...]:
    """Numbers of phalanges from a label such as `2-3-4-5`."""
    return tuple(int(part) for part in text.split("-"))


def cell_foot(foot: Foot, values: Mapping[str, Value]) -> Foot:
    """The foot of a cell.

    Args:
        foot: The foot that the sweep starts from.
        values: The cell's quantities [SI].

    Returns:
        The foot with what the cell says about it.

    Raises:
        ParameterError: There is no such foot.
    """
    given = {name: values[name] for name in FOOT_QUANTITIES if name in values}
    counts = given.pop("phalanges", None)
    changed = foot.replace(**given)
    if counts is None:
        return changed
    pairs = zip(changed.fingers, phalanx_counts(str(counts)), strict=True)
    fingers = tuple(replace(finger, phalanges=count) for finger, count in pairs)
    return changed.replace(fingers=fingers)


def cell_branch(foot: Foot, values: Mapping[str, Value]) -> Branch:
    """The branch of a cell, before its height is found where that is asked for.

    Args:
        foot: The cell's foot.
        values: The cell's quantities [SI].

    Returns:
        The branch, its centre on the z axis.

    Raises:
        ParameterError: There is no such branch.
    """
    radius, yaw, pitch = (float(values[name]) for name in ("radius", "yaw", "pitch"))
    resting = resting_branch(foot, radius, yaw=yaw, pitch=pitch)
    height = values["height"]
    if isinstance(height, str):
        return resting
    return Branch(radius, (0.0, 0.0, height), branch_axis(yaw, pitch))


def _parsed(foot: Foot, name: str, given: Any) -> tuple[tuple[Value, ...], bool]:  # noqa: ANN401
    """The values of a quantity, and whether it is a single one that does not vary."""
    if name == "phalanges":
        return _parsed_counts(foot, given)
    if name == "height" and isinstance(given, str):
        kinds.one_of("height", given, (REST, FOUND))
        return (given,), True
    values = checks.array(f"grid[{name!r}]", given)
    if values.ndim > 1:
        remedy = "give a number, or numbers in a row"
        raise ParameterError(f"grid[{name!r}].shape", values.shape, "(n,)", remedy)
    listed = tuple(float(value) for value in values.ravel())
    _check_distinct(name, listed)
    return listed, values.ndim == 0


def _parsed_counts(foot: Foot, given: Any) -> tuple[tuple[str, ...], bool]:  # noqa: ANN401
    """Numbers of phalanges as labels."""
    single = isinstance(given, str) or (
        isinstance(given, Sequence)
        and len(given) > 0
        and np.ndim(given[0]) == 0
        and not isinstance(given[0], str)
    )
    labels = tuple(_label(foot, each) for each in ([given] if single else given))
    _check_distinct("phalanges", labels)
    return labels, single


def _label(foot: Foot, given: Any) -> str:  # noqa: ANN401
    """One foot's numbers of phalanges as a label, checked."""
    text = given if isinstance(given, str) else "-".join(str(n) for n in given)
    fingers = len(foot.fingers)
    counts = phalanx_counts(text) if _COUNTS.fullmatch(text) else ()
    if len(counts) != fingers or not all(1 <= n <= MAX_PHALANGES for n in counts):
        allowed = f"{fingers} numbers from 1 to {MAX_PHALANGES}"
        own = "-".join(str(finger.phalanges) for finger in foot.fingers)
        raise ParameterError("phalanges", text, allowed, f"give such as {own}")
    return "-".join(map(str, counts))


def _check_distinct(name: str, values: tuple[Value, ...]) -> None:
    """A dimension has values, each once: they are its labels."""
    if not values or len(set(values)) != len(values):
        allowed, remedy = "one or more distinct values", "give each value once"
        raise ParameterError(f"grid[{name!r}]", values, allowed, remedy)
