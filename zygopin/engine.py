"""The two routes from controls to distances, which share nothing."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from zygopin import clearance, kinds
from zygopin.bones import posed_bones
from zygopin.branch import Branch
from zygopin.clearance import Clearance, Floats
from zygopin.foot import Foot

EngineName = Literal["exact", "fcl"]

Pairs = tuple[NDArray[np.intp], NDArray[np.intp]]

ENGINES: tuple[EngineName, ...] = ("exact", "fcl")


@dataclass(frozen=True)
class Engine:
    """One route from controls to distances.

    Attributes:
        name: `exact` or `fcl`.
        foot: The foot it is for.
        bones: Controls (…, P) that were checked to bones (…, P, 2, 3).
        distances: Bones, radii, branch and pairs of phalanges to a `Clearance`, and
            to the least distance of the pairs' skins in the bones' batch (…).
    """

    name: str
    foot: Foot
    bones: Callable[[Floats], Floats]
    distances: Callable[[Floats, Floats, Branch, Pairs], tuple[Clearance, Floats]]


def make_engine(name: str, foot: Foot) -> Engine:
    """An engine for a foot, to be used for any number of checks.

    The two share nothing: `exact` is closed form throughout, `fcl` goes through the
    URDF, Pinocchio and FCL.

    Args:
        name: `exact` or `fcl`.
        foot: The foot.

    Returns:
        The engine.

    Raises:
        UnknownNameError: There is no engine of that name.
    """
    kinds.instance("foot", foot, Foot)
    kinds.one_of("engine", name, ENGINES)
    if name == "exact":
        return Engine(
            name,
            foot,
            partial(posed_bones, foot),
            clearance.distances,
        )
    from zygopin import collision  # FCL and Pinocchio take a quarter of a second
    from zygopin.model import FootModel

    return Engine(
        name,
        foot,
        FootModel(foot).forward,
        collision.distances,
    )
