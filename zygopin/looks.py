"""How parts look, in scenes and in figures alike: paints, and radii as drawn."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot


@dataclass(frozen=True)
class Paint:
    """How a surface looks.

    Attributes:
        colour: Colour as 0xRRGGBB.
        opacity: 1: opaque; less: what is behind shows through.
        on_top: Whether it is drawn over all else, even from behind.
    """

    colour: int
    opacity: float = 1.0
    on_top: bool = False

    def shaded(self, factor: float) -> Paint:
        """This paint with its colour's channels multiplied by a factor up to 1."""
        channels = (int((self.colour >> shift & 0xFF) * factor) for shift in (16, 8, 0))
        red, green, blue = channels
        return Paint(red << 16 | green << 8 | blue, self.opacity, self.on_top)

    def tinted(self, share: float) -> Paint:
        """This paint with a share of white, from 0 to 1, mixed into its colour."""
        channels = (self.colour >> shift & 0xFF for shift in (16, 8, 0))
        red, green, blue = (round(c + share * (255 - c)) for c in channels)
        return Paint(red << 16 | green << 8 | blue, self.opacity, self.on_top)

    @property
    def css(self) -> str:
        """The colour as CSS writes it."""
        return f"#{self.colour:06x}"


FINGER_PAINTS = tuple(
    map(Paint, (0x3F6FA8, 0x7D5BA6, 0x2B8F8C, 0xB85C85, 0x5A6B3B, 0x54669B))
)
"""Colours of the fingers in order; a foot with more of them starts again."""

WOOD = Paint(0x9A6A3C, opacity=0.76)
"""Paint of a branch's bark."""

BARE_BONE = 0.02
"""Radius of a drawn bone without skin, over the longest phalanx."""


def finger_paint(index: int) -> Paint:
    """The colour of a finger.

    Args:
        index: Its place among the fingers, from 0.

    Returns:
        The paint.
    """
    return FINGER_PAINTS[index % len(FINGER_PAINTS)]


def drawn_radii(foot: Foot) -> NDArray[np.float64]:
    """Radii that the phalanges are drawn with: their skin's, or a thin rod's.

    Args:
        foot: The foot.

    Returns:
        Radii [m], shape (P,).
    """
    thin = BARE_BONE * float(foot.lengths.max())
    return foot.radii if foot.thickness > 0 else np.full(foot.phalanx_count, thin)
