"""How long closing toes keep the contact that engaged them, in the reading `paper`.

The source remarks: if O is convex, P⁽ˡ⁾ ∩ O ≠ ∅ for some finger l throughout. Its
phalanges pass through O, the base x₀ stays, and the first phalanx, of length ℓ and skin
ε, turns by ωv about x₀: P(v) = {x₀ + a·e(v₀ + ωv), 0 ≤ a ≤ ℓ}. It meets O where P(v)
meets O_ε, which is O grown by ε, and convex where O is. Then:

1. If x₀ ∈ O_ε, contact is kept: every P(v) holds x₀. O need not be convex.
2. Else let O be convex and C the part of O_ε in the finger's plane within ℓ of x₀. C is
   convex, compact and without x₀, so the directions from x₀ to it fill one closed arc,
   narrower than π. P(v) meets O_ε where its direction is in that arc: a point of O_ε
   on P(v) is in C, and a point of C in the direction of P(v) is on P(v).
3. So for ω < π the values v of contact are one closed interval, or none. For ω > π
   they may be two, of which one holds v = 0 and the other v = 1.
4. So for ω < π one finger keeps contact from v(0) to v(T) if and only if it has contact
   at both. Several keep it together if and only if their intervals cover [v(0), v(T)].
5. So a finger keeps contact all along only if x₀ ∈ O_ε, or if C, seen from x₀, is at
   least as wide as the turn ω(v(T) − v(0)). A ball of radius r at a distance d is no
   wider than 2·asin((r + ε)/d): a toe that turns farther sweeps through it.

Convexity alone does not keep contact: `counterexample` has a ball that a toe sweeps
through.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from zygopin import checks, kinds
from zygopin.errors import ParameterError
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.grasp import Criteria
from zygopin.kinematics import as_azimuths
from zygopin.motion import Motion
from zygopin.obstacle import Obstacle, Sphere, as_obstacle
from zygopin.phalanx_sweep import Interval, Sweep, about_z, merged
from zygopin.reach import find_finger

FINEST = 1e-7
"""Least tolerance over the foot's size: at a smaller clearance the normal is off by
more than that, by rounding."""

TOUCH = 0.8
"""Where a counterexample's ball touches the phalanx, over its length."""

WIDEST = math.pi / 3
"""Turn at which a counterexample's toe has swept through the ball at most, unless
said otherwise [rad]: the ball stays small."""

HALFWAY = 0.5
"""Value of v at which it has, unless said otherwise and unless that is too wide."""

LATE = 4.0
"""Clearance over the tolerance at which a contact has ended for certain."""


@dataclass(frozen=True)
class ContactKept:
    """Where closing toes meet an obstacle, as their map v runs from 0 to 1.

    Attributes:
        intervals: Values v at which each finger's first phalanx meets the obstacle,
            as disjoint intervals, ascending. In them its clearance is at most twice
            the tolerance; outside it is more than the tolerance.
        tolerance: Clearance that counts as contact [m].
    """

    intervals: Mapping[str, tuple[Interval, ...]]
    tolerance: float

    @property
    def together(self) -> tuple[Interval, ...]:
        """Values v at which some first phalanx meets the obstacle."""
        return merged([each for found in self.intervals.values() for each in found])

    @property
    def kept(self) -> bool:
        """Whether some first phalanx meets the obstacle at every v in [0, 1]."""
        return self.keeps(0.0, 1.0)

    @property
    def lost_at(self) -> float:
        """Value v from which on none does, for the first time; infinite where kept."""
        ends = [last for first, last in self.together if first == 0]
        end = ends[0] if ends else 0.0
        return end if end < 1 else math.inf

    def keeps(self, first: float, last: float) -> bool:
        """Whether some first phalanx meets the obstacle from one v to another.

        Args:
            first: v(0), in [0, 1].
            last: v(T) ≥ v(0), in [0, 1].

        Returns:
            The verdict.
        """
        first, last = checks.unit("first", first), checks.unit("last", last)
        return any(low <= first <= last <= high for low, high in self.together)


@dataclass(frozen=True, eq=False)
class Counterexample:
    """A ball that touches a straight toe from below, and is swept through.

    Attributes:
        foot: The foot, its base in the world's frame.
        finger: The finger whose first phalanx touches the ball at v = 0.
        obstacle: The ball.
        lost_at: Value v at which that phalanx touches it for the last time.
    """

    foot: Foot
    finger: Finger
    obstacle: Sphere
    lost_at: float

    @property
    def contact(self) -> ContactKept:
        """The same by `contact_kept`, which knows nothing of the closed form."""
        return contact_kept(self.foot, self.obstacle)


