"""A finger of any length as contractions of the plane: parameters, words, bounds.

Everything is in the finger's plane, the complex numbers x + iz, in the source's units:
the first phalanx has length 1/ρ (MODEL.md, section 3). Callers apply the scale.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.errors import ParameterError

MAX_DEPTH = 1000
"""Largest depth k: far beyond what double precision can tell apart."""

MAX_WORDS = 2**62
"""Most words that an index can count."""

Levels = int | Sequence[float] | NDArray[Any]
"""A finite control set: n equal levels of [0, 1], or the levels themselves."""


@dataclass(frozen=True)
class ControlSystem:
    """A finger of any length: its contractions f_v for v in a control set.

    f_v(x) = e^(−iωv)/ρ·(x + 1) (MODEL.md, section 3).

    Attributes:
        rho: Scaling factor ρ > 1 between a phalanx and the next.
        omega: Largest joint angle ω, in (0, 2π) without π [rad].
        levels: The control set, in [0, 1], sorted, read-only, shape (n,); an int n
            stands for n equal levels. None: the whole interval [0, 1].
        orientation: The initial orientation v₀, downward from horizontal [rad].
    """

    rho: float
    omega: float
    levels: NDArray[np.float64] | Levels | None = None
    orientation: float = 0.0

    def __post_init__(self) -> None:
        set_field = object.__setattr__
        set_field(self, "rho", as_rho(self.rho))
        set_field(self, "omega", as_omega(self.omega))
        set_field(self, "orientation", checks.angle("orientation", self.orientation))
        if self.levels is not None:
            set_field(self, "levels", as_levels(self.levels))

    @property
    def finite_levels(self) -> NDArray[np.float64]:
        """The levels of a finite control set, shape (n,).

        Raises:
            ParameterError: The control set is the interval [0, 1].
        """
        if isinstance(self.levels, np.ndarray):
            return self.levels
        remedy = "give a number of levels, such as 33, or a sequence of levels"
        raise ParameterError("levels", self.levels, "a finite control set", remedy)

    @property
    def factors(self) -> NDArray[np.complex128]:
        """The factors e^(−iωv)/ρ of the contractions, shape (n,)."""
        factors: NDArray[np.complex128] = (
            np.exp(-1j * self.omega * self.finite_levels) / self.rho
        )
        return factors

    @property
    def turn(self) -> complex:
        """The factor e^(−iv₀) of the initial orientation."""
        return complex(np.exp(-1j * self.orientation))

    def tail(self, depth: int, total: float = math.inf) -> float:
        """Radius of the disc around x_depth that holds all that follows.

        Σ_{depth<m≤total} ρ^−m; ρ^−depth/(ρ−1) without an end.

        Args:
            depth: Phalanges that are already placed.
            total: Phalanges in all; infinite for the attractor.

        Returns:
            The radius.
        """
        depth = checks.integer("depth", depth, 0, MAX_DEPTH)
        if isinstance(total, float) and total == math.inf:
            return depth_bound(self.rho, depth)
        total = checks.integer("total", total, depth, MAX_DEPTH)
        # Not the difference of two endless tails: near ρ = 1 both are huge.
        rank = np.arange(depth + 1.0, total + 1)
        return float(np.sum(self.rho**-rank))


def depth_bound(rho: float, depth: float) -> float:
    """Bound on d_H(Rₖ, R∞): ρ^−k/(ρ−1), attained where 0 is a level.

    Args:
        rho: Scaling factor ρ > 1.
        depth: Number of phalanges k.

    Returns:
        The bound.
    """
    bound: float = rho**-depth / (rho - 1)
    return bound


def depth_within(rho: float, tolerance: float) -> int:
    """The smallest depth k ≥ 1 with ρ^−k/(ρ−1) within a tolerance.

    Args:
        rho: Scaling factor ρ > 1.
        tolerance: Largest Hausdorff distance allowed, > 0.

    Returns:
        The depth k.

    Raises:
        ParameterError: A parameter is out of range.
    """
    rho, tolerance = as_rho(rho), as_tolerance(tolerance)
    depth = max(1, math.ceil(-math.log(tolerance * (rho - 1)) / math.log(rho)) - 1)
    while depth_bound(rho, depth) > tolerance:
        depth += 1
    return as_depth(depth)


def grid_bound(system: ControlSystem, depth: int) -> float:
    """Bound on d_H between Rₖ of some levels and Rₖ of the interval [0, 1].

    (ωh/2)·Σ_{j≤k} j·ρ^−j, with h the largest gap between levels: each control moves
    by at most h/2, so the direction of phalanx j turns by at most jωh/2.

    Args:
        system: The contractions.
        depth: Number of phalanges k.

    Returns:
        The bound; 0 for the interval itself.

    Raises:
        ParameterError: 0 or 1 is not a level.
    """
    if system.levels is None:
        return 0.0
    levels = system.finite_levels
    if levels[0] != 0 or levels[-1] != 1:
        ends = float(levels[0]), float(levels[-1])
        remedy = "add them, or use depth_bound, which holds for any levels"
        allowed = "(0, 1), which a bound against the interval [0, 1] needs"
        raise ParameterError("first and last level", ends, allowed, remedy)
    rank = np.arange(1.0, depth + 1)
    weight = float(np.sum(rank * system.rho**-rank))
    return system.omega * float(np.diff(levels).max()) / 2 * weight


def words(levels: Levels, depth: int, indices: ArrayLike) -> NDArray[np.float64]:
    """The control sequences of points, from their indices in lexicographic order.

    Args:
        levels: The control set: a number n of equal levels, or the levels.
        depth: Number of phalanges k.
        indices: Indices from 0 to n^k − 1, shape (…).

    Returns:
        Controls in [0, 1], shape (…, k).

    Raises:
        ParameterError: An index is no integer or out of range.
    """
    levels, depth = as_levels(levels), as_depth(depth)
    count = len(levels) ** depth
    what, remedy = "an array of integers", "give integers"
    index = checks.array_of("indices", indices, "iu", what, remedy)
    good, remedy = (index >= 0) & (index < count), "count points from 0"
    checks.require("indices", index, good, f"in [0, {count - 1}]", remedy)
    places = [len(levels) ** (depth - j) for j in range(1, depth + 1)]
    digits = [index // min(place, MAX_WORDS) % len(levels) for place in places]
    return levels[np.stack(digits, axis=-1).astype(np.intp)]


def as_levels(levels: Levels) -> NDArray[np.float64]:
    """A finite control set as one checked array.

    Args:
        levels: A number n ≥ 2 of equal levels of [0, 1], or the levels.

    Returns:
        The levels, sorted, each once, read-only, shape (n,).

    Raises:
        ParameterError: Fewer than two equal levels, or a level outside [0, 1].
    """
    values = checks.array("levels", levels)
    if values.ndim == 0:
        count = checks.integer("number of levels", levels, 2, 2**24)
        return frozen(np.linspace(0, 1, count))
    if values.ndim != 1 or not values.size:
        remedy = "give a sequence of levels, or their number"
        raise ParameterError("levels.shape", values.shape, "(n,) with n ≥ 1", remedy)
    remedy = "give controls: 0 is the straight joint, 1 the fully closed one"
    good = (values >= 0) & (values <= 1)
    checks.require("levels", values, good, "in [0, 1]", remedy)
    return frozen(np.unique(values + 0.0))


def as_depth(depth: int) -> int:
    """A checked depth k, from 1 to `MAX_DEPTH`."""
    return checks.integer("depth", depth, 1, MAX_DEPTH)


def as_tolerance(tolerance: float) -> float:
    """A checked tolerance > 0."""
    return checks.number(
        "tolerance",
        tolerance,
        allowed=f"a finite number > 0, up to {checks.LARGEST:g}",
        where=lambda x: 0 < x <= checks.LARGEST,
        remedy="give a distance, in units in which the first phalanx has length 1/ρ",
    )


def as_points(name: str, points: ArrayLike) -> NDArray[np.complex128]:
    """Finite complex numbers as an array, shape (…)."""
    remedy = "give x + iz as a complex number"
    kinds = f"{checks.REAL}c"
    given = checks.array_of(name, points, kinds, "complex numbers", remedy)
    values = given.astype(np.complex128)
    checks.require(name, values, np.isfinite(values), "finite", "give finite x + iz")
    near = np.abs(values.real) + np.abs(values.imag) <= checks.LARGEST
    checks.require(name, values, near, f"within {checks.LARGEST:g}", remedy)
    return values


def frozen(values: NDArray[Any]) -> NDArray[Any]:
    """The array, read-only."""
    values.setflags(write=False)
    return values


def as_rho(rho: float) -> float:
    """A checked scaling factor."""
    return checks.number(
        "rho",
        rho,
        allowed="a number above 1, up to 100",
        where=lambda x: 1 < x <= 100,
        remedy="phalanges shrink by ρ: give a number such as 1.2",
    )


def as_omega(omega: float) -> float:
    """A checked largest joint angle [rad]."""
    return checks.number(
        "omega",
        omega,
        allowed="in (0, 2π) and different from π",
        where=lambda x: 0 < x < 2 * math.pi and x != math.pi,
        remedy="give radians, such as 0.5236 for 30°",
    )
