"""Strikes of the paper's foot whose course is known by hand: straight down, flat."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.closing import Closing
from zygopin.engine import EngineName
from zygopin.flight import Flight
from zygopin.foot import Foot
from zygopin.motion import Law, Motion
from zygopin.obstacle import Obstacle, Sphere
from zygopin.strike import simulate_strike
from zygopin.tendon import Contact
from zygopin.trajectory import StrikeTrajectory

HEIGHT, SPEED, END = 1.0, 2.0, 2.0
"""Height from which the foot descends, its speed, and when the flight ends."""

DURATION = 0.25
"""Closing time T."""

RADIUS = 0.1
"""Radius of the ball, and of the branch."""

KNOTS = 9
"""Instants between which the controls change evenly."""


def ball_under_toe() -> Sphere:
    """A ball whose centre is level with z = 0, under the first phalanx of finger 3.

    Returns:
        The ball.
    """
    return Sphere(
        RADIUS, (0.3 * math.cos(math.pi / 12), -0.3 * math.sin(math.pi / 12), 0)
    )


def branch_under_base() -> Branch:
    """A branch across the way of the base, its axis y at z = 0.

    Returns:
        The branch.
    """
    return Branch(RADIUS, (0.0, 0.0, 0.0))


def contact_time() -> float:
    """When the descending foot meets ball or branch, by hand.

    Returns:
        The time at which the flat foot is a radius above the centre.
    """
    return (HEIGHT - RADIUS) / SPEED


def wandering(foot: Foot) -> Law:
    """Controls that move the outer joints at random; first phalanges stay level.

    Args:
        foot: The foot.

    Returns:
        The law, defined to the flight's end.
    """
    values = np.random.default_rng(5).uniform(0, 0.5, (KNOTS, foot.phalanx_count))
    values[:, foot.rank_of_phalanx == 1] = 0.0
    return Law.through(np.linspace(0, END, KNOTS), values)


def descent(
    foot: Foot,
    obstacle: Obstacle,
    *,
    controls: Law | float = 0.0,
    closing: Closing | None = None,
    engine: EngineName | None = None,
) -> StrikeTrajectory:
    """A foot that comes straight down from a height over the origin.

    Args:
        foot: The foot.
        obstacle: What it meets.
        controls: Controls while it is free.
        closing: How its toes close; None: smoothly, in the reading `paper`.
        engine: The engine that measures clearances; None: the exact one.

    Returns:
        The record.
    """
    bottom = HEIGHT - SPEED * END
    motion = Motion.through([0.0, END], [(0, 0, HEIGHT), (0, 0, bottom)])
    chosen = closing or Closing(reading="paper", duration=DURATION)
    return simulate_strike(
        foot,
        obstacle,
        Flight(motion, controls),
        closing=chosen,
        contact=Contact(sensing="first", engine=engine),
    )


def local_bones(strike: StrikeTrajectory) -> NDArray[np.float64]:
    """Bones seen from the base, which does not turn.

    Args:
        strike: A descent.

    Returns:
        Bones, shape (n, P, 2, 3).
    """
    return strike.bones - strike.base[:, None, None, :3, 3]
