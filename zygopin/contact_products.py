"""Scalar products over tangent phalanges of opposable fingers: MODEL.md, section 5."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.clearance import norm
from zygopin.directions import FEET, Floats
from zygopin.foot import Foot

Booleans = NDArray[np.bool_]
Indices = NDArray[np.intp]


def both_products(
    foot: Foot, tangent: Booleans, normals: Floats, bones: Floats
) -> Floats:
    """`least_products` of contact normals, and of the phalanges' directions.

    Args:
        foot: The foot.
        tangent: Which phalanges are tangent, shape (…, P).
        normals: Unit normals at their contacts, shape (…, P, 3).
        bones: Bones [m], shape (…, P, 2, 3), which may have fewer batch axes.

    Returns:
        The two products, shape (2, …); NaN without such a pair.
    """
    return least_products(foot, tangent, normals, base_to_tip(bones))


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
    i, j, _ = opposed_pairs(foot)
    both = tangent.take(i, axis=-1) & tangent.take(j, axis=-1)
    some = both.any(axis=-1)
    if some.all():
        return np.array([_least(foot, both, each) for each in vectors])
    least = np.full((len(vectors), *some.shape), np.nan)
    if some.any():
        shape = *tangent.shape, 3
        for room, each in zip(least, vectors, strict=True):
            room[some] = _least(foot, both[some], np.broadcast_to(each, shape)[some])
    return least


def base_to_tip(bones: Floats) -> Floats:
    """Unit vectors along bones.

    Args:
        bones: Bones, shape (…, P, 2, 3).

    Returns:
        Vectors, shape (…, P, 3).
    """
    lines: Floats = bones[..., 1, :] - bones[..., 0, :]
    lines /= norm(lines)[..., None]
    return lines


def _least(foot: Foot, both: Booleans, vectors: Floats) -> Floats:
    """Least products over pairs, shape (…).

    Args:
        foot: The foot.
        both: Whether both phalanges of a pair are tangent, shape (…, M).
        vectors: A vector for each phalanx, shape (…, P, 3).
    """
    *_, places = opposed_pairs(foot)
    # All products at once: cheaper than to gather the vectors of each pair first.
    products = vectors @ vectors.swapaxes(-1, -2)
    products = products.reshape(*products.shape[:-2], foot.phalanx_count**2)
    opposed = products.take(places, axis=-1)
    return np.asarray(np.where(both, opposed, np.inf).min(axis=-1, initial=np.inf))


@lru_cache(FEET)
def opposed_pairs(foot: Foot) -> tuple[Indices, Indices, Indices]:
    """Pairs of phalanges of opposable fingers.

    Args:
        foot: The foot.

    Returns:
        Indices of the first, of the second, and of their product in a flat matrix,
        shape (M,) each, read-only.
    """
    finger = foot.finger_of_phalanx
    opposed = np.zeros((foot.phalanx_count,) * 2, dtype=bool)
    for one, other in foot.opposable_pairs:
        opposed |= (finger[:, None] == one) & (finger == other)
    first, second = map(checks.read_only, np.nonzero(opposed))
    return first, second, checks.read_only(np.flatnonzero(opposed))
