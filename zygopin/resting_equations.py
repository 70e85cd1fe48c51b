"""Tangency to a branch under the base: one linear equation in its radius.

The centre is tied to the radius r: the base is on the bark, the branch below it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from zygopin import kinds
from zygopin.clearance import Floats
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.placement import Placement
from zygopin.tangent_lines import (
    Integers,
    last_bone,
    plane_axes,
    skin,
    tangent_lines,
)

Section = Literal["geometric", "printed", "circle"]

SECTIONS: tuple[Section, ...] = ("geometric", "printed", "circle")


@dataclass(frozen=True)
class RestingEquations:
    """share·r = offset for some phalanges of a finger, and where they are touched.

    Attributes:
        rank: Number k of the phalanx, shape (N,).
        word: Index of v₁ … vₖ among the words of the levels, shape (N,).
        side: 1: the branch lies on the palm's side of the toe; −1: on its back.
        share: What multiplies the radius, shape (N,).
        offset: Right-hand side [m], shape (N,).
        t_start: Where on the bone a branch of radius zero touches, shape (N,).
        t_rate: What that gains per metre of radius [1/m], shape (N,).
    """

    rank: Integers
    word: Integers
    side: Integers
    share: Floats
    offset: Floats
    t_start: Floats
    t_rate: Floats


def check_section(section: Section, placement: Placement) -> None:
    """Raise unless a section applies: the source's are those of a branch along y.

    Args:
        section: Its name.
        placement: Where the branches lie.

    Raises:
        UnknownNameError: There is no such section.
        ParameterError: It does not apply to the axis.
    """
    kinds.one_of("section", section, SECTIONS)
    axis = np.asarray(placement.axis)
    if section != "geometric" and abs(axis[1]) != 1:
        remedy = "take the section 'geometric', which holds for every axis"
        name = f"axis of a branch with the section {section!r}"
        raise ParameterError(name, axis, "(0, 1, 0)", remedy)


def resting_equations(
    foot: Foot, finger: int, controls: Floats, section: Section, placement: Placement
) -> RestingEquations:
    """The equations of phalanx k of a finger for controls v₁ … vₖ.

    Args:
        foot: The foot.
        finger: Index of the finger.
        controls: Controls in [0, 1], one row for each word, shape (m, k).
        section: What the section of the branch in the finger's plane is.
        placement: Where the branches lie.

    Returns:
        Both sides' equations; a phalanx that lies along the axis has none in the true
        section.
    """
    if section == "geometric":
        lines, level = tangent_lines(foot, finger, controls, placement), placement.level
        return RestingEquations(
            lines.rank,
            lines.word,
            lines.side,
            1 - lines.normal_z / level,
            lines.offset,
            lines.t_start,
            -lines.t_rate / level,
        )
    wide = 1.0 if section == "circle" else abs(plane_axes(foot, finger)[0, 0])
    return _planar(foot, finger, controls, wide)


def _planar(foot: Foot, finger: int, controls: Floats, wide: float) -> RestingEquations:
    """The equations for an ellipse in the finger's plane, half-axes wide·r and r.

    With unit normal N, the ellipse around (0, −r) reaches out to r·(h − N_z) along N,
    h² = (wide·N_x)² + N_z², and is touched there at r·((wide²·N_x, N_z)/h − (0, 1)).
    """
    rank = controls.shape[1]
    start, bone = last_bone(foot, finger, controls)
    square = np.sum(bone**2, axis=1)
    normal = np.stack([-bone[:, 1], bone[:, 0]], axis=1) / np.sqrt(square)[:, None]
    reach = np.hypot(wide * normal[:, 0], normal[:, 1])
    spot = normal * (wide**2, 1.0) / reach[:, None]
    along, across = np.sum(spot * bone, axis=1), np.sum(normal * start, axis=1)
    side = np.repeat(np.array([1, -1], dtype=np.int64), len(controls))
    twice = {
        name: np.tile(x, 2)
        for name, x in (
            ("word", np.arange(len(controls), dtype=np.int64)),
            ("t_start", -np.sum(start * bone, axis=1) / square),
        )
    }
    return RestingEquations(
        rank=np.full(len(side), rank, dtype=np.int64),
        side=side,
        share=np.tile(reach, 2) - side * np.tile(normal[:, 1], 2),
        offset=side * np.tile(across, 2) - skin(foot, finger, rank),
        t_rate=(side * np.tile(along, 2) - np.tile(bone[:, 1], 2)) / np.tile(square, 2),
        **twice,
    )
