"""Where a ball is struck, measured with squares that are halved at the edge."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.stance import azimuths_at

COARSE = 32
"""Squares along a side at first."""

HALVINGS = 8
"""How often the squares at the edge are halved."""


@lru_cache(4)
def struck_area(foot: Foot, radius: float, reversal: float) -> tuple[float, float]:
    """Area of the places, seen from above, where straight toes meet a ball.

    A square is inside where its middle is, by more than its half diagonal; outside
    likewise; else it is cut in four. What is left bounds the error.

    Args:
        foot: The foot.
        radius: The ball's radius [m].
        reversal: Turn of the reversible toes, from 0 to 1.

    Returns:
        The area over s², and its largest error.
    """
    azimuths = azimuths_at(foot, np.array(reversal))
    straight = np.zeros(foot.phalanx_count)
    bones = forward_kinematics(foot, straight, azimuths=azimuths) / foot.scale
    reach = (foot.radii + radius) / foot.scale
    half = 1.01 * (foot.size / foot.scale + float(reach.max()))
    side = 2 * half / COARSE
    line = (np.arange(COARSE) + 0.5) * side - half
    middles = (line[:, None] + 1j * line).ravel()
    area = 0.0
    for _ in range(HALVINGS):
        gaps = _gaps(middles, bones[..., 0] + 1j * bones[..., 1], reach)
        slack = side / math.sqrt(2)
        area += float(np.sum(gaps <= -slack)) * side**2
        edge = middles[np.abs(gaps) < slack]
        corners = side / 4 * np.array([1 + 1j, 1 - 1j, -1 + 1j, -1 - 1j])
        middles, side = (edge[:, None] + corners).ravel(), side / 2
    left = len(middles) * side**2
    return area + left / 2, left / 2


def _gaps(
    points: NDArray[np.complex128],
    bones: NDArray[np.complex128],
    reach: NDArray[np.float64],
) -> NDArray[np.float64]:
    """Distance of points from the nearest stadium, negative inside, shape (n,)."""
    start, line = bones[:, 0], bones[:, 1] - bones[:, 0]
    along = ((points[:, None] - start) * line.conj()).real / np.abs(line) ** 2
    nearest = start + np.clip(along, 0, 1) * line
    return np.asarray((np.abs(points[:, None] - nearest) - reach).min(axis=1))
