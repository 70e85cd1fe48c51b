"""The owl's foot in two poses (figure 6), and which of its toes turns."""

from __future__ import annotations

import math
from itertools import pairwise
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin import names
from zygopin.attack import Attack
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.obstacle import Sphere
from zygopin.paper.entry import (
    BY_HAND,
    EXACT,
    Entry,
    Exhibit,
    Measurement,
    Reference,
    at_least,
    at_most,
    equal,
    rounding,
)
from zygopin.paper.strike_grid import struck_area
from zygopin.paper.toe_planes import first_azimuths
from zygopin.spread import SpreadCurve, SpreadStudy, spread_study
from zygopin.stance import azimuths_at
from zygopin.strike import simulate_strike

RANDOM = 300
"""Random control sequences on which two routes are held against each other."""

TURN = 7 * math.pi / 12
"""Turn of the owl's toe 4 [rad]."""

BEST = math.pi / 3
"""Turn at which toe 4 stands at a right angle to the plane of toes 1 and 3 [rad]."""

BALL = 0.015
"""Radius of the prey [m]: half of the scale s."""

STEPS, FINE = 24, 106
"""Poses that a study looks at, for numbers and for a drawing."""

FLAT = 1e-4
"""How well a smooth maximum is placed by its values [rad]."""

POSES: dict[names.Pose, float] = {"zygodactyl": 0.0, "spread": 1.0}
"""Turn of toe 4 in each pose, over the whole turn."""

Floats = NDArray[np.float64]


def figure_6() -> Entry:
    """Figure 6: the owl's foot in two configurations.

    Returns:
        The entry.
    """
    owl = Foot.preset("owl")
    study = spread_study(owl, BALL, steps=STEPS)
    return Entry(
        key="figure-6",
        kind="figure",
        title="The owl's foot in two poses",
        place="section 5, figure 6",
        printed=(
            "Two configurations: one for grasping, and one for flight with a toe to "
            "the front; a wide spread is said to make a catch most likely."
        ),
        ours=(
            "Toe 4 is a revolute joint about the vertical, from the azimuth 195° to "
            "300°. The angle of the turn, 105°, is illustrative: the paper gives none."
        ),
        finding=(
            "Turning toe 4 gains: seen from above, the hull of the talons of the "
            f"straight toes grows by {study.hull.gain:.1%}, and the places where a "
            "ball of radius s/2 is struck from above grow by "
            f"{study.strike_all.gain:.1%}. Toes 1 and 3 lie on one line, so all three "
            "areas are largest with toe 4 at a right angle to it, after 60° of the "
            "105°. That toe 4 turns alone, and how far, is our choice (scaling factor "
            "1.18, after an owl), so this is no test of the paper's sentence: it says "
            "how much a spread is worth, and that more is not always better."
        ),
        measurements=(
            *_azimuths(owl),
            *_hulls(owl, study),
            *_strikes(owl, study),
            *_maxima(study),
        ),
        figures=_pictures(),
        scenes=(
            Exhibit(
                "figure-6.html",
                "The owl attacks a ball of radius 15 mm: toe 4 turns forward in level "
                "flight, the spread foot comes down, the tendon engages at the first "
                "contact, and the toes close around the ball and lock.",
                _write_strike,
            ),
        ),
    )


def _pictures() -> tuple[Exhibit, ...]:
    """The two poses, and the areas between them."""
    return (
        Exhibit(
            "figure-6.png",
            "The owl's foot from above, straight toes with their skin, x up and y to "
            "the left. Left: the zygodactyl pose. Right: toe 4 turned forward, called "
            "isodactyl in the paper. Dashed: the hull of the talons.",
            _draw_poses,
        ),
        Exhibit(
            "figure-6-areas.png",
            "Areas seen from above, over that of the zygodactyl pose, as toe 4 turns: "
            "the hull of the talons, and where a ball of radius s/2 is met by the "
            "first or by all phalanges. All are largest at 60°.",
            _draw_areas,
        ),
    )


def _azimuths(owl: Foot) -> tuple[Measurement, ...]:
    """Where toe 4 stands in both poses, on both routes."""
    straight = np.zeros(owl.phalanx_count)
    controls = np.random.default_rng(6).uniform(size=(RANDOM, owl.phalanx_count))
    model, found = FootModel(owl), []
    for pose, turn in POSES.items():
        azimuths = azimuths_at(owl, np.array(turn))
        bones = forward_kinematics(owl, straight, azimuths=azimuths)
        angle = float(first_azimuths(owl, bones)[3]) % math.tau
        expected = equal(13 * math.pi / 12 + turn * TURN, EXACT, "195° and 105° more")
        words = f"azimuth of toe 4, {pose} pose, by its bones"
        found.append(Measurement(f"azimuth_{pose}", words, angle, expected, unit="rad"))
        apart = forward_kinematics(owl, controls, azimuths=azimuths)
        apart = apart - model.forward(controls, azimuths=azimuths)
        found.append(
            rounding(
                f"pinocchio_{pose}",
                f"largest distance of a junction from Pinocchio's, over s, {pose} "
                f"pose, {RANDOM} random controls",
                float(np.abs(apart).max()) / owl.scale,
            )
        )
    return tuple(found)


