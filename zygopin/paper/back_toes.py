"""The toes that point back: why v₀ = π curls them up, and is no half turn."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
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

HALF_TURN = math.pi
"""The orientation that a half turn gives [rad]."""

PRINTED = math.pi * PAPER_TURN
"""The orientation ωv₀ that the printed v₀ = π gives [rad]."""

CURLED = (POWER[1] + POWER[5]) / 2 + ROOT * (POWER[2] + POWER[4]) + POWER[3]
"""How far down the tip of a toe of 5 phalanges is, all controls 1, ω = π/6: the sum of
ρ^−j·sin(jπ/6)."""


def erratum_2() -> Entry:
    """Back toes by a half turn in the toe's own plane curl up.

    Returns:
        The entry.
    """
    return Entry(
        key="erratum-2",
        kind="erratum",
        title="Back toes that curl up",
        place="section 4, below figure 2",
        printed=(
            r"Back toes by the initial rotation $v_0=\pi$ in system (1), whose turns "
            r"are clockwise. It follows that $x_k=\sum_{j\le "
            r"k}\rho^{-j}e^{-i(\pi+\theta_j)}$."
        ),
        ours=(
            r"Back toes by the azimuth $\Omega+\pi$ about the vertical, with $v_0=0$: "
            r"in the plane, $x_k=-\sum_{j\le k}\rho^{-j}e^{i\theta_j}$."
        ),
        finding=(
            r"Take $v_0=\pi$ as the half turn that is meant. Then every junction is "
            "minus that of the forward toe: a straight back toe is right, a flexed "
            "one rises. A half turn about the vertical mirrors the toe instead, and "
            "it curls down. The foot's two halves could otherwise not close on a "
            "branch below it."
        ),
        measurements=_curls(),
        figures=(
            Exhibit(
                "erratum-2.png",
                "Side view of a toe of 5 phalanges with all controls 0, 1/2 and 1, "
                "golden mean, ω = π/6. Left: forward toe and back toe as printed, v₀ "
                f"a half turn: its tip rises to {CURLED:.3f}. Right: ours, the mirror "
                f"image: the tip sinks to −{CURLED:.3f}.",
                partial(_draw, HALF_TURN, "v₀ a half turn: curls up"),
            ),
        ),
    )


def erratum_3() -> Entry:
    """The initial angle is ωv₀, so that v₀ = π is no half turn.

    Returns:
        The entry.
    """
    return Entry(
        key="erratum-3",
        kind="erratum",
        title="A half turn is not v₀ = π",
        place="section 4, below figure 2; section 3",
        printed=(
            r"$v_0^2=v_0^4=\pi$, where a finger at rest forms the angle $-v_0\omega$ "
            "with the x-axis."
        ),
        ours=r"The orientation is an angle; a half turn would be $v_0=\pi/\omega=6$.",
        finding=(
            r"Literally, with $\omega=\pi/6$, the angle is $\pi^2/6=94.2°$: the "
            "straight toe hangs almost straight down, 4.2° past the vertical. zygopin "
            "takes the orientation as an angle and turns back toes by their azimuth."
        ),
        measurements=_hangs(),
        figures=(
            Exhibit(
                "erratum-3.png",
                "The same side view with the printed v₀ = π read literally: the angle "
                "ωv₀ is 94.2°, and the straight toe (black) hangs down. Right: ours.",
                partial(_draw, PRINTED, "v₀ = π literally: 94.2° down"),
            ),
        ),
    )


def back_toe(start: float, value: float) -> NDArray[np.complex128]:
    """The printed sum for a back toe whose controls all equal v.

    Args:
        start: Initial angle below the x-axis [rad].
        value: The value v.

    Returns:
        Junctions x₀ to x₅, shape (6,).
    """
    turns = start + closing_turns(PAPER_TURN, value, BACK_TOE)
    return junctions(Foot.preset("paper").rho, turns)


def _curls() -> tuple[Measurement, ...]:
    """The tips' heights, on all routes, and the two reflections."""
    by_sum = back_toe(HALF_TURN, 1.0)
    routes = _turned_foot(HALF_TURN, 1.0)
    ours = _ours(1.0)
    forward = back_toe(0.0, 1.0)
    straight = back_toe(HALF_TURN, 0.0)[-1]
    return (
        by_hand(
            "z_printed",
            "height of the back toe's tip, 5 phalanges, all controls 1, printed sum: "
            r"$+\sum\rho^{-j}\sin(j\pi/6)$",
            float(by_sum[-1].imag),
            CURLED,
        ),
        by_hand(
            "z_ours",
            "the same, ours, by forward_kinematics",
            float(ours[-1].imag),
            -CURLED,
        ),
        *_routes("printed", routes, by_sum),
        rounding(
            "point_reflection",
            "largest distance of the printed toe's junctions from minus the forward "
            "toe's",
            float(np.abs(by_sum + forward).max()),
        ),
        rounding(
            "mirror",
            "largest distance of our toe's junctions from the forward toe's, mirrored "
            "at the vertical",
            float(np.abs(ours + forward.conj()).max()),
        ),
        rounding(
            "straight",
            "distance between the tips of the straight toes, printed and ours",
            float(abs(straight - _ours(0.0)[-1])),
        ),
    )


