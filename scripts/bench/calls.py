"""Seconds that users wait for one call or one command."""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from collections.abc import Callable
from functools import partial
from itertools import product

import numpy as np

from zygopin import (
    Attack,
    Box,
    Branch,
    Capsule,
    ControlSystem,
    ConvexMesh,
    Foot,
    FootModel,
    Friction,
    Sphere,
    Strength,
    branch_contacts,
    closure_quality,
    find_word,
    force_closure,
    forward_kinematics,
    least_friction,
    plan_perch,
    pull_limit,
    reachable_set,
    simulate_strike,
    tilt_limit,
    to_urdf,
)
from zygopin.clearance import branch_clearance
from zygopin.obstacle import Obstacle
from zygopin.raster import raster


def seconds(work: Callable[[], object], runs: int) -> float:
    """Median time of a piece of work [s].

    Args:
        work: The work.
        runs: Runs after the first, which does not count; 0: it is all there is.

    Returns:
        The median.
    """
    times = []
    for _ in range(runs + 1):
        start = time.perf_counter()
        work()
        times.append(time.perf_counter() - start)
    return statistics.median(times[1:] or times)


def rows(runs: int, levels: int) -> dict[str, float]:
    """Seconds for one call of each kind.

    Args:
        runs: Runs of each.
        levels: Levels of controls of the reachable sets.

    Returns:
        The medians by name.
    """
    return {
        **single_rows(runs),
        **reach_rows(runs, levels),
        **strike_rows(runs),
        **hold_rows(runs),
        **command_rows(runs),
    }


def piece_rows(count: int, runs: int) -> dict[str, float]:
    """Seconds for each configuration in the parts of a check."""
    foot, branch = Foot.preset("parrot"), Branch(0.008, (0.0, 0.0, -0.0097))
    controls = np.random.default_rng(0).uniform(size=(count, foot.phalanx_count))
    model, bones = FootModel(foot), forward_kinematics(foot, controls)
    works: dict[str, Callable[[], object]] = {
        "exact clearances of given bones": lambda: branch_clearance(
            bones, foot.radii, branch
        ),
        "FootModel, through Pinocchio": lambda: model.forward(controls),
    }
    return {name: seconds(work, runs) / count for name, work in works.items()}


def single_rows(runs: int) -> dict[str, float]:
    """Seconds for one call."""
    foot = Foot.preset("parrot")
    placed = Branch(0.008, (0.0, 0.0, -0.0097))
    return {
        "to_urdf": seconds(lambda: to_urdf(foot), runs),
        "plan_perch at a height": seconds(lambda: plan_perch(foot, placed), runs),
        "plan_perch, height searched": seconds(
            lambda: plan_perch(foot, placed, find_height=True), runs
        ),
    }


def reach_rows(runs: int, levels: int) -> dict[str, float]:
    """Seconds for reachable sets: the golden mean, ω = π/6."""
    rho, omega = (1 + 5**0.5) / 2, np.pi / 6
    count = levels**4
    system = ControlSystem(rho, omega, 33)
    rng = np.random.default_rng(0)
    targets = 1.6 * rng.random(50) - 1.2j * rng.random(50)
    asked = seconds(
        lambda: [find_word(x, system, 5, tolerance=1e-3) for x in targets], runs
    )
    return {
        f"np.full of {count} complex numbers": seconds(
            lambda: np.full(count, 1j), runs
        ),
        f"reachable_set, {levels} levels, depth 4": seconds(
            lambda: reachable_set(rho, omega, levels, 4), runs
        ),
        "find_word, 33 levels, depth 5, mean": asked / len(targets),
        f"raster of R∞, 33 levels, {32 * levels} px": seconds(
            lambda: raster(system, pixels=32 * levels), min(runs, 3)
        ),
    }


def strike_rows(runs: int) -> dict[str, float]:
    """Seconds for an owl's strike at targets of several shapes."""
    owl, corners = Foot.preset("owl"), np.array([*product((-0.015, 0.015), repeat=3)])
    targets: dict[str, Obstacle] = {
        "sphere": Sphere(0.015, (0, 0, 0)),
        "branch": Branch(0.015, (0, 0, 0)),
        "capsule": Capsule(0.015, [(0, -0.01, 0), (0, 0.01, 0)]),
        "box": Box((0.03, 0.03, 0.03), (0, 0, 0)),
        "mesh": ConvexMesh(corners),
    }
    flight = Attack().flight(owl, radius=0.03)
    return {
        f"simulate_strike, {name}": seconds(
            partial(simulate_strike, owl, target, flight), runs
        )
        for name, target in targets.items()
    }


def hold_rows(runs: int) -> dict[str, float]:
    """Seconds for what friction makes of one perch."""
    plan = plan_perch(Foot.preset("parrot"), Branch(0.008, (0.0, 0.0, -0.0097)))
    contacts, firm = branch_contacts(plan.report), Strength(0.2, Friction())
    works: dict[str, Callable[[], object]] = {
        "force_closure": partial(force_closure, contacts, firm.friction),
        "closure_quality": partial(closure_quality, contacts, firm.friction),
        "least_friction": partial(least_friction, contacts),
        "pull_limit": partial(pull_limit, contacts, firm, (0.0, 0.0, 1.0)),
        "tilt_limit": partial(tilt_limit, contacts, firm, 0.04, (0.0, 0.0, 0.03)),
    }
    return {name: seconds(work, runs) for name, work in works.items()}


def command_rows(runs: int) -> dict[str, float]:
    """Seconds for a command from a cold start."""
    zeros = ",".join("0" * 14)
    where = ("--radius-mm", "8", "--height-mm", "-9.7")
    commands = {
        "zygopin --help": ("--help",),
        "zygopin check": ("check", *where, "--controls", zeros, "--json"),
        "zygopin perch": ("perch", "--radius-mm", "8", "--json"),
        "zygopin strike": ("strike", "--preset", "owl", "--prey-radius-mm", "15"),
    }
    start = (sys.executable, "-m", "zygopin")
    return {
        name: seconds(
            partial(subprocess.run, [*start, *words], capture_output=True, check=False),
            runs,
        )
        for name, words in commands.items()
    }
