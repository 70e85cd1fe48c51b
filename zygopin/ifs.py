"""Reachable sets of one finger as an iterated function system, with certificates.

In the finger's plane, the complex numbers x + iz, and the source's units: the first
phalanx has length 1/ρ (MODEL.md, section 3).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds, memory
from zygopin.control_system import (
    MAX_WORDS,
    ControlSystem,
    Levels,
    as_depth,
    as_omega,
    as_points,
    as_rho,
    depth_bound,
    depth_within,
    frozen,
    grid_bound,
    words,
)
from zygopin.errors import ParameterError

BLOCK = 2**20
"""Points in a block of `iter_reachable`, unless said otherwise."""

_POINT_BYTES = np.dtype(np.complex128).itemsize


@dataclass(frozen=True)
class ReachableSet:
    """The points that the tip of a finger of `depth` phalanges can reach.

    Point i belongs to the word whose base-n digits, first control first, are those of
    i: words stand in lexicographic order.

    Attributes:
        system: The contractions.
        depth: Number of phalanges k.
        points: All points x + iz, read-only, shape (n^k,).
    """

    system: ControlSystem
    depth: int
    points: NDArray[np.complex128]

    @property
    def rho(self) -> float:
        """Scaling factor ρ."""
        return self.system.rho

    @property
    def omega(self) -> float:
        """Largest joint angle ω [rad]."""
        return self.system.omega

    @property
    def levels(self) -> NDArray[np.float64]:
        """The control levels, sorted, shape (n,)."""
        return self.system.finite_levels

    @property
    def orientation(self) -> float:
        """The initial orientation v₀ [rad]."""
        return self.system.orientation

    @property
    def depth_bound(self) -> float:
        """Bound on d_H(Rₖ, R∞) of these levels: ρ^−k/(ρ−1).

        It is attained where 0 is a level.
        """
        return depth_bound(self.rho, self.depth)

    @property
    def grid_bound(self) -> float:
        """Bound on d_H between Rₖ of these levels and Rₖ of the interval [0, 1].

        Raises:
            ParameterError: 0 or 1 is not a level.
        """
        return grid_bound(self.system, self.depth)

    @property
    def error_bound(self) -> float:
        """Bound on d_H from this set to the attractor of [0, 1].

        The sum of `depth_bound` and `grid_bound`.

        Raises:
            ParameterError: 0 or 1 is not a level.
        """
        return self.depth_bound + self.grid_bound

    def words(self, indices: ArrayLike) -> NDArray[np.float64]:
        """The control sequences of some points, computed from their indices.

        Args:
            indices: Indices into `points`, shape (…).

        Returns:
            Controls in [0, 1], shape (…, k).

        Raises:
            ParameterError: An index is no integer or out of range.
        """
        return words(self.levels, self.depth, indices)


def contraction(
    points: ArrayLike, control: ArrayLike, rho: float, omega: float
) -> NDArray[np.complex128]:
    """The map f_v(x) = e^(−iωv)/ρ·(x + 1) (MODEL.md, section 3).

    Args:
        points: Points x + iz, shape (…).
        control: Control v, broadcast against the points.
        rho: Scaling factor ρ > 1.
        omega: Largest joint angle ω [rad].

    Returns:
        The images, shape (…).

    Raises:
        ParameterError: A parameter is out of range.
    """
    factor = np.exp(-1j * as_omega(omega) * _controls(control)) / as_rho(rho)
    image: NDArray[np.complex128] = factor * (as_points("points", points) + 1)
    return image


def hutchinson(
    points: ArrayLike, levels: Levels, rho: float, omega: float
) -> NDArray[np.complex128]:
    """The Hutchinson operator F(S) = ⋃ f_v(S) over the levels.

    Args:
        points: The points of S, shape (m,).
        levels: The control set: a number of equal levels, or the levels, n of them.
        rho: Scaling factor ρ > 1.
        omega: Largest joint angle ω [rad].

    Returns:
        The n·m images, those of the first level first, shape (n·m,).

    Raises:
        ParameterError: A parameter is out of range.
    """
    system = ControlSystem(rho, omega, levels)
    shifted = as_points("points", points).ravel() + 1
    return np.multiply.outer(system.factors, shifted).ravel()


def reachable_set(
    rho: float,
    omega: float,
    levels: Levels,
    depth: int,
    *,
    orientation: float = 0.0,
    max_bytes: int | None = None,
) -> ReachableSet:
    """All points Rₖ = e^(−iv₀)·F^k({0}) that k phalanges can reach.

    One array is allocated and filled in place: its first nʲ entries hold F^j({0})
    and grow n-fold at each step.

    Args:
        rho: Scaling factor ρ > 1.
        omega: Largest joint angle ω, in (0, 2π) without π [rad].
        levels: The control set: a number n of equal levels, or the levels.
        depth: Number of phalanges k ≥ 1.
        orientation: The initial orientation v₀ [rad].
        max_bytes: Most memory for the points; None: half of the machine's.

    Returns:
        The set with its certificates.

    Raises:
        ParameterError: A parameter is out of range, or the points need more memory.
    """
    system = ControlSystem(rho, omega, levels, orientation)
    depth = as_depth(depth)
    count = _word_count(system, depth)
    _check_memory(count, max_bytes)
    points = np.empty(count, dtype=np.complex128)
    _fill(points, system, depth, system.turn)
    return ReachableSet(system, depth, frozen(points))


def iter_reachable(
    system: ControlSystem, depth: int, *, block: int = BLOCK
) -> Iterator[tuple[range, NDArray[np.complex128]]]:
    """The points of a reachable set in blocks, for sets that do not fit in memory.

    Args:
        system: The contractions, of a finite control set.
        depth: Number of phalanges k ≥ 1.
        block: Most points in a block, if that holds one copy of the levels.

    Returns:
        Pairs of the range of indices (see `words`) and the points, in order.

    Raises:
        ParameterError: A parameter is out of range.
    """
    kinds.instance("system", system, ControlSystem)
    depth = as_depth(depth)
    block = checks.integer("block", block, 1, 2**40)
    _word_count(system, depth)
    return _blocks(system, depth, block)


def attractor(
    rho: float,
    omega: float,
    levels: Levels,
    tolerance: float,
    *,
    orientation: float = 0.0,
) -> ReachableSet:
    """A reachable set within a tolerance of the attractor R∞ of the same levels.

    Args:
        rho: Scaling factor ρ > 1.
        omega: Largest joint angle ω, in (0, 2π) without π [rad].
        levels: The control set: a number n of equal levels, or the levels.
        tolerance: Largest Hausdorff distance allowed, > 0.
        orientation: The initial orientation v₀ [rad].

    Returns:
        The set of the smallest depth whose `depth_bound` is within the tolerance.

    Raises:
        ParameterError: A parameter is out of range, or the points need more memory.
    """
    depth = depth_within(rho, tolerance)
    return reachable_set(rho, omega, levels, depth, orientation=orientation)


def _fill(
    points: NDArray[np.complex128],
    system: ControlSystem,
    depth: int,
    turn: complex = 1.0,
) -> None:
    """Write turn·F^depth({0}) into an array of its size."""
    points[0] = 0
    size = 1
    for step in range(1, depth + 1):
        factors = system.factors * (turn if step == depth else 1.0)
        base = points[:size]
        base += 1
        for place in range(len(factors) - 1, -1, -1):
            image = points[place * size : (place + 1) * size]
            np.multiply(base, factors[place], out=image)
        size *= len(factors)


def _blocks(
    system: ControlSystem, depth: int, block: int
) -> Iterator[tuple[range, NDArray[np.complex128]]]:
    """Blocks of equal tails: a prefix of each word, and all that may follow it."""
    levels = system.finite_levels
    tail_depth = 0
    while tail_depth < depth and len(levels) ** (tail_depth + 1) <= block:
        tail_depth += 1
    size = len(levels) ** tail_depth
    tail = np.empty(size, dtype=np.complex128)
    _fill(tail, system, tail_depth)
    prefix = depth - tail_depth
    for index in range(len(levels) ** prefix):
        place, direction = 0j, system.turn
        for digit in reversed(range(prefix)):
            control = levels[index // len(levels) ** digit % len(levels)]
            direction *= np.exp(-1j * system.omega * control) / system.rho
            place += direction
        yield range(index * size, (index + 1) * size), place + direction * tail


def _word_count(system: ControlSystem, depth: int) -> int:
    """The number of words, where an index can count them."""
    count: int = len(system.finite_levels) ** depth
    if count > MAX_WORDS:
        remedy = "take fewer levels or phalanges, or draw the set as a raster"
        raise ParameterError("number of words", count, f"at most {MAX_WORDS}", remedy)
    return count


def _check_memory(count: int, max_bytes: int | None) -> None:
    """Refuse a set whose points do not fit."""
    remedy = "stream them with iter_reachable, or take fewer levels or phalanges"
    most = memory.limit(max_bytes)
    memory.require(f"{count} points", count * _POINT_BYTES, most, remedy)


def _controls(control: ArrayLike) -> NDArray[np.float64]:
    """Controls, checked to lie in [0, 1]."""
    values = checks.array("control", control)
    remedy = "0 is the straight joint, 1 the fully closed one"
    good = (values >= 0) & (values <= 1)
    checks.require("control", values, good, "in [0, 1]", remedy)
    return values
