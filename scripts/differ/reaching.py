"""Routes to reachable sets: the function system, plain enumeration, Pinocchio."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import product

import numpy as np
from numpy.typing import NDArray

from differ.bones import CORNERS, rounding
from differ.comparison import Comparison, at_most, close, same
from differ.draw import Draw, Size
from differ.route import Route
from zygopin import (
    Foot,
    FootModel,
    find_word,
    finger_reach,
    inverse_reach,
    nearest_reachable,
)
from zygopin.clearance import Floats, norm
from zygopin.control_system import ControlSystem
from zygopin.word_answer import WordAnswer

MOST_POINTS = 4000
"""Points of a set that is enumerated."""

THROUGH = 100
"""Points of a set whose controls go through Pinocchio."""

Complex = NDArray[np.complex128]


def _levels(drawn: Draw, depth: int) -> Floats:
    """Levels of a finite control set: equal or not, 0 and 1 mostly among them."""
    most = max(2, min(9, int(MOST_POINTS ** (1 / depth))))
    count = int(drawn.rng.integers(2, most + 1))
    if drawn.rng.random() < 0.5:
        return np.linspace(0, 1, count)
    levels = np.unique(drawn.rng.uniform(size=count))
    if drawn.rng.random() < 0.5:
        levels[[0, -1]] = 0, 1
    return np.unique(levels)


def enumerated(foot: Foot, finger: int, levels: Floats) -> tuple[Floats, Complex]:
    """Every word of some levels and its tip, by equation (sys) term by term.

    Args:
        foot: The foot.
        finger: Index of the finger.
        levels: The levels, shape (n,).

    Returns:
        Words in lexicographic order, shape (n^K, K), and points x + iz in units of the
        scale, shape (n^K,).
    """
    chosen = foot.fingers[finger]
    words = np.array([*product(levels, repeat=chosen.phalanges)])
    pitch, tip = np.full(len(words), chosen.orientation), np.zeros(len(words), complex)
    for rank in range(chosen.phalanges):
        pitch = pitch + foot.omega * words[:, rank]
        tip += foot.rho ** -(rank + 1.0) * (np.cos(pitch) - 1j * np.sin(pitch))
    return words, tip


def against_enumeration(drawn: Draw) -> Sequence[Comparison]:
    """A set's points and words, each against plain sums, some through Pinocchio."""
    foot, finger = drawn.foot, _finger(drawn)
    levels = _levels(drawn, foot.fingers[finger].phalanges)
    drawn.beyond.update(finger=finger, levels=levels)
    reach = finger_reach(foot, finger + 1, levels)
    words, tips = enumerated(foot, finger, levels)
    some = drawn.rng.integers(len(words), size=THROUGH)
    through = _tips(foot, finger, words[some])
    within = rounding(foot)
    indices = np.arange(len(words))
    return (
        close("points: set / enumeration", reach.points, foot.scale * tips, within),
        same("words: set / enumeration", reach.plane.words(indices), words),
        close("points: set / Pinocchio", reach.in_space(some), through, within),
    )


def _finger(drawn: Draw) -> int:
    """Index of one of the fingers."""
    return int(drawn.rng.integers(len(drawn.foot.fingers)))


def _tips(foot: Foot, finger: int, words: Floats) -> Floats:
    """Tips of a finger by Pinocchio [m], shape (n, 3)."""
    part = [*foot.finger_slices.values()][finger]
    controls = np.zeros((len(words), foot.phalanx_count))
    controls[:, part] = words
    return FootModel(foot).forward(controls)[:, part.stop - 1, 1]


QUERIES = 12
"""Points that are asked for in each set."""


def against_search(drawn: Draw) -> Sequence[Comparison]:
    """`find_word` and `nearest_reachable` against all words there are."""
    foot, finger, rng = drawn.foot, _finger(drawn), drawn.rng
    levels = _levels(drawn, foot.fingers[finger].phalanges)
    _, tips = enumerated(foot, finger, levels)
    unit = foot.size / foot.scale
    targets = _targets(tips, unit, rng)
    tolerance = unit * 10 ** rng.uniform(-10, -0.5, QUERIES)
    drawn.beyond.update(finger=finger, levels=levels)
    drawn.beyond.update(targets=targets, tolerance=tolerance)
    found, near = _answers(foot, finger, levels, targets, tolerance)
    least, band = (
        np.abs(targets[:, None] - tips).min(axis=1),
        rounding(foot) / foot.scale,
    )
    verdicts = np.array([each.verdict for each in found])
    sure = np.abs(least - tolerance) > band
    reached, none = verdicts == "reachable", verdicts == "not_reachable"
    distance, bound = (
        np.array([[getattr(each, name) for each in many] for many in (found, near)]).T
        for name in ("distance", "lower_bound")
    )
    ended = np.stack([_apart(foot, finger, each, targets) for each in (found, near)], 1)
    return (
        same("reachable: search / enumeration", reached, least <= tolerance, sure),
        same("not reachable: search / enumeration", none, least > tolerance, sure),
        close("nearest: search / enumeration", distance[:, 1], least, band),
        close("distance: search / its word by Pinocchio", distance, ended, band),
        at_most("lower bounds / enumeration", bound, least[:, None] + 0 * bound, band),
    )


