"""The closing toes as they are printed: a sum too long, a range too short."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.paper.entry import (
    EXACT,
    Entry,
    Exhibit,
    Measurement,
    by_hand,
    equal,
    rounding,
)
from zygopin.paper.toe_sums import (
    BACK_TOE,
    PAPER_TURN,
    POWER,
    ROOT,
    closing_turns,
    junctions,
)

STAGES = 201
"""Values of v on which the printed sum is looked at."""


def erratum_10() -> Entry:
    """The sum to k + 1, and without the initial orientation.

    Returns:
        The entry.
    """
    return Entry(
        key="erratum-10",
        kind="erratum",
        title="A sum with one phalanx too many, and without v₀",
        place="section 5, system for the TLM",
        printed=(
            r"$x_k^{(h)}(t)=\sum_{j=1}^{k+1}\rho^{-j}e^{-i\omega jv(t)}$, and the same "
            "bounds in the free mode."
        ),
        ours=(
            r"$x_k^{(h)}(t)=\sum_{j=1}^{k}\rho^{-j}e^{-i(v_0+\omega jv(t))}$ in the "
            "toe's plane, which its azimuth turns; $v_0=0$."
        ),
        finding=(
            r"Printed, $x_0$ is not the base: it lies $1/\rho$ away and moves on an "
            "arc as $v$ grows. A toe of $K$ phalanges gets $K+1$, and the segment "
            "from the origin to $x_1$, called the first phalanx, spans two. Without "
            "$v_0$ a back toe points forward. The sum to k agrees with system (1)."
        ),
        measurements=_one_too_many(Foot.preset("paper")),
    )


def erratum_12() -> Entry:
    """The range of v in the caption of figure 7.

    Returns:
        The entry.
    """
    return Entry(
        key="erratum-12",
        kind="erratum",
        title="The range of v",
        place="section 5, caption of figure 7",
        printed=r"$v(t)\in[0,\pi/6]$",
        ours=r"$v(t)\in[0,1]$, as the text says; $\omega v(t)\in[0,\pi/6]$.",
        finding=(
            r"The angle is $\omega v$ with $\omega=\pi/6$. If $v$ itself ended at "
            r"$\pi/6$, the last phalanx of toe 4 would turn by $5(\pi/6)^2=78.5°$ and "
            "not by 150°: the talon would end 1.166 ahead of the base, not 0.575."
        ),
        measurements=_two_ranges(Foot.preset("paper")),
        figures=(
            Exhibit(
                "erratum-12.png",
                "Toe 4 at the end of its closing, golden mean, ω = π/6, with the path "
                "of the talon. Red: v up to π/6 = 0.524, the caption taken literally. "
                "Black: v up to 1.",
                _draw_ranges,
            ),
        ),
    )


def _one_too_many(foot: Foot) -> tuple[Measurement, ...]:
    """Base, first phalanx and tip by the printed sum."""
    stages = np.linspace(0, 1, STAGES)
    printed = junctions(foot.rho, closing_turns(PAPER_TURN, stages, BACK_TOE + 1))
    base, first, last = (printed[:, k] for k in (1, 2, BACK_TOE + 1))
    bones = forward_kinematics(foot, np.zeros(foot.phalanx_count))
    tip = bones[foot.finger_slices["finger4"].stop - 1, 1]
    starts = [part.start for part in foot.finger_slices.values()]
    length = (1 - POWER[5]) / (foot.rho - 1)
    return (
        by_hand(
            "base_off",
            r"distance of the printed $x_0$ from the base, $1/\rho$ at every $v$",
            float(np.abs(base).max()),
            1 / foot.rho,
        ),
        by_hand(
            "base_moves",
            "distance of the printed $x_0$ at $v=1$ from that at $v=0$: "
            r"$2\sin(\omega/2)/\rho$",
            float(abs(base[-1] - base[0])),
            2 * math.sin(PAPER_TURN / 2) / foot.rho,
        ),
        by_hand(
            "first_phalanx",
            "length of the printed $P=[0,x_1]$ at $v=1$: "
            r"$\sqrt{\rho^{-2}+2\rho^{-3}\cos\omega+\rho^{-4}}$",
            float(abs(first[-1])),
            math.sqrt(POWER[2] + 2 * POWER[3] * ROOT + POWER[4]),
        ),
        by_hand(
            "printed_length",
            r"x of toe 4's straight tip, printed: $(1-\rho^{-6})/(\rho-1)$, forward",
            float(last[0].real),
            (1 - POWER[5] / foot.rho) / (foot.rho - 1),
        ),
        by_hand(
            "our_length",
            r"x of toe 4's straight tip, ours: $-\cos\Omega\,(1-\rho^{-5})/(\rho-1)$, "
            "back",
            float(tip[0]),
            -math.cos(math.pi / 12) * length,
        ),
        rounding(
            "our_base",
            "largest distance of a finger's first junction from the base, ours",
            float(np.abs(bones[starts, 0]).max()),
        ),
    )


def _two_ranges(foot: Foot) -> tuple[Measurement, ...]:
    """Turn and talon at the end of both ranges of v."""
    part = foot.finger_slices["finger4"]
    ends = forward_kinematics(
        foot,
        np.repeat([[PAPER_TURN], [1.0]], foot.phalanx_count, axis=1),
    )[:, part.stop - 1]
    pitch = _pitches(ends)
    turns = closing_turns(PAPER_TURN, [PAPER_TURN, 1.0], BACK_TOE)
    tips = junctions(foot.rho, turns)[:, -1]
    return (
        by_hand(
            "turn_printed",
            r"turn of the last phalanx at $v=\pi/6$: $5(\pi/6)^2$",
            float(pitch[0]),
            5 * math.pi**2 / 36,
            unit="rad",
        ),
        by_hand(
            "turn_ours",
            r"turn of the last phalanx at $v=1$: $5\pi/6$",
            float(pitch[1]),
            5 * math.pi / 6,
            unit="rad",
        ),
        rounding(
            "talon",
            r"distance of the talon at $v=\pi/6$ from "
            r"$\sum_{j\le5}\rho^{-j}e^{-ij(\pi/6)^2}$",
            float(abs(_flat(ends[0, 1]) - tips[0])),
        ),
        Measurement(
            "short",
            r"distance between the talons at $v=\pi/6$ and at $v=1$",
            float(np.linalg.norm(ends[1, 1] - ends[0, 1])),
            equal(float(abs(tips[1] - tips[0])), EXACT, "the two sums, term by term"),
        ),
    )


def _flat(points: NDArray[np.float64]) -> NDArray[np.complex128]:
    """Points of finger 4 as x + iz along it."""
    ahead = -np.array([math.cos(math.pi / 12), math.sin(math.pi / 12), 0.0])
    return np.asarray(points @ ahead + 1j * points[..., 2])


def _pitches(bones: NDArray[np.float64]) -> NDArray[np.float64]:
    """Angles of finger 4's bones below the straight toe [rad]."""
    return np.asarray(-np.angle(_flat(bones[:, 1] - bones[:, 0])))


def _draw_ranges(path: Path) -> object:
    """Draw the talon's path by the caption and by the text."""
    from zygopin.paper.owl_drawings import draw_ranges

    return draw_ranges(Foot.preset("paper").rho, path)
