"""Touch intervals: which radii of a branch a finger can touch without entering it.

D(v) = minₖ (dist(boneₖ, axis line) − εₖ) is continuous in the controls v, so a finger
can touch the branch of radius r around an axis, and not enter it, if and only if r is
in [min D, max D] (MODEL.md, section 4). Both ends are certified from both sides.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.axis_chain import AxisChain, Floats, Indices
from zygopin.branch import Branch
from zygopin.foot import Foot
from zygopin.touch_search import Extreme, greatest_distance, least_distance

TOLERANCE = 1e-3
"""Width of the brackets over the finger's length, unless said otherwise."""

FINEST = 1e-9
"""The least tolerance: well above rounding."""

MAX_BOXES = 20_000
"""Boxes of controls that are bounded for each end of an interval, unless said
otherwise: fingers of five phalanges take a few hundred, seldom thousands."""

AXES = 256
"""Axes that are searched at once: they share what a call costs, and fit in memory."""


@dataclass(frozen=True, eq=False)
class TouchIntervals:
    """The radii that each finger can touch around axes, with certificates.

    min D is in the bracket `least`, max D in the bracket `most`; from the attained end
    of one to that of the other every radius can be touched.

    Attributes:
        foot: The foot.
        branch: The branches; only their axis lines matter.
        least: Certified lower bound of min D, and the D that `least_controls` attain
            [m], shape (…, F, 2).
        most: The D that `most_controls` attain, and the certified upper bound of
            max D [m], shape (…, F, 2).
        least_controls: Controls of all fingers, each where it comes nearest, shape
            (…, P).
        most_controls: Controls of all fingers, each where it keeps farthest, shape
            (…, P).
        boxes: Boxes that were bounded for both ends, shape (…, F).
        tolerance: Wanted width of the brackets over the finger's length.
    """

    foot: Foot
    branch: Branch
    least: Floats
    most: Floats
    least_controls: Floats
    most_controls: Floats
    boxes: Indices
    tolerance: float

    def __post_init__(self) -> None:
        checks.freeze(self)

    @property
    def width(self) -> Floats:
        """Width of the wider bracket [m], shape (…, F): the tolerance reached."""
        widths = np.ptp(self.least, axis=-1), np.ptp(self.most, axis=-1)
        return np.asarray(np.maximum(*widths))

    @property
    def converged(self) -> NDArray[np.bool_]:
        """Whether both brackets are as narrow as wanted, shape (…, F)."""
        return np.asarray(self.width <= self.tolerance * _finger_lengths(self.foot))

    def _radii(self, radius: ArrayLike) -> Floats:
        """Checked radii that broadcast against the fingers' ends, shape (…, 1)."""
        radii = checks.lengths("radius", radius)
        batch = self.boxes.shape[:-1]
        checks.common_batch("radius and intervals", radii.shape, batch)
        return radii[..., None]

    def touchable(self, radius: ArrayLike) -> NDArray[np.bool_]:
        """Whether branches certainly can be touched without being entered.

        Args:
            radius: Radii [m], shape (…).

        Returns:
            For each finger, shape (…, F); false also where it is not decided.

        Raises:
            ParameterError: A radius is no positive length, or the shapes differ.
        """
        radii = self._radii(radius)
        return (radii >= self.least[..., 1]) & (radii <= self.most[..., 0])

    def out_of_touch(self, radius: ArrayLike) -> NDArray[np.bool_]:
        """Whether branches certainly are missed or entered, whatever the controls.

        Args:
            radius: Radii [m], shape (…).

        Returns:
            For each finger, shape (…, F); false also where it is not decided.

        Raises:
            ParameterError: A radius is no positive length, or the shapes differ.
        """
        radii = self._radii(radius)
        return (radii < self.least[..., 0]) | (radii > self.most[..., 1])


def touch_intervals(
    foot: Foot,
    branch: Branch,
    *,
    tolerance: float = TOLERANCE,
    max_boxes: int = MAX_BOXES,
) -> TouchIntervals:
    """The radii that each finger can touch around axes (MODEL.md, section 4).

    Args:
        foot: The foot.
        branch: Its axis lines, infinite; radius and length do not matter.
        tolerance: Wanted width of each end's bracket, over the finger's length.
        max_boxes: Boxes after which an end is left as it is, with a wider bracket; the
            last halving may go beyond.

    Returns:
        The intervals; the batch is that of the branch's centre and axis.

    Raises:
        ParameterError: An argument is out of range or of the wrong type.
    """
    kinds.instance("foot", foot, Foot)
    kinds.instance("branch", branch, Branch)
    within = checks.number(
        "tolerance",
        tolerance,
        allowed=f"from {FINEST:g} to 1",
        where=lambda x: FINEST <= x <= 1,
        remedy="give a part of the finger's length, such as 1e-3",
    )
    most = checks.integer("max_boxes", max_boxes, 1, 10**9)
    shape = np.broadcast_shapes(branch.centre.shape[:-1], branch.axis.shape[:-1])
    axes = Branch(1.0, branch.centre, branch.axis).broadcast(shape)
    ends = [
        [
            _joined(
                [search(chain, within, most) for chain in _chains(foot, index, axes)]
            )
            for index in range(len(foot.fingers))
        ]
        for search in (least_distance, greatest_distance)
    ]
    return _intervals(foot, branch, ends, shape, within)


def _chains(foot: Foot, index: int, axes: Branch) -> list[AxisChain]:
    """A finger before the axes, so many at once."""
    count = axes.batch_shape[0]
    return [
        AxisChain.of(foot, index, axes[start : start + AXES])
        for start in range(0, max(count, 1), AXES)
    ]


def _joined(parts: list[Extreme]) -> Extreme:
    """The ends for all axes; there may be none."""
    fields = ("bound", "value", "controls", "boxes")
    return Extreme(
        *(
            np.concatenate([getattr(part, field) for part in parts], axis=-1)
            for field in fields
        )
    )


def _intervals(
    foot: Foot,
    branch: Branch,
    ends: list[list[Extreme]],
    shape: tuple[int, ...],
    tolerance: float,
) -> TouchIntervals:
    """The record, from each end of each finger."""
    lengths = _finger_lengths(foot)

    def stacked(values: list[Floats]) -> Floats:
        """Values of each finger, with the batch's shape."""
        return np.asarray(np.stack(values, axis=-1).reshape(*shape, len(lengths)))

    def bracket(found: list[Extreme], first: str, second: str) -> Floats:
        """Both sides of one end [m]."""
        sides = (
            stacked([getattr(each, name) for each in found]) for name in (first, second)
        )
        return np.stack([lengths * side for side in sides], axis=-1)

    least, most = ends
    near, far = (
        np.concatenate([each.controls for each in found]).T.reshape(
            *shape, foot.phalanx_count
        )
        for found in ends
    )
    boxes = [a.boxes + b.boxes for a, b in zip(least, most, strict=True)]
    return TouchIntervals(
        foot,
        branch,
        bracket(least, "bound", "value"),
        bracket(most, "value", "bound"),
        near,
        far,
        np.stack(boxes, axis=-1).reshape(*shape, len(lengths)),
        tolerance,
    )


def _finger_lengths(foot: Foot) -> Floats:
    """Length of each finger [m], shape (F,)."""
    return np.array([foot.lengths[part].sum() for part in foot.finger_slices.values()])
