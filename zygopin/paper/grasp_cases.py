"""Poses astride a branch, worked out by hand: toes 1 and 3 lie as mirror images."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from zygopin.branch import Branch
from zygopin.foot import Foot
from zygopin.grasp import Criteria, GraspReport, Reading, check_grasp
from zygopin.paper.finger_plane import (
    Floats,
    tilt,
)


@dataclass(frozen=True, eq=False)
class Case:
    """A pose and the branch that it is about.

    Attributes:
        foot: The foot.
        controls: Its controls, shape (P,).
        branch: The branch.
        pitch: How far down the tangent phalanges point [rad].
        seen: The same as seen along the branch [rad].
    """

    foot: Foot
    controls: Floats
    branch: Branch
    pitch: float
    seen: float


def astride(foot: Foot, closed: tuple[float, ...], t: float) -> Case:
    """All toes alike, and the branch below the base that their kth phalanges touch.

    Seen along the branch, the phalanx points down by α' with tan α' = tan α/cos Ω and
    has the normal (sin α', cos α'); a branch at x = 0 that touches it at p has
    r = p_x/sin α' and its centre at z = p_z − r·cos α'.

    Args:
        foot: The foot.
        closed: Controls v₁ … vₖ; what follows is straight.
        t: Where on phalanx k the branch touches.

    Returns:
        The case.
    """
    pitches = foot.omega * np.cumsum(closed)
    share = np.append(np.ones(len(closed) - 1), t)
    lengths = share * foot.rho ** -np.arange(1.0, len(closed) + 1)
    x = tilt(foot) * float(lengths @ np.cos(pitches))
    z = -float(lengths @ np.sin(pitches))
    pitch = float(pitches[-1])
    seen = math.atan2(math.sin(pitch), tilt(foot) * math.cos(pitch))
    radius = x / math.sin(seen)
    rows = np.array([*closed, *(0.0,) * foot.phalanx_count])
    controls = rows[foot.rank_of_phalanx - 1]
    branch = Branch(radius, (0.0, 0.0, z - radius * math.cos(seen)))
    return Case(foot, controls, branch, pitch, seen)


def trunk() -> Case:
    """Toes that lie nearly flat on a trunk fifteen times as thick as the foot is long.

    Returns:
        The case.
    """
    return astride(Foot.preset("paper"), (0.025,), 0.5)


def perch() -> Case:
    """Toes that clasp a perch: their second phalanges point down by 60°.

    Returns:
        The case.
    """
    return astride(Foot.preset("paper"), (1.0, 1.0), 0.5)


def quarter_turn() -> Case:
    """One toe flat on a branch, the other upright beside it: the product is zero.

    Joints turn by up to π/2 and both toes lie in the xz-plane. Toe 3 goes straight for
    1/ρ and then down; the branch is right behind it and below toe 1.

    Returns:
        The case.
    """
    whole = Foot.preset("paper").replace(omega=math.pi / 2, splay=0.0)
    foot = whole.replace(fingers=(whole.fingers[0], whole.fingers[2]))
    controls = np.array([0.0, 0.0, 0.0, 1.0, 0.0, 0.0])
    radius = 0.65
    branch = Branch(radius, (1 / foot.rho - radius, 0.0, -radius))
    return Case(foot, controls, branch, math.pi / 2, math.pi / 2)


def verdicts(case: Case, reading: Reading = "section") -> GraspReport:
    """The exact engine's verdicts on a case.

    Args:
        case: The pose and the branch.
        reading: Which product decides.

    Returns:
        The report.
    """
    criteria = Criteria(reading=reading)
    return check_grasp(case.foot, case.controls, case.branch, criteria=criteria)
