"""How a foot holds an obstacle of any shape: its contacts, and how they oppose."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.clearance import Clearance, skin_distance
from zygopin.foot import Foot
from zygopin.grasp import classify, finger_pairs, least_gap

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Grip:
    """The contacts of one stance.

    Attributes:
        clearance: Signed clearance of each phalanx [m], shape (P,).
        point: Nearest points of the obstacle [m], shape (P, 3).
        normal: Unit normals there, outward, shape (P, 3).
        touching: |clearance| ≤ tolerance, shape (P,).
        penetrating: clearance < −tolerance, shape (P,).
        finger_clearance: Least distance between two fingers' skins [m]; infinite for
            one finger.
        fingers: Names of the fingers that touch.
        scalar_product: Least product of contact normals of two fingers; NaN where
            fewer than two touch. −1: they face each other across the obstacle.
        feasible: No phalanx penetrates the obstacle, and no finger another.
    """

    clearance: Floats
    point: Floats
    normal: Floats
    touching: NDArray[np.bool_]
    penetrating: NDArray[np.bool_]
    finger_clearance: float
    fingers: tuple[str, ...]
    scalar_product: float
    feasible: bool

    def __post_init__(self) -> None:
        checks.freeze(self)

    @property
    def grasping(self) -> bool:
        """Whether contact normals of two fingers are at least a quarter turn apart.

        Any two fingers and any touch count; `GraspReport.grasping` asks for tangency
        and an opposable pair.
        """
        return bool(self.scalar_product <= 0)


def grip_of(foot: Foot, bones: Floats, near: Clearance, tolerance: float) -> Grip:
    """The contacts of one stance.

    Args:
        foot: The foot.
        bones: Bones [m], shape (P, 2, 3).
        near: Nearest points of the obstacle, shape (P,).
        tolerance: Clearance that is contact [m].

    Returns:
        The contacts.
    """
    contacts = classify(near, tolerance)
    touching, finger = contacts.touching, foot.finger_of_phalanx
    between = skin_distance(bones, foot.radii, finger_pairs(foot))
    apart = float(between.min(initial=np.inf))
    held = np.unique(finger[touching])
    products = near.normal @ near.normal.T
    opposed = touching[:, None] & touching & (finger[:, None] != finger)
    return Grip(
        clearance=near.distance,
        point=near.point,
        normal=near.normal,
        touching=touching,
        penetrating=contacts.penetrating,
        finger_clearance=apart,
        fingers=tuple(foot.fingers[index].name for index in held),
        scalar_product=float(products[opposed].min()) if opposed.any() else np.nan,
        feasible=not contacts.penetrating.any() and apart >= least_gap(foot, tolerance),
    )
