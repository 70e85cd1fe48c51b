"""The paper's section 5: the tendon locking mechanism as a system of two modes."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.paper.descents import (
    DURATION,
    END,
    SPEED,
    ball_under_toe,
    branch_under_base,
    contact_time,
    descent,
    local_bones,
    wandering,
)
from zygopin.paper.entry import (
    Entry,
    Exhibit,
    Measurement,
    at_least,
    equal,
    rounding,
)
from zygopin.paper.toe_sums import (
    PAPER_TURN,
    closing_turns,
    junctions,
    placed,
)
from zygopin.trajectory import StrikeTrajectory

STAGES = 201
"""Values of v on which routes are held against each other."""

TOLERANCE = 1e-6
"""Clearance that counts as contact, over the foot's size."""


def tlm_map() -> Entry:
    """The two modes of the tendon locking mechanism, and its lock.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    strike = descent(foot, ball_under_toe(), controls=wandering(foot))
    return Entry(
        key="tlm-map",
        kind="statement",
        title="Two modes, and a lock",
        place="section 5, system for the TLM and the remark after it",
        printed=(
            r"Free while no first phalanx meets $\mathcal O$: "
            r"$x_k=\sum_{j=1}^{k+1}\rho^{-j}e^{-i\omega\sum_{n=1}^{j}u_n(t)}$. "
            r"Otherwise $x_k=\sum_{j=1}^{k+1}\rho^{-j}e^{-i\omega jv(t)}$. The lock "
            "closes after $T$."
        ),
        ours=(
            r"Three modes: FREE, CLOSING with $x_k=\sum_{j=1}^{k}\rho^{-j}e^{-i\omega "
            "jv(t-t^*)}$ from the first contact $t^*$ on, LOCKED after the time $T$."
        ),
        finding=(
            "With the sum to k and each toe in its own plane, the closing mode is that "
            "of equal controls on every route. The printed system has no memory and no "
            "locked state; the text asks for both, and TendonFoot has them. A strike "
            "straight down shows it: the controls are free before contact, count for "
            "nothing after it, and the instant of contact is the one worked by hand. "
            "At contact the controls jump to v(0), as the printed system has it."
        ),
        measurements=(
            *_closed_routes(foot),
            *_modes(foot, strike),
            *_instants(foot, strike),
        ),
        figures=(
            Exhibit(
                "tlm-map.png",
                "The strike over time, a closing taken to last a quarter of a second. "
                "Above: the least clearance of each toe to the ball; toe 3 sinks into "
                "it. Below: the controls of each toe. The outer joints wander as they "
                "are told until toe 3 meets the ball at 450 ms, all follow v(t) for "
                "250 ms, and stay at 1 whatever they are told then.",
                partial(_draw_strike, strike),
            ),
        ),
    )


def _closed_routes(foot: Foot) -> tuple[Measurement, ...]:
    """Equal controls on two routes against the sum to k."""
    stages = np.linspace(0, 1, STAGES)
    expected = _summed(foot, stages)
    controls = np.repeat(stages[:, None], foot.phalanx_count, axis=1)
    routes = {
        "forward_kinematics": forward_kinematics(foot, controls),
        "Pinocchio": FootModel(foot).forward(controls),
    }
    return tuple(
        rounding(
            f"closing_{name.lower()}",
            f"largest distance of a junction from the sum to k, {STAGES} values of v, "
            f"14 phalanges, {name}",
            float(np.abs(bones[..., 1, :] - expected).max()),
        )
        for name, bones in routes.items()
    )


def _modes(foot: Foot, strike: StrikeTrajectory) -> tuple[Measurement, ...]:
    """What the record of a strike shows in each mode."""
    bones, law = local_bones(strike), wandering(foot)
    free, closing, locked = (
        strike.modes == mode for mode in ("free", "closing", "locked")
    )
    asked = law.at(strike.times)
    share = (strike.times[closing] - strike.events[0].time) / DURATION
    expected = _summed(foot, 3 * share**2 - 2 * share**3)
    asked_free = FootModel(foot).forward(asked[free])
    return (
        rounding(
            "free",
            f"largest distance, in {free.sum()} free instants, from Pinocchio with the "
            "controls that are asked for",
            float(np.abs(bones[free] - asked_free).max()),
        ),
        rounding(
            "strike",
            f"largest distance, in {closing.sum()} closing instants, from the sum to "
            "k with $v=3s^2-2s^3$, $s=(t-t^*)/T$",
            float(np.abs(bones[closing][..., 1, :] - expected).max()),
        ),
        Measurement(
            "locked",
            f"largest distance that a junction moves in {locked.sum()} locked instants",
            float(np.ptp(strike.bones[locked], axis=0).max()),
            equal(0.0, 0.0, "nothing moves"),
        ),
        Measurement(
            "asked",
            "meanwhile, the largest change of a control that is asked for",
            float(np.ptp(asked[locked], axis=0).max()),
            at_least(0.1, "a change that would be seen"),
        ),
        Measurement(
            "lock_time",
            "time from contact to lock",
            strike.events[-1].time - strike.events[0].time,
            equal(DURATION, 1e-12, "T"),
        ),
        Measurement(
            "last_locked",
            "last locked instant",
            float(strike.times[locked][-1]),
            equal(END, 1e-12, "the flight's end"),
        ),
    )


def _instants(foot: Foot, strike: StrikeTrajectory) -> tuple[Measurement, ...]:
    """Instants of contact of a flat foot that comes straight down."""
    # Contact counts from a clearance of the tolerance on: early by that much way.
    early = 1.01 * TOLERANCE * foot.size / SPEED
    branch = branch_under_base()
    strikes = {
        "ball": ("a ball under toe 3", strike),
        "branch": ("a branch under the base", descent(foot, branch)),
        "fcl": (
            "the ball, clearances by FCL",
            descent(foot, ball_under_toe(), engine="fcl"),
        ),
    }
    return tuple(
        Measurement(
            f"instant_{key}",
            f"instant of contact with {words}, radius 0.1, from the height 1 at the "
            "speed 2",
            each.events[0].time,
            equal(contact_time(), early, "(1 − 0.1)/2, worked by hand"),
        )
        for key, (words, each) in strikes.items()
    )


def _summed(foot: Foot, values: NDArray[np.float64]) -> NDArray[np.float64]:
    """Ends of all phalanges at values v by the sums to k, shape (n, P, 3)."""
    azimuths = np.array([11, 1, -1, 13]) * math.pi / 12
    toes = []
    for count, azimuth in zip((2, 3, 4, 5), azimuths, strict=True):
        points = junctions(foot.rho, closing_turns(PAPER_TURN, values, count))
        toes.append(placed(points[:, 1:], float(azimuth)))
    return np.concatenate(toes, axis=1)


def _draw_strike(strike: StrikeTrajectory, path: Path) -> object:
    """Draw a strike over time."""
    from zygopin.strike_plots import plot_strike

    return plot_strike(strike, path)
