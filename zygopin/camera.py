"""Where a scene is seen from: a view that frames the foot at any size."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch

DISTANCE = 8.0
"""From the eye to the target, in units of the scene: far enough that lines which
are parallel look so, near enough to tell front from back."""

MARGIN = 1.12
"""The frame's size over that of what it holds."""

WIDEST = 1.25
"""The greatest ratio of the frame's sides: a flat foot has room above and below."""

AHEAD, ASIDE, ABOVE = 0.75, 0.52, 0.40
"""The eye's direction, along the branch, across it, and outward to the foot's base:
the fingers' wrap is seen nearly end on, in three quarters, from above."""

HIGHEST, LOWEST = math.radians(55), math.radians(-15)
"""Range of the eye's elevation [rad]: a view from the zenith has no upright."""

_PREFERRED_END = np.array([0.2, -0.5, 1.0])


@dataclass(frozen=True, eq=False)
class View:
    """A perspective view of a part of space.

    Attributes:
        target: The point in the middle of the frame [m], shape (3,).
        direction: Unit vector from the target to the eye, shape (3,).
        unit: Length of one unit of the scene: half the greater side of what is
            framed [m].
        half_height: Half the frame's height over the eye's distance.
        aspect: The frame's width over its height.
    """

    target: NDArray[np.float64]
    direction: NDArray[np.float64]
    unit: float
    half_height: float
    aspect: float

    @property
    def eye(self) -> NDArray[np.float64]:
        """Position of the eye from the target, in units of the scene, shape (3,)."""
        return DISTANCE * self.direction

    @property
    def axes(self) -> NDArray[np.float64]:
        """Rows: rightward, upward and toward the eye, in the world, shape (3, 3)."""
        return _axes(self.direction)

    @property
    def field_of_view(self) -> float:
        """The angle that the frame's height subtends [rad]."""
        return 2 * math.atan(self.half_height)

    def corner(self, right: float, up: float) -> NDArray[np.float64]:
        """A point of the plane through the target that faces the eye.

        Args:
            right: Place across the frame, from -1 to 1.
            up: Place up the frame, from -1 to 1.

        Returns:
            The point [m], shape (3,).
        """
        half = DISTANCE * self.half_height * self.unit
        axes = self.axes
        return np.asarray(
            self.target + half * (right * self.aspect * axes[0] + up * axes[1])
        )


def framed(
    points: NDArray[np.float64],
    radii: NDArray[np.float64],
    direction: NDArray[np.float64],
) -> View:
    """The view from a direction whose frame just holds some balls.

    Args:
        points: Centres [m], shape (N, 3).
        radii: Radii [m], shape (N,).
        direction: Unit vector to the eye, shape (3,).

    Returns:
        The view.
    """
    axes = _axes(direction)
    flat = points @ axes.T
    low, high = (flat - radii[:, None]).min(0), (flat + radii[:, None]).max(0)
    unit = float((high - low)[:2].max()) / 2
    middle = (low + high) / 2
    for _ in range(3):
        low, high = _seen((flat - middle) / unit, radii / unit)
        middle[:2] += DISTANCE * unit * (low + high) / 2
    half = MARGIN * (high - low) / 2
    half = np.maximum(half, half[::-1] / WIDEST)
    return View(
        middle @ axes, direction, unit, float(half[1]), float(half[0] / half[1])
    )


def grasp_direction(branch: Branch) -> NDArray[np.float64]:
    """The direction from which a grasp of a branch is best seen.

    Args:
        branch: One branch.

    Returns:
        Unit vector to the eye, shape (3,).
    """
    return wrap_direction(branch.axis, branch.frame(_toward_base(branch))[:, 0])


def wrap_direction(
    axis: NDArray[np.float64], outward: NDArray[np.float64]
) -> NDArray[np.float64]:
    """The direction from which fingers that wrap around an axis are best seen.

    Args:
        axis: Unit vector, either way along the axis, shape (3,).
        outward: Unit vector across it, toward the foot's base, shape (3,).

    Returns:
        Unit vector to the eye, shape (3,).
    """
    axis = axis * (1.0 if axis @ _PREFERRED_END >= 0 else -1.0)
    eye = AHEAD * axis + ABOVE * outward + ASIDE * np.cross(outward, axis)
    level = math.hypot(eye[0], eye[1])
    heading = eye[:2] / level if level > 1e-9 else np.array([0.0, -1.0])
    elevation = min(max(math.atan2(eye[2], level), LOWEST), HIGHEST)
    return np.array([*(math.cos(elevation) * heading), math.sin(elevation)])


def _toward_base(branch: Branch) -> NDArray[np.float64]:
    """From the axis to the foot's base, or upward where the base is on the axis."""
    outward: NDArray[np.float64] = (branch.centre @ branch.axis) * branch.axis
    outward = outward - branch.centre
    length = float(np.linalg.norm(outward))
    near = length < 1e-6 * float(branch.radius)
    return np.array([0.0, 0.0, 1.0]) if near else outward / length


def _seen(
    flat: NDArray[np.float64], radii: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The frame's least and greatest right and up over the distance, shape (2,)."""
    depth = (DISTANCE - flat[:, 2:])[:, [0, 0]]
    reach = radii[:, None] / depth
    place = flat[:, :2] / depth
    return (place - reach).min(0), (place + reach).max(0)


def _axes(direction: NDArray[np.float64]) -> NDArray[np.float64]:
    """Rows: rightward, upward and toward the eye, in the world, shape (3, 3)."""
    right = np.cross((0.0, 0.0, 1.0), direction)
    right = right / np.linalg.norm(right)
    return np.stack([right, np.cross(direction, right), direction])
