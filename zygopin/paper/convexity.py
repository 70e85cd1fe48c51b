"""The paper's last remark: whether toes that close keep a convex obstacle."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from zygopin.closing import Closing, Reading
from zygopin.engine import EngineName
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.obstacle import Box, Capsule, Obstacle, Sphere
from zygopin.paper.descents import DURATION, descent
from zygopin.paper.entry import BY_HAND, Entry, Exhibit, Measurement, at_least, equal
from zygopin.paper.toe_sums import junctions, placed
from zygopin.remark import Counterexample, contact_kept, counterexample
from zygopin.solid_clearance import obstacle_clearance
from zygopin.trajectory import StrikeTrajectory

OBSTACLES, CERTIFIED = 90, 15
"""Random convex obstacles on which the corrected statement is tested, and the first
of them, whose intervals are certified as well."""

VALUES = 401
"""Values of v at which each of them is looked at."""

WIDE = 0.85 * math.pi
"""The wide turn ω of the random obstacles' foot, below π [rad]."""

PLACE = 0.8 * 2 / (1 + math.sqrt(5))
"""Where the counterexample's ball touches the straight phalanx, from the base."""

QUARTER = math.pi / 24
"""A quarter of the paper's ω [rad]."""

NEAR = 4e-5
"""How much later in v contact ends at the tolerance than at zero clearance."""

Floats = NDArray[np.float64]


def erratum_11() -> Entry:
    """The remark that a convex obstacle stays in contact.

    Returns:
        The entry.
    """
    found = counterexample(Foot.preset("paper"))
    return Entry(
        key="erratum-11",
        kind="erratum",
        title="Convexity does not keep contact",
        place="section 5, last remark",
        printed=(
            r"If $\mathcal O$ is convex, then $P^{(l)}\cap\mathcal O\neq\emptyset$ for "
            r"some $l$ at every $t\in[0,T]$."
        ),
        ours=(
            r"Let $\mathcal O$ be convex and closed and the turn $\omega(v(T)-v(0))$ "
            r"less than $\pi$. A finger has contact on one closed interval of $v$, or "
            "never; so it keeps contact if and only if it has it at both ends. Some "
            "finger or other has contact throughout exactly if their intervals cover "
            r"$[v(0), v(T)]$. This is always so if the base is in $\mathcal O$."
        ),
        finding=(
            "Without contact forces the phalanx passes through the obstacle. A ball "
            "under toe 4 that touches the straight first phalanx is swept through: "
            r"with $s$ the place of touch and $r=s\tan(\omega/4)$ it is lost at "
            "$v=1/2$. The printed system has no memory: with the guard false again it "
            "would return to the free mode in the middle of the closing. With contact "
            "forces, the reading “contact”, the same ball stops the toe and contact "
            "is kept. On random balls, boxes and capsules in the way of the first "
            "phalanges the corrected statement holds without exception."
        ),
        measurements=(
            *_lost(found),
            *_strikes(found),
            *_random_obstacles(),
        ),
        figures=(
            Exhibit(
                "erratum-11.png",
                "The paper's foot and a ball of radius 0.065 below toe 4. Left: the "
                "first phalanx meets the ball (red) up to v = 0.5 and has then lost it "
                "(grey). Right: clearances of all four first phalanges; after v = 0.5 "
                "none is in contact.",
                _draw_remark,
            ),
        ),
        scenes=(
            Exhibit(
                "erratum-11.html",
                "The foot comes down on that ball in the paper's reading: the first "
                "phalanx of toe 4 engages, passes through and leaves the ball behind.",
                _write_swept,
            ),
        ),
    )


def _lost(found: Counterexample) -> tuple[Measurement, ...]:
    """Where the ball is lost: three routes; and how far off it is at the end."""
    contact = found.contact
    return (
        Measurement(
            "radius",
            r"radius of the ball: $s\tan(\omega/4)$",
            found.obstacle.radius,
            equal(PLACE * math.tan(QUARTER), 1e-12, BY_HAND),
        ),
        Measurement(
            "lost_kept",
            "v at which contact is lost, by contact_kept",
            contact.lost_at,
            equal(0.5, NEAR, r"$2\alpha/\omega$ with $\alpha=\omega/4$, by hand"),
        ),
        Measurement(
            "lost_fcl",
            "the same, where FCL's distance leaves 0, by bisection",
            _last_contact(found),
            equal(0.5, 1e-6, r"$2\alpha/\omega$ with $\alpha=\omega/4$, by hand"),
        ),
        Measurement(
            "contacts_after",
            "values of v after it, of 1000, at which some first phalanx is in contact",
            int(np.sum(_clearances(found, np.linspace(0.5, 1, 1001)[1:]) <= 0)),
            equal(0, 0, "dense scan by FCL"),
        ),
        Measurement(
            "gap",
            "clearance of toe 4's first phalanx at $v=1$: "
            r"$s\sin(3\omega/4)/\cos(\omega/4)-r$",
            float(_clearances(found, np.ones(1), engine="exact")[0, 3]),
            equal(
                PLACE * (math.sin(3 * QUARTER) / math.cos(QUARTER) - math.tan(QUARTER)),
                1e-12,
                BY_HAND,
            ),
        ),
    )


def _strikes(found: Counterexample) -> tuple[Measurement, ...]:
    """Strikes at the ball in both readings of the closing."""
    paper, contact = _strike(found, "paper"), _strike(found, "contact")
    closing = paper.modes == "closing"
    values = paper.controls[closing][:, 0]
    gaps = paper.clearance[closing][:, _firsts(found.foot)].min(axis=1)
    return (
        Measurement(
            "first_gap",
            "first v of a closing instant without contact, simulate_strike in the "
            "reading paper",
            float(values[gaps > paper.tolerance].min()),
            equal(0.5, 2e-2, "1/2, and a step of the record"),
        ),
        Measurement(
            "held_gap",
            "clearance of the nearest phalanx of toe 4 at the lock, reading contact",
            float(contact.grip.clearance[found.foot.finger_slices["finger4"]].min()),
            equal(0.0, 1.01 * contact.tolerance, "contact is kept"),
        ),
    )


