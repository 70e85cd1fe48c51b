"""What a query of the word tree asks, and what it answers."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from zygopin.control_system import ControlSystem, frozen

Verdict = Literal["reachable", "not_reachable", "undecided"]
"""Whether some word comes within the tolerance; undecided where the search stopped."""

ROUNDING = 1e-14
"""Relative rounding of a sum of phalanges, which every bound is widened by."""


@dataclass(frozen=True)
class Goal:
    """A query.

    Attributes:
        target: The point x + iz.
        depth: Number of phalanges k.
        tolerance: Largest distance that counts as reached.
        max_nodes: Nodes to visit before the search gives up.
        nearest: Go on to the nearest point, rather than stop within the tolerance.
    """

    target: complex
    depth: int
    tolerance: float
    max_nodes: int
    nearest: bool


@dataclass(frozen=True)
class WordAnswer:
    """The answer to a query, with what proves it.

    Attributes:
        verdict: `reachable`, `not_reachable` or `undecided`, within the tolerance.
        controls: The best control sequence met, read-only, shape (k,).
        distance: The distance of its tip from the target.
        lower_bound: No control sequence comes nearer than this: the certificate.
        nodes: Nodes of the tree that were visited.
    """

    verdict: Verdict
    controls: NDArray[np.float64]
    distance: float
    lower_bound: float
    nodes: int


def answer(
    system: ControlSystem,
    goal: Goal,
    controls: NDArray[np.float64],
    open_bound: float,
    nodes: int,
) -> WordAnswer:
    """The answer that a search's findings amount to.

    Args:
        system: The contractions.
        goal: The query.
        controls: The best control sequence met, shape (k,).
        open_bound: Least distance that the words left out could still have.
        nodes: Nodes that were visited.

    Returns:
        The answer; its distance is measured anew from the controls.
    """
    distance = abs(tip(system, controls) - goal.target)
    margin = ROUNDING * (system.tail(0, goal.depth) + abs(goal.target))
    lower = max(0.0, min(distance, open_bound) - margin)
    verdict: Verdict = "undecided"
    if distance <= goal.tolerance:
        verdict = "reachable"
    elif lower > goal.tolerance or open_bound >= distance - margin:
        verdict = "not_reachable"
    return WordAnswer(verdict, frozen(controls), float(distance), lower, nodes)


def tip(system: ControlSystem, controls: NDArray[np.float64]) -> complex:
    """The tip of a finger: equation (sys), for one control sequence of shape (k,)."""
    rank = np.arange(1.0, len(controls) + 1)
    pitch = system.omega * np.cumsum(controls)
    return system.turn * complex(np.sum(system.rho**-rank * np.exp(-1j * pitch)))


def arc_discs(
    system: ControlSystem, depth: int
) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Discs that hold all that can follow j phalanges, j = 0 … depth.

    The direction of the i-th phalanx that follows lies on an arc of half angle iω/2;
    an arc of half angle δ < π/2 lies in the disc of radius sin δ around cos δ times
    its middle, and any arc in the unit disc.

    Args:
        system: The contractions.
        depth: Number of phalanges k in all.

    Returns:
        Centres, as factors of the last phalanx's vector, and radii, shape (k+1,).
    """
    rank = np.arange(1.0, depth + 1)
    half = np.minimum(rank * system.omega / 2, np.pi / 2)
    weight = system.rho**-rank
    middle = weight * np.cos(half) * np.exp(-0.5j * system.omega * rank)
    centres = np.concatenate([[0], np.cumsum(middle)])[::-1]
    radii = np.concatenate([[0], np.cumsum(weight * np.sin(half))])[::-1]
    return centres, radii * system.rho ** -np.arange(depth + 1.0)
