"""The paper's section 4: four toes, and how they stand (figure 2)."""

from __future__ import annotations

import math
from itertools import combinations
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.paper.entry import Entry, Exhibit, Measurement, by_hand, equal, rounding
from zygopin.paper.toe_planes import (
    OPPOSED,
    between,
    first_azimuths,
    normals,
    off_plane,
)
from zygopin.paper.top_view import tip_sides

RANDOM = 1000
"""Random control sequences on which two routes are held against each other."""

FINGERS = (1, 2, 3, 4)
"""Numbers of the fingers."""

PAIRS = {(1, 2), (1, 3), (2, 4), (3, 4)}
"""Fingers that oppose each other: one forward, one back."""

SECTORS = {(2, 3): 1, (1, 4): 1, (1, 2): 5, (3, 4): 5}
"""Angles between neighbouring fingers, over π/6: the labels of the paper's figure."""

TOE_LENGTHS = (55 / 36, 455 / 216, 3355 / 1296, 23255 / 7776)
"""Lengths 5·(1 − (5/6)^K) of toes with 2 to 5 phalanges at ρ = 6/5."""

Floats = NDArray[np.float64]


def figure_2() -> Entry:
    """Figure 2: the foot from above.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper-figure")
    return Entry(
        key="figure-2",
        kind="figure",
        title="The foot from above",
        place="section 4, figure 2",
        printed=(
            r"Angles $\pi/6$ between the forward toes and between the back toes, "
            r"$\frac{5}{6}\pi$ at the sides; $\rho = 1.2$."
        ),
        ours="",
        finding=(
            r"The azimuths $\pi-\Omega$, $\Omega$, $-\Omega$, $\pi+\Omega$ of fingers "
            r"1 to 4 with $\Omega=\pi/12$ give the labelled angles, in the closed form "
            "and in Pinocchio. The text takes the golden mean for $\\rho$, this "
            "caption 1.2."
        ),
        measurements=(*_angles(foot), *_lengths(foot)),
        figures=(
            Exhibit(
                "figure-2.png",
                "The foot from above, forward up and left to the left: straight toes "
                "with their junctions, ρ = 1.2. Numbers beside the phalanges are their "
                "lengths $1.2^{-k}$. The longest toe measures 2.991.",
                _draw_foot,
            ),
        ),
    )


def opposable_fingers() -> Entry:
    """Fingers 1 and 3 share a vertical plane, and so do 2 and 4.

    Returns:
        The entry.
    """
    return Entry(
        key="opposable-fingers",
        kind="statement",
        title="Coplanar and opposable fingers",
        place="section 4",
        printed=(
            "The planes of the fingers are orthogonal to the xy-plane. Fingers 1 and 3 "
            "are coplanar, and fingers 2 and 4; the fingers oppose in pairs."
        ),
        ours="",
        finding=(
            "With the azimuths of figure 2 this holds whatever the controls are. Of "
            "the six pairs of fingers four have one finger forward and one back: "
            "(1,2), (1,3), (4,2) and (4,3)."
        ),
        measurements=_shared_planes(Foot.preset("paper")),
    )


def _shared_planes(foot: Foot) -> tuple[Measurement, ...]:
    """How far fingers leave their planes, and which of them oppose."""
    controls = _random_controls(foot)
    routes = {
        "fk": ("forward_kinematics", forward_kinematics(foot, controls)),
        "pinocchio": ("Pinocchio", FootModel(foot).forward(controls)),
    }
    ahead = tip_sides(foot)[:, 0]
    listed = {(i + 1, j + 1) for i, j in foot.opposable_pairs}
    seen = {(i, j) for i, j in combinations(FINGERS, 2) if ahead[i - 1] != ahead[j - 1]}
    return (
        *(
            rounding(
                f"apart_{first}{second}_{key}",
                f"largest distance of a junction of fingers {first} and {second} from "
                f"their common plane, {RANDOM} random controls, {route}",
                off_plane(foot, bones, (first, second)),
            )
            for key, (route, bones) in routes.items()
            for first, second in OPPOSED
        ),
        rounding(
            "tilt",
            "largest vertical part of the unit normals of the fingers' planes",
            float(np.abs(normals(foot)[:, 2]).max()),
        ),
        Measurement(
            "pairs",
            "opposable pairs",
            len(listed),
            equal(4, 0, "two fingers forward times two back"),
        ),
        Measurement(
            "wrong_pairs",
            "pairs on which the list, the four above, and the sides of the tips in "
            "forward_kinematics disagree",
            len((listed ^ PAIRS) | (listed ^ seen)),
            equal(0, 0, "the four pairs"),
        ),
    )


def _angles(foot: Foot) -> tuple[Measurement, ...]:
    """Angles between neighbouring fingers, on both routes."""
    straight = first_azimuths(
        foot, forward_kinematics(foot, np.zeros(foot.phalanx_count))
    )
    moved = first_azimuths(foot, FootModel(foot).forward(_random_controls(foot)))
    off = [
        np.abs(between(moved, pair) - number * math.pi / 6).max()
        for pair, number in SECTORS.items()
    ]
    return (
        *(
            by_hand(
                f"angle_{first}{second}",
                f"angle between fingers {first} and {second}, forward_kinematics",
                float(between(straight, (first, second))),
                number * math.pi / 6,
                unit="rad",
            )
            for (first, second), number in SECTORS.items()
        ),
        rounding(
            "pinocchio",
            "largest difference of the four angles from the labels, by Pinocchio, "
            f"{RANDOM} random controls",
            float(np.max(off)),
            unit="rad",
        ),
    )


def _lengths(foot: Foot) -> tuple[Measurement, ...]:
    """Lengths of the straight toes."""
    bones = forward_kinematics(foot, np.zeros(foot.phalanx_count))
    return tuple(
        by_hand(
            f"length_{number}",
            rf"length of toe {number}, $5\,(1-(5/6)^{number + 1})$",
            float(np.linalg.norm(bones[part.stop - 1, 1])),
            expected,
        )
        for number, part, expected in zip(
            FINGERS, foot.finger_slices.values(), TOE_LENGTHS, strict=True
        )
    )


def _random_controls(foot: Foot) -> Floats:
    """Controls that are the same each time, shape (n, P)."""
    return np.random.default_rng(4).uniform(size=(RANDOM, foot.phalanx_count))


def _draw_foot(path: Path) -> object:
    """Draw figure 2."""
    from zygopin.paper.foot_drawings import draw_foot_from_above

    return draw_foot_from_above(Foot.preset("paper-figure"), path)
