"""What the spread pose gains: how much ground a foot covers as its toes turn.

Seen from above (MODEL.md, section 6): the hull of the talons, and the places where a
ball is met by a foot that comes straight down.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import minimize_scalar

from zygopin import checks, kinds, names
from zygopin.errors import ParameterError
from zygopin.extent import convex_hull
from zygopin.foot import Foot
from zygopin.kinematics import Controls, as_controls, forward_kinematics
from zygopin.stadiums import Stadiums
from zygopin.stance import azimuths_at

Phalanges = Literal["first", "all"]
"""Which phalanges count: the first ones, whose contact closes the foot, or all."""

PHALANGES: tuple[Phalanges, ...] = ("first", "all")

STEPS = 181
"""Reversals that a study looks at, unless said otherwise."""

MOST_STEPS = 100_001
"""Reversals that a study may have: some minutes."""

LARGEST_RADIUS = 1e6
"""Largest target [m]: that of the largest foot."""

WIDTH = 1e-10
"""Reversals closer than this are not told apart: a maximum is flat far wider."""

EQUALITY = 1e-9
"""Part of an area by which it may lie below another and still count as equal."""

FLAT = 1e-14
"""Hulls smaller than this part of the square of the foot's size are lines: rounding."""


@dataclass(frozen=True, eq=False)
class SpreadCurve:
    """An area over the reversal.

    Attributes:
        areas: Areas [m²] at the study's reversals, read-only, shape (n,).
        best_reversal: Where the area is largest, in [0, 1].
        best_area: The area there [m²].
    """

    areas: NDArray[np.float64]
    best_reversal: float
    best_area: float

    @property
    def zygodactyl(self) -> float:
        """Area in the zygodactyl pose [m²]."""
        return float(self.areas[0])

    @property
    def spread(self) -> float:
        """Area in the spread pose [m²]."""
        return float(self.areas[-1])

    @property
    def gain(self) -> float:
        """What the spread pose adds, as a part of the zygodactyl pose's area.

        Infinite if that is zero; 0 if both are.
        """
        if self.zygodactyl == 0:
            return math.inf if self.spread > 0 else 0.0
        return self.spread / self.zygodactyl - 1

    @property
    def spread_is_best(self) -> bool:
        """Whether no pose along the turn covers more than the spread one."""
        return self.best_area * (1 - EQUALITY) <= self.spread


@dataclass(frozen=True, eq=False)
class SpreadStudy:
    """How much a foot covers along the turn of its toes, seen from above.

    Attributes:
        foot: The foot.
        radius: The target's radius [m].
        reversal: Reversals from 0, zygodactyl, to 1, spread, read-only, shape (n,).
        hull: Area of the talons' convex hull.
        strike_first: Strike area of the first phalanges.
        strike_all: Strike area of all phalanges.
    """

    foot: Foot
    radius: float
    reversal: NDArray[np.float64]
    hull: SpreadCurve
    strike_first: SpreadCurve
    strike_all: SpreadCurve


def talon_hull_area(
    foot: Foot, controls: Controls | None = None, *, reversal: ArrayLike
) -> NDArray[np.float64]:
    """Area of the convex hull of the talons, seen from above.

    The talons are the fingers' last junctions, projected along z.

    Args:
        foot: The foot.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}; None:
            straight toes.
        reversal: Where the toes that turn stand, shape (…): 0 at their azimuth, 1 at
            the reversed one.

    Returns:
        Areas [m²], shape (…).

    Raises:
        ParameterError: A control or a reversal is outside [0, 1], a shape is wrong, or
            no toe of the foot can turn.
        UnknownNameError: A finger does not exist.
    """
    kinds.instance("foot", foot, Foot)
    talons = [part.stop - 1 for part in foot.finger_slices.values()]
    bones = _projected(foot, controls, reversal)[..., talons, 1]
    areas = _each(bones, 1, lambda points: convex_hull(points).area)
    return np.asarray(np.where(areas > FLAT * foot.size**2, areas, 0.0))


def strike_area(
    foot: Foot,
    radius: float,
    *,
    reversal: ArrayLike,
    controls: Controls | None = None,
    phalanges: Phalanges = "first",
) -> NDArray[np.float64]:
    """Area of the places where a ball is met by a foot that comes straight down.

    A phalanx meets the ball iff the ball's centre is, seen from above, no farther from
    its bone than skin and ball are thick together: inside a stadium. The area is that
    of the stadiums' union, exact but for rounding.

    Args:
        foot: The foot.
        radius: The ball's radius ≥ 0 [m].
        reversal: Where the toes that turn stand, shape (…): 0 at their azimuth, 1 at
            the reversed one.
        controls: Controls in [0, 1], shape (…, P), or {finger name: sequence}; None:
            straight toes.
        phalanges: Which of them count: the `first`, the guard of the owl's automaton,
            or `all`.

    Returns:
        Areas [m²], shape (…).

    Raises:
        ParameterError: A value is out of range, a shape is wrong, or no toe of the foot
            can turn.
        UnknownNameError: A finger does not exist, or `phalanges` is neither.
    """
    kinds.instance("foot", foot, Foot)
    radius = _checked_radius(radius)
    kinds.one_of("phalanges", phalanges, PHALANGES)
    counted = foot.rank_of_phalanx <= (1 if phalanges == "first" else math.inf)
    bones = _projected(foot, controls, reversal)[..., counted, :]
    radii = foot.radii[counted] + radius
    return _each(bones, 2, lambda each: Stadiums.around(each, radii).area())


