"""What a foot struck at, drawn and described."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.canvas import Canvas
from zygopin.caption import Lengths, solid_branch_rows
from zygopin.drawing import draw_branch, rims
from zygopin.looks import WOOD, Paint
from zygopin.obstacle import Box, Capsule, ConvexMesh, Obstacle, Sphere

PREY = Paint(0x9C8878, opacity=0.85)
"""A mouse's grey-brown; toes inside show through."""

PATH = "obstacle"


def obstacle_paint(obstacle: Obstacle) -> Paint:
    """The look of an obstacle.

    Args:
        obstacle: The obstacle.

    Returns:
        The paint: a capsule's is opaque, since its half balls are whole ones.
    """
    if isinstance(obstacle, Branch):
        return WOOD
    return Paint(PREY.colour) if isinstance(obstacle, Capsule) else PREY


def draw_obstacle(
    canvas: Canvas, obstacle: Obstacle, stretch: tuple[float, float]
) -> None:
    """Draw an obstacle.

    Args:
        canvas: What it is drawn on.
        obstacle: The obstacle.
        stretch: For a branch: where it starts and ends along its axis [m].
    """
    paint = obstacle_paint(obstacle)
    match obstacle:
        case Branch():
            draw_branch(canvas, obstacle, stretch)
        case Sphere():
            canvas.ball(PATH, obstacle.centre, float(obstacle.radius), paint)
        case Box():
            canvas.block(PATH, obstacle.size, _box_pose(obstacle), paint)
        case Capsule():
            canvas.capsule(PATH, obstacle.ends, float(obstacle.radius), paint)
        case ConvexMesh():
            canvas.facets(PATH, obstacle.vertices[obstacle.triangles], paint)


def obstacle_extent(
    obstacle: Obstacle, stretch: tuple[float, float]
) -> tuple[NDArray[np.float64], float]:
    """Balls of one radius whose convex hull is about the obstacle.

    Args:
        obstacle: The obstacle.
        stretch: For a branch: the part of its axis that counts [m].

    Returns:
        Centres [m], shape (N, 3), and their radius [m].
    """
    match obstacle:
        case Branch():
            return rims(obstacle, stretch), 0.0
        case Sphere():
            return np.asarray(obstacle.centre)[None], float(obstacle.radius)
        case Box():
            pose, signs = _box_pose(obstacle), np.array([-0.5, 0.5])
            corners = np.stack(np.meshgrid(signs, signs, signs), -1).reshape(-1, 3)
            return corners * obstacle.size @ pose[:3, :3].T + pose[:3, 3], 0.0
        case Capsule():
            return obstacle.ends, float(obstacle.radius)
        case ConvexMesh():
            return obstacle.vertices, 0.0


def obstacle_rows(obstacle: Obstacle, size: float) -> dict[str, str]:
    """An obstacle's size and place, name by value.

    Args:
        obstacle: The obstacle.
        size: The foot's size [m].

    Returns:
        Plain texts.
    """
    lengths = Lengths(size)
    match obstacle:
        case Branch():
            return solid_branch_rows(obstacle, size)
        case Sphere():
            return {
                "Radius": lengths(float(obstacle.radius)),
                "Centre": _place(obstacle.centre, lengths),
            }
        case Box():
            return {
                "Edges": _place(obstacle.size, lengths),
                "Centre": _place(obstacle.centre, lengths),
            }
        case Capsule():
            return {
                "Radius": lengths(float(obstacle.radius)),
                "Start": _place(obstacle.ends[0], lengths),
                "End": _place(obstacle.ends[1], lengths),
            }
        case ConvexMesh():
            low, high = obstacle.vertices.min(0), obstacle.vertices.max(0)
            return {
                "Vertices": str(len(obstacle.vertices)),
                "Extent": _place(high - low, lengths),
                "Middle": _place((low + high) / 2, lengths),
            }


def _box_pose(box: Box) -> NDArray[np.float64]:
    """T_world_box, shape (4, 4)."""
    pose = np.eye(4)
    pose[:3, :3], pose[:3, 3] = box.rotation, box.centre
    return pose


def _place(point: NDArray[np.float64], lengths: Lengths) -> str:
    """Three lengths with one unit."""
    return f"{', '.join(lengths(float(x)).removesuffix(' mm') for x in point)} mm"
