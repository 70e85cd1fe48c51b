"""Scalar products over tangent phalanges of opposable fingers: MODEL.md, section 5."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from zygopin import checks
from zygopin.directions import FEET, Floats
from zygopin.foot import Foot

Booleans = NDArray[np.bool_]


def least_product(foot: Foot, vectors: Floats, tangent: Booleans) -> Floats:
    """Least scalar product over tangent phalanges of opposable fingers.

    Args:
        foot: The foot.
        vectors: A vector for each phalanx, shape (…, P, 3).
        tangent: Which phalanges are tangent, shape (…, P).

    Returns:
        The least products, shape (…); NaN without such a pair.
    """
    return least_over(tangent_pairs(foot, tangent), vectors)


class TangentPairs(NamedTuple):
    """Pairs of phalanges of opposable fingers, for poses that are tangent with both.

    Attributes:
        batch: Shape of the batch.
        pose: Numbers in the batch of the m poses with such a pair, shape (m,).
        tangent: Whether they are tangent with both of a pair, shape (m, M).
        first: The one phalanx of each pair, shape (M,).
        second: The other phalanx, shape (M,).
    """

    batch: tuple[int, ...]
    pose: NDArray[np.intp]
    tangent: Booleans
    first: NDArray[np.intp]
    second: NDArray[np.intp]


def tangent_pairs(foot: Foot, tangent: Booleans) -> TangentPairs:
    """The pairs of poses.

    Args:
        foot: The foot.
        tangent: Which phalanges are tangent, shape (…, P).

    Returns:
        The pairs.
    """
    i, j = _opposed(foot)
    flat = tangent.reshape(-1, tangent.shape[-1])
    both = flat[:, i] & flat[:, j]
    pose = np.flatnonzero(both.any(axis=1))
    return TangentPairs(tangent.shape[:-1], pose, both[pose], i, j)


def least_over(pairs: TangentPairs, vectors: Floats) -> Floats:
    """Least product over each pose's pairs.

    Args:
        pairs: The pairs.
        vectors: A vector for each phalanx, shape (…, P, 3), that broadcasts to them.

    Returns:
        The least products, shape (…); NaN without such a pair.
    """
    least = np.full(math.prod(pairs.batch), np.nan)
    if len(pairs.pose):
        vectors = np.broadcast_to(vectors, (*pairs.batch, *vectors.shape[-2:]))
        some = vectors.reshape(-1, *vectors.shape[-2:])[pairs.pose]
        # All products at once: cheaper than to gather the vectors of each pair first.
        products = (some @ some.swapaxes(-1, -2))[:, pairs.first, pairs.second]
        least[pairs.pose] = np.where(pairs.tangent, products, np.inf).min(axis=1)
    return least.reshape(pairs.batch)


@lru_cache(FEET)
def _opposed(foot: Foot) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Pairs of phalanges of opposable fingers: indices of the first and the second."""
    finger = foot.finger_of_phalanx
    opposed = np.zeros((foot.phalanx_count,) * 2, dtype=bool)
    for one, other in foot.opposable_pairs:
        opposed |= (finger[:, None] == one) & (finger == other)
    i, j = np.nonzero(opposed)
    return checks.read_only(i), checks.read_only(j)
