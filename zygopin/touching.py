"""Controls with which fingers touch branches of given radii, and do not enter them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.axis_chain import AxisChain, Floats, Indices
from zygopin.branch import Branch
from zygopin.illinois import crossings
from zygopin.touch import TouchIntervals

ITERATIONS = 200
"""Steps to a contact; a dozen are usual."""


@dataclass(frozen=True, eq=False)
class TouchingControls:
    """Controls with which fingers touch branches and do not enter them.

    Attributes:
        controls: Controls of all fingers, shape (…, P); a finger that cannot touch is
            where it comes nearest to touching.
        clearance: Clearance of each finger from the branch [m], shape (…, F).
        touching: Which fingers touch, shape (…, F).
    """

    controls: Floats
    clearance: Floats
    touching: NDArray[np.bool_]

    def __post_init__(self) -> None:
        checks.freeze(self)


def touching_controls(intervals: TouchIntervals, radius: ArrayLike) -> TouchingControls:
    """Controls with which each finger touches branches, and does not enter them.

    D is continuous between the controls where a finger comes nearest to the axis and
    those where it keeps farthest, so it takes every radius of the interval on the way.

    Args:
        intervals: The intervals of the branches' axes.
        radius: Radii of the branches [m], shape (…), which broadcasts against the
            batch of the intervals.

    Returns:
        The controls; where a finger touches, the clearance is zero up to rounding.

    Raises:
        ParameterError: A radius is not a positive length, or the shapes differ.
    """
    kinds.instance("intervals", intervals, TouchIntervals)
    foot, radii = intervals.foot, checks.lengths("radius", radius)
    batch = intervals.boxes.shape[:-1]
    shape = checks.common_batch("radius and intervals", radii.shape, batch)
    axes = Branch(1.0, intervals.branch.centre, intervals.branch.axis).broadcast(batch)
    places = np.arange(np.prod(batch, dtype=int)).reshape(batch)
    which = np.broadcast_to(places, shape).ravel()
    wanted = np.broadcast_to(radii, shape).ravel()
    controls = np.empty((len(which), foot.phalanx_count))
    clearance = np.empty((len(which), len(foot.fingers)))
    touching = np.empty(clearance.shape, dtype=bool)
    near, far = (
        each.reshape(places.size, foot.phalanx_count)
        for each in (intervals.least_controls, intervals.most_controls)
    )
    for index, part in enumerate(foot.finger_slices.values()):
        length = foot.lengths[part].sum()
        chain = AxisChain.of(foot, index, axes)
        line = _Line(chain, which, near[which, part].T, far[which, part].T)
        found, gap = line.at(wanted / length)
        controls[:, part], clearance[:, index] = found.T, gap * length
        touching[:, index] = np.abs(gap) <= chain.rounding[which]
    return TouchingControls(
        controls.reshape(*shape, foot.phalanx_count),
        clearance.reshape(*shape, len(foot.fingers)),
        touching.reshape(*shape, len(foot.fingers)),
    )


@dataclass(frozen=True, eq=False)
class _Line:
    """Controls on the way between two sequences, before axes.

    Attributes:
        chain: The chains.
        which: Index of the axis of each, shape (m,).
        start: Controls that come near the axis, shape (K, m).
        end: Controls that keep far from it, shape (K, m).
    """

    chain: AxisChain
    which: Indices
    start: Floats
    end: Floats

    def controls(self, index: Indices, place: Floats) -> Floats:
        """Controls part of the way, shape (K, n)."""
        start, end = self.start[:, index], self.end[:, index]
        return np.asarray(np.clip(start + place * (end - start), 0.0, 1.0))

    def gap(self, index: Indices, place: Floats, radius: Floats) -> Floats:
        """Clearance part of the way, shape (n,)."""
        found = self.chain.distance(self.controls(index, place), self.which[index])
        return found - radius[index]

    def at(self, radius: Floats) -> tuple[Floats, Floats]:
        """Controls that touch, or the nearer end, and their clearances.

        Args:
            radius: Radii over the finger's length, shape (m,).

        Returns:
            Controls, shape (K, m), and clearances over the finger's length, (m,).
        """
        every = np.arange(len(self.which))
        near, far = np.zeros(len(every)), np.ones(len(every))
        values = self.gap(every, near, radius), self.gap(every, far, radius)
        place = np.where(values[0] > 0, near, far)
        inside = np.nonzero((values[0] < 0) & (values[1] > 0))[0]
        enough = self.chain.rounding[self.which]
        place[inside], _ = crossings(
            lambda active, new: self.gap(inside[active], new, radius),
            (near[inside], far[inside]),
            (values[0][inside], values[1][inside]),
            enough[inside],
            ITERATIONS,
        )
        return self.controls(every, place), self.gap(every, place, radius)
