"""Routes from controls to distances: the exact engine and FCL, which share nothing."""

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
from zygopin.compiler import has_compiler
from zygopin.contact_products import Booleans, both_products
from zygopin.foot import Foot

EngineName = Literal["exact", "fcl"]
FasterName = Literal["exact", "fcl", "fast"]

Pairs = tuple[NDArray[np.intp], NDArray[np.intp]]

ENGINES: tuple[EngineName, ...] = ("exact", "fcl")
"""The two routes."""

MADE: tuple[FasterName, ...] = (*ENGINES, "fast")
"""Engines that can be made: the routes, and the exact one in compiled loops."""


@dataclass(frozen=True)
class Engine:
    """One route from controls to distances.

    Attributes:
        name: `exact`, `fcl` or `fast`.
        foot: The foot it is for.
        bones: Controls (…, P) that were checked to bones (…, P, 2, 3).
        distances: Bones, radii, branch and pairs of phalanges to a `Clearance`, and
            to the least distance of the pairs' skins in the bones' batch (…).
        products: `contact_products.both_products`, of what was measured.
    """

    name: str
    foot: Foot
    bones: Callable[[Floats], Floats]
    distances: Callable[[Floats, Floats, Branch, Pairs], tuple[Clearance, Floats]]
    products: Callable[[Foot, Booleans, Floats, Floats], Floats]


def make_engine(name: str, foot: Foot) -> Engine:
    """An engine for a foot, to be used for any number of checks.

    `exact` and `fcl` share nothing: the one is closed form throughout, the other goes
    through the URDF, Pinocchio and FCL. `fast` is `exact` in loops compiled by Numba,
    the extra `fast`; it is `exact` itself where Numba is not there.

    Args:
        name: `exact`, `fcl` or `fast`.
        foot: The foot.

    Returns:
        The engine.

    Raises:
        UnknownNameError: There is no engine of that name.
    """
    kinds.instance("foot", foot, Foot)
    kinds.one_of("engine", name, MADE)
    if name == "fast" and has_compiler():
        from zygopin import fast_clearance  # with Numba
        from zygopin.fast_bones import fast_bones

        bones, distances = partial(fast_bones, foot), fast_clearance.distances
        return Engine(name, foot, bones, distances, fast_clearance.products)
    if name == "fcl":
        from zygopin import collision  # FCL and Pinocchio take a quarter of a second
        from zygopin.model import FootModel

        forward = FootModel(foot).forward
        return Engine(name, foot, forward, collision.distances, both_products)
    bones = partial(posed_bones, foot)
    return Engine(name, foot, bones, clearance.distances, both_products)
