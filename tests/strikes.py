"""Random strikes, and a reference that tells when their obstacles are first met."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from zygopin.branch import Branch
from zygopin.closing import Closing
from zygopin.errors import ParameterError
from zygopin.finger import Finger
from zygopin.flight import Flight
from zygopin.foot import Foot
from zygopin.motion import Law, Motion
from zygopin.obstacle import Box, Capsule, ConvexMesh, Sphere
from zygopin.solid_clearance import obstacle_clearance
from zygopin.tendon import Contact, TendonFoot

KINDS = ("sphere", "branch", "stump", "box", "capsule", "mesh")
"""Shapes of obstacles; a stump is a branch of finite length."""

PRESETS = ("parrot", "owl", "anisodactyl", "paper")

GRID = 1001
"""Instants between which a reference takes paths as straight."""

BENT = 1.3
"""Length of a path over that of its chord, at most, between two of these instants."""

COARSE = 20
"""Steps of that grid that a reference starts with at once."""

ROUNDING = 1e-3
"""Share of the tolerance by which two evaluations of a clearance may differ."""

STEP = 1e-3
"""The fixed step of a simulation that looks at instants only [s]."""


@dataclass(frozen=True)
class Verdict:
    """What became of one strike; lengths over the tolerance.

    Attributes:
        engaged: Whether the tendon engaged.
        early: Clearance at that instant, less the tolerance.
        depth: Deepest that the reference found before it, or at any time without.
        grazing: Without engagement: it came within the tolerance.
        stepped_over: The fixed step saw no contact at all, though there was one.
    """

    engaged: bool
    early: float
    depth: float
    grazing: bool
    stepped_over: bool

    @property
    def good(self) -> bool:
        """No contact was missed, and none was seen where there is none."""
        return self.early <= ROUNDING and self.depth <= ROUNDING


def random_foot(rng):
    """A preset, or a foot of any allowed shape and of many sizes."""
    if rng.random() < 0.3:
        return Foot.preset(str(rng.choice(PRESETS)))
    scale = 10 ** rng.uniform(-3, 1)
    fingers = [
        Finger(
            f"finger{i + 1}",
            int(rng.integers(1, 6)),
            azimuth=rng.uniform(-np.pi, np.pi),
            reversed_azimuth=rng.choice([None, rng.uniform(-np.pi, np.pi)]),
        )
        for i in range(int(rng.integers(1, 5)))
    ]
    return Foot(
        rho=rng.uniform(1.02, 2.5),
        omega=rng.uniform(0.1, 3.0),
        scale=scale,
        thickness=scale * rng.choice([0.0, rng.uniform(0.01, 0.4)]),
        fingers=tuple(fingers),
    )


def random_motion(rng, size):
    """Waypoints with turns, or a swing given as a function, at any speed."""
    end = 10 ** rng.uniform(-3, 0)
    if rng.random() < 0.2:
        return _swing(rng, size, end)
    count = int(rng.integers(2, 7))
    times = np.append(0.0, np.cumsum(rng.uniform(0.05, 1.0, count - 1)))
    turns = Rotation.from_rotvec(rng.normal(size=(count, 3)) * rng.uniform(0, 1.5))
    places = rng.normal(size=(count, 3)) * 1.5 * size
    return Motion.through(times / times[-1] * end, places, turns.as_matrix())


def _swing(rng, size, end):
    """A base that turns about its own axis while it swings along a line."""
    way, axis = rng.normal(size=(2, 3))
    way, axis = way / np.linalg.norm(way), axis / np.linalg.norm(axis)
    width, pace = rng.uniform(0.5, 2) * size, rng.uniform(1, 4) * math.pi / end
    spin = rng.uniform(0, 6) / end

    def pose(time):
        matrix = np.eye(4)
        matrix[:3, :3] = Rotation.from_rotvec(axis * spin * time).as_matrix()
        matrix[:3, 3] = way * width * math.cos(pace * time)
        return matrix

    return Motion.of(pose, end=end, speed=width * pace, turn_rate=spin)


def random_law(rng, motion, shape):
    """Values in [0, 1] that change over a motion, or do not."""
    count = int(rng.integers(2, 7))
    first, last = motion.times[[0, -1]]
    return Law.through(np.linspace(first, last, count), rng.random((count, *shape)))


def random_flight(rng, foot):
    """A motion, with controls and a reversal that may change."""
    motion = random_motion(rng, foot.size)
    controls = random_law(rng, motion, (foot.phalanx_count,))
    reversal = random_law(rng, motion, ())
    return Flight(
        motion,
        controls if rng.random() < 0.7 else rng.random(foot.phalanx_count),
        reversal if rng.random() < 0.5 else rng.random(),
    )


def make_obstacle(kind, width, centre, rng):
    """An obstacle of a given shape, width and place, turned at random."""
    turn = Rotation.random(None, rng).as_matrix()
    long = width * 10 ** rng.uniform(0.1, 1.5)
    made = {
        "sphere": lambda: Sphere(width, centre),
        "branch": lambda: Branch(width, centre, turn[0]),
        "stump": lambda: Branch(width, centre, turn[0], long),
        "box": lambda: Box(width * rng.uniform(0.5, 4, 3), centre, turn),
        "capsule": lambda: Capsule(
            width, centre + np.outer([-0.5, 0.5], long * turn[0])
        ),
        "mesh": lambda: ConvexMesh(centre + width * rng.normal(size=(12, 3))),
    }
    return made[kind]()


def random_strike(rng, kind, **options):
    """A foot in flight with an obstacle near one of its phalanges' paths.

    Widths go down to a thousandth of the foot. Some spheres are of a radius at which
    they are just met, or just missed.
    """
    foot = random_foot(rng)
    flight = random_flight(rng, foot)
    contact = Contact(sensing=str(rng.choice(["any", "first"])))
    while True:
        width = foot.size * 10 ** rng.uniform(-3, -0.5)
        probe = TendonFoot(foot, Sphere(1e-3 * foot.size, np.full(3, 1e3)), flight)
        bones = probe.flow.stances(rng.uniform(*flight.motion.times[[0, -1]], 1)).bones
        bone = bones[0, rng.integers(foot.phalanx_count)]
        aside = foot.size * rng.normal(size=3) * 10 ** rng.uniform(-3, -0.3)
        place = bone[0] + rng.random() * (bone[1] - bone[0]) + aside
        obstacle = make_obstacle(kind, width, place, rng)
        if kind == "sphere" and rng.random() < 0.4:
            obstacle = _grazed(probe, obstacle, rng)
        try:
            return TendonFoot(foot, obstacle, flight, contact=contact, **options)
        except ParameterError as error:
            assert "holds the base" in str(error)  # noqa: PT017


def _grazed(probe, sphere, rng):
    """A sphere about the same place, as large as it may be to be just missed."""
    times = np.linspace(*probe.flow.motion.times[[0, -1]], GRID)
    for _ in range(8):
        gaps = _clearance(probe.flow.stances(times).bones, probe.foot, sphere)
        best = times[np.argmin(gaps.min(axis=1))]
        half = (times[-1] - times[0]) / 50
        inside = np.array([best - half, best + half]).clip(times[0], times[-1])
        times = np.linspace(*inside, 101)
    radius = sphere.radius + gaps.min() + probe.tolerance * rng.uniform(-3, 3)
    return Sphere(max(radius, 1e-3 * probe.foot.size), sphere.centre)


def _clearance(bones, foot, obstacle):
    return obstacle_clearance(bones, foot.radii, obstacle).distance


def deepest_before(automaton, end):
    """Least clearance of a sensing phalanx from the flight's start to an instant.

    Intervals are halved until the length of each phalanx's path over one, measured on
    a dense grid, shows that nothing in it is below what was found, or in contact.

    Args:
        automaton: A foot with its flight.
        end: The instant [s].

    Returns:
        The least clearance [m]; where there is no contact, no less than it.
    """
    foot, flow = automaton.foot, automaton.flow
    grid = np.union1d(np.linspace(flow.start, end, GRID), _breaks(flow, end))
    bones = flow.stances(grid).bones
    chords = np.linalg.norm(np.diff(bones, axis=0), axis=-1).max(axis=-1)
    rates = chords / np.diff(grid)[:, None]
    padded = np.pad(rates, ((1, 1), (0, 0)), mode="edge")
    rates = BENT * np.maximum(np.maximum(padded[:-2], padded[2:]), rates)
    paths = np.append(
        np.zeros((1, foot.phalanx_count)),
        np.cumsum(rates * np.diff(grid)[:, None], axis=0),
        axis=0,
    )
    coarse = np.unique(np.append(np.arange(0, len(grid), COARSE), len(grid) - 1))
    gaps = _clearance(bones[coarse], foot, automaton.obstacle)
    gaps = np.where(automaton.senses, gaps, np.inf)
    least = float(gaps.min())
    step, phalanx = np.nonzero(np.ones(gaps[1:].shape, bool))
    low, high = grid[coarse][step], grid[coarse][step + 1]
    below, above = gaps[step, phalanx], gaps[step + 1, phalanx]
    slack = ROUNDING * automaton.tolerance / 2
    while True:
        length = _between(grid, paths, phalanx, low, high)
        open_ = (below + above - length) / 2 < min(least, automaton.tolerance) - slack
        low, high, below, above, phalanx = (
            x[open_] for x in (low, high, below, above, phalanx)
        )
        middle = (low + high) / 2
        moving = (middle > low) & (middle < high)
        if not moving.any():
            return least
        low, high, below, above, phalanx, middle = (
            x[moving] for x in (low, high, below, above, phalanx, middle)
        )
        between = _single_clearances(automaton, middle, phalanx)
        least = min(least, float(between.min()))
        low, high = np.append(low, middle), np.append(middle, high)
        below, above = np.append(below, between), np.append(between, above)
        phalanx = np.tile(phalanx, 2)


def _breaks(flow, end):
    """Instants before an end at which a law bends."""
    times = np.concatenate(
        [flow.motion.times, flow.controls.times, flow.reversal.times]
    )
    return times[(times > flow.start) & (times < end)]


def _between(grid, paths, phalanx, low, high):
    """Lengths of phalanges' paths between two instants each."""
    length = np.empty(len(phalanx))
    for index in np.unique(phalanx):
        own = phalanx == index
        length[own] = np.interp(high[own], grid, paths[:, index]) - np.interp(
            low[own], grid, paths[:, index]
        )
    return length


