"""Corners: the extremes that are drawn on purpose, each by its name."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from zygopin import Finger
from zygopin.clearance import Floats
from zygopin.finger import MAX_PHALANGES

Rng = np.random.Generator
Shape = dict[str, Any]
"""Fields of a `Foot`, with `skin`, the thickness over the scale, for `thickness`."""


def _fingers(rng: Rng, count: int, phalanges: int) -> tuple[Finger, ...]:
    """Fingers all around, of equally many phalanges."""
    turns = rng.uniform(-math.pi, math.pi, count)
    return tuple(Finger(f"toe{i}", phalanges, turn) for i, turn in enumerate(turns))


FOOT_CORNERS: dict[str, Callable[[Rng], Shape]] = {
    "rho near 1": lambda rng: {"rho": 1 + 10.0 ** rng.uniform(-15, -3)},
    "rho large": lambda rng: {"rho": 10.0 ** rng.uniform(0.7, 2)},
    "omega tiny": lambda rng: {"omega": 10.0 ** rng.uniform(-12, -3)},
    "omega near 2 pi": lambda rng: {
        "omega": 2 * math.pi - 10.0 ** rng.uniform(-12, -3)
    },
    "thickness 0": lambda _: {"skin": 0.0},
    "scale 1e-4": lambda _: {"scale": 1e-4},
    "scale 1e4": lambda _: {"scale": 1e4},
    "one phalanx": lambda rng: {"fingers": _fingers(rng, 4, 1)},
    "ten fingers": lambda rng: {"fingers": _fingers(rng, 10, 2)},
    "twelve phalanges": lambda rng: {"fingers": _fingers(rng, 2, MAX_PHALANGES)},
}
"""What each corner makes of a foot."""


def _ends(controls: Floats, rng: Rng) -> Floats:
    """Controls at 0 and 1 alone."""
    return rng.integers(0, 2, controls.shape).astype(float)


def _straight(controls: Floats, rng: Rng) -> Floats:
    """Toes that go on straight after a joint, or from the base."""
    first = rng.integers(0, controls.shape[-1], (len(controls), 1))
    return np.where(np.arange(controls.shape[-1]) >= first, 0.0, controls)


POSE_CORNERS: dict[str, Callable[[Floats, Rng], Floats]] = {
    "controls 0 and 1": _ends,
    "straight toes": _straight,
}
"""What each corner makes of controls, shape (n, P)."""

BRANCH_CORNERS = (
    "touch at a junction",
    "base on the bark",
    "axis in a toe's plane",
    "branch thin",
    "branch huge",
)
"""Corners of branches: see `branches.around`."""

CORNER_NAMES = (*FOOT_CORNERS, *POSE_CORNERS, *BRANCH_CORNERS)

SECOND = 0.25
"""Chance of a second corner beside the first."""


def chosen(corners: tuple[str, ...], seed: int, rng: Rng) -> tuple[str, ...]:
    """The corners of a case: none for even seeds, all in their turn for odd ones.

    Args:
        corners: Those that may be drawn.
        seed: The case's seed.
        rng: Where a second one comes from.

    Returns:
        None, one or two of them.
    """
    if seed % 2 == 0 or not corners:
        return ()
    first = corners[seed // 2 % len(corners)]
    second = corners[int(rng.integers(len(corners)))]
    if rng.random() >= SECOND or second == first:
        return (first,)
    return first, second
