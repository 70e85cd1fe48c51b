"""Side views: a foot on a branch, projected along the branch."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from zygopin.figures import Axes, Circle, Polygon, Unit, draw_toe
from zygopin.grasp import GraspReport
from zygopin.looks import WOOD, drawn_radii, finger_paint

Floats = NDArray[np.float64]

VIEW_ACROSS, VIEW_UP = 1.05, (-1.3, 0.45)
"""What a side view shows on either side of the base and up, over the foot's size."""

BARK = "#e9d3b6"

FAINT = 0.35
"""Opacity of skin in a side view: the bones show through."""


def side_view(points: Floats, axis: Floats) -> NDArray[np.complex128]:
    """Points as they are seen along an axis, x to the right and z up.

    Args:
        points: Points [m], shape (…, 3).
        axis: Unit vector, shape (3,).

    Returns:
        Complex numbers [m], shape (…): across an axis along y, x + iz.
    """
    up = np.eye(3)[2 if abs(axis[2]) < 0.9 else 0]
    up = up - (up @ axis) * axis
    up = up / np.linalg.norm(up)
    right = np.cross(axis, up)
    right = right if right @ (1.0, -1e-3, 0.0) >= 0 else -right
    return np.asarray(points @ right + 1j * (points @ up))


def draw_side_view(view: Axes, report: GraspReport, unit: Unit) -> None:
    """Draw a foot on a branch, seen along the branch.

    Args:
        view: The panel.
        report: Of one configuration.
        unit: The panel's unit.
    """
    foot, branch, factor = report.foot, report.branch, unit.per_metre
    centre = complex(side_view(branch.centre, branch.axis)) * factor
    place, radius = (centre.real, centre.imag), float(branch.radius) * factor
    view.add_patch(Circle(place, radius, facecolor=BARK, edgecolor=WOOD.css))
    bones = side_view(report.bones, branch.axis) * factor
    radii = drawn_radii(foot) * factor
    for index, part in enumerate(foot.finger_slices.values()):
        colour = finger_paint(index).css
        for bone, skin in zip(bones[part], radii[part], strict=True):
            outline = _capsule(bone, float(skin))
            view.add_patch(Polygon(outline, facecolor=colour, alpha=FAINT, lw=0))
        joints = np.append(bones[part][0, 0], bones[part][:, 1])
        draw_toe(view, joints, colour, 1.2)
    size = foot.size * factor
    view.set_xlim(-VIEW_ACROSS * size, VIEW_ACROSS * size)
    view.set_ylim(*(end * size for end in VIEW_UP))
    view.set_aspect("equal")
    view.tick_params(labelsize=6)


def _capsule(bone: NDArray[np.complex128], radius: float) -> Floats:
    """The outline of a phalanx with its skin, shape (n, 2)."""
    along = bone[1] - bone[0]
    turn = np.exp(1j * np.linspace(-np.pi / 2, np.pi / 2, 13))
    turn = turn * (along / abs(along) if abs(along) > 0 else 1.0) * radius
    outline = np.concatenate([bone[1] + turn, bone[0] - turn])
    return np.stack([outline.real, outline.imag], axis=-1)
