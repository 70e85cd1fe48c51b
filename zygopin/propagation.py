"""Poses of the whole foot that move over a grid: from each branch to those beside it.

A pose that shows something on one branch, laid again on the next, mostly shows it there
too; where toes run into each other, or into the branch, random turns of their free
joints lead around.
"""

from __future__ import annotations

import itertools

import numpy as np
from numpy.typing import NDArray

from zygopin.projection import Floats, ProjectedFinger
from zygopin.relaid import Indices, relaid
from zygopin.witnesses import Witnesses

BESIDE = [step for step in itertools.product((-1, 0, 1), repeat=2) if any(step)]
"""Rows and columns to the branches around one."""

STRIDES = (1, 8, 4, 2, 1)
"""How far poses are moved, in turn."""

PLAIN = 4
"""Every so many rounds poses are moved as they are, in the others with random turns."""

PATIENCE, TRIES = 8, 1000
"""Rounds in which nothing more is shown before this ends, and poses tried in them."""

STEPS = (-3.0, -0.5)
"""Sizes of the random turns, in powers of ten of the controls' range."""

SHARES = (0.2, 0.5, 1.0)
"""Shares of the joints that are turned."""

KEPT = 0.7
"""Share of the contacts that are laid again, in every other round."""


def propagate(
    witnesses: Witnesses, fingers: list[ProjectedFinger], goal: NDArray[np.intp]
) -> None:
    """Move poses on from branch to branch until no more is shown.

    Args:
        witnesses: Poses of the whole foot; more of them afterwards.
        fingers: The foot's fingers, seen along the branches.
        goal: Merit that is wanted for each branch, shape (H, R).
    """
    rng, idle, tries = np.random.default_rng(0), 0, 0
    for turn in itertools.count():
        before = witnesses.merit.copy()
        cells, sources = _moves(before, goal, STRIDES[turn % len(STRIDES)])
        controls, sides = witnesses.controls[sources], witnesses.sides[sources]
        if turn % PLAIN:
            controls = turned(controls, rng)
        if turn % 2:
            sides = np.where(rng.random(sides.shape) < KEPT, sides, 0)
        moved = relaid(fingers, witnesses.grid, cells, controls, sides)
        witnesses.offer(cells, moved)
        idle, tries = idle + 1, tries + len(moved)
        if (witnesses.merit > before).any():
            idle, tries = 0, 0
        if idle > PATIENCE and (tries > TRIES or not tries):
            return


def _moves(
    merit: Indices, goal: Indices, stride: int
) -> tuple[tuple[Indices, Indices], tuple[Indices, Indices]]:
    """Branches that want more than they have, and better ones so far from them."""
    want = np.argwhere(merit < goal)
    cells = np.repeat(want, len(BESIDE), axis=0)
    sources = cells - stride * np.tile(BESIDE, (len(want), 1))
    inside = ((sources >= 0) & (sources < merit.shape)).all(axis=1)
    cells, sources = cells[inside], sources[inside]
    better = merit[tuple(sources.T)] > merit[tuple(cells.T)]
    to, start = cells[better].T, sources[better].T
    return (to[0], to[1]), (start[0], start[1])


def turned(controls: Floats, rng: np.random.Generator) -> Floats:
    """Poses with some of their joints turned at random.

    Args:
        controls: The poses, shape (n, P).
        rng: Random numbers.

    Returns:
        Poses, shape (n, P): each with a step and a share of the joints of its own.
    """
    count = (len(controls), 1)
    size = 10 ** rng.uniform(*STEPS, count)
    some = rng.random(controls.shape) < rng.choice(SHARES, count)
    step = np.where(some, size * rng.standard_normal(controls.shape), 0.0)
    return np.asarray(np.clip(controls + step, 0.0, 1.0))
