"""Route to tangencies: all branches of a control set, FCL, random systems."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from differ.clearances import TINY, sure
from differ.comparison import Comparison, at_most, same
from differ.corners import CORNER_NAMES
from differ.draw import Draw, Size
from differ.route import Route
from zygopin import (
    Foot,
    check_grasp,
    forward_kinematics,
    make_engine,
    stable_branches,
)
from zygopin.branch_solutions import BranchSolutions
from zygopin.clearance import Floats, dot, norm
from zygopin.placement import Placement
from zygopin.tangent_lines import Integers

LEVELS = 3
"""Most equal levels of the controls of `stable-branches`."""

SYSTEMS = 4000
"""Random systems that are solved for themselves."""

THROUGH = 150
"""Solutions that go through Pinocchio and FCL."""

INSIDE = 1e-6
"""How far inside the bone a contact is that cannot be rounded out of it."""

REGULAR = 1e-5
"""Determinant above which a system's solution is a number."""

SOLVED = 1e-14
"""Difference of a solution over the foot's size and its own, times the determinant:
both routes solve two equations whose entries are rounded."""


def against_systems(drawn: Draw) -> Sequence[Comparison]:
    """All branches of a control set: by FCL, and random systems of it among them."""
    foot, rng = drawn.foot, drawn.rng
    pair = foot.opposable_pairs[int(rng.integers(len(foot.opposable_pairs)))]
    levels = np.linspace(0, 1, int(rng.integers(2, LEVELS + 1)))
    place = Placement(slanted(rng), *(foot.size * rng.normal(size=2) * [0.2, 0.2]))
    drawn.beyond.update(pair=pair, levels=levels, placement=place)
    found = stable_branches(foot, (pair[0] + 1, pair[1] + 1), levels, placement=place)
    return (*by_fcl(found, rng), *_missing(found, levels, rng))


def slanted(rng: np.random.Generator) -> Floats:
    """A direction that is not vertical; across the foot, every fourth time.

    Args:
        rng: Where it comes from.

    Returns:
        A vector of any length, shape (3,).
    """
    if rng.random() < 0.25:
        return np.array([0.0, 1.0, 0.0])
    axis = rng.normal(size=3)
    axis[1] += np.copysign(0.5, axis[1])
    return axis


def by_fcl(found: BranchSolutions, rng: np.random.Generator) -> Sequence[Comparison]:
    """Contacts and verdicts of some solutions by FCL.

    Args:
        found: The solutions.
        rng: Where it comes from which of them.

    Returns:
        The comparisons; none without a solution.
    """
    if not len(found):
        return ()
    some = rng.integers(len(found), size=min(THROUGH, len(found)))
    foot, branches = found.foot, found.branches[some]
    controls, engine = found.controls[some], make_engine("fcl", found.foot)
    report = check_grasp(foot, controls, branches, engine=engine)
    starts = [part.start for part in foot.finger_slices.values()]
    rows = np.arange(len(some))[:, None]
    gaps = np.abs(report.clearance[rows, found.phalanx[some] - 1 + starts])
    decided = sure(check_grasp(foot, controls, branches))
    return (
        at_most("tangent phalanges / FCL", gaps, 0 * gaps, found.tolerance),
        *(
            same(
                f"{name} / FCL",
                getattr(found, name)[some],
                getattr(report, name),
                decided,
            )
            for name in ("stable", "grasping", "feasible")
        ),
    )


