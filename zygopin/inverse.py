"""Which controls reach a point: searches of the word tree, with proof.

A finite control set is searched exactly (`word_tree`); the interval [0, 1] by branch
and bound on boxes of controls (`control_boxes`). MODEL.md, section 3.
"""

from __future__ import annotations

from zygopin import checks, kinds
from zygopin.control_boxes import search_boxes
from zygopin.control_system import (
    ControlSystem,
    as_depth,
    as_points,
    as_tolerance,
)
from zygopin.errors import ParameterError
from zygopin.word_answer import Goal, WordAnswer
from zygopin.word_tree import search_words

MAX_NODES = 4_000_000
"""Nodes of the tree that a query may visit, unless said otherwise: seconds."""

SHORTEST = 1e-60
"""Shortest last phalanx of a query: far below what double precision can resolve."""


def find_word(
    target: complex,
    system: ControlSystem,
    depth: int,
    *,
    tolerance: float,
    max_nodes: int = MAX_NODES,
) -> WordAnswer:
    """A control sequence that brings the tip within a tolerance, or proof of none.

    Args:
        target: The point x + iz, in units in which phalanx 1 has length 1/ρ.
        system: The contractions; levels None: all controls in [0, 1].
        depth: Number of phalanges k ≥ 1.
        tolerance: Largest distance that counts as reached, > 0.
        max_nodes: Nodes of the search tree to visit before it stays undecided.

    Returns:
        The verdict, the best sequence that was met, and the certificate.

    Raises:
        ParameterError: A parameter is out of range.
    """
    goal = _goal(target, system, depth, tolerance, (max_nodes, False))
    return _search(system, goal)


def nearest_reachable(
    target: complex,
    system: ControlSystem,
    depth: int,
    *,
    tolerance: float = 1e-9,
    max_nodes: int = MAX_NODES,
) -> WordAnswer:
    """The reachable point nearest to a target.

    For a finite control set it is exact; for the interval [0, 1] its distance is
    within the tolerance of the least one. Where the nodes run out first,
    `lower_bound` says how far that distance may be from the least one. The verdict is
    `reachable` where the distance is within the tolerance.

    Args:
        target: The point x + iz, in units in which phalanx 1 has length 1/ρ.
        system: The contractions; levels None: all controls in [0, 1].
        depth: Number of phalanges k ≥ 1.
        tolerance: What the distance may lose against the least one, > 0.
        max_nodes: Nodes of the search tree to visit; then `lower_bound` says what
            is known.

    Returns:
        The verdict, the nearest sequence, and the certificate.

    Raises:
        ParameterError: A parameter is out of range.
    """
    goal = _goal(target, system, depth, tolerance, (max_nodes, True))
    return _search(system, goal)


def contains(
    target: complex,
    system: ControlSystem,
    depth: int,
    *,
    tolerance: float,
    max_nodes: int = MAX_NODES,
) -> bool | None:
    """Whether the tip comes within a tolerance of a point.

    Args:
        target: The point x + iz, in units in which phalanx 1 has length 1/ρ.
        system: The contractions; levels None: all controls in [0, 1].
        depth: Number of phalanges k ≥ 1.
        tolerance: Largest distance that counts as reached, > 0.
        max_nodes: Nodes of the search tree to visit.

    Returns:
        True, False, or None where the search stayed undecided.

    Raises:
        ParameterError: A parameter is out of range.
    """
    answer = find_word(target, system, depth, tolerance=tolerance, max_nodes=max_nodes)
    return {"reachable": True, "not_reachable": False, "undecided": None}[
        answer.verdict
    ]


def _search(system: ControlSystem, goal: Goal) -> WordAnswer:
    """The answer by the method that the control set asks for."""
    if system.levels is None:
        return search_boxes(system, goal)
    return search_words(system, goal)


def _goal(
    target: complex,
    system: ControlSystem,
    depth: int,
    tolerance: float,
    limits: tuple[int, bool],
) -> Goal:
    """A checked goal; the limits are the most nodes, and whether to go for nearest."""
    kinds.instance("system", system, ControlSystem)
    points = as_points("target", target)
    if points.ndim:
        remedy = "ask for one point at a time"
        raise ParameterError("target.shape", points.shape, "()", remedy)
    length = system.rho ** -as_depth(depth)
    if length < SHORTEST:
        remedy = "take fewer phalanges: the last ones do not move the tip"
        allowed = f"at least {SHORTEST:g}"
        raise ParameterError("length of the last phalanx", length, allowed, remedy)
    count = checks.integer("max_nodes", limits[0], 1, 2**62)
    return Goal(
        complex(points.item()), depth, as_tolerance(tolerance), count, limits[1]
    )