def _hangs() -> tuple[Measurement, ...]:
    """Where the straight toe points by the printed angle."""
    tip = back_toe(PRINTED, 0.0)[-1]
    length = (1 - POWER[BACK_TOE]) / (Foot.preset("paper").rho - 1)
    foot_tip = _turned_foot(PRINTED, 0.0)["fk"][-1]
    half = back_toe(PAPER_TURN * 6, 0.0)[-1]
    return (
        Measurement(
            "angle",
            "angle of the straight toe below the x-axis, printed sum",
            float(-np.angle(tip)),
            equal(math.pi**2 / 6, EXACT, r"$\omega\pi$ by hand"),
            unit="rad",
        ),
        by_hand(
            "x_printed",
            "x of the straight toe's tip, 5 phalanges, printed sum: "
            r"$\cos(\pi^2/6)\,(1-\rho^{-5})/(\rho-1)$",
            float(tip.real),
            math.cos(math.pi**2 / 6) * length,
        ),
        by_hand(
            "x_fk",
            "the same by forward_kinematics with that orientation",
            float(foot_tip.real),
            math.cos(math.pi**2 / 6) * length,
        ),
        by_hand(
            "x_ours",
            "the same, ours, by forward_kinematics in the finger's plane",
            float(_ours(0.0)[-1].real),
            -length,
        ),
        *_routes(
            "printed", _turned_foot(PRINTED, 1.0), back_toe(PRINTED, 1.0), ", bent"
        ),
        by_hand(
            "six",
            r"x of that tip with $v_0=6$: a half turn",
            float(half.real),
            -length,
        ),
    )


def _ours(value: float) -> NDArray[np.complex128]:
    """Junctions of finger 4 in its plane, x forward, by forward_kinematics."""
    foot = Foot.preset("paper")
    bones = forward_kinematics(foot, np.full(foot.phalanx_count, value))
    return _in_plane(bones[foot.finger_slices["finger4"]], math.pi / 12)


def _turned_foot(start: float, value: float) -> dict[str, NDArray[np.complex128]]:
    """Junctions of a toe with an orientation and azimuth 0, on both routes."""
    toe = Finger("finger4", BACK_TOE, 0.0, orientation=start)
    foot = Foot.preset("paper").replace(fingers=(toe,))
    controls = np.full(foot.phalanx_count, value)
    routes = {
        "fk": forward_kinematics(foot, controls),
        "pinocchio": FootModel(foot).forward(controls),
    }
    return {key: _in_plane(bones, 0.0) for key, bones in routes.items()}


def _in_plane(bones: NDArray[np.float64], azimuth: float) -> NDArray[np.complex128]:
    """Junctions x₀ to x_K of a toe's bones as x + iz, x along an azimuth."""
    points = np.concatenate([bones[:1, 0], bones[:, 1]])
    ahead = np.array([math.cos(azimuth), math.sin(azimuth), 0.0])
    return np.asarray(points @ ahead + 1j * points[:, 2])


def _routes(
    key: str,
    routes: dict[str, NDArray[np.complex128]],
    by_sum: NDArray[np.complex128],
    words: str = "",
) -> tuple[Measurement, ...]:
    """Distances of a finger with that orientation from the printed sum."""
    names = {"fk": "forward_kinematics", "pinocchio": "Pinocchio"}
    return tuple(
        rounding(
            f"{key}_{route}",
            "largest distance of the printed sum's junctions from a finger with that "
            f"orientation{words}, {names[route]}",
            float(np.abs(points - by_sum).max()),
        )
        for route, points in routes.items()
    )


def _draw(start: float, title: str, path: Path) -> object:
    """Draw the back toe by a printed orientation beside ours."""
    from zygopin.paper.foot_drawings import draw_back_toes

    stages = (0.0, 0.5, 1.0)
    forward, printed, ours = (
        [*map(toe, stages)]
        for toe in (partial(back_toe, 0.0), partial(back_toe, start), _ours)
    )
    return draw_back_toes({title: (forward, printed), "ours": (forward, ours)}, path)
