"""Branches to which a phalanx is tangent: a line in the plane of heights and radii.

Let branches share the direction of their axis, and let their centres lie above one
another. A phalanx with skin ε, its controls given, is tangent to the branch of height h
and radius r where n·x = n·c + (r + ε), n a unit normal of its bone seen along the axis
(MODEL.md, section 4). That is one linear equation, n_z·h + r = offset, and where on the
bone the branch touches is linear in h: the branches that touch inside the bone are a
segment of that line.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.clearance import PARALLEL, Floats
from zygopin.control_system import MAX_WORDS, Levels, as_levels, words
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.grasp import PARAMETER_SLACK
from zygopin.placement import Placement
from zygopin.records import joined

Integers = NDArray[np.int64]

BLOCK = 4096
"""Lines in a block of `line_blocks`: some hundred kilobytes."""


@dataclass(frozen=True)
class TangentLines:
    """Tangency of some phalanges of a finger: normal_z·h + r = offset for each.

    A phalanx of rank k counts once for each sequence of the controls v₁ … vₖ, and once
    for each of its sides.

    Attributes:
        rank: Number k of the phalanx in its finger, from 1, shape (N,).
        word: Index of v₁ … vₖ among the words of the levels, shape (N,).
        side: 1: the branch lies on the palm's side of the toe; −1: on its back.
        normal_z: z of the unit normal from the branch to the bone, shape (N,).
        offset: Right-hand side [m], shape (N,).
        t_start: Where on the bone, from 0 to 1, the branch at h = 0 touches, (N,).
        t_rate: What that gains per metre of height [1/m], shape (N,).
    """

    rank: Integers
    word: Integers
    side: Integers
    normal_z: Floats
    offset: Floats
    t_start: Floats
    t_rate: Floats

    def __len__(self) -> int:
        return len(self.rank)

    def heights(self) -> tuple[Floats, Floats]:
        """Heights between which the branch touches inside the bone [m], shape (N,).

        Infinite for a bone that is level, and then reversed where it never does.
        """
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            first = (-PARAMETER_SLACK - self.t_start) / self.t_rate
            last = (1 + PARAMETER_SLACK - self.t_start) / self.t_rate
        low, high = np.minimum(first, last), np.maximum(first, last)
        level = self.t_rate == 0
        off = np.abs(self.t_start - 0.5) > 0.5 + PARAMETER_SLACK
        low = np.where(level, np.where(off, np.inf, -np.inf), low)
        return low, np.where(level, -low, high)


def control_set(levels: Levels) -> Floats:
    """A finite control set R of the source: 0 and 1 are in it.

    Args:
        levels: A number n ≥ 2 of equal levels of [0, 1], or the levels.

    Returns:
        The levels, sorted, each once, shape (n,).

    Raises:
        ParameterError: A level is outside [0, 1], or 0 or 1 is not a level.
    """
    values = as_levels(levels)
    ends = float(values[0]), float(values[-1])
    if ends != (0.0, 1.0):
        remedy = "add 0 and 1, the straight joint and the fully closed one"
        raise ParameterError("first and last level", ends, "(0, 1)", remedy)
    return values


def whole_controls(
    levels: Floats, phalanges: int, rank: Integers, word: Integers
) -> Floats:
    """A finger's whole control sequences, 0 after the tangent phalanx.

    Args:
        levels: The control set, 0 as its first, shape (n,).
        phalanges: Number K of the finger's phalanges.
        rank: Number k of each tangent phalanx, shape (N,).
        word: Index of its v₁ … vₖ, shape (N,).

    Returns:
        Controls in [0, 1], shape (N, K).
    """
    rest = np.int64(len(levels)) ** (phalanges - rank)
    return words(levels, phalanges, word * rest)


def line_count(foot: Foot, finger: int, levels: Levels) -> int:
    """Number of tangent lines of a finger: 2·Σₖ nᵏ, for both sides of each phalanx.

    Args:
        foot: The foot.
        finger: Index of the finger.
        levels: The control set.

    Returns:
        The number.

    Raises:
        ParameterError: The levels are no control set, or too many to be counted.
    """
    count, phalanges = len(control_set(levels)), foot.fingers[finger].phalanges
    lines: int = 2 * sum(count**rank for rank in range(1, phalanges + 1))
    if lines > MAX_WORDS:
        remedy = "take fewer levels"
        name = f"number of {foot.fingers[finger].name}'s tangent lines"
        raise ParameterError(name, lines, f"at most {MAX_WORDS}", remedy)
    return lines


def line_blocks(
    foot: Foot,
    finger: int,
    levels: Levels,
    placement: Placement,
    *,
    block: int = BLOCK,
) -> Iterator[TangentLines]:
    """All tangent lines of a finger in blocks, the phalanges nearest the base first.

    Args:
        foot: The foot.
        finger: Index of the finger.
        levels: The control set.
        placement: Where the branches lie.
        block: Lines in a block, about.

    Yields:
        The lines. A phalanx that lies along the axis has none: it is missing.

    Raises:
        ParameterError: The levels are no control set, or too many to be counted.
    """
    line_count(foot, finger, levels)
    values, half = control_set(levels), max(1, block // 2)
    held: list[TangentLines] = []
    for rank in range(1, foot.fingers[finger].phalanges + 1):
        count = len(values) ** rank
        for start in range(0, count, half):
            index = np.arange(start, min(start + half, count), dtype=np.int64)
            controls = words(values, rank, index)
            held.append(tangent_lines(foot, finger, controls, placement, index))
            if sum(map(len, held)) >= half:
                yield joined(held)
                held = []
    if held:
        yield joined(held)


def tangent_lines(
    foot: Foot,
    finger: int,
    controls: Floats,
    placement: Placement,
    word: Integers | None = None,
) -> TangentLines:
    """Tangent lines of phalanx k of a finger for given controls v₁ … vₖ.

    Args:
        foot: The foot.
        finger: Index of the finger.
        controls: Controls in [0, 1], shape (m, k).
        placement: Where the branches lie.
        word: What the lines are to bear as `word`, shape (m,); None: the row.

    Returns:
        Both sides' lines, shape (2m,): the palm's first. Those of a phalanx that lies
        along the axis are missing.
    """
    rank = controls.shape[1]
    word = np.arange(len(controls), dtype=np.int64) if word is None else word
    plane = plane_axes(foot, finger)
    start, bone = (x @ plane for x in last_bone(foot, finger, controls))
    axis = np.asarray(placement.axis)
    across = np.cross(axis, bone)
    sine = np.linalg.norm(across, axis=1) / np.linalg.norm(bone, axis=1)
    seen = sine > PARALLEL
    start, bone, across, word = start[seen], bone[seen], across[seen], word[seen]
    # Away from a branch on the palm's side: upward from one below a straight toe.
    left = np.cross(plane[1], plane[0])
    normal = across if axis @ left <= 0 else -across
    normal = normal / np.linalg.norm(normal, axis=1, keepdims=True)
    flat = np.cross(across, axis)  # the bone less its part along the axis
    rate = flat / np.sum(across**2, axis=1, keepdims=True)
    base = start - placement.centre
    distance = np.sum(normal * base, axis=1)
    both = np.repeat(np.array([1, -1], dtype=np.int64), len(word))
    return TangentLines(
        rank=np.full(len(both), rank, dtype=np.int64),
        word=np.tile(word, 2),
        side=both,
        normal_z=both * np.tile(normal[:, 2], 2),
        offset=both * np.tile(distance, 2) - skin(foot, finger, rank),
        t_start=np.tile(-np.sum(rate * base, axis=1), 2),
        t_rate=np.tile(rate[:, 2], 2),
    )


def last_bone(foot: Foot, finger: int, controls: Floats) -> tuple[Floats, Floats]:
    """Phalanx k of a finger for given controls v₁ … vₖ, in the finger's plane.

    Args:
        foot: The foot.
        finger: Index of the finger.
        controls: Controls in [0, 1], shape (m, k).

    Returns:
        Its start and its vector, forward and upward [m], shape (m, 2) each.
    """
    chosen = foot.fingers[finger]
    lengths = foot.lengths[foot.finger_slices[chosen.name]][: controls.shape[1]]
    pitch = chosen.orientation + foot.omega * np.cumsum(controls, axis=1)
    steps = lengths[:, None] * np.stack([np.cos(pitch), -np.sin(pitch)], axis=2)
    return steps[:, :-1].sum(axis=1), steps[:, -1]


def plane_axes(foot: Foot, finger: int) -> Floats:
    """Unit vectors forward and upward in a finger's plane.

    Args:
        foot: The foot.
        finger: Index of the finger.

    Returns:
        The vectors as rows, shape (2, 3).
    """
    azimuth = foot.fingers[finger].azimuth
    return np.array([[np.cos(azimuth), np.sin(azimuth), 0.0], [0.0, 0.0, 1.0]])


def skin(foot: Foot, finger: int, rank: int) -> float:
    """Skin radius εₖ of phalanx k of a finger [m].

    Args:
        foot: The foot.
        finger: Index of the finger.
        rank: The number k.

    Returns:
        The radius.
    """
    part = foot.finger_slices[foot.fingers[finger].name]
    return float(foot.radii[part][rank - 1])
