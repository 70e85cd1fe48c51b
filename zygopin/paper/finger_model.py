"""The paper's sections 2 and 3: one finger as a control system on the plane."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.paper.entry import (
    BY_HAND,
    ROUNDING,
    Entry,
    Measurement,
    at_most,
    equal,
)

EXACT = 1e-12
"""Difference of two routes to a length of about one that is rounding."""

RANDOM = 1000
"""Random control sequences on which two routes are held against each other."""

FINGER = "finger3"
"""The finger whose reachability the paper discusses."""


def control_system() -> Entry:
    """The system (1): positions of the junctions for given controls.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    closed = _plane(foot, forward_kinematics(foot, np.ones(foot.phalanx_count)))
    controls = np.random.default_rng(0).uniform(size=(RANDOM, foot.phalanx_count))
    bones = forward_kinematics(foot, controls)
    apart = float(np.abs(bones - FootModel(foot).forward(controls)).max())
    summed = np.abs(_plane(foot, bones) - _by_definition(foot, controls)).max()
    bends = _bends(_plane(foot, bones))
    tip = closed[-1]
    return Entry(
        key="control-system",
        kind="statement",
        title="The control system",
        place="section 3, system (1)",
        printed=r"$x_k = x_{k-1} + \rho^{-k}\,e^{-i\omega(v_0+\dots+v_k)}$, $x_0 = 0$",
        ours="",
        finding=(
            "Three routes give the same junctions: the system summed term by term, "
            "the closed form of forward_kinematics, and Pinocchio on the URDF."
        ),
        measurements=(
            Measurement(
                "x4_re",
                r"$\Re x_4$ of finger 3, all controls 1",
                float(tip.real),
                equal(
                    math.sqrt(3) / 2 * _POWER[1] + (_POWER[2] - _POWER[4]) / 2,
                    EXACT,
                    BY_HAND,
                ),
            ),
            Measurement(
                "x4_im",
                r"$\Im x_4$ of finger 3, all controls 1",
                float(tip.imag),
                equal(
                    -_POWER[1] / 2
                    - math.sqrt(3) / 2 * (_POWER[2] + _POWER[4])
                    - _POWER[3],
                    EXACT,
                    BY_HAND,
                ),
            ),
            Measurement(
                "by_definition",
                f"largest distance to the sum, {RANDOM} random control sequences",
                float(summed),
                at_most(EXACT, ROUNDING),
            ),
            Measurement(
                "pinocchio",
                "largest distance to Pinocchio on the URDF, all 14 phalanges",
                apart,
                at_most(EXACT, ROUNDING),
            ),
            Measurement(
                "largest_bend",
                r"largest turn from one phalanx to the next, at most $\omega$",
                float(bends.max()),
                at_most(foot.omega, "the joints' range"),
                unit="rad",
            ),
        ),
    )


_POWER = [Foot.preset("paper").rho ** -k for k in range(5)]
"""Powers ρ^−k of the golden mean."""


def _plane(foot: Foot, bones: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Junctions x₁ to x_K of finger 3 in its plane, shape (…, K)."""
    finger = foot.fingers[2]
    ends = bones[..., foot.finger_slices[FINGER], 1, :]
    ahead = np.array([math.cos(finger.azimuth), math.sin(finger.azimuth), 0.0])
    return np.asarray(ends @ ahead + 1j * ends[..., 2])


def _by_definition(foot: Foot, controls: NDArray[np.float64]) -> NDArray[np.complex128]:
    """The same by the recursion, step by step."""
    steps, place, turn = [], 0j, 0.0
    for k, column in enumerate(controls[:, foot.finger_slices[FINGER]].T, 1):
        turn = turn + column
        place = place + foot.rho**-k * np.exp(-1j * foot.omega * turn)
        steps.append(place)
    return np.stack(steps, axis=-1)


def _bends(junctions: NDArray[np.complex128]) -> NDArray[np.float64]:
    """Turns from each phalanx to the next, downward positive [rad]."""
    steps = np.diff(junctions, prepend=0, axis=-1)
    return np.asarray(-np.angle(steps[..., 1:] / steps[..., :-1]))