def _random_obstacles() -> tuple[Measurement, ...]:
    """How often contact is no interval, and how often the statement fails."""
    foot = Foot.preset("paper").replace(omega=WIDE)
    rng, values = np.random.default_rng(11), np.linspace(0, 1, VALUES)
    split = wrong = differ = met = engaged = lost = 0
    for number in range(OBSTACLES):
        solid = _solid(rng, number % 3)
        gaps = _scan(foot, solid, values)
        contact = gaps <= 0
        changes = np.diff(contact.astype(int), axis=0, prepend=0, append=0)
        split += int(np.any(np.sum(changes == 1, axis=0) > 1))
        wrong += int(np.any((contact[0] & contact[-1]) != contact.all(axis=0)))
        if number < CERTIFIED:
            differ += _differences(foot, solid, values, gaps)
        met += int(contact.any(axis=0).sum())
        engaged += int(contact[0].any())
        lost += int(contact[0].any() and not contact.any(axis=1).all())
    return (
        Measurement(
            "split",
            f"of {OBSTACLES} random balls, boxes and capsules, those that a first "
            "phalanx meets in more than one interval of v, turn 153°",
            split,
            equal(0, 0, f"scan of {VALUES} values of v"),
        ),
        Measurement(
            "wrong",
            "those for which contact at both ends and contact throughout differ for "
            f"some finger; fingers meet them in {met} cases",
            wrong,
            equal(0, 0, f"scan of {VALUES} values of v"),
        ),
        Measurement(
            "differ",
            "values of v at which the intervals of contact_kept and the scan differ, "
            f"of {CERTIFIED * VALUES * len(foot.fingers)} for {CERTIFIED} of them",
            differ,
            equal(0, 0, "dense scan"),
        ),
        Measurement(
            "lost",
            f"of {engaged} obstacles in contact at v = 0, those that all first "
            "phalanges have lost at some later v, against the print",
            lost,
            at_least(1, "one is enough"),
        ),
    )


def _differences(foot: Foot, solid: Obstacle, values: Floats, gaps: Floats) -> int:
    """At how many values the certified intervals and a scan contradict each other."""
    kept = contact_kept(foot, solid)
    inside = np.zeros(gaps.shape, bool)
    for column, finger in enumerate(foot.fingers):
        for low, high in kept.intervals[finger.name]:
            inside[:, column] |= (low <= values) & (values <= high)
    grazed = np.abs(gaps) <= 2 * kept.tolerance
    return int(np.sum((inside != (gaps <= 0)) & ~grazed))


def _solid(rng: np.random.Generator, kind: int) -> Obstacle:
    """A convex obstacle in the way of some first phalanx."""
    toe = Foot.preset("paper").fingers[rng.integers(4)]
    distance, pitch = rng.uniform(0.2, 0.6), rng.uniform(-0.1, 1.0) * WIDE
    place = distance * junctions(1.0, [pitch])[1:]
    centre = placed(place, toe.azimuth)[0] + rng.uniform(-0.1, 0.1, 3)
    size = float(rng.uniform(0.03, 0.3))
    if kind == 0:
        return Sphere(size, centre)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    turn = turn * np.linalg.det(turn)
    if kind == 1:
        return Box(size * rng.uniform(0.4, 2, 3), centre, turn)
    return Capsule(size / 2, centre + size * np.outer((-1, 1), turn[0]))


def _scan(
    foot: Foot, solid: Obstacle, values: Floats, engine: EngineName = "exact"
) -> Floats:
    """Clearances of the first phalanges with all controls equal, shape (n, F)."""
    controls = np.repeat(values[:, None], foot.phalanx_count, axis=1)
    firsts = _firsts(foot)
    bones = forward_kinematics(foot, controls)[:, firsts]
    return obstacle_clearance(bones, foot.radii[firsts], solid, engine=engine).distance


def _clearances(
    found: Counterexample, values: Floats, engine: EngineName = "fcl"
) -> Floats:
    """The same for the counterexample's ball."""
    return _scan(found.foot, found.obstacle, values, engine)


def _last_contact(found: Counterexample) -> float:
    """Value of v between 1/4 and 1 at which FCL's distance leaves 0."""
    low, high = 0.25, 1.0
    for _ in range(40):
        middle = (low + high) / 2
        touching = _clearances(found, np.array([middle]))[0, 3] <= 0
        low, high = (middle, high) if touching else (low, middle)
    return (low + high) / 2


def _strike(found: Counterexample, reading: Reading) -> StrikeTrajectory:
    """A strike straight down on the ball."""
    closing = Closing(reading=reading, duration=DURATION, shape="linear")
    return descent(found.foot, found.obstacle, closing=closing)


def _firsts(foot: Foot) -> list[int]:
    """Indices of the first phalanges."""
    return [part.start for part in foot.finger_slices.values()]


def _draw_remark(path: Path) -> object:
    """Draw the ball that is swept through."""
    from zygopin.remark_plots import plot_remark

    return plot_remark(Foot.preset("paper"), path)


def _write_swept(path: Path) -> object:
    """Write the strike that loses the ball."""
    from zygopin.strike_scene import export_strike

    strike = _strike(counterexample(Foot.preset("paper")), "paper")
    return export_strike(strike, path, title="A ball that a closing toe loses")
