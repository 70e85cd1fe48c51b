"""The paper's top view (figure 2): what the labels on it say of the toes.

The picture itself is not in the source, its labels are. A label stands beside the tip
of its toe, so its height over the base measures the toe.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from itertools import permutations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics

LABELS: Mapping[str, tuple[float, float]] = {
    "finger1": (5, 80),
    "finger2": (-5, 263),
    "finger3": (110, 289),
    "finger4": (115, 3),
}
"""Lower left corners of the fingers' names, right and up [points]."""

ANGLE_LABELS: Mapping[str, tuple[float, float]] = {
    "π/6 below": (65, 120),
    "π/6 above": (65, 195),
    "5π/6 right": (100, 155),
    "5π/6 left": (26, 155),
}
"""Lower left corners of the angles."""

BASE_HEIGHT = (ANGLE_LABELS["π/6 below"][1] + ANGLE_LABELS["π/6 above"][1]) / 2
"""Height of the base [points]: halfway between the labels of the equal angles."""

MIDDLE = ANGLE_LABELS["π/6 above"][0]
"""Where left ends and right begins [points]."""

COUNTS = (2, 3, 4, 5)
"""Phalanges of fingers 1 to 4, as birds' digits I to IV have them."""


@dataclass(frozen=True)
class Fit:
    """The scale at which lengths come closest to distances, by least squares.

    Attributes:
        scale: The scale [points].
        misfit: Norm of what is left over that of the distances.
    """

    scale: float
    misfit: float


def label_distances() -> NDArray[np.float64]:
    """Vertical distances of the fingers' labels from the base.

    Returns:
        Distances [points], shape (4,).
    """
    heights = np.array([height for _, height in LABELS.values()])
    return np.abs(heights - BASE_HEIGHT)


def label_sides() -> NDArray[np.float64]:
    """On which sides of the base the labels stand.

    Returns:
        1 for forward and for left, −1 for back and for right, shape (4, 2).
    """
    places = np.array([*LABELS.values()])
    return np.sign(np.stack([places[:, 1] - BASE_HEIGHT, MIDDLE - places[:, 0]], 1))


def tip_sides(foot: Foot) -> NDArray[np.float64]:
    """On which sides of the base the tips of straight toes lie.

    Args:
        foot: The foot.

    Returns:
        1 for forward and for left, −1 for back and for right, shape (F, 2).
    """
    bones = forward_kinematics(foot, np.zeros(foot.phalanx_count))
    tips = [part.stop - 1 for part in foot.finger_slices.values()]
    return np.asarray(np.sign(bones[tips, 1, :2]))


def fitted(lengths: ArrayLike) -> Fit:
    """The scale at which toes fit the labels best.

    Args:
        lengths: Lengths of the toes along x, shape (4,).

    Returns:
        The fit.
    """
    distances, toes = label_distances(), np.asarray(lengths, dtype=float)
    scale = float(np.linalg.lstsq(toes[:, None], distances, rcond=None)[0][0])
    left = np.linalg.norm(distances - scale * toes)
    return Fit(scale, float(left / np.linalg.norm(distances)))


def assignments(foot: Foot) -> dict[tuple[int, ...], Fit]:
    """How each way to give the toes 2, 3, 4 and 5 phalanges fits the labels.

    Args:
        foot: The foot whose longest toe, straight, has the phalanges' lengths.

    Returns:
        {phalanges of fingers 1 to 4: the fit}, all 24 of them.
    """
    bones = forward_kinematics(foot, np.zeros(foot.phalanx_count))
    along = np.abs(bones[foot.finger_slices["finger4"], 1, 0])
    return {
        counts: fitted([along[count - 1] for count in counts])
        for counts in permutations(COUNTS)
    }


def misfit_by_hand(rho: float, counts: tuple[int, ...]) -> float:
    """The misfit as the sine of the angle between distances and lengths.

    Args:
        rho: Scaling factor ρ; a toe of K phalanges is (1 − ρ^−K)/(ρ − 1) long.
        counts: Phalanges of fingers 1 to 4.

    Returns:
        The misfit.
    """
    distances = [77.5, 105.5, 131.5, 154.5]
    toes = [(1 - rho**-count) / (rho - 1) for count in counts]
    product = math.fsum(a * b for a, b in zip(distances, toes, strict=True))
    return math.sqrt(1 - (product / math.hypot(*distances) / math.hypot(*toes)) ** 2)
