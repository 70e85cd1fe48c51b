"""Force closure: can contacts with friction balance any small wrench, and how well."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from zygopin import kinds
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
    """Ferrari and Canny's quality of a grasp with round friction cones, in a bracket.

    Attributes:
        low: Largest ball about 0 in the hull of the inscribed pyramids' wrenches [N
            per newton of normal force at each contact's edges]; 0 without closure.
        high: How far the round cones' hull reaches at least in one direction, the
            most adverse of the pyramids' facets: no ball about 0 is larger.
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

    Each edge of a cone has a normal force of 1 N; ε is the radius of the largest ball
    about 0 in the convex hull of their wrenches, so the normal forces of all contacts
    together are at most 1 N.

    Args:
        contacts: The contacts; their scale makes torques forces.
        friction: Their friction.

    Returns:
        ε of the round cones, between two numbers.
    """
    facets = _facets(_edge_wrenches(contacts, friction))
    if facets is None:
        return ClosureQuality(0.0, 0.0)
    low = max(0.0, float(-facets[:, -1].max()))
    reach = float(_round_reach(contacts, friction, facets[:, :-1]).min())
    return ClosureQuality(low=low, high=max(low, reach))


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
    kinds.instance("contacts", contacts, Contacts)
    most = Friction(LARGEST_FRICTION, edges)
    if not force_closure(contacts, most):
        return math.inf, math.inf
    if force_closure(contacts, replace(most, coefficient=FRICTION_TOLERANCE)):
        return 0.0, FRICTION_TOLERANCE
    low, high = FRICTION_TOLERANCE, 1.0
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


def _edge_wrenches(contacts: Contacts, friction: Friction) -> Floats:
    """Wrenches of all edges of the inscribed pyramids, shape (N·edges, 6)."""
    kinds.instance("contacts", contacts, Contacts)
    kinds.instance("friction", friction, Friction)
    return contacts.wrenches(friction.forces(contacts.normals)).reshape(-1, 6)


def _facets(wrenches: Floats) -> Floats | None:
    """Facets of the hull: outward unit normals and minus their distances from 0.

    Returns:
        Shape (facets, 7); None where the wrenches lie in a plane, so that no ball fits.
    """
    from scipy.spatial import ConvexHull, QhullError  # slow to load: only where used

    values = np.linalg.svd(wrenches - wrenches.mean(axis=0), compute_uv=False)
    if len(values) < 6 or values[-1] <= FULL_RANK * values[0]:
        return None
    try:
        return np.asarray(ConvexHull(wrenches).equations)
    except QhullError:  # flat but for rounding
        return None


def _round_reach(contacts: Contacts, friction: Friction, units: Floats) -> Floats:
    """How far the round cones' wrenches reach along directions.

    Args:
        contacts: The contacts.
        friction: Their friction.
        units: Unit directions of wrenches, shape (D, 6).

    Returns:
        max over contacts of n·p + μ·|p − (n·p) n|, shape (D,), with the pull p of the
        direction at the contact: its force, and its torque over the arm.
    """
    arms = (contacts.points - contacts.origin) / contacts.scale
    pulls = units[:, None, :3] + np.cross(units[:, None, 3:], arms)
    along = (pulls * contacts.normals).sum(axis=-1)
    across = np.linalg.norm(pulls - along[..., None] * contacts.normals, axis=-1)
    reach: Floats = (along + friction.coefficient * across).max(axis=-1)
    return reach
