"""The branch on which a foot sits at rest."""

from __future__ import annotations

import math

from zygopin import checks, kinds
from zygopin.branch import Branch, branch_axis
from zygopin.errors import ParameterError
from zygopin.foot import Foot

LEVEL = 1e-3
"""Cosine of the slope below which a branch is upright: no foot sits on it."""


def resting_branch(
    foot: Foot, radius: float, *, yaw: float = 0.0, pitch: float = 0.0
) -> Branch:
    """The branch straight below the base that the base's skin rests on.

    Its axis crosses the z axis at −(radius + skin)/cos(pitch), where the skin is that
    of the thickest phalanx: the gap between base and bark is the skin alone.

    Args:
        foot: The foot.
        radius: Radius of the branch [m].
        yaw: Turn about z [rad]; 0: across the foot.
        pitch: Rise to the left [rad].

    Returns:
        An endless branch, its centre on the z axis.

    Raises:
        ParameterError: The radius is no positive length, or the branch is upright.
    """
    kinds.instance("foot", foot, Foot)
    axis, slope = branch_axis(yaw, pitch), math.cos(pitch)
    if abs(slope) < LEVEL:
        remedy = "give a slope that a foot can sit on, such as 0.5"
        raise ParameterError("pitch", pitch, "a slope", remedy)
    thick = checks.length("radius", radius)
    reach = thick + float(foot.radii.max())
    return Branch(thick, (0.0, 0.0, -reach / abs(slope)), axis)