def _answers(
    foot: Foot, finger: int, levels: Floats, targets: Complex, tolerance: Floats
) -> tuple[list[WordAnswer], list[WordAnswer]]:
    """For each target any word within the tolerance, and the nearest."""
    chosen = foot.fingers[finger]
    system = ControlSystem(foot.rho, foot.omega, levels, chosen.orientation)
    asked = [*zip(targets.tolist(), tolerance.tolist(), strict=True)]
    found, near = (
        [search(point, system, chosen.phalanges, tolerance=t) for point, t in asked]
        for search in (find_word, nearest_reachable)
    )
    return found, near


def _apart(
    foot: Foot, finger: int, found: list[WordAnswer], targets: Complex
) -> Floats:
    """How far words end from their targets by Pinocchio, in units of the scale."""
    azimuth = foot.fingers[finger].azimuth
    ahead = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    places = targets.real[:, None] * ahead + targets.imag[:, None] * (0.0, 0.0, 1.0)
    tips = _tips(foot, finger, np.array([each.controls for each in found]))
    return norm(tips - foot.scale * places) / foot.scale


def _targets(tips: Complex, unit: float, rng: np.random.Generator) -> Complex:
    """Points on the set, near it, and anywhere around."""
    kind = rng.integers(3, size=QUERIES)
    stray = unit * (rng.normal(size=QUERIES) + 1j * rng.normal(size=QUERIES))
    share = np.choose(kind, [0.0, 10 ** rng.uniform(-11, -1, QUERIES), 1.0])
    start = np.where(kind == 2, 0.0, tips[rng.integers(len(tips), size=QUERIES)])
    return np.asarray(start + share * stray)


POINTS = 4
"""Points of space that are asked for in each case of `reach-inverse`."""

NODES = 20_000
"""Nodes that such a query may visit: a second at most; then it stays undecided."""


def against_random(drawn: Draw) -> Sequence[Comparison]:
    """`inverse_reach` over [0, 1]: yes through Pinocchio, no against random poses."""
    foot, finger = drawn.foot, _finger(drawn)
    part = [*foot.finger_slices.values()][finger]
    tips = _tips(foot, finger, drawn.controls[:, part])
    targets = tips[:POINTS] + foot.size * drawn.rng.normal(size=(POINTS, 3)) * [
        [0.0],
        [0.0],
        [0.01],
        [0.3],
    ]
    drawn.beyond.update(finger=finger, targets=targets)
    found = [
        inverse_reach(foot, finger + 1, target, max_nodes=NODES) for target in targets
    ]
    ends = _tips(foot, finger, np.array([each.controls for each in found]))
    residual = np.array([each.residual for each in found])
    bound = np.array([each.lower_bound for each in found])
    denied = np.array([each.verdict == "not_reachable" for each in found])
    tolerance = np.array([each.tolerance for each in found])
    nearest = norm(targets[:, None] - tips).min(axis=1)
    within = rounding(foot)
    return (
        close("residual: search / Pinocchio", residual, norm(ends - targets), within),
        at_most("lower bound / random poses", bound, nearest, within),
        same(
            "a reached point is denied", denied & (nearest <= tolerance), denied & False
        ),
    )


STATED = "32 ulp of the foot's size for each turn of a toe: rounding"

ROUTES = (
    Route(
        "reach-points",
        "points and words of a reachable set / enumeration / Pinocchio",
        STATED,
        against_enumeration,
        Size(poses=1),
        CORNERS,
        posed=False,
    ),
    Route(
        "reach-words",
        "find_word, nearest_reachable, bounds / all words there are; words / Pinocchio",
        f"{STATED}; verdicts alike, but within that of the tolerance asked for",
        against_search,
        Size(poses=1),
        CORNERS,
        posed=False,
    ),
    Route(
        "reach-inverse",
        "inverse_reach over [0, 1]: residuals / Pinocchio; bounds / random poses",
        STATED,
        against_random,
        Size(poses=2000, fingers=3, phalanges=4),
        CORNERS,
        posed=False,
    ),
)
"""Routes to reachable sets."""
