"""Route to branches under the base: FCL, and equations solved for themselves."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from differ.clearances import TINY
from differ.comparison import Comparison, at_most
from differ.draw import Draw, Size
from differ.route import Route
from differ.tangencies import LEVELS, REGULAR, SHORT, SOLVED, by_fcl, slanted
from zygopin import (
    Foot,
    RestingRadii,
    forward_kinematics,
    resting_branches,
    resting_radii,
)
from zygopin.clearance import Floats, dot, norm
from zygopin.placement import Placement
from zygopin.tangent_lines import Integers

EQUATIONS = 500
"""Random words of a toe whose equation is solved."""


def against_equations(drawn: Draw) -> Sequence[Comparison]:
    """Branches under the base by FCL; radii of random words among those of a toe."""
    foot, rng = drawn.foot, drawn.rng
    pair = foot.opposable_pairs[int(rng.integers(len(foot.opposable_pairs)))]
    levels = np.linspace(0, 1, int(rng.integers(2, LEVELS + 1)))
    place = Placement(slanted(rng))
    drawn.beyond.update(pair=pair, levels=levels, axis=place.axis)
    one, other = (index + 1 for index in pair)
    found = resting_branches(foot, (one, other), levels, axis=place.axis)
    radii = resting_radii(foot, one, levels, axis=place.axis)
    return (*by_fcl(found, rng), *_missing(foot, pair[0], levels, place, radii, rng))


def _missing(
    foot: Foot,
    finger: int,
    levels: Floats,
    place: Placement,
    radii: RestingRadii,
    rng: np.random.Generator,
) -> Sequence[Comparison]:
    """Random words of a toe that have a radius: each is among those found."""
    part = [*foot.finger_slices.values()][finger]
    count = part.stop - part.start
    rank = rng.integers(1, count + 1, EQUATIONS)
    words = levels[rng.integers(len(levels), size=(EQUATIONS, count))]
    words = np.where(np.arange(count) < rank[:, None], words, 0.0)
    radius, share = _solved(foot, part, words, rank, place, rng)
    kept = np.flatnonzero((share > 0) & (radius > REGULAR * foot.size))
    if not len(kept):
        return ()
    apart = [
        np.abs(
            radii.radius[
                (radii.controls == words[i]).all(axis=1) & (radii.phalanx == rank[i])
            ]
            - radius[i]
        ).min(initial=np.inf)
        for i in kept
    ]
    within = SOLVED * (foot.size + radius[kept]) / share[kept]
    return (at_most("random words / radii", apart, 0 * radius[kept], within),)


def _solved(
    foot: Foot,
    part: slice,
    words: Floats,
    rank: Integers,
    place: Placement,
    rng: np.random.Generator,
) -> tuple[Floats, Floats]:
    """Radii, and how well they are determined: 0 for a bone along the axis, (n,)."""
    controls = np.zeros((len(words), foot.phalanx_count))
    controls[:, part] = words
    bones = forward_kinematics(foot, controls)
    chosen = part.start + rank - 1
    start, end = bones[np.arange(len(words)), chosen].swapaxes(0, 1)
    normal = np.cross(np.asarray(place.axis), end - start)
    size = norm(normal)
    normal /= np.maximum(size, TINY)[:, None]
    normal *= rng.choice([-1, 1], (len(words), 1))
    # normal · centre = normal · start + r + skin, the centre at (0, 0, −r/level).
    share = 1 + normal[:, 2] / place.level
    right = -dot(normal, start) - foot.radii[chosen]
    good = (np.abs(share) > REGULAR) & (size > REGULAR * norm(end - start))
    radius = np.divide(right, share, 0 * right, where=good)
    # A short bone has a rounded direction.
    steady = np.abs(share) * np.minimum(size / foot.size, 1.0)
    return radius, np.where(good, steady, 0.0)


ROUTES = (
    Route(
        "resting-branches",
        "branches under the base: contacts, verdicts / FCL; equations / radii",
        f"the contact tolerance (FCL), {SOLVED:g} over the share of r (equations)",
        against_equations,
        Size(poses=1, fingers=4, phalanges=3, opposed=True),
        SHORT,
        posed=False,
    ),
)
"""Route to branches under the base."""
