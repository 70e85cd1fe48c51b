"""Grasp checks: zygopin's own ways, and the other tools'.

Each tool poses the foot, measures 14 clearances between capsules, which it does to
rounding, and decides by `checking.decided`. Whether fingers collide with each other,
which zygopin decides as well, is asked of coal in a row of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from importlib import import_module

from bench.checking import Answer, Checking, of_verdicts
from bench.peer import Peer, cores
from zygopin import check_grasp, grasp_verdicts, make_engine
from zygopin.compiler import BatchName

Check = Callable[[], Answer]
Checker = Peer[Checking, Answer]

POSED = "FK by Pinocchio, 14 distances, verdict"


def verdicts(engine: BatchName, threads: int | None) -> Callable[[Checking], Check]:
    """Zygopin's verdicts alone, by an engine that takes many cases at once."""

    def make(job: Checking) -> Check:
        case = job.foot, job.controls, job.branch
        return lambda: of_verdicts(
            grasp_verdicts(*case, engine=engine, threads=threads)
        )

    return make


def report(engine: str) -> Callable[[Checking], Check]:
    """Zygopin's whole report, by an engine that is ready."""

    def make(job: Checking) -> Check:
        made = make_engine(engine, job.foot)

        def check() -> Answer:
            found = check_grasp(job.foot, job.controls, job.branch, engine=made)
            verdicts = of_verdicts(found)
            return Answer(
                clearance=found.clearance,
                stable=verdicts.stable,
                grasping=verdicts.grasping,
                feasible=verdicts.feasible,
            )

        return check

    return make


def other(module: str, name: str) -> Callable[[Checking], Check]:
    """A way of another tool, which is imported only where it is used."""
    return lambda job: getattr(import_module(f"bench.{module}"), name)(job)


NUMBA = ("numba",)

VERDICTS: tuple[Checker, ...] = (
    Checker(
        "zygopin, verdicts, fast",
        "grasp_verdicts: FK, 14 clearances, fingers, all verdicts; engine fast",
        verdicts("fast", None),
        packages=NUMBA,
        threads=cores(),
    ),
    Checker(
        "zygopin, verdicts, fast, one thread",
        "the same on one thread",
        verdicts("fast", 1),
        packages=NUMBA,
    ),
    Checker(
        "zygopin, verdicts",
        "the same by the engine exact, which needs NumPy alone",
        verdicts("exact", None),
        threads=cores(),
    ),
    Checker(
        "zygopin, verdicts, one thread",
        "the same on one thread",
        verdicts("exact", 1),
    ),
)
"""Zygopin's verdicts alone; the first is what all others are held against."""

OWN: tuple[Checker, ...] = (
    *VERDICTS,
    Checker(
        "zygopin, check_grasp, fast",
        "the same with the evidence: points, normals, products; engine fast",
        report("fast"),
        packages=NUMBA,
        share=1 / 4,
    ),
    Checker(
        "zygopin, check_grasp",
        "the same by the engine exact",
        report("exact"),
        share=1 / 4,
    ),
    Checker(
        "zygopin, check_grasp by FCL",
        "the same through the URDF, Pinocchio and FCL",
        report("fcl"),
        share=1 / 100,
    ),
)
"""Zygopin's own."""

FCL = ("pin", "python-fcl")
COAL = ("pin", "coal")

PEERS: tuple[Checker, ...] = (
    Checker(
        "python-fcl, as written",
        f"{POSED}; objects, request and result made for each",
        other("fcl_peers", "as_written"),
        packages=FCL,
        share=1 / 100,
    ),
    Checker(
        "python-fcl, at its best",
        f"{POSED}; objects moved by setters, no request",
        other("fcl_peers", "at_best"),
        packages=FCL,
        share=1 / 100,
    ),
    Checker(
        "coal, distances",
        f"{POSED}; computeDistances without nearest points",
        other("coal_peers", "distances"),
        packages=COAL,
        share=1 / 20,
    ),
    Checker(
        "coal, distances and fingers",
        "the same with the 65 pairs of phalanges of different fingers",
        other("coal_peers", "whole"),
        packages=COAL,
        share=1 / 40,
    ),
    Checker(
        "coal, collisions in parallel",
        "less work: computeCollisionsInParallel, does anything penetrate the branch",
        other("coal_peers", "collisions"),
        packages=COAL,
        share=1 / 4,
        threads=cores(),
    ),
    Checker(
        "MuJoCo, mj_geomDistance",
        "mj_kinematics, 14 distances, verdict",
        other("mujoco_peer", "distances"),
        packages=("mujoco",),
        share=1 / 40,
    ),
)
"""Other tools on many poses and one branch."""

SINGLE_PEERS = tuple(peer for peer in PEERS if peer.threads == 1)
"""Other tools on one pose and one branch: nothing to share between threads."""

BRANCH_PEERS: tuple[Checker, ...] = (
    Checker(
        "python-fcl, at its best",
        "14 distances to a new capsule for each branch, verdict",
        other("fcl_peers", "many_branches"),
        packages=FCL,
        share=1 / 40,
    ),
    Checker(
        "coal, distances",
        "coal.distance of 14 capsules to one that is moved, verdict",
        other("coal_peers", "many_branches"),
        packages=COAL,
        share=1 / 20,
    ),
)
"""Other tools on one pose and many branches."""
