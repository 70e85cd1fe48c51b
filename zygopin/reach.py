"""The fingers' reachable sets in space: each in its own vertical plane."""

from __future__ import annotations

import dataclasses
import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.control_system import ControlSystem, Levels, as_tolerance, frozen
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.extent import Hull, convex_hull
from zygopin.foot import Finger, Foot
from zygopin.ifs import ReachableSet, reachable_set
from zygopin.inverse import find_word, nearest_reachable
from zygopin.kinematics import forward_kinematics
from zygopin.word_answer import Verdict, WordAnswer

MOST_LEVELS = 33
"""Equal levels of [0, 1] that a finger gets where their number is left open."""

REACHED = 1e-6
"""Distance over the finger's length within which a point counts as reached."""

NEAREST = 1e-4
"""What the residual may lose against the least one where a point is out of reach,
over the length that a finger of any number of phalanges has."""


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
        chosen = self.plane.points[indices]
        return to_space(self.foot, self.finger.name, chosen)


@dataclass(frozen=True, eq=False)
class InverseReach:
    """Controls that bring a finger's tip near a point, and what is certain about it.

    Attributes:
        finger: The finger's name.
        controls: The controls of its phalanges, read-only, shape (K,).
        tip: Where they put the tip, by `forward_kinematics` [m], shape (3,).
        residual: Distance of the tip from the point [m].
        out_of_plane: Distance of the point from the finger's plane, to the finger's
            left positive [m].
        lower_bound: No controls bring the tip nearer than this [m]: the certificate.
        tolerance: Distance within which the point counts as reached [m].
    """

    finger: str
    controls: NDArray[np.float64]
    tip: NDArray[np.float64]
    residual: float
    out_of_plane: float
    lower_bound: float
    tolerance: float

    @property
    def verdict(self) -> Verdict:
        """`reachable` within the tolerance, `not_reachable` (proved) or `undecided`."""
        if self.residual <= self.tolerance:
            return "reachable"
        return "not_reachable" if self.lower_bound > self.tolerance else "undecided"


def inverse_reach(
    foot: Foot,
    finger: str | int,
    point: ArrayLike,
    *,
    tolerance: float | None = None,
    levels: Levels | None = None,
) -> InverseReach:
    """Controls of a finger that reach a point of space, or the nearest there are.

    The point is projected into the finger's plane, and searched there by pruning the
    tree of control sequences (MODEL.md, section 3). Out of reach, the residual is
    within 1e-4 of the finger's length of the least one.

    Args:
        foot: The foot.
        finger: Name, or number from 1.
        point: The point in the foot's frame [m], shape (3,).
        tolerance: Distance that counts as reached, > 0 [m]; None: 1e-6 of the
            finger's length.
        levels: The control set; None: all of [0, 1].

    Returns:
        The controls, where they put the tip, and what is certain.

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: A value is out of range.
    """
    chosen = find_finger(foot, finger)
    goal = _single_point(point)
    if tolerance is None:
        tolerance = REACHED * finger_length(foot, finger)
    within = as_tolerance(tolerance)
    target, aside = to_plane(foot, finger, goal)
    spare = math.sqrt(max(within**2 - float(aside) ** 2, 0.0)) or within
    system = ControlSystem(foot.rho, foot.omega, levels, chosen.orientation)
    found = _searched(complex(target), system, chosen.phalanges, spare / foot.scale)
    controls = np.zeros(foot.phalanx_count)
    part = foot.finger_slices[chosen.name]
    controls[part] = found.controls
    tip = forward_kinematics(foot, controls)[part.stop - 1, 1]
    return InverseReach(
        finger=chosen.name,
        controls=found.controls,
        tip=frozen(tip.copy()),
        residual=float(np.linalg.norm(tip - goal)),
        out_of_plane=float(aside),
        lower_bound=math.hypot(foot.scale * found.lower_bound, float(aside)),
        tolerance=within,
    )


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


def _searched(
    target: complex, system: ControlSystem, depth: int, tolerance: float
) -> WordAnswer:
    """Any word within the tolerance; where there is none, the nearest."""
    found = find_word(target, system, depth, tolerance=tolerance)
    if found.verdict == "reachable":
        return found
    coarse = max(tolerance, NEAREST / (system.rho - 1))
    nearest = nearest_reachable(target, system, depth, tolerance=coarse)
    best = min(found, nearest, key=lambda each: each.distance)
    bound = max(found.lower_bound, nearest.lower_bound)
    return dataclasses.replace(best, lower_bound=bound)


def _single_point(point: ArrayLike) -> NDArray[np.float64]:
    """One checked point of space, shape (3,)."""
    goal = checks.array("point", point, last=3)
    if goal.ndim != 1:
        remedy = "ask for one point at a time"
        raise ParameterError("point.shape", goal.shape, "(3,)", remedy)
    return goal


def _axes(finger: Finger) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Unit vectors along the straight finger and to its left, each of shape (3,)."""
    cosine, sine = np.cos(finger.azimuth), np.sin(finger.azimuth)
    return np.array([cosine, sine, 0.0]), np.array([-sine, cosine, 0.0])
