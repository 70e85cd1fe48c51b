"""Scalar products over tangent phalanges of opposable fingers: MODEL.md, section 5."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.directions import FEET, Floats
from zygopin.foot import Foot

Booleans = NDArray[np.bool_]


def least_products(foot: Foot, tangent: Booleans, *vectors: Floats) -> Floats:
    """Least scalar products over tangent phalanges of opposable fingers.

    Args:
        foot: The foot.
        tangent: Which phalanges are tangent, shape (…, P).
        vectors: A vector for each phalanx, shape (…, P, 3), which broadcasts to them;
            k such arrays.

    Returns:
        The least products, shape (k, …); NaN without such a pair.
    """
    i, j = _opposed(foot)
    flat = tangent.reshape(-1, tangent.shape[-1])
    both = flat[:, i] & flat[:, j]
    some = both.any(axis=1)
    least = np.full((len(vectors), len(flat)), np.nan)
    if some.any():
        wide = np.empty((len(vectors), *tangent.shape, 3))
        for room, given in zip(wide, vectors, strict=True):
            room[...] = given
        chosen = wide.reshape(len(vectors), *flat.shape, 3)[:, some]
        # All products at once: cheaper than to gather the vectors of each pair first.
        products = chosen @ chosen.swapaxes(-1, -2)
        products = products.reshape(*products.shape[:2], -1)
        opposed = products.take(i * flat.shape[1] + j, axis=-1)
        least[:, some] = np.where(both[some], opposed, np.inf).min(axis=-1)
    return least.reshape(len(vectors), *tangent.shape[:-1])


@lru_cache(FEET)
def _opposed(foot: Foot) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of phalanges of opposable fingers: indices of the first and the second."""
    finger = foot.finger_of_phalanx
    opposed = np.zeros((foot.phalanx_count,) * 2, dtype=bool)
    for one, other in foot.opposable_pairs:
        opposed |= (finger[:, None] == one) & (finger == other)
    i, j = np.nonzero(opposed)
    return checks.read_only(i), checks.read_only(j)
