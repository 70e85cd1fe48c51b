"""Force closure: can contacts with friction balance any small wrench, and how well."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
from scipy.spatial import ConvexHull, QhullError

from zygopin.contacts import LARGEST_FRICTION, Contacts, Floats, Friction
from zygopin.programme import maximise_last

FULL_RANK = 1e-9
"""Singular value below which wrenches leave a direction out, over the largest."""

POSITIVE = 1e-9
"""Share of the whole normal force that each edge must bear to count as borne."""

FRICTION_TOLERANCE = 1e-6
"""Width of the interval to which the least friction is narrowed."""


@dataclass(frozen=True)
class ClosureQuality:
    """Ferrari and Canny's quality of a grasp, between two pyramids.

    Attributes:
        low: Largest ball about 0 in the hull of the inscribed pyramids' wrenches [N
            per newton of normal force at each contact's edges]; 0 without closure.
        high: The same of the circumscribed pyramids, at least the cone's.
    """

    low: float
    high: float


def force_closure(contacts: Contacts, friction: Friction) -> bool:
    """Whether the contacts can balance every wrench, given enough normal force.

    Every edge of the inscribed pyramids can be loaded in an equilibrium, and their
    wrenches span all six directions (MODEL.md, section 5). Where the pyramid says
    yes, so does the cone.

    Args:
        contacts: The contacts.
        friction: Their friction.

    Returns:
        Whether they close.
    """
    wrenches = _edge_wrenches(contacts, friction)
    values = np.linalg.svd(wrenches, compute_uv=False)
    if len(values) < 6 or values[-1] <= FULL_RANK * values[0]:
        return False
    count = len(wrenches)
    # Largest share s with Σ λ w = 0, Σ λ = 1, λ ≥ s: write λ = s + μ with μ ≥ 0.
    balance = np.vstack([wrenches.T, np.ones(count)])
    columns = np.hstack([balance, balance.sum(axis=1, keepdims=True)])
    best = maximise_last(count + 1, A_eq=columns, b_eq=[0.0] * 6 + [1.0])
    return best is not None and best.value * count > POSITIVE


def closure_quality(contacts: Contacts, friction: Friction) -> ClosureQuality:
    """Ferrari and Canny's ε: how large a wrench is balanced whatever its direction.

    Each edge of a pyramid has a normal force of 1 N; ε is the radius of the largest
    ball about 0 in the convex hull of their wrenches, so the normal forces of all
    contacts together are at most 1 N.

    Args:
        contacts: The contacts; their scale makes torques forces.
        friction: Their friction.

    Returns:
        ε between the inscribed and the circumscribed pyramids.
    """
    low, high = (
        _ball(_edge_wrenches(contacts, friction, around=around))
        for around in (False, True)
    )
    return ClosureQuality(low=low, high=max(low, high))


def least_friction(contacts: Contacts, edges: int = 8) -> tuple[float, float]:
    """The least coefficient of friction with which the contacts close.

    Args:
        contacts: The contacts.
        edges: Edges of the pyramids that stand for the cones.

    Returns:
        Coefficients (low, high): below low nothing closes, above high all does;
        infinite where none does, up to `LARGEST_FRICTION`.

    Raises:
        ParameterError: Edges out of range.
    """
    most = Friction(LARGEST_FRICTION, edges)
    if not force_closure(contacts, most):
        return math.inf, math.inf
    low, high = 0.0, 1.0
    while high < LARGEST_FRICTION and not force_closure(
        contacts, replace(most, coefficient=high)
    ):
        low, high = high, min(2 * high, LARGEST_FRICTION)
    while high - low > FRICTION_TOLERANCE:
        middle = (low + high) / 2
        if force_closure(contacts, replace(most, coefficient=middle)):
            high = middle
        else:
            low = middle
    return low * most.rounding, high


def _edge_wrenches(
    contacts: Contacts, friction: Friction, *, around: bool = False
) -> Floats:
    """Wrenches of all edges, shape (N·edges, 6)."""
    forces = friction.forces(contacts.normals, around=around)
    return contacts.wrenches(forces).reshape(-1, 6)


def _ball(wrenches: Floats) -> float:
    """Radius of the largest ball about 0 in the hull; 0 where 0 is not inside."""
    values = np.linalg.svd(wrenches - wrenches.mean(axis=0), compute_uv=False)
    if len(values) < 6 or values[-1] <= FULL_RANK * values[0]:
        return 0.0
    try:
        hull = ConvexHull(wrenches)
    except QhullError:  # flat but for rounding
        return 0.0
    return max(0.0, float(-hull.equations[:, -1].max()))
