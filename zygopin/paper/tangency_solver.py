"""The paper's tangency system, solved in the plane of fingers 1 and 3.

It knows complex numbers and the ellipse alone: no projection along the branch, no
distance in space, none of the linear equations by which branches are listed.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from zygopin.branch_solutions import BranchSolutions
from zygopin.foot import Foot
from zygopin.paper.finger_plane import (
    Complexes,
    Floats,
    phalanx_lines,
    section,
    section_tangent,
    widths,
)


@dataclass(frozen=True)
class Tangency:
    """What comes nearest to solving the tangency system for phalanges and branches.

    Attributes:
        t: Place on the phalanx, in [0, 1], shape (…).
        angle: θ in [0, 2π) [rad], shape (…).
        place: φ(t), shape (…).
        tangent: γ̇(θ), shape (…).
        misfit: |φ(t) − γ(θ)|, shape (…): 0 where the system has a solution.
    """

    t: Floats
    angle: Floats
    place: Complexes
    tangent: Complexes
    misfit: Floats


def solve(
    foot: Foot,
    lines: tuple[Complexes, Complexes],
    height: ArrayLike,
    radius: ArrayLike,
) -> Tangency:
    """Solve the system: parallel first, which leaves two θ, then incident.

    Args:
        foot: The foot.
        lines: Starts and steps of phalanges, shape (…) each.
        height: Heights of the branches' axes, shape (…).
        radius: Their radii, shape (…).

    Returns:
        For each phalanx the one of the two θ that fits better, and the t in [0, 1] at
        which the phalanx comes nearest to γ(θ).
    """
    step = lines[1]
    width = widths(foot)["true"]
    first = np.arctan2(-step.real / width, step.imag)
    one, other = (
        fitted(lines, x, height, radius, width) for x in (first, first + np.pi)
    )
    better = one.misfit <= other.misfit
    return Tangency(
        *(
            np.where(better, getattr(one, name), getattr(other, name))
            for name in Tangency.__dataclass_fields__
        )
    )


def fitted(
    lines: tuple[Complexes, Complexes],
    angle: Floats,
    height: ArrayLike,
    radius: ArrayLike,
    width: float,
) -> Tangency:
    """The phalanges' points nearest to γ(θ), θ given.

    Args:
        lines: Starts and steps of phalanges, shape (…) each.
        angle: θ [rad], shape (…).
        height: Heights of the branches' axes, shape (…).
        radius: Their radii, shape (…).
        width: Horizontal half-axis of the ellipse over the radius.

    Returns:
        The points, and how far they are from γ(θ).
    """
    start, step = lines
    goal = section(angle, height, radius, width)
    t = np.clip(((goal - start) * np.conj(step)).real / np.abs(step) ** 2, 0.0, 1.0)
    place = start + t * step
    tangent = section_tangent(angle, radius, width)
    return Tangency(t, angle % (2 * np.pi), place, tangent, np.abs(place - goal))


def tangent_lines_of(
    found: BranchSolutions,
) -> tuple[Complexes, Complexes]:
    """Starts and steps of the tangent phalanges of solutions.

    Args:
        found: Solutions for fingers 1 and 3.

    Returns:
        Complex numbers, shape (N, 2) each.
    """
    starts, steps = [], []
    for column, (finger, part) in enumerate(found.foot.finger_slices.items()):
        lines = phalanx_lines(found.foot, finger, found.controls[:, part])
        rank = found.phalanx[:, column, None] - 1
        start, step = (np.take_along_axis(x, rank, axis=1)[:, 0] for x in lines)
        starts.append(start)
        steps.append(step)
    return np.stack(starts, axis=1), np.stack(steps, axis=1)