def _missing(
    found: BranchSolutions, levels: Floats, rng: np.random.Generator
) -> Sequence[Comparison]:
    """Random systems, solved here, that have a branch: each is among the solutions."""
    foot, place = found.foot, found.placement
    rank = np.stack(
        [rng.integers(1, f.phalanges + 1, SYSTEMS) for f in foot.fingers], 1
    )
    controls = levels[rng.integers(len(levels), size=(SYSTEMS, foot.phalanx_count))]
    # Straight beyond the tangent phalanx, as the solutions are.
    own = rank[:, foot.finger_of_phalanx]
    controls = np.where(foot.rank_of_phalanx <= own, controls, 0.0)
    height, radius, regular = _solved(foot, place, controls, rank, rng)
    kept = np.flatnonzero(_counts(foot, place, height, radius, regular))
    if not len(kept):
        return ()
    apart = [
        _nearest(found, controls[i], rank[i], np.array([height[i], radius[i]]))
        for i in kept
    ]
    scale = foot.size + norm(place.centre) + np.abs(height[kept]) + radius[kept]
    within = SOLVED * scale / regular[kept]
    return (at_most("random systems / solutions", apart, np.zeros(len(kept)), within),)


def _solved(
    foot: Foot,
    place: Placement,
    controls: Floats,
    rank: Integers,
    rng: np.random.Generator,
) -> tuple[Floats, Floats, Floats]:
    """Heights, radii, how well determined (0: a contact off a bone), shape (n,)."""
    rows = np.arange(len(controls))[:, None]
    starts = np.array([part.start for part in foot.finger_slices.values()])
    chosen = starts + rank - 1
    bones = forward_kinematics(foot, controls)[rows, chosen] - place.centre
    line = bones[:, :, 1] - bones[:, :, 0]
    axis = np.asarray(place.axis)
    normal = np.cross(axis, line)
    size = norm(normal)[..., None]
    normal = normal / np.maximum(size, TINY) * rng.choice([-1, 1], (*rank.shape, 1))
    # n_z·h − r = n·x + skin, for a branch on the normal's side.
    right = dot(normal, bones[:, :, 0]) + foot.radii[chosen]
    slope = normal[..., 2]
    determinant = slope[:, 1] - slope[:, 0]
    good = (np.abs(determinant) > REGULAR) & (size[..., 0] > REGULAR * norm(line)).all(
        1
    )
    height = np.divide(
        right[:, 1] - right[:, 0], determinant, 0 * determinant, where=good
    )
    radius = slope[:, 0] * height - right[:, 0]
    offset = np.stack([0 * height, 0 * height, height], 1)[:, None] - bones[:, :, 0]
    flat = line - dot(line, axis)[..., None] * axis
    t = dot(offset, flat) / np.maximum(dot(flat, flat), TINY)
    inside = (np.abs(t - 0.5) < 0.5 - INSIDE).all(axis=1)
    # A short bone has a rounded direction.
    steady = np.minimum(size[..., 0] / foot.size, 1.0).min(axis=1)
    regular = np.abs(determinant) * steady
    return height, radius, np.where(good & inside, regular, 0.0)


def _counts(
    foot: Foot, place: Placement, height: Floats, radius: Floats, regular: Floats
) -> Floats:
    """Which solutions are branches beyond doubt."""
    good = (regular > 0) & (radius > 1e-5 * foot.size)
    good &= radius + np.abs(height) + norm(place.centre) < 1e5 * foot.size
    branch = place.branch(height, np.where(good, radius, foot.size))
    return np.asarray(good & (branch.base_distance() > radius * (1 + INSIDE)))


def _nearest(
    found: BranchSolutions, controls: Floats, rank: Integers, wanted: Floats
) -> float:
    """How far the nearest solution of the same pose is, in height and radius [m]."""
    alike = (found.controls == controls).all(axis=1) & (found.phalanx == rank).all(
        axis=1
    )
    places = np.stack([found.height, found.radius], 1)[alike]
    return float(np.abs(places - wanted).max(axis=1).min(initial=np.inf))


SHORT = tuple(name for name in CORNER_NAMES if name != "twelve phalanges")
"""Corners of what grows as the levels to the number of phalanges."""

ROUTES = (
    Route(
        "stable-branches",
        "branches of a control set: contacts, verdicts / FCL; systems / found",
        f"the contact tolerance (FCL), {SOLVED:g} over the determinant (systems)",
        against_systems,
        Size(poses=1, fingers=4, phalanges=3, opposed=True),
        SHORT,
        posed=False,
    ),
)
"""Route to tangencies."""