def _hulls(owl: Foot, study: SpreadStudy) -> tuple[Measurement, ...]:
    """Areas of the talons' hull against the polygon's by hand."""
    areas = (study.hull.zygodactyl, study.hull.spread)
    return tuple(
        Measurement(
            f"hull_{pose}",
            rf"area of the talons' hull over $s^2$, {pose} pose",
            area / owl.scale**2,
            equal(
                _polygon(13 * math.pi / 12 + turn * TURN),
                1e-10,
                "four triangles at the base, worked by hand",
            ),
        )
        for (pose, turn), area in zip(POSES.items(), areas, strict=True)
    )


def _polygon(azimuth: float) -> float:
    """Area of the hull of the talons by its triangles at the base, over s²."""
    rho = 1.18
    length = [(1 - rho**-count) / (rho - 1) for count in (2, 3, 4, 5)]
    one, two, three = math.pi * 11 / 12, math.pi / 12, -math.pi / 12 + math.tau
    around = [(length[1], two), (length[0], one), (length[3], azimuth)]
    around += [(length[2], three), (length[1], two + math.tau)]
    return math.fsum(a * b * math.sin(v - u) / 2 for (a, u), (b, v) in pairwise(around))


def _strikes(owl: Foot, study: SpreadStudy) -> tuple[Measurement, ...]:
    """Areas where a ball is struck against a count on a grid."""
    found = []
    for pose, turn in POSES.items():
        area = (study.strike_all.zygodactyl, study.strike_all.spread)[int(turn)]
        counted, error = struck_area(owl, BALL, turn)
        found.append(
            Measurement(
                f"strike_{pose}",
                "area over $s^2$ where a ball of radius s/2 is met by any phalanx, "
                f"{pose} pose",
                area / owl.scale**2,
                equal(counted, error, "cells of a grid, counted and bounded"),
            )
        )
    return tuple(found)


def _maxima(study: SpreadStudy) -> tuple[Measurement, ...]:
    """What the spread pose gains, and where each area is largest."""
    back, front = (13 * math.pi / 12 + turn * TURN for turn in POSES.values())
    gain = _polygon(front) / _polygon(back) - 1
    share = _polygon(front) / _polygon(back + BEST)
    by_hand = equal(gain, 1e-9, BY_HAND), equal(share, 1e-7, BY_HAND)
    less = at_most(0.99, "it is not the maximum")
    more = at_least(0.0, "it covers more")
    first, every = "where first phalanges meet the ball", "where any phalanx meets it"
    return (
        *_maximum("hull", "the hull of the talons", study.hull, by_hand),
        *_maximum("first", first, study.strike_first, (more, less)),
        *_maximum("all", every, study.strike_all, (_counted_gain(study), less)),
    )


def _counted_gain(study: SpreadStudy) -> Reference:
    """The spread pose's gain by the counts on a grid."""
    (back, error), (front, other) = (
        struck_area(study.foot, BALL, turn) for turn in POSES.values()
    )
    gain = front / back
    bound = gain * (other / front + error / back) / (1 - error / back)
    return equal(gain - 1, bound, "cells of a grid, counted and bounded")


def _maximum(
    key: str, words: str, curve: SpreadCurve, references: tuple[Reference, Reference]
) -> tuple[Measurement, ...]:
    """Gain of the spread pose, its share of the maximum, and where that is."""
    gain, share = references
    return (
        Measurement(
            f"gain_{key}",
            f"gain of the spread pose over the zygodactyl one, {words}",
            curve.gain,
            gain,
        ),
        Measurement(
            f"share_{key}",
            f"spread pose over the best one, {words}",
            curve.spread / curve.best_area,
            share,
        ),
        Measurement(
            f"best_{key}",
            f"turn of toe 4 at which it is largest, {words}",
            curve.best_reversal * TURN,
            equal(BEST, FLAT, "a right angle to toes 1 and 3, worked by hand"),
            unit="rad",
        ),
    )


def _draw_poses(path: Path) -> object:
    """Draw figure 6."""
    from zygopin.paper.owl_drawings import draw_poses

    return draw_poses(Foot.preset("owl"), path)


def _draw_areas(path: Path) -> object:
    """Draw areas over the turn of toe 4."""
    from zygopin.paper.owl_drawings import draw_areas

    return draw_areas(spread_study(Foot.preset("owl"), BALL, steps=FINE), path)


def _write_strike(path: Path) -> object:
    """Write the owl's strike."""
    from zygopin.strike_scene import export_strike

    owl = Foot.preset("owl")
    flight = Attack(speed=3.0, slope=1.0).flight(owl)
    return export_strike(simulate_strike(owl, Sphere(BALL, (0, 0, 0)), flight), path)
