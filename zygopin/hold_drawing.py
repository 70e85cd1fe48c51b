"""A hold in a scene: friction cones, and the forces that balance a pull, to scale."""

from __future__ import annotations

import math

import numpy as np

from zygopin.canvas import Canvas
from zygopin.contacts import Floats
from zygopin.foot import Foot
from zygopin.hold import Hold
from zygopin.looks import Paint

CONE = Paint(0xE8B71A, opacity=0.4, on_top=True)
FORCE = Paint(0x1B3A6B, on_top=True)
PULL = Paint(0xB8336A, on_top=True)

CONE_SIDE = 0.13
"""Length of a cone's side, in units of the view."""

LONGEST = 0.34
"""Length of the longest contact force's arrow, in units of the view."""

PULL_SPAN = 0.25
"""Length of the pull's arrow over the foot's size."""

SHAFT = 0.008
"""Radius of an arrow, in units of the view."""

SLIGHT = 0.02
"""Share of the largest contact force below which a force is not drawn."""


def pull_arrow(hold: Hold, foot: Foot, base: Floats) -> Floats:
    """The arrow that stands for the pull.

    Args:
        hold: The record.
        foot: The foot.
        base: Where the pull acts [m], shape (3,).

    Returns:
        Its ends [m], shape (2, 3).
    """
    return np.stack([base, base + PULL_SPAN * foot.size * hold.pull.direction])


def draw_hold(
    canvas: Canvas, hold: Hold, foot: Foot, base: Floats
) -> list[tuple[Paint, str]]:
    """Draw the cones, and the forces of the largest pull.

    Args:
        canvas: What they are drawn on.
        hold: The record.
        foot: The foot.
        base: Where the pull acts [m], shape (3,).

    Returns:
        The paints, and what they stand for in plain text.
    """
    if hold.contacts is None:
        return []
    friction = hold.strength.friction.coefficient
    side = CONE_SIDE * canvas.unit / math.hypot(1.0, friction)
    for number, (point, normal) in enumerate(
        zip(hold.contacts.points, hold.contacts.normals, strict=True), start=1
    ):
        if friction > 0:
            ends = np.stack([point, point + side * normal])
            canvas.rod(f"hold/cone{number}", ends, (0.0, friction * side), CONE)
    keys = [(CONE, f"friction cone, μ = {friction:g}")]
    if hold.pull.force == 0:
        return keys
    strongest = float(np.linalg.norm(hold.pull.contact_forces, axis=-1).max())
    scale = LONGEST * canvas.unit / strongest
    for number, (point, force) in enumerate(
        zip(hold.contacts.points, hold.pull.contact_forces, strict=True), start=1
    ):
        if np.linalg.norm(force) > SLIGHT * strongest:
            _arrow(canvas, f"hold/force{number}", point, scale * force, FORCE)
    canvas.arrow("hold/pull", pull_arrow(hold, foot, base), SHAFT * canvas.unit, PULL)
    return [
        *keys,
        (FORCE, f"contact force, the longest {strongest:.3g} N"),
        (PULL, f"largest pull, {hold.pull.force:.3g} N, not to scale"),
    ]


def _arrow(
    canvas: Canvas, path: str, start: Floats, span: Floats, paint: Paint
) -> None:
    """An arrow from a point."""
    ends = np.stack([start, start + span])
    canvas.arrow(path, ends, SHAFT * canvas.unit, paint)
