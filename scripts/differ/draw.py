"""What a case is drawn from: a foot, poses and branches, all from one seed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from zlib import crc32

import numpy as np

from differ.branches import around
from differ.corners import FOOT_CORNERS, POSE_CORNERS, Rng, Shape, chosen
from zygopin import Branch, Finger, Foot
from zygopin.clearance import Floats
from zygopin.foot import SHORTEST

LEAST = 2 * SHORTEST
"""Share of the scale that even the last of many phalanges has."""


@dataclass(frozen=True)
class Size:
    """How much a case holds.

    Attributes:
        poses: Poses, each on a branch of its own.
        fingers: Most fingers, but for the corner of ten.
        phalanges: Most phalanges of a finger, but for the corner of twelve.
        opposed: Whether the first two fingers point forward and back.
    """

    poses: int
    fingers: int = 6
    phalanges: int = 6
    opposed: bool = False


@dataclass(frozen=True, eq=False)
class Draw:
    """What the routes of a case are given.

    Attributes:
        seed: The seed.
        corners: The corners that it stands in.
        foot: A foot.
        controls: Controls of n poses, shape (n, P).
        branch: A branch for each pose, batch (n,), the base outside.
        rng: Where a route takes what it needs beyond.
        beyond: What that was, by name: a replay prints it.
    """

    seed: int
    corners: tuple[str, ...]
    foot: Foot
    controls: Floats
    branch: Branch
    rng: Rng
    beyond: dict[str, object] = field(default_factory=dict)


def draw(name: str, seed: int, corners: tuple[str, ...], size: Size) -> Draw:
    """The draw of a route for a seed: the same in every process.

    Args:
        name: The route's name.
        seed: The seed, ≥ 0.
        corners: Corners that the route may stand in.
        size: How much to draw.

    Returns:
        The draw.
    """
    rng = np.random.default_rng([crc32(name.encode()), seed])
    stands = chosen(corners, seed, rng)
    foot = _foot(stands, size, rng)
    controls = rng.uniform(size=(size.poses, foot.phalanx_count))
    for corner in stands:
        if corner in POSE_CORNERS:
            controls = POSE_CORNERS[corner](controls, rng)
    branch = around(foot, controls, stands, rng)
    return Draw(seed, stands, foot, controls, branch, rng)


def _foot(corners: tuple[str, ...], size: Size, rng: Rng) -> Foot:
    """A foot of any allowed shape, in its corners."""
    shape: Shape = {
        "rho": rng.uniform(1.02, 2.5),
        "omega": rng.choice(
            [rng.uniform(0.1, 3.0), rng.uniform(3.3, 6.2)], p=[0.8, 0.2]
        ),
        "scale": 10 ** rng.uniform(-3, 1),
        "skin": rng.choice([0.0, rng.uniform(0.01, 0.3)], p=[0.2, 0.8]),
        "fingers": tuple(_finger(i, size, rng) for i in range(_count(size, rng))),
    }
    for corner in corners:
        if corner in FOOT_CORNERS:
            shape |= FOOT_CORNERS[corner](rng)
    if size.opposed:
        shape["fingers"] = _opposed(shape["fingers"], rng)
    most = max(finger.phalanges for finger in shape["fingers"])
    shape["rho"] = min(shape["rho"], LEAST ** (-1 / most))
    return Foot(thickness=shape.pop("skin") * shape["scale"], **shape)


def _count(size: Size, rng: Rng) -> int:
    """A number of fingers, two at least where they shall be opposed."""
    return int(rng.integers(2 if size.opposed else 1, size.fingers + 1))


def _opposed(fingers: tuple[Finger, ...], rng: Rng) -> tuple[Finger, ...]:
    """The fingers, the first of them pointing forward, the second back."""
    ahead, back = np.add(rng.uniform(-1.2, 1.2, 2), [0.0, math.pi])
    one, other = replace(fingers[0], azimuth=ahead), replace(fingers[1], azimuth=back)
    return (one, other, *fingers[2:])


def _finger(index: int, size: Size, rng: Rng) -> Finger:
    """A finger anywhere; some start inclined, some can turn."""
    azimuth, turned = rng.uniform(-math.pi, math.pi, 2)
    inclined, turns = rng.random(2) < (0.3, 0.2)
    return Finger(
        name=f"toe{index}",
        phalanges=int(rng.integers(1, size.phalanges + 1)),
        azimuth=azimuth,
        orientation=rng.uniform(-1, 1) if inclined else 0.0,
        reversed_azimuth=turned if turns else None,
    )
