"""Simple solids drawn into recorded meshcat commands, reproducibly."""

from __future__ import annotations

from dataclasses import dataclass, replace

import meshcat
import numpy as np
from meshcat.geometry import Box, Geometry
from numpy.typing import ArrayLike, NDArray

from zygopin.looks import Paint
from zygopin.solids import Cloud, Facets, Frustum, Ring, Solid, Sphere, Thread
from zygopin.viewer import Recorder

DECIMALS = 6
"""Decimals of every number in a scene, whose size is about 1: a thousandth of a
pixel, and coarse enough that the last bits of a sum do not show in the file."""


@dataclass(frozen=True, eq=False)
class Canvas:
    """A scene under way: solids in metres, recorded in units of the view.

    Each solid is drawn in its own frame, whose x axis runs along it, and then
    placed by one transform of its path: what moves needs only a new transform.

    Attributes:
        recorder: What keeps the commands.
        origin: The point that becomes the viewer's origin [m], shape (3,).
        unit: The length that becomes 1 [m].
        folder: What all paths start with, such as `step1/`.
    """

    recorder: Recorder
    origin: NDArray[np.float64]
    unit: float
    folder: str = ""

    def inside(self, folder: str) -> Canvas:
        """The same canvas for what belongs together, under one path.

        Args:
            folder: The path.

        Returns:
            A canvas whose paths are below it.
        """
        return replace(self, folder=f"{self.folder}{folder}/")

    def ball(self, path: str, centre: ArrayLike, radius: float, paint: Paint) -> None:
        """Draw a ball.

        Args:
            path: Its name in the scene's tree.
            centre: Its centre [m], shape (3,).
            radius: Its radius [m].
            paint: Its look.
        """
        self._add(path, Sphere(self._length(radius)), paint)
        self.place(path, segment_pose(centre, centre))

    def rod(
        self,
        path: str,
        ends: NDArray[np.float64],
        radii: tuple[float, float],
        paint: Paint,
    ) -> None:
        """Draw a solid cylinder, or a cone's frustum.

        Args:
            path: Its name in the scene's tree.
            ends: The middles of its ends [m], shape (2, 3).
            radii: Its radii at the two ends [m].
            paint: Its look.
        """
        self._frustum(f"{path}/shaft", _span(ends), radii, paint)
        self.place(path, segment_pose(*ends))

    def tube(
        self, path: str, ends: NDArray[np.float64], radius: float, paint: Paint
    ) -> None:
        """Draw a cylinder's mantle.

        Args:
            path: Its name in the scene's tree.
            ends: The middles of its ends [m], shape (2, 3).
            radius: Its radius [m].
            paint: Its look.
        """
        radii = (radius, radius)
        self._frustum(f"{path}/mantle", _span(ends), radii, paint, tube=True)
        self.place(path, segment_pose(*ends))

    def capsule(
        self, path: str, ends: NDArray[np.float64], radius: float, paint: Paint
    ) -> None:
        """Draw a cylinder with a half ball on either end.

        Args:
            path: Its name in the scene's tree.
            ends: The ends of its bone [m], shape (2, 3).
            radius: Its radius [m].
            paint: Its look.
        """
        length = _span(ends)
        self._frustum(f"{path}/shaft", length, (radius, radius), paint)
        for name, along in (("start", 0.0), ("end", length)):
            self._add(f"{path}/{name}", Sphere(self._length(radius)), paint)
            self._transform(f"{path}/{name}", _shifted(np.eye(3), along / self.unit))
        self.place(path, segment_pose(*ends))

    def arrow(
        self, path: str, ends: NDArray[np.float64], radius: float, paint: Paint
    ) -> None:
        """Draw an arrow.

        Args:
            path: Its name in the scene's tree.
            ends: Where it starts and what it points at [m], shape (2, 3).
            radius: Its shaft's radius [m].
            paint: Its look.
        """
        head = min(7 * radius, 0.6 * _span(ends)) / _span(ends)
        neck = ends[1] - head * (ends[1] - ends[0])
        shaft, point = np.stack([ends[0], neck]), np.stack([neck, ends[1]])
        self.rod(f"{path}/body", shaft, (radius, radius), paint)
        self.rod(f"{path}/head", point, (2.6 * radius, 0.0), paint)

    def ring(
        self,
        path: str,
        ends: NDArray[np.float64],
        radii: tuple[float, float],
        paint: Paint,
    ) -> None:
        """Draw a flat ring, or a disc, that is seen from one side.

        Args:
            path: Its name in the scene's tree.
            ends: Its centre, and a point that it faces [m], shape (2, 3).
            radii: Its inner and outer radius [m].
            paint: Its look.
        """
        inner, outer = map(self._length, radii)
        self._add(f"{path}/face", Ring((inner, outer)), paint)
        z_to_x = np.array([[0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
        self._transform(f"{path}/face", _shifted(z_to_x, 0.0))
        self.place(path, segment_pose(*ends))

    def cloud(
        self, path: str, points: NDArray[np.float64], size: float, paint: Paint
    ) -> None:
        """Draw points as dots.

        Args:
            path: Its name in the scene's tree.
            points: The points [m], shape (N, 3).
            size: Width of a dot [m].
            paint: Its look; dots are opaque.
        """
        dots = Cloud(self.folder + path, self._units(points), self._length(size), paint)
        self._at(path).set_object(dots)

    def thread(self, path: str, points: NDArray[np.float64], paint: Paint) -> None:
        """Draw a thin line from point to point.

        Args:
            path: Its name in the scene's tree.
            points: The points [m], shape (N, 3).
            paint: Its look.
        """
        self._at(path).set_object(
            Thread(self.folder + path, self._units(points), paint)
        )

    def block(
        self,
        path: str,
        size: NDArray[np.float64],
        T_world_block: NDArray[np.float64],
        paint: Paint,
    ) -> None:
        """Draw a box.

        Args:
            path: Its name in the scene's tree.
            size: Lengths of its edges [m], shape (3,).
            T_world_block: Pose of its middle [m], shape (4, 4).
            paint: Its look.
        """
        self._add(path, Box([self._length(edge) for edge in size]), paint)
        self.place(path, T_world_block)

    def facets(self, path: str, corners: NDArray[np.float64], paint: Paint) -> None:
        """Draw flat triangles, each seen from the side where it is counter-clockwise.

        Args:
            path: Its name in the scene's tree.
            corners: The triangles' corners [m], shape (T, 3, 3).
            paint: Their look.
        """
        self._add(path, Facets(self._units(corners)), paint)

    def place(self, path: str, T_world_solid: NDArray[np.float64]) -> None:
        """Put what a path holds at a pose.

        Args:
            path: Its name in the scene's tree.
            T_world_solid: The pose [m], shape (4, 4).
        """
        self._transform(path, self.in_units(T_world_solid))

    def in_units(self, T_world_solid: NDArray[np.float64]) -> NDArray[np.float64]:
        """Poses as the viewer has them: in units, from its origin.

        Args:
            T_world_solid: Poses [m], shape (…, 4, 4).

        Returns:
            New poses, shape (…, 4, 4).
        """
        poses = np.array(T_world_solid)
        poses[..., :3, 3] = (poses[..., :3, 3] - self.origin) / self.unit
        return poses

    def address(self, path: str) -> str:
        """Where the viewer keeps what a path holds.

        Args:
            path: Its name in the scene's tree.

        Returns:
            The viewer's path.
        """
        return str(self._at(path).path.lower())

    def _frustum(
        self,
        path: str,
        length: float,
        radii: tuple[float, float],
        paint: Paint,
        *,
        tube: bool = False,
    ) -> None:
        """A frustum along x from the origin of its path's parent."""
        start, end = map(self._length, radii)
        geometry = Frustum(self._length(length), (start, end), tube=tube)
        self._add(path, geometry, paint)
        y_to_x = np.array([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
        self._transform(path, _shifted(y_to_x, length / self.unit / 2))

    def _add(self, path: str, geometry: Geometry, paint: Paint) -> None:
        self._at(path).set_object(Solid(self.folder + path, geometry, paint))

    def _transform(self, path: str, pose: NDArray[np.float64]) -> None:
        self._at(path).set_transform(np.round(pose, DECIMALS) + 0.0)

    def _units(self, points: NDArray[np.float64]) -> NDArray[np.float32]:
        """Points in units, as the viewer reads them."""
        units = np.round((points - self.origin) / self.unit, DECIMALS) + 0.0
        return units.astype(np.float32)

    def _at(self, path: str) -> meshcat.Visualizer:
        return meshcat.Visualizer(window=self.recorder)[self.folder + path]

    def _length(self, metres: float) -> float:
        return round(metres / self.unit, DECIMALS)


def segment_pose(start: ArrayLike, end: ArrayLike) -> NDArray[np.float64]:
    """A frame at a segment's start with its x axis along the segment.

    Args:
        start: The start [m], shape (3,).
        end: The end [m], shape (3,); at the start: the axes are the world's.

    Returns:
        T_world_segment, shape (4, 4), right-handed.
    """
    start, end = np.asarray(start, float), np.asarray(end, float)
    length = float(np.linalg.norm(end - start))
    pose = np.eye(4)
    pose[:3, 3] = start
    if length > 0:
        along = (end - start) / length
        aside = np.cross(
            (0.0, 0.0, 1.0) if abs(along[2]) < 0.9 else (0.0, 1.0, 0.0), along
        )
        aside = aside / np.linalg.norm(aside)
        pose[:3, :3] = np.stack([along, aside, np.cross(along, aside)], axis=-1)
    return pose


def _span(ends: NDArray[np.float64]) -> float:
    """Distance between two points [m]."""
    return float(np.linalg.norm(ends[1] - ends[0]))


def _shifted(rotation: NDArray[np.float64], along: float) -> NDArray[np.float64]:
    """A turn, then a shift along x, shape (4, 4)."""
    pose = np.eye(4)
    pose[:3, :3] = rotation
    pose[0, 3] = along
    return pose