def _single_clearances(automaton, times, phalanx):
    """Clearances of one phalanx at one instant each."""
    bones = automaton.flow.stances(times).bones
    bones = bones[np.arange(len(times)), phalanx][:, None]
    near = obstacle_clearance(bones, np.zeros(1), automaton.obstacle)
    return near.distance[:, 0] - automaton.foot.radii[phalanx]


def judged(automaton):
    """Run a strike to its flight's end, and hold it against the reference."""
    flow, tolerance, senses = automaton.flow, automaton.tolerance, automaton.senses
    automaton.run(flow.end)
    engaged = bool(automaton.events)
    until = automaton.events[0].time if engaged else flow.end
    near = [math.inf]
    if engaged:
        bones = flow.stances(np.array([until])).bones[0]
        near = _clearance(bones, automaton.foot, automaton.obstacle)[senses]
    least = deepest_before(automaton, until) if until > flow.start else math.inf
    times = np.append(np.arange(flow.start, flow.end, STEP), flow.end)
    bones = flow.stances(times).bones
    looked = _clearance(bones, automaton.foot, automaton.obstacle)[:, senses].min()
    return Verdict(
        engaged=engaged,
        early=(min(near) - tolerance) / tolerance if engaged else -math.inf,
        depth=-least / tolerance,
        grazing=not engaged and least <= tolerance,
        stepped_over=engaged and bool(looked > tolerance),
    )


def paper_reading():
    """Toes that close through the obstacle: nothing but the guard takes time."""
    return Closing(reading="paper", shape="linear")
