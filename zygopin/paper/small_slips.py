"""Slips of the print that change no result, each with what shows it."""

from __future__ import annotations

import math

import numpy as np

from zygopin.foot import GOLDEN_MEAN, Foot
from zygopin.hausdorff import hausdorff_distance
from zygopin.ifs import contraction
from zygopin.kinematics import forward_kinematics
from zygopin.paper.entry import BY_HAND, EXACT, Entry, Measurement, by_hand, equal
from zygopin.paper.finger_model import junctions_of
from zygopin.paper.toe_sums import PAPER_TURN, junctions

WIDE = 1.5 * math.pi
"""A joint limit between π and 2π, which the paper allows [rad]."""


def smaller_slips() -> Entry:
    """What a reader stumbles over and can put right.

    Returns:
        The entry.
    """
    return Entry(
        key="smaller-slips",
        kind="erratum",
        title="Smaller slips",
        place="throughout",
        printed=(
            "a contraction has $d(f(x), f(y)) < c\\,d(x, y)$ for every x and y; the "
            "angle between phalanges is in $[\\pi-\\omega, \\pi]$ and $\\omega \\in "
            "(0, 2\\pi)$; in $R_k$ the index of $v_n \\in R$ starts at 0; “$u_j \\in "
            "E$”; $\\sum_i$ over terms in j; levels $r_0, a_1, \\dots, r_n$; R both "
            "for the control set and for the attractor; the engagement in figure 6 (A)"
        ),
        ours=(
            "$\\leq$ in place of <; for $\\omega > \\pi$ the inner angle goes down to "
            "0 and up again on the palm's side; n from 1, $v_0$ being no control; the "
            "rest read as it must be meant: no E, sums over j, one letter for the "
            "levels; the engagement is in figure 7 (A)"
        ),
        finding=(
            "The strict inequality fails for $x = y$, and for the paper's own maps "
            r"with $c = 1/\rho$, which shrink every distance by exactly $\rho$. If "
            r"$v_0$ ranged over $R$ as printed, $R_1$ for $R = \{0, 1\}$ would have a "
            r"third point. A joint that turns by more than $\pi$ folds its phalanx "
            "past the one before."
        ),
        measurements=(_strictness(), _free_start(), _past_the_fold()),
    )


def _strictness() -> Measurement:
    """The ratio of distances that should be below c = 1/ρ."""
    images = contraction(np.array([0.0, 1.0]), 0.5, GOLDEN_MEAN, PAPER_TURN)
    words = r"$|f_v(1) - f_v(0)|$, which < with $c = 1/\rho$ would have below $1/\rho$"
    return by_hand(
        "strictness", words, float(abs(images[1] - images[0])), 1 / GOLDEN_MEAN
    )


def _free_start() -> Measurement:
    """How far R₁ with v₀ in R is from R₁ with v₀ = 0."""
    turns = PAPER_TURN * np.arange(3.0)[:, None]
    printed = junctions(GOLDEN_MEAN, turns)[:, 1]
    apart = hausdorff_distance(printed, printed[:2]).value
    expected = 2 * math.sin(PAPER_TURN / 2) / GOLDEN_MEAN
    words = r"$d_H$ from $R_1$ with $v_0 \in \{0, 1\}$ to $R_1$ with $v_0 = 0$"
    return Measurement(
        "free_start",
        words,
        apart,
        equal(expected, EXACT, rf"$2\sin(\omega/2)/\rho$, {BY_HAND}"),
    )


def _past_the_fold() -> Measurement:
    """The inner angle of a closed joint with ω = 3π/2."""
    foot = Foot.preset("paper").replace(omega=WIDE)
    closed = np.where(foot.rank_of_phalanx == 2, 1.0, 0.0)
    first, second = junctions_of(foot, forward_kinematics(foot, closed))[:2]
    inner = abs(np.angle(-(second - first) / first))
    words = (
        r"angle between the first two phalanges for $v_2 = 1$ and $\omega = 3\pi/2$, "
        r"where $\pi - \omega$ is $-90°$"
    )
    return by_hand("past_the_fold", words, float(inner), math.pi / 2, unit="rad")