def spread_study(
    foot: Foot,
    radius: float,
    *,
    controls: Controls | None = None,
    steps: int = STEPS,
) -> SpreadStudy:
    """How much a foot covers along the turn of its toes, and where it covers most.

    The maxima are the best of equal steps, refined between the neighbours of that one.

    Args:
        foot: The foot.
        radius: The target's radius ≥ 0 [m].
        controls: Controls in [0, 1], shape (P,), or {finger name: sequence}; None:
            straight toes.
        steps: Number of reversals, from 0 to 1.

    Returns:
        The areas with their maxima.

    Raises:
        ParameterError: A value is out of range, a shape is wrong, or no toe of the foot
            can turn.
        UnknownNameError: A finger does not exist.
    """
    radius = _checked_radius(radius)
    steps = checks.integer("steps", steps, 2, MOST_STEPS)
    pose = np.zeros(foot.phalanx_count) if controls is None else controls
    pose = as_controls(foot, pose)
    if pose.ndim != 1:
        remedy = "give one pose; the reversal is what varies"
        raise ParameterError("controls.shape", pose.shape, "of shape (P,)", remedy)
    reversal = np.linspace(0, 1, steps)

    def hull(turn: ArrayLike) -> NDArray[np.float64]:
        return talon_hull_area(foot, pose, reversal=turn)

    def strike(phalanges: Phalanges) -> _Area:
        return lambda turn: strike_area(
            foot, radius, reversal=turn, controls=pose, phalanges=phalanges
        )

    curves = (_curve(area, reversal) for area in (hull, strike("first"), strike("all")))
    return SpreadStudy(foot, radius, checks.read_only(reversal), *curves)


_Area = Callable[[ArrayLike], NDArray[np.float64]]


def _curve(area: _Area, reversal: NDArray[np.float64]) -> SpreadCurve:
    """An area at some reversals, and its maximum."""
    areas = area(reversal)
    place = int(np.argmax(areas))
    bounds = reversal[max(place - 1, 0)], reversal[min(place + 1, len(areas) - 1)]
    unit = max(float(areas[place]), np.finfo(float).tiny)
    found = minimize_scalar(
        lambda turn: -float(area(turn)) / unit,
        bounds=bounds,
        method="bounded",
        options={"xatol": WIDTH},
    )
    best, largest = float(reversal[place]), float(areas[place])
    between = float(area(found.x))
    if between > largest:
        best, largest = float(found.x), between
    return SpreadCurve(checks.read_only(areas), best, largest)


def _projected(
    foot: Foot, controls: Controls | None, reversal: ArrayLike
) -> NDArray[np.complex128]:
    """Bones seen from above, ends x + iy [m], shape (…, P, 2)."""
    turning = [*map(names.is_reversible, foot.fingers)]
    if not any(turning):
        name = f"toes of {foot.name} that can turn"
        remedy = "give a finger its reversed_azimuth, or take the preset owl"
        raise ParameterError(name, 0, "at least 1", remedy)
    turn = checks.array("reversal", reversal)
    inside = (turn >= 0) & (turn <= 1)
    remedy = "0 is the zygodactyl pose, 1 the spread one"
    checks.require("reversal", turn, inside, "in [0, 1]", remedy)
    straight = np.zeros(foot.phalanx_count)
    chosen = straight if controls is None else controls
    bones = forward_kinematics(foot, chosen, azimuths=azimuths_at(foot, turn))
    return np.asarray(bones[..., 0] + 1j * bones[..., 1])


def _each(
    values: NDArray[np.complex128],
    axes: int,
    area: Callable[[NDArray[np.complex128]], float],
) -> NDArray[np.float64]:
    """An area of each entry of a batch, whose entries have so many axes."""
    batch, shape = values.shape[:-axes], values.shape[-axes:]
    areas = [area(each) for each in values.reshape(-1, *shape)]
    return np.array(areas, dtype=float).reshape(batch)


def _checked_radius(radius: object) -> float:
    """A target's radius [m]."""
    allowed = f"in [0, {LARGEST_RADIUS:g}]"
    remedy = "give metres, such as 0.015 for 15 mm"
    return checks.number(
        "radius",
        radius,
        allowed=allowed,
        where=lambda x: 0 <= x <= LARGEST_RADIUS,
        remedy=remedy,
    )