def contact_kept(
    foot: Foot,
    obstacle: Obstacle,
    *,
    base: ArrayLike | None = None,
    azimuths: ArrayLike | None = None,
    tolerance: float | None = None,
) -> ContactKept:
    """Where first phalanges meet an obstacle while all controls go from 0 to 1.

    A point at a distance a from the base moves by ωa per unit of v, and a plane parts
    the phalanx from a convex solid. So one look tells of a whole range of v that the
    phalanx is clear, or that it is not; where it does not, the range is halved. No
    contact is stepped over, however thin the obstacle is.

    Args:
        foot: The foot.
        obstacle: The obstacle, in the world's frame.
        base: T_world_base, shape (4, 4); None: the world's frame.
        azimuths: Azimuth of each finger [rad], shape (F,); None: the foot's own.
        tolerance: Clearance that counts as contact [m]; None: 1e-6 of the foot's size.

    Returns:
        The intervals of v, and whether contact is kept.

    Raises:
        ParameterError: A value is out of range or of a wrong shape.
    """
    kinds.instance("foot", foot, Foot)
    solid, within = as_obstacle(obstacle), _tolerance(foot, tolerance)
    pose = Motion.resting(base).at(np.zeros(1))[0]
    turns = as_azimuths(foot, azimuths)
    checks.shaped("azimuths", turns, (len(foot.fingers),))
    found = {}
    for finger, azimuth in zip(foot.fingers, turns, strict=True):
        swept = Sweep(foot, finger, pose @ about_z(azimuth), solid)
        found[finger.name] = swept.contacts(within)
    return ContactKept(found, within)


def counterexample(
    foot: Foot, *, finger: str | int | None = None, lost_at: float | None = None
) -> Counterexample:
    """A ball that a toe touches at v = 0 and has swept through at a given v₁ < 1.

    With R = r + ε, a ball under a point at a distance s along the straight phalanx has
    its centre at d = √(s² + R²), at an angle α = atan(R/s) = asin(R/d) below. The
    phalanx is tangent to it at the turns 0 and 2α, and meets it between. So
    v₁ = 2α/ω, and R = s·tan(ωv₁/2).

    Args:
        foot: The foot.
        finger: Name, or number from 1; None: the last, which is the source's.
        lost_at: v₁ in (0, 1) with ωv₁ < π; None: 1/2, or less so that ωv₁ ≤ π/3.

    Returns:
        The ball.

    Raises:
        UnknownNameError: There is no finger of that name.
        ParameterError: v₁ is out of range, the skin is too thick for any ball, or
            another finger keeps the ball beyond v₁.
    """
    kinds.instance("foot", foot, Foot)
    toe = find_finger(foot, len(foot.fingers) if finger is None else finger)
    last = _checked_loss(foot, lost_at)
    first = foot.finger_slices[toe.name].start
    place, half = TOUCH * foot.lengths[first], foot.omega * last / 2
    grown = place * math.tan(half)
    radius = grown - foot.radii[first]
    if radius < checks.SMALLEST:
        name, remedy = "skin of the first phalanx", "give a later lost_at, or less skin"
        allowed = f"less than {grown:.3g} m"
        raise ParameterError(name, float(foot.radii[first]), allowed, remedy)
    along = math.cos(toe.orientation + half), -math.sin(toe.orientation + half)
    flat = math.cos(toe.azimuth), math.sin(toe.azimuth)
    centre = np.array([along[0] * flat[0], along[0] * flat[1], along[1]])
    ball = Sphere(radius, place / math.cos(half) * centre)
    found = Counterexample(foot, toe, ball, last)
    _check_lost(found)
    return found


def _tolerance(foot: Foot, tolerance: float | None) -> float:
    """Clearance that counts as contact [m]."""
    near = Criteria(tolerance=tolerance).metres(foot)
    least = FINEST * foot.size
    if near < least:
        allowed = f"at least {least:.3g} m, {FINEST:g} of the foot"
        raise ParameterError("tolerance", near, allowed, "give more: rounding shows")
    return near


def _checked_loss(foot: Foot, lost_at: float | None) -> float:
    """Value of v at which a counterexample's contact ends."""
    if lost_at is None:
        return min(HALFWAY, WIDEST / foot.omega)
    most = min(1.0, math.pi / foot.omega)
    return checks.number(
        "lost_at",
        lost_at,
        allowed=f"in (0, {most:.4g})",
        where=lambda v: 0 < v < most,
        remedy="the toe has then turned by ω times that, less than half a turn",
    )


def _check_lost(found: Counterexample) -> None:
    """No finger keeps the ball beyond the value at which it shall be lost."""
    foot, contact = found.foot, found.contact
    place = TOUCH * foot.lengths[foot.finger_slices[found.finger.name].start]
    end = found.lost_at + LATE * contact.tolerance / (foot.omega * place)
    for name, intervals in contact.intervals.items():
        late = [last for _, last in intervals if last > end]
        if late:
            remedy = "take another finger, or a smaller lost_at: a smaller ball"
            allowed = f"at most {found.lost_at:.4g}, where {found.finger.name} loses it"
            raise ParameterError(
                f"v at which {name} meets it", late[0], allowed, remedy
            )
