"""Surfaces as meshcat's viewer reads them, with names that never change."""

from __future__ import annotations

import uuid
from typing import Any

import meshcat.geometry as shapes
import numpy as np
from numpy.typing import NDArray

from zygopin.looks import Paint

FRONT_SIDE = 0
"""The viewer's number for drawing a surface from outside only."""

WIDE = 0.15
"""Radius, in units of the view, from which a cylinder needs more sides."""

_NAMES = uuid.uuid5(uuid.NAMESPACE_DNS, "zygopin.scene")


class Sphere(shapes.Sphere):  # type: ignore[misc]
    """A sphere that is round at any zoom."""

    def lower(self, object_data: dict[str, Any]) -> dict[str, Any]:
        """The sphere as the viewer reads it."""
        data: dict[str, Any] = super().lower(object_data)
        return {**data, "widthSegments": 40, "heightSegments": 28}


class Frustum(shapes.Cylinder):  # type: ignore[misc]
    """A cylinder or cone along y, with more sides the wider it is."""

    def __init__(
        self, height: float, radii: tuple[float, float], *, tube: bool
    ) -> None:
        super().__init__(height, radiusBottom=radii[0], radiusTop=radii[1])
        self.radialSegments = 48 if max(radii) < WIDE else 192
        self.tube = tube

    def lower(self, object_data: dict[str, Any]) -> dict[str, Any]:
        """The frustum as the viewer reads it."""
        data: dict[str, Any] = super().lower(object_data)
        return {**data, "openEnded": self.tube}


class Ring(shapes.Geometry):  # type: ignore[misc]
    """A flat ring that faces z, and is not seen from behind."""

    def __init__(self, radii: tuple[float, float]) -> None:
        super().__init__()
        self.radii = radii

    def lower(self, _: dict[str, Any]) -> dict[str, Any]:
        """The ring as the viewer reads it."""
        inner, outer = self.radii
        shape = {"innerRadius": inner, "outerRadius": outer, "thetaSegments": 192}
        return {"uuid": self.uuid, "type": "RingGeometry", **shape}


class Facets(shapes.TriangularMeshGeometry):  # type: ignore[misc]
    """Flat triangles: no two share a corner, so that each has its own normal."""

    def __init__(self, corners: NDArray[np.float32]) -> None:
        order = np.arange(3 * len(corners)).reshape(-1, 3)
        super().__init__(corners.reshape(-1, 3), order)


class Dots(shapes.PointsMaterial):  # type: ignore[misc]
    """Points of one size and one colour."""

    def lower(self, object_data: dict[str, Any]) -> dict[str, Any]:
        """The material as the viewer reads it."""
        data: dict[str, Any] = super().lower(object_data)
        return {**data, "vertexColors": False}


class Cloud(shapes.Points):  # type: ignore[misc]
    """A cloud of points, named after its path."""

    def __init__(
        self, path: str, points: NDArray[np.float32], size: float, paint: Paint
    ) -> None:
        geometry = shapes.PointsGeometry(points.T)
        material = Dots(size, paint.colour)
        super().__init__(geometry, material)
        _name_parts(path, self, geometry, material)


class Thread(shapes.Line):  # type: ignore[misc]
    """A line through points, one pixel wide, named after its path."""

    def __init__(self, path: str, points: NDArray[np.float32], paint: Paint) -> None:
        geometry = shapes.PointsGeometry(points.T)
        material = shapes.LineBasicMaterial(color=paint.colour, opacity=paint.opacity)
        super().__init__(geometry, material)
        _name_parts(path, self, geometry, material)


class Solid(shapes.Mesh):  # type: ignore[misc]
    """A mesh named after its path, with its place in the order of drawing."""

    def __init__(self, path: str, geometry: shapes.Geometry, paint: Paint) -> None:
        material = _material(paint)
        super().__init__(geometry, material)
        self.order = int(paint.on_top)
        _name_parts(path, self, geometry, material)

    def lower(self) -> dict[str, Any]:
        """The mesh as the viewer reads it."""
        data: dict[str, Any] = super().lower()
        data["object"]["renderOrder"] = self.order
        return data


def _material(paint: Paint) -> shapes.MeshPhongMaterial:
    """The viewer's material for a paint."""
    return shapes.MeshPhongMaterial(
        color=paint.colour,
        opacity=paint.opacity,
        transparent=paint.opacity < 1 or paint.on_top,
        side=FRONT_SIDE,
        depthTest=not paint.on_top,
        shininess=25,
    )


def _name_parts(path: str, *parts: shapes.SceneElement) -> None:
    """Give parts names that follow from their path."""
    for part in parts:
        part.uuid = str(uuid.uuid5(_NAMES, f"{path}:{type(part).__name__}"))
