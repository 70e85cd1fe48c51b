"""The fingers' reachable sets in space: each in its own vertical plane."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks, kinds
from zygopin.control_system import Levels
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.extent import Hull, convex_hull
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.ifs import ReachableSet, reachable_set

MOST_LEVELS = 33
"""Equal levels of [0, 1] that a finger gets where their number is left open."""

MOST_POINTS = 2_000_000
"""Points of a finger's set: levels are fewer where it would have more."""


@dataclass(frozen=True, eq=False)
class FingerReach:
    """What the tip of one finger of a foot can reach, with its certificates.

    Attributes:
        foot: The foot.
        finger: The finger.
        plane: The set in the finger's plane, in the source's units.
    """

    foot: Foot
    finger: Finger
    plane: ReachableSet

    @property
    def depth(self) -> int:
        """Number of phalanges k of the set."""
        return self.plane.depth

    @property
    def points(self) -> NDArray[np.complex128]:
        """All points x + iz of the set [m], shape (n^k,)."""
        return self.foot.scale * self.plane.points

    @property
    def depth_bound(self) -> float:
        """Bound on d_H(Rₖ, R∞) of these levels [m]; the source's ρ^−k/(ρ−1)."""
        return self.foot.scale * self.plane.depth_bound

    @property
    def grid_bound(self) -> float:
        """Bound on d_H from Rₖ of these levels to Rₖ of the interval [0, 1] [m].

        Raises:
            ParameterError: 0 or 1 is not a level.
        """
        return self.foot.scale * self.plane.grid_bound

    @cached_property
    def hull(self) -> Hull:
        """The convex hull of `points`: its vertices and area in metres."""
        return convex_hull(self.points)

    def in_space(
        self, indices: NDArray[np.intp] | slice = slice(None)
    ) -> NDArray[np.float64]:
        """Points of the set in the foot's frame.

        Args:
            indices: Which of them, shape (…), or a slice.

        Returns:
            Points [m], shape (…, 3).
        """
        if not isinstance(indices, slice):
            indices = checks.indices("indices", indices, len(self.plane.points))
        chosen = self.plane.points[indices]
        return to_space(self.foot, self.finger.name, chosen)


def find_finger(foot: Foot, finger: str | int) -> Finger:
    """A finger by its name or its number.

    Args:
        foot: The foot.
        finger: Its name, or its number from 1, as the model counts them.

    Returns:
        The finger.

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: There is no finger of that number.
    """
    kinds.instance("foot", foot, Foot)
    if not isinstance(finger, str):
        number = checks.integer("finger", finger, 1, len(foot.fingers))
        return foot.fingers[number - 1]
    known = {each.name: each for each in foot.fingers}
    if finger not in known:
        raise UnknownNameError("finger", finger, known)
    return known[finger]


def finger_length(foot: Foot, finger: str | int) -> float:
    """Length of a finger: s·Σ ρ^−k over its phalanges.

    Args:
        foot: The foot.
        finger: Name, or number from 1.

    Returns:
        The length [m].

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: There is no finger of that number.
    """
    part = foot.finger_slices[find_finger(foot, finger).name]
    return float(foot.lengths[part].sum())


def finger_reach(
    foot: Foot,
    finger: str | int,
    levels: Levels = MOST_LEVELS,
    *,
    depth: int | None = None,
) -> FingerReach:
    """What a finger's tip can reach, in its own plane (MODEL.md, section 3).

    Args:
        foot: The foot.
        finger: Name, or number from 1.
        levels: The control set: a number of equal levels of [0, 1], or the levels.
        depth: Phalanges that count, from the base; None: the finger's own number.
            It may be larger: the finger then goes on by the same rule.

    Returns:
        The set.

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: A value is out of range, or the points need more memory.
    """
    chosen = find_finger(foot, finger)
    depth = chosen.phalanges if depth is None else depth
    turn = chosen.orientation
    plane = reachable_set(foot.rho, foot.omega, levels, depth, orientation=turn)
    return FingerReach(foot, chosen, plane)


def to_space(foot: Foot, finger: str | int, points: ArrayLike) -> NDArray[np.float64]:
    """Points of a finger's plane in space: x + iz ↦ (x, 0, z), turned by the azimuth.

    Args:
        foot: The foot.
        finger: Name, or number from 1.
        points: Points x + iz in the source's units, shape (…).

    Returns:
        Points in the foot's frame [m], shape (…, 3).

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: There is no finger of that number.
    """
    ahead, _ = _axes(find_finger(foot, finger))
    plane = foot.scale * np.asarray(points, dtype=complex)
    space = plane.real[..., None] * ahead
    space[..., 2] += plane.imag
    return space


def to_plane(
    foot: Foot, finger: str | int, points: ArrayLike
) -> tuple[NDArray[np.complex128], NDArray[np.float64]]:
    """Points of space projected into a finger's plane; `to_space` leads back.

    Args:
        foot: The foot.
        finger: Name, or number from 1.
        points: Points in the foot's frame [m], shape (…, 3).

    Returns:
        Points x + iz in the source's units, shape (…), and the signed distances
        from the plane [m], to the finger's left positive, shape (…).

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: A point is not finite or not three numbers.
    """
    ahead, left = _axes(find_finger(foot, finger))
    space = checks.array("points", points, last=3)
    plane = (space @ ahead + 1j * space[..., 2]) / foot.scale
    return plane, space @ left


def levels_within(phalanges: int, points: int, most: int = MOST_LEVELS) -> int:
    """The greatest number n of levels, at least 2, with n^phalanges points at most.

    Args:
        phalanges: Number of phalanges K.
        points: Most points, n^K.
        most: Most levels, whatever the points.

    Returns:
        The number of levels, from 2 to `most`.

    Raises:
        ParameterError: Even two levels make more points.
    """
    fitting = [n for n in range(2, most + 1) if n**phalanges <= points]
    if not fitting:
        allowed = f"at least 2^{phalanges} = {2**phalanges}"
        remedy = "two levels of each control make as many"
        raise ParameterError("points", points, allowed, remedy)
    return fitting[-1]


def _axes(finger: Finger) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit vectors along the straight finger and to its left, each of shape (3,)."""
    cosine, sine = np.cos(finger.azimuth), np.sin(finger.azimuth)
    return np.array([cosine, sine, 0.0]), np.array([-sine, cosine, 0.0])
