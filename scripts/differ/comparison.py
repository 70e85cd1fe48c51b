"""One quantity by two routes: how far apart, over what is allowed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin.clearance import Floats

Booleans = NDArray[np.bool_]


@dataclass(frozen=True, eq=False)
class Comparison:
    """A quantity of n cases by two routes.

    Attributes:
        quantity: Its name, and the routes'.
        one: What the one route says, shape (n, …).
        other: What the other says, shape (n, …).
        ratio: Difference over tolerance, shape (n,): above 1 the routes disagree.
        decided: Cases that are not within rounding of a threshold, shape (n,).
    """

    quantity: str
    one: NDArray[Any]
    other: NDArray[Any]
    ratio: Floats
    decided: Booleans

    @property
    def failed(self) -> Booleans:
        """Cases in which the routes disagree, shape (n,)."""
        return np.asarray(self.decided & ~(self.ratio <= 1))


def close(
    quantity: str, one: ArrayLike, other: ArrayLike, tolerance: ArrayLike
) -> Comparison:
    """Numbers that shall be within a tolerance; the same infinity is no difference.

    Args:
        quantity: What they are.
        one: Numbers of the one route, shape (n, …).
        other: Numbers of the other, of the same shape.
        tolerance: What is allowed, broadcast against them.

    Returns:
        The comparison.
    """
    one, other = np.asarray(one), np.asarray(other)
    alike = (one == other) | (np.isnan(one) & np.isnan(other))
    with np.errstate(invalid="ignore"):
        apart = np.where(alike, 0.0, np.abs(one - other))
    return _made(quantity, one, other, apart / np.asarray(tolerance))


def at_most(
    quantity: str, one: ArrayLike, other: ArrayLike, tolerance: ArrayLike
) -> Comparison:
    """Numbers of the one route that shall not exceed the other's.

    Args:
        quantity: What they are.
        one: Numbers, shape (n, …).
        other: Their upper bounds, of the same shape.
        tolerance: By how much they may exceed them, for rounding.

    Returns:
        The comparison; numbers below their bounds have the ratio 0.
    """
    one, other = np.asarray(one, float), np.asarray(other, float)
    beyond = np.where(one <= other, 0.0, one - other)
    return _made(quantity, one, other, beyond / np.asarray(tolerance))


def same(
    quantity: str, one: ArrayLike, other: ArrayLike, decided: ArrayLike = True
) -> Comparison:
    """Verdicts that shall be equal where they are decided.

    Args:
        quantity: What they are.
        one: Verdicts of the one route, shape (n, …).
        other: Verdicts of the other, of the same shape.
        decided: Which are not within rounding of a threshold, shape (n,).

    Returns:
        The comparison: 0 or infinite.
    """
    one, other = np.asarray(one), np.asarray(other)
    ratio = np.where(one == other, 0.0, np.inf)
    return _made(quantity, one, other, ratio, decided)


def _made(
    quantity: str,
    one: NDArray[Any],
    other: NDArray[Any],
    ratio: Floats,
    decided: ArrayLike = True,
) -> Comparison:
    """The comparison, its ratios one for each case; not a number is no agreement."""
    flat = np.where(np.isnan(ratio), np.inf, ratio).reshape(len(ratio), -1)
    wide = np.broadcast_to(np.asarray(decided, bool), (len(ratio),))
    return Comparison(quantity, one, other, flat.max(axis=1, initial=0.0), wide)
