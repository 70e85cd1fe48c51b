"""What is measured of zygopin: the one place where its functions are called."""

from __future__ import annotations

import inspect
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

import zygopin
from zygopin import Branch, Foot, check_grasp, forward_kinematics

Floats = NDArray[np.float64]

_check: Any = getattr(zygopin, "grasp_verdicts", check_grasp)

VERDICTS: str = _check.__name__
"""The function that gives verdicts alone."""

THREADED = all(
    "threads" in inspect.signature(function).parameters
    for function in (_check, forward_kinematics)
)
"""Whether the number of threads can be chosen."""


class Verdicts(Protocol):
    """What a check decides: arrays of the batch's shape."""

    @property
    def stable(self) -> NDArray[np.bool_]:
        """Two opposable fingers are tangent."""

    @property
    def grasping(self) -> NDArray[np.bool_]:
        """Stable, and the contacts are a quarter turn apart at least."""

    @property
    def feasible(self) -> NDArray[np.bool_]:
        """Nothing penetrates."""


def bones(foot: Foot, controls: Floats, threads: int | None = None) -> Floats:
    """Bones of many control sequences [m], shape (…, P, 2, 3)."""
    return forward_kinematics(foot, controls, **_given(threads))


def verdicts(
    foot: Foot, controls: Floats, branch: Branch, threads: int | None = None
) -> Verdicts:
    """Verdicts alone, on many control sequences or many branches."""
    found: Verdicts = _check(foot, controls, branch, **_given(threads))
    return found


def _given(threads: int | None) -> dict[str, Any]:
    """The option threads, where functions have it."""
    return {"threads": threads} if THREADED else {}
