"""Figure 7: a toe that its tendon closes, and the path of its talon."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from zygopin.engagement import engaged_junctions
from zygopin.foot import Foot
from zygopin.model import FootModel
from zygopin.paper.descents import ball_under_toe, descent
from zygopin.paper.entry import Entry, Exhibit, Measurement, by_hand, rounding
from zygopin.paper.toe_sums import PAPER_TURN, POWER, ROOT
from zygopin.reach import find_finger

STAGES = 201
"""Values of v on which routes are held against each other."""


def figure_7() -> Entry:
    """Figure 7: a toe that its tendon closes, and the path of its talon.

    Returns:
        The entry.
    """
    return Entry(
        key="figure-7",
        kind="figure",
        title="The tendon engages: toe 4 and the path of its talon",
        place="section 5, figure 7",
        printed=r"Stages of finger 4 with all controls equal to $v(t)$.",
        ours="",
        finding=(
            "The caption does not say which scaling factor it takes; here it is the "
            r"golden mean, with $\omega=\pi/6$. At $v=1$ the last phalanx has turned "
            r"by $5\omega=150°$ and points backward and down."
        ),
        measurements=_talon(Foot.preset("paper")),
        figures=(
            Exhibit(
                "figure-7.png",
                "Left: finger 4 of the paper's foot (golden mean, ω = 30°) in its "
                "plane as all controls go from 0 to 1. Right: the path of its talon, "
                "from 1.472 straight ahead to (0.575, −1.047).",
                _draw_engagement,
            ),
        ),
        scenes=(
            Exhibit(
                "figure-7.html",
                "The paper's foot, its first phalanx 0.618 long, comes down on a ball "
                "of radius 0.1 under toe 3. All controls then follow v(t), and the "
                "toes pass through the ball: the reading “paper”.",
                _write_paper_strike,
            ),
        ),
    )


def _talon(foot: Foot) -> tuple[Measurement, ...]:
    """Both ends of the talon's path, and the path by Pinocchio."""
    toe = find_finger(foot, "finger4")
    path = engaged_junctions(foot, toe, np.linspace(0, 1, STAGES))[:, -1]
    controls = np.repeat(np.linspace(0, 1, STAGES)[:, None], foot.phalanx_count, 1)
    ends = FootModel(foot).forward(controls)[:, foot.finger_slices["finger4"], 1]
    direction = np.diff(ends[-1, -2:], axis=0)[0]
    ahead = np.array([math.cos(toe.azimuth), math.sin(toe.azimuth), 0.0])
    talon = ends[:, -1] @ ahead + 1j * ends[:, -1, 2]
    turned = -np.angle(complex(direction @ ahead, direction[2]))
    return (
        by_hand(
            "straight",
            r"distance of the talon from the base at $v=0$: $(1-\rho^{-5})/(\rho-1)$",
            float(path[0].real),
            (1 - POWER[5]) / (foot.rho - 1),
        ),
        by_hand(
            "closed_re",
            r"$\Re x_5$ at $v=1$, along the toe",
            float(path[-1].real),
            ROOT * (POWER[1] - POWER[5]) + (POWER[2] - POWER[4]) / 2,
        ),
        by_hand(
            "closed_im",
            r"$\Im x_5$ at $v=1$",
            float(path[-1].imag),
            -(POWER[1] + POWER[5]) / 2 - ROOT * (POWER[2] + POWER[4]) - POWER[3],
        ),
        by_hand(
            "turned",
            r"turn of the last phalanx at $v=1$, by Pinocchio: $5\omega$",
            float(turned),
            5 * PAPER_TURN,
            unit="rad",
        ),
        rounding(
            "pinocchio",
            f"largest distance of the talon's path from Pinocchio's, {STAGES} stages",
            float(np.abs(talon - path).max()),
        ),
    )


def _draw_engagement(path: Path) -> object:
    """Draw figure 7."""
    from zygopin.engagement_plots import plot_engagement

    return plot_engagement(Foot.preset("paper"), path, finger="finger4")


def _write_paper_strike(path: Path) -> object:
    """Write a strike in the reading `paper`."""
    from zygopin.strike_scene import export_strike

    strike = descent(Foot.preset("paper"), ball_under_toe())
    return export_strike(strike, path, title="The paper's foot closes by v(t)")
