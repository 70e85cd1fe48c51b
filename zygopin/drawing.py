"""The parts of a grasp's scene: foot, branch, contacts, directions."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.camera import View
from zygopin.canvas import Canvas
from zygopin.foot import Foot
from zygopin.grasp import GraspReport
from zygopin.looks import WOOD, Paint, drawn_radii, finger_paint

RINGS = tuple(
    (inner, outer, Paint(colour, opacity=0.8))
    for inner, outer, colour in (
        (0.91, 1.0, 0x7E5530),
        (0.63, 0.91, 0xDDBE94),
        (0.60, 0.63, 0xC29E70),
        (0.32, 0.60, 0xDDBE94),
        (0.29, 0.32, 0xC29E70),
        (0.0, 0.29, 0xDDBE94),
    )
)
"""Cut faces of the branch: inner and outer radii over its own, and paints."""

OVERHANG = (0.21, 0.5)
"""What is drawn of an infinite branch beyond the foot, over the foot's size: from
a twig to a trunk."""

HORN, BASE = Paint(0x2E2A27), Paint(0x5F6670)
AXIS_PAINTS = tuple(Paint(c, on_top=True) for c in (0xC0392B, 0x3A9A4A, 0x2F5FC4))

GRASPING = Paint(0x1E9E4A, on_top=True)
STABLE = Paint(0xF0A30A, on_top=True)
TOUCHING = Paint(0x7F93AD, on_top=True)
PENETRATING = Paint(0xD62828, on_top=True)

KNUCKLE = 1.05
"""Radius of a drawn joint over the radius of the phalanx before it."""


TALON_ROOT = 0.45
"""Start of a talon beyond its phalanx's bone, over the phalanx's radius."""


def draw_foot(canvas: Canvas, foot: Foot, bones: NDArray[np.float64]) -> None:
    """Draw the phalanges, the joints before them, the talons and the base.

    Args:
        canvas: What it is drawn on.
        foot: The foot.
        bones: Its bones [m], shape (P, 2, 3).
    """
    radii = drawn_radii(foot)
    for index, (name, part) in enumerate(foot.finger_slices.items()):
        paint = finger_paint(index)
        for rank, phalanx in enumerate(range(part.start, part.stop), start=1):
            link = f"foot/{name}/phalanx{rank}"
            canvas.capsule(link, bones[phalanx], radii[phalanx], paint)
            if rank > 1:
                knuckle = KNUCKLE * radii[phalanx - 1]
                joint = f"foot/{name}/joint{rank}"
                canvas.ball(joint, bones[phalanx, 0], knuckle, paint.shaded(0.7))
        _draw_talon(canvas, f"foot/{name}/talon", bones[part.stop - 1], radii[part][-1])
    canvas.ball("foot/base", bones[0, 0], 1.2 * float(radii.max()), BASE)


def moved_parts(foot: Foot) -> list[list[tuple[str, float]]]:
    """What of a drawn foot moves with each phalanx.

    Args:
        foot: The foot.

    Returns:
        For each phalanx, paths of `draw_foot`, and how far along its bone from its
        start each has its own start [m].
    """
    radii, parts = drawn_radii(foot), []
    for name, part in foot.finger_slices.items():
        for rank, phalanx in enumerate(range(part.start, part.stop), start=1):
            moved = [(f"foot/{name}/phalanx{rank}", 0.0)]
            if rank > 1:
                moved.append((f"foot/{name}/joint{rank}", 0.0))
            if phalanx == part.stop - 1:
                root = float(foot.lengths[phalanx] + TALON_ROOT * radii[phalanx])
                moved.append((f"foot/{name}/talon", root))
            parts.append(moved)
    parts[0].append(("foot/base", 0.0))
    return parts


def draw_branch(canvas: Canvas, branch: Branch, stretch: tuple[float, float]) -> None:
    """Draw a stretch of a branch, with its cut faces.

    Args:
        canvas: What it is drawn on.
        branch: One branch.
        stretch: Where it starts and ends along the axis from the centre [m].
    """
    ends = branch.centre + np.outer(stretch, branch.axis)
    radius = float(branch.radius)
    canvas.tube("branch/bark", ends, radius, WOOD)
    for name, face in (("end", ends), ("start", ends[::-1])):
        facing = np.stack([face[1], 2 * face[1] - face[0]])
        for number, (inner, outer, paint) in enumerate(RINGS, start=1):
            path = f"branch/{name}/ring{number}"
            canvas.ring(path, facing, (inner * radius, outer * radius), paint)


def stretch_beyond(
    branch: Branch, points: NDArray[np.float64], size: float
) -> tuple[float, float]:
    """The part of an infinite branch that shows how a foot lies on it.

    Args:
        branch: One branch.
        points: The foot's points [m], shape (…, 3).
        size: The foot's size [m].

    Returns:
        Start and end along the axis from the branch's centre [m].
    """
    along = (points - branch.centre) @ branch.axis
    least, most = (share * size for share in OVERHANG)
    beyond = min(max(0.5 * float(branch.radius), least), most)
    return float(along.min()) - beyond, float(along.max()) + beyond


def rims(branch: Branch, stretch: tuple[float, float]) -> NDArray[np.float64]:
    """Points of the circles around both ends of a stretch of a branch.

    Args:
        branch: One branch.
        stretch: Where it starts and ends along the axis from the centre [m].

    Returns:
        Points [m], shape (N, 3).
    """
    turn = np.linspace(0, 2 * math.pi, 24, endpoint=False)
    circle = np.stack([np.cos(turn), np.sin(turn)], -1) @ branch.frame()[:, :2].T
    middles = branch.centre + np.outer(stretch, branch.axis)
    points: NDArray[np.float64] = middles[:, None] + float(branch.radius) * circle
    return points.reshape(-1, 3)


def draw_contacts(canvas: Canvas, report: GraspReport) -> None:
    """Draw the points where phalanges meet the branch, with their normals.

    Args:
        canvas: What they are drawn on.
        report: Of one configuration.
    """
    size = 0.014 * canvas.unit
    met = report.tangent | report.touching | report.penetrating
    for phalanx in np.flatnonzero(met):
        point, paint = report.point[phalanx], contact_paint(report, int(phalanx))
        tip = point + 14 * size * report.normal[phalanx]
        path = f"contacts/phalanx{phalanx}"
        canvas.ball(f"{path}/point", point, 1.6 * size, paint)
        canvas.arrow(f"{path}/normal", np.stack([point, tip]), 0.45 * size, paint)


def draw_axes(canvas: Canvas, view: View, right: float = 0.68) -> float:
    """Draw the directions x, y and z in a corner, as long as a round length.

    Args:
        canvas: What they are drawn on.
        view: Whose frame's corner it is.
        right: Place across the frame, from -1 to 1.

    Returns:
        The arms' length [m].
    """
    arm = _round_length(0.24 * view.unit)
    corner = view.corner(right, -0.86)
    for name, direction, paint in zip("xyz", np.eye(3), AXIS_PAINTS, strict=True):
        ends = np.stack([corner, corner + arm * direction])
        canvas.arrow(f"axes/{name}", ends, 0.008 * view.unit, paint)
    return arm


def contact_paint(report: GraspReport, phalanx: int) -> Paint:
    """The colour of a contact.

    Args:
        report: Of one configuration.
        phalanx: Which phalanx meets the branch.

    Returns:
        Its paint: penetrating, or tangent by the whole grasp's verdict, or touching.
    """
    if report.penetrating[phalanx]:
        return PENETRATING
    if report.tangent[phalanx] and report.stable:
        return GRASPING if report.grasping and report.feasible else STABLE
    return TOUCHING


def _draw_talon(
    canvas: Canvas, path: str, bone: NDArray[np.float64], radius: float
) -> None:
    """A cone that goes on from the last phalanx: an ornament, not in the model."""
    along = (bone[1] - bone[0]) / np.linalg.norm(bone[1] - bone[0])
    reach = (TALON_ROOT * radius, 2.8 * radius)
    ends = np.stack([bone[1] + length * along for length in reach])
    canvas.rod(path, ends, (0.85 * radius, 0.0), HORN)


def _round_length(metres: float) -> float:
    """The nearest of 1, 2, 5 times a power of ten to a length [m]."""
    power = 10.0 ** math.floor(math.log10(metres))
    steps = (step * power for step in (1, 2, 5, 10))
    return min(steps, key=lambda step: abs(math.log(step / metres)))
