"""The work that zygopin and its peers share: one foot, its poses, its branches."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from bench import grasp_peers, kinematics_peers
from bench.checking import Answer, Checking, compare
from bench.peer import check
from bench.posing import Posing
from bench.suite import Suite
from zygopin import Branch, Foot, forward_kinematics, plan_perch
from zygopin.clearance import Floats

PRESET, RADIUS, CENTRE = "parrot", 0.008, (0.0, 0.0, -0.0097)

NOISE = 1e-9
"""Change of a control that keeps a touch: it moves a toe by a thousandth of the contact
tolerance."""

KINEMATICS, RANDOM, TOUCHING, BRANCHES, SINGLE = (
    "forward kinematics",
    "grasp checks, random poses",
    "grasp checks, poses that touch",
    "grasp checks, one pose on many branches",
    "one grasp check",
)


def kinematics(count: int, *, compiling: bool = True) -> list[Suite[Any, Any]]:
    """Forward kinematics of many random control sequences.

    Args:
        count: How many.
        compiling: Whether peers may take part that a compiler has to make first.

    Returns:
        The one suite.
    """
    foot = Foot.preset(PRESET)
    job = Posing(foot, _controls(foot, count))
    made, ready = kinematics_peers.COMPILED, kinematics_peers.PEERS
    peers = (*made, *ready) if compiling else ready
    return [Suite(KINEMATICS, job, kinematics_peers.OWN, peers, same_bones)]


def checks(count: int) -> list[Suite[Any, Any]]:
    """Grasp checks of several kinds."""
    foot, branch = Foot.preset(PRESET), Branch(RADIUS, CENTRE)
    perched = plan_perch(foot, branch).controls
    shaken = perched + np.random.default_rng(1).uniform(
        -NOISE, NOISE, (count, foot.phalanx_count)
    )
    touching = Checking(foot, np.clip(shaken, 0, 1), branch)
    kinds = {
        RANDOM: Checking(foot, _controls(foot, count), branch),
        TOUCHING: touching,
    }
    found = [
        Suite(part, job, grasp_peers.OWN, grasp_peers.PEERS, same_verdicts)
        for part, job in kinds.items()
    ]
    many = Checking(foot, perched, _branches(foot, count))
    for part, job, peers in (
        (BRANCHES, many, grasp_peers.BRANCH_PEERS),
        (SINGLE, touching.few(1), grasp_peers.SINGLE_PEERS),
    ):
        found.append(Suite(part, job, grasp_peers.OWN, peers, same_verdicts))
    return found


def same_bones(
    name: str, job: Posing, answer: Floats | Callable[[], Floats], tolerance: float
) -> str:
    """Hold bones, or the junctions between them, against zygopin's."""
    given = answer() if callable(answer) else answer
    bones = given if given.ndim == 4 else job.bones(given)  # else (N, P + F, 3)
    right = forward_kinematics(job.foot, job.controls)
    apart = float(np.abs(bones - right).max()) / job.foot.size
    check(name, apart, tolerance)
    return f"bones within {apart:.0e} of the foot's size"


def same_verdicts(name: str, job: Checking, answer: Answer, tolerance: float) -> str:
    """Hold verdicts, and clearances where there are any, against zygopin's."""
    left = compare(name, job, answer, tolerance)
    return f"{job.count - left} of {job.count} verdicts compared, all alike"


def _controls(foot: Foot, count: int) -> Floats:
    """Random control sequences."""
    return np.random.default_rng(0).uniform(size=(count, foot.phalanx_count))


def _branches(foot: Foot, count: int) -> Branch:
    """Branches of many radii and directions that touch the base from below."""
    rng = np.random.default_rng(2)
    radius = rng.uniform(0.05, 0.4, count) * foot.size
    axis = np.stack([rng.uniform(-0.3, 0.3, count), np.ones(count), np.zeros(count)], 1)
    centre = np.zeros((count, 3))
    centre[:, 2] = -radius - foot.thickness
    return Branch(radius, centre, axis)
