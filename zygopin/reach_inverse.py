"""Controls that bring a finger's tip to a point of space, or the proof of none."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.control_system import ControlSystem, Levels, as_tolerance, frozen
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.inverse import find_word, nearest_reachable
from zygopin.kinematics import forward_kinematics
from zygopin.reach import find_finger, finger_length, to_plane
from zygopin.word_answer import Verdict, WordAnswer

REACHED = 1e-6
"""Distance over the finger's length within which a point counts as reached."""

MAX_NODES = 1_000_000
"""Nodes that a search for controls may visit, unless said otherwise: seconds
at worst."""


@dataclass(frozen=True, eq=False)
class InverseReach:
    """Controls that bring a finger's tip near a point, and what is certain about it.

    Attributes:
        finger: The finger's name.
        controls: The controls of its phalanges, read-only, shape (K,).
        tip: Where they put the tip, by `forward_kinematics` [m], shape (3,).
        residual: Distance of the tip from the point [m].
        out_of_plane: Distance of the point from the finger's plane, to the finger's
            left positive [m].
        lower_bound: No controls bring the tip nearer than this [m]: the certificate.
        tolerance: Distance within which the point counts as reached [m].
    """

    finger: str
    controls: NDArray[np.float64]
    tip: NDArray[np.float64]
    residual: float
    out_of_plane: float
    lower_bound: float
    tolerance: float

    @property
    def verdict(self) -> Verdict:
        """`reachable` within the tolerance, `not_reachable` (proved) or `undecided`."""
        if self.residual <= self.tolerance:
            return "reachable"
        return "not_reachable" if self.lower_bound > self.tolerance else "undecided"


def inverse_reach(
    foot: Foot,
    finger: str | int,
    point: ArrayLike,
    *,
    tolerance: float | None = None,
    levels: Levels | None = None,
    max_nodes: int = MAX_NODES,
) -> InverseReach:
    """Controls of a finger that reach a point of space, or the nearest there are.

    The point is projected into the finger's plane, and searched there by pruning the
    tree of control sequences (MODEL.md, section 3). Out of reach, the search goes on
    until the residual is within the tolerance of the least one, or the nodes run out:
    `lower_bound` says how near it certainly is.

    Args:
        foot: The foot.
        finger: Name, or number from 1.
        point: The point in the foot's frame [m], shape (3,).
        tolerance: Distance that counts as reached, > 0 [m]; None: 1e-6 of the
            finger's length.
        levels: The control set; None: all of [0, 1].
        max_nodes: Nodes of the tree that each search may visit.

    Returns:
        The controls, where they put the tip, and what is certain.

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: A value is out of range.
    """
    chosen = find_finger(foot, finger)
    place = _single_point(point)
    if tolerance is None:
        tolerance = REACHED * finger_length(foot, finger)
    within = as_tolerance(tolerance)
    target, aside = to_plane(foot, finger, place)
    spare = math.sqrt(max(within**2 - float(aside) ** 2, 0.0)) or within
    system = ControlSystem(foot.rho, foot.omega, levels, chosen.orientation)
    within_plane, count = spare / foot.scale, chosen.phalanges
    found = _searched(complex(target), system, count, within_plane, max_nodes)
    controls = np.zeros(foot.phalanx_count)
    part = foot.finger_slices[chosen.name]
    controls[part] = found.controls
    tip = forward_kinematics(foot, controls)[part.stop - 1, 1]
    return InverseReach(
        finger=chosen.name,
        controls=found.controls,
        tip=frozen(tip.copy()),
        residual=float(np.linalg.norm(tip - place)),
        out_of_plane=float(aside),
        lower_bound=math.hypot(foot.scale * found.lower_bound, float(aside)),
        tolerance=within,
    )


def _searched(
    target: complex, system: ControlSystem, depth: int, within: float, nodes: int
) -> WordAnswer:
    """Any word within the tolerance; where there is none, the nearest."""
    found = find_word(target, system, depth, tolerance=within, max_nodes=nodes)
    if found.verdict == "reachable":
        return found
    nearest = nearest_reachable(
        target, system, depth, tolerance=within, max_nodes=nodes
    )
    best = min(found, nearest, key=lambda each: each.distance)
    bound = max(found.lower_bound, nearest.lower_bound)
    return dataclasses.replace(best, lower_bound=bound)


def _single_point(point: ArrayLike) -> NDArray[np.float64]:
    """One checked point of space, shape (3,)."""
    goal = checks.array("point", point, last=3)
    if goal.ndim != 1:
        remedy = "ask for one point at a time"
        raise ParameterError("point.shape", goal.shape, "(3,)", remedy)
    return goal
