"""Convex polytopes: exact signed distances from bones to boxes and meshes."""

from __future__ import annotations

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.clearance import (
    Floats,
    Nearest,
    least_of_convex,
    norm,
    segment_offset,
)
from zygopin.obstacle import Box, ConvexMesh

ON_FACE = 1e-12
"""How far the foot of a perpendicular may lie outside the solid, over the solid's
size: rounding, at the rim of a face."""

COINCIDENT = 1e-10
"""Gap over the solid's size below which a bone's offset from an edge is rounding
and the nearest face gives the normal."""

CORNERS = np.array(list(itertools.product((-0.5, 0.5), repeat=3)))
"""Corners of the unit box."""

EDGES = np.array(
    [
        (i, j)
        for i, j in itertools.combinations(range(8), 2)
        if (CORNERS[i] != CORNERS[j]).sum() == 1
    ]
)
"""Its edges, as pairs of corners."""


@dataclass(frozen=True)
class Polytope:
    """A convex polytope, relative to its middle.

    Attributes:
        middle: A point inside [m], shape (3,).
        size: Distance of the farthest vertex from it [m].
        normals: Outward unit normals of the faces, shape (F, 3).
        offsets: Distances of the faces from the middle [m], shape (F,).
        edges: Edges, relative to the middle [m], shape (E, 2, 3).
    """

    middle: Floats
    size: float
    normals: Floats
    offsets: Floats
    edges: Floats

    @classmethod
    def of(cls, solid: Box | ConvexMesh) -> Polytope:
        """The polytope that a solid is."""
        if isinstance(solid, Box):
            axes, half = solid.rotation.T, solid.size / 2
            edges = (CORNERS * solid.size @ axes)[EDGES]
            normals, offsets = np.concatenate([axes, -axes]), np.tile(half, 2)
            return cls(solid.centre, float(norm(half)), normals, offsets, edges)
        middle = solid.vertices.mean(axis=0)
        vertices, faces = solid.vertices - middle, solid.triangles
        sides = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
        normals, offsets = solid.planes[:, :3], solid.planes[:, 3]
        return cls(
            middle,
            float(norm(vertices).max()),
            normals,
            offsets - normals @ middle,
            vertices[sides[sides[:, 0] < sides[:, 1]]],
        )

    def nearest(self, bones: Floats) -> Nearest:
        """Where bare bones are nearest.

        Args:
            bones: Bones [m], shape (n, 2, 3).

        Returns:
            The nearest points; the gap of a bone that enters is minus the depth of
            its deepest point below the face that is nearest to that point.
        """
        bones = bones - self.middle
        found = self._deepest(bones)
        outside = found.gap > 0
        if outside.any():
            parts = self._apart(bones[outside], found.normal[outside])
            for whole, part in zip(found, parts, strict=True):
                whole[outside] = part
        return found

    def _deepest(self, bones: Floats) -> Nearest:
        """Where the greatest height over the faces' planes is least."""
        start = bones[:, 0] @ self.normals.T - self.offsets
        rise = (bones[:, 1] - bones[:, 0]) @ self.normals.T
        row = np.arange(len(bones))

        def highest(t: Floats) -> NDArray[np.intp]:
            return np.asarray((start + t[:, None] * rise).argmax(axis=1), np.intp)

        def slope(t: Floats) -> Floats:
            return np.asarray(rise[row, highest(t)])

        t = least_of_convex(slope, len(bones))
        face = highest(t)
        return Nearest(
            t, start[row, face] + t * rise[row, face], self.normals[face].copy()
        )

    def _apart(self, bones: Floats, spare: Floats) -> Nearest:
        """The nearest pair of features: a bone's end and a face, or bone and edge."""
        heights = bones @ self.normals.T - self.offsets
        # No other face can be the nearest: the solid is below the highest plane.
        face = np.argmax(heights, axis=-1)
        height = heights.max(axis=-1)
        upright = self.normals[face]
        feet = bones - height[..., None] * upright
        outside = (feet @ self.normals.T - self.offsets).max(axis=-1)
        gaps = np.where(outside <= ON_FACE * self.size, height, np.inf)
        along, offsets = segment_offset(bones[:, None], self.edges)
        apart = norm(offsets)
        best = np.argmin(np.concatenate([gaps, apart], axis=1), axis=1)
        row = np.arange(len(bones))
        edge = np.maximum(best - 2, 0)
        t, gap, vector = along[row, edge], apart[row, edge], offsets[row, edge]
        clear = gap > COINCIDENT * self.size
        normal = np.divide(vector, gap[:, None], spare.copy(), where=clear[:, None])
        end = best < 2
        t[end] = best[end]
        gap[end] = gaps[end, best[end]]
        normal[end] = upright[end, best[end]]
        return Nearest(t, gap, normal)
