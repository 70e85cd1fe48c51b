"""The Hausdorff distance of two clouds of points, exactly, with the points it is at."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin import checks
from zygopin.blocks import in_blocks
from zygopin.errors import ParameterError


@dataclass(frozen=True, eq=False)
class HausdorffDistance:
    """A distance between two clouds, and the pair of points that attains it.

    Attributes:
        value: The distance, in the unit of the points.
        points: The attaining points, first cloud's first, shape (2, D).
        indices: Their places in the two clouds.
    """

    value: float
    points: NDArray[np.float64]
    indices: tuple[int, int]

    def __post_init__(self) -> None:
        points = np.array(self.points, float)
        points.setflags(write=False)
        object.__setattr__(self, "points", points)


def hausdorff_distance(first: ArrayLike, second: ArrayLike) -> HausdorffDistance:
    """The Hausdorff distance of two finite sets.

    d_H(A, B) = max(max_{a∈A} min_{b∈B} |a−b|, max_{b∈B} min_{a∈A} |a−b|), by nearest
    neighbours in a k-d tree: exact but for the rounding of |a−b|.

    Args:
        first: Points: complex numbers, shape (N,), or coordinates, shape (N, D).
        second: Points of the same kind, shape (M,) or (M, D).

    Returns:
        The distance and the points that attain it.

    Raises:
        ParameterError: A cloud is empty, not finite, or their dimensions differ.
    """
    ahead = directed_distance(first, second)
    back = directed_distance(second, first)
    if ahead.value >= back.value:
        return ahead
    return HausdorffDistance(back.value, back.points[::-1], back.indices[::-1])


def directed_distance(first: ArrayLike, second: ArrayLike) -> HausdorffDistance:
    """The one-sided distance: how far the first set strays from the second.

    max_{a∈A} min_{b∈B} |a−b|; zero where A is part of B.

    Args:
        first: Points: complex numbers, shape (N,), or coordinates, shape (N, D).
        second: Points of the same kind, shape (M,) or (M, D).

    Returns:
        The distance, the point of `first` farthest from `second`, and its nearest.

    Raises:
        ParameterError: A cloud is empty, not finite, or their dimensions differ.
    """
    sources, targets = as_cloud("first", first), as_cloud("second", second)
    if sources.shape[1] != targets.shape[1]:
        allowed = f"of the first cloud's dimension {sources.shape[1]}"
        remedy = "give two clouds of the same dimension"
        raise ParameterError("second.shape", targets.shape, allowed, remedy)
    distances, nearest = nearest_points(sources, targets)
    farthest = int(np.argmax(distances))
    pair = farthest, int(nearest[farthest])
    points = np.stack([sources[pair[0]], targets[pair[1]]])
    return HausdorffDistance(float(distances[farthest]), points, pair)


def nearest_points(
    sources: NDArray[np.float64], targets: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.intp]]:
    """The nearest point of one cloud to each point of another.

    Args:
        sources: Points, shape (N, D).
        targets: Points, shape (M, D), at least one.

    Returns:
        Distances, in the points' unit, and indices into `targets`, both shape (N,).
    """
    from scipy.spatial import cKDTree  # slow to load: only where used

    # Equal points make one leaf of any size, which a search walks through.
    kept = _first_of_each(targets)
    tree = cKDTree(targets[kept], balanced_tree=False)
    distances, nearest = np.empty(len(sources)), np.empty(len(sources), np.intp)

    # Not by the tree's own threads: where one is interrupted, others go on in memory
    # that has been given back.
    def search(part: slice) -> None:
        distances[part], nearest[part] = tree.query(sources[part])

    in_blocks(search, len(sources))
    return distances, kept[nearest]


def as_cloud(name: str, points: ArrayLike) -> NDArray[np.float64]:
    """Points as one checked array of coordinates.

    Args:
        name: Name of the parameter, for the message.
        points: Complex numbers, shape (N,), or coordinates, shape (N, D).

    Returns:
        A new array of shape (N, D); complex numbers have D = 2.

    Raises:
        ParameterError: No points, not finite, or of another shape.
    """
    what, remedy = "an array of numbers", "give a row for each point"
    values = checks.array_of(name, points, f"{checks.REAL}c", what, remedy)
    if values.dtype.kind == "c":
        points = np.stack([values.real, values.imag], axis=-1)
    cloud = checks.array(name, points)
    if cloud.ndim != 2 or 0 in cloud.shape:
        allowed = "of the form (N, D) with at least one point"
        remedy = "give complex numbers in one row, or a row for each point"
        raise ParameterError(f"{name}.shape", cloud.shape, allowed, remedy)
    return cloud


def _first_of_each(cloud: NDArray[np.float64]) -> NDArray[np.intp]:
    """Indices of the points without repetitions, shape (≤ N,)."""
    order = np.lexsort(cloud.T)
    ordered = cloud[order]
    new = np.ones(len(cloud), dtype=bool)
    new[1:] = np.any(ordered[1:] != ordered[:-1], axis=1)
    return np.sort(order[new])
