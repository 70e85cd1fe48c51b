"""The paper's section 3: one finger as a control system on the complex plane."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np

from zygopin.foot import GOLDEN_MEAN, Foot
from zygopin.ifs import contraction
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.paper.entry import Entry, Exhibit, Measurement, by_hand, rounding
from zygopin.paper.finger_plane import Complexes, Floats, in_plane
from zygopin.paper.toe_sums import junctions

RANDOM = 1000
"""Random control sequences on which two routes are held against each other."""

SHOWN = (0.3, 0.3, 1.0)
"""Controls of the finger that shows the notation: its last one is 1."""

FINGER = "finger3"
"""The finger whose reachability the paper discusses."""


def figure_1() -> Entry:
    """Figure 1: a phalanx turned by ω against the one before.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    toe = summed(foot, np.array(SHOWN))
    before, after = np.diff(toe)[1:]
    turn = float(-np.angle(after / before))
    within = float(abs(np.angle(-after / before)))
    words = r"turn of phalanx $k+1$ against phalanx $k$, $v_{k+1} = 1$"
    inner = r"angle at $x_k$ between the two phalanges, $\pi-\omega$"
    return Entry(
        key="figure-1",
        kind="figure",
        title="Junctions and controls",
        place="section 3, figure 1",
        printed=r"phalanx $k+1$, with $v_{k+1}=1$, turned by $\omega$ against phalanx "
        r"$k$",
        ours="",
        finding=(
            r"A control $v$ turns its phalanx by $\omega v$ against the one before, "
            r"down toward the palm: the angle between the two is in $[\pi-\omega, "
            r"\pi]$."
        ),
        measurements=(
            by_hand("turn", words, turn, math.pi / 6, unit="rad"),
            by_hand("inner_angle", inner, within, 5 * math.pi / 6, unit="rad"),
        ),
        figures=(
            Exhibit(
                "figure-1.png",
                r"A finger with $\rho$ the golden mean and $\omega = \pi/6$. The "
                "broken line goes on straight; $v_{k+1} = 1$ turns phalanx $k+1$ from "
                r"there by $\omega$.",
                partial(_draw_notation, toe, foot.omega),
            ),
        ),
    )


def control_system() -> Entry:
    """The system (1): positions of the junctions for given controls.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    controls = np.random.default_rng(0).uniform(size=(RANDOM, foot.phalanx_count))
    bones = forward_kinematics(foot, controls)
    toe = controls[:, foot.finger_slices[FINGER]]
    sums = summed(foot, toe)[:, 1:]
    miniature = contraction(summed(foot, toe[:, 1:]), toe[:, :1], foot.rho, foot.omega)
    apart = {
        "by_definition": float(np.abs(junctions_of(foot, bones) - sums).max()),
        "pinocchio": float(np.abs(bones - FootModel(foot).forward(controls)).max()),
        "miniature": float(np.abs(sums[:, 1:] - miniature[:, 1:]).max()),
    }
    words = {
        "by_definition": f"the sum taken term by term, {RANDOM} random sequences",
        "pinocchio": "the URDF in Pinocchio, all 14 phalanges",
        "miniature": r"that of the miniature, moved by $f_{v_1}$",
    }
    return Entry(
        key="control-system",
        kind="statement",
        title="The control system",
        place="section 3, system (1)",
        printed=r"$x_k = x_{k-1} + \rho^{-k} e^{-i\omega(v_0+\dots+v_k)}$, $x_0 = 0$",
        ours="",
        finding=(
            "Three routes give the same junctions: the sum, the closed form of "
            "forward_kinematics, and Pinocchio, which reads the URDF. What follows "
            r"the first phalanx is a miniature of the whole, smaller by $\rho$: the "
            r"finger with controls $v_2, v_3, \dots$, moved by $f_{v_1}$. This makes "
            "the reachable sets self-similar, as the introduction says."
        ),
        measurements=(
            *_closed_finger(foot),
            *(
                rounding(name, f"largest distance of a junction to {what}", apart[name])
                for name, what in words.items()
            ),
        ),
    )


def junctions_of(foot: Foot, bones: Floats) -> Complexes:
    """Junctions of finger 3 in its own plane.

    Args:
        foot: The foot.
        bones: Bones of all phalanges, shape (…, P, 2, 3).

    Returns:
        x₁ to x_K as x + iz, shape (…, K).
    """
    return in_plane(foot, bones[..., foot.finger_slices[FINGER], 1, :])


def summed(foot: Foot, controls: Floats) -> Complexes:
    """The system (1) summed term by term; v₀ = 0.

    Args:
        foot: The foot: its ρ and ω count.
        controls: v₁ to v_K, shape (…, K).

    Returns:
        x₀ to x_K, shape (…, K + 1).
    """
    return junctions(foot.rho, foot.omega * np.cumsum(controls, axis=-1))


def _closed_finger(foot: Foot) -> tuple[Measurement, ...]:
    """x₄ of finger 3 with all controls 1, whose phalanges point to 30°, …, 120°."""
    tip = junctions_of(foot, forward_kinematics(foot, np.ones(foot.phalanx_count)))[-1]
    length, height = [GOLDEN_MEAN**-k for k in range(5)], math.sqrt(3) / 2
    expected = (
        height * length[1] + (length[2] - length[4]) / 2,
        -length[1] / 2 - height * (length[2] + length[4]) - length[3],
    )
    return tuple(
        by_hand(
            f"x4_{part.lower()}",
            rf"$\{part} x_4$ of finger 3, all controls 1",
            float(found),
            value,
        )
        for part, found, value in zip(
            ("Re", "Im"), (tip.real, tip.imag), expected, strict=True
        )
    )


def _draw_notation(toe: Complexes, omega: float, path: Path) -> Path:
    from zygopin.paper.finger_drawings import draw_notation

    return draw_notation(path, toe, omega)
