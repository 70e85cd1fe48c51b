"""Convex solids that a foot can meet: where they are, and what they are made of."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch


@dataclass(frozen=True, eq=False)
class Sphere:
    """A solid ball.

    Attributes:
        radius: Radius > 0 [m].
        centre: Its centre [m], shape (3,).
    """

    radius: float
    centre: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Box:
    """A solid box.

    Attributes:
        size: Lengths of its edges > 0 [m], shape (3,).
        centre: Its centre [m], shape (3,).
        rotation: R_world_box, shape (3, 3); None: along the world's axes.
    """

    size: NDArray[np.float64]
    centre: NDArray[np.float64]
    rotation: NDArray[np.float64] | None = None


@dataclass(frozen=True, eq=False)
class Capsule:
    """A solid cylinder with a half ball on either end.

    Attributes:
        radius: Radius > 0 [m].
        ends: Ends of its core segment [m], shape (2, 3).
    """

    radius: float
    ends: NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class ConvexMesh:
    """A solid convex polyhedron.

    Attributes:
        vertices: Vertices [m], shape (V, 3).
        triangles: Vertices of each face, counter-clockwise from outside, shape
            (T, 3); None: those of the vertices' convex hull.
    """

    vertices: NDArray[np.float64]
    triangles: NDArray[np.intp] | None = None


Obstacle = Branch | Sphere | Box | Capsule | ConvexMesh
"""What a foot can meet; a `Branch` here is one, not a batch."""
