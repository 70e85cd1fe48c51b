"""What loops compiled by Numba have in common.

Numba is optional: who imports this module, or one that does, is ready for that.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numba

from zygopin.clearance import UNTURNED

Loop = TypeVar("Loop", bound=Callable[..., Any])


def compiled(loop: Loop) -> Loop:
    """A loop, compiled when it is first called, kept on disk, run without the GIL."""
    made: Loop = numba.njit(loop, cache=True, nogil=True, error_model="numpy")
    return made


@compiled
def clipped(value: float) -> float:
    """The nearest number in [0, 1]."""
    value = value if value > 0.0 else 0.0
    return value if value < 1.0 else 1.0


@compiled
def parameters(
    uu: float, vv: float, uv: float, uw: float, vw: float
) -> tuple[float, float]:
    """Where two segments are nearest, as `clearance.segment_offset` has it."""
    determinant = uu * vv - uv * uv
    crossing = determinant > UNTURNED * uu * vv
    s = (uv * vw - uw * vv) / determinant if crossing else 0.0
    t = clipped((uv * clipped(s) + vw) / vv)
    return clipped((uv * t - uw) / uu), t
