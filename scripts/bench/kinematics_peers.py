"""Forward kinematics: zygopin's own, and the other tools'."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from bench import forward_ways as ways
from bench.peer import Peer, cores
from bench.pinocchio_loop import why_not
from bench.posing import Posing
from zygopin import forward_kinematics
from zygopin.clearance import Floats
from zygopin.compiler import BatchName

Forward = Callable[[], Floats]

Poser = Peer[Posing, Floats | Forward]

SINGLE = 1e-6
"""Difference over the foot's size that is allowed where floats of 32 bits come in."""


def closed_form(engine: BatchName, threads: int | None) -> Callable[[Posing], Forward]:
    """Zygopin's own, on so many threads."""

    def make(job: Posing) -> Forward:
        case = job.foot, job.controls
        return lambda: forward_kinematics(*case, engine=engine, threads=threads)

    return make


def reused(engine: BatchName) -> Callable[[Posing], Forward]:
    """Zygopin's own, written to one array again and again."""

    def make(job: Posing) -> Forward:
        room = np.empty((len(job.controls), job.foot.phalanx_count, 2, 3))
        case = job.foot, job.controls
        return lambda: forward_kinematics(*case, engine=engine, out=room)

    return make


def own(engine: BatchName, named: str, packages: tuple[str, ...]) -> Iterator[Poser]:
    """Zygopin's own, by one of its engines."""
    name = f"zygopin, forward kinematics{named}"
    for way, computes, make, threads in (
        ("", "14 bones in closed form", closed_form(engine, None), cores()),
        (", one thread", "the same on one thread", closed_form(engine, 1), 1),
        (
            ", memory reused",
            "the same on all cores, written to one array again and again",
            reused(engine),
            cores(),
        ),
    ):
        yield Poser(name + way, computes, make, packages=packages, threads=threads)


OWN: tuple[Poser, ...] = (*own("fast", ", fast", ("numba",)), *own("exact", "", ()))
"""Zygopin's own; the first that can run is what all others are held against."""

COMPILED: tuple[Poser, ...] = (
    Poser(
        "Pinocchio, C++ loop",
        "forwardKinematics and 18 points, compiled with -O3 around its own library",
        ways.loop(1),
        packages=("pin",),
        needs=why_not,
    ),
    Poser(
        "Pinocchio, C++ loop, nothing read",
        "less work: forwardKinematics alone, which leaves joint placements in Data",
        ways.bare_loop(1),
        packages=("pin",),
        needs=why_not,
    ),
    Poser(
        "Pinocchio, C++ loop, all cores",
        "the same on parts of the rows, each with its own Data",
        ways.loop(cores()),
        packages=("pin",),
        needs=why_not,
        threads=cores(),
    ),
)
"""Pinocchio without Python in between, which takes a compiler half a minute once."""

PEERS: tuple[Poser, ...] = (
    Poser(
        "Pinocchio, call by call",
        "framesForwardKinematics with one Data; 18 origins read as views",
        ways.pinocchio,
        packages=("pin",),
        share=1 / 5,
    ),
    Poser(
        "MuJoCo",
        "mj_kinematics; 14 bodies and 4 sites read",
        ways.mujoco,
        packages=("mujoco",),
        share=1 / 10,
    ),
    Poser(
        "PyBullet",
        "DIRECT: resetJointStatesMultiDof, getLinkStates of 18 links",
        ways.pybullet,
        packages=("pybullet",),
        share=1 / 25,
        tolerance=SINGLE,
    ),
    Poser(
        "Drake",
        "SetPositions, EvalPoseInWorld of 18 bodies",
        ways.drake,
        packages=("drake",),
        share=1 / 25,
    ),
    Poser(
        "pytorch-kinematics",
        "one batch, float64, no gradients; 18 matrices",
        ways.pytorch_kinematics,
        packages=("torch", "pytorch-kinematics"),
        share=1 / 25,
        tolerance=SINGLE,
    ),
    Poser(
        "kinpy",
        "forward_kinematics of the tree; 18 positions",
        ways.kinpy,
        packages=("kinpy",),
        share=1 / 400,
    ),
    Poser(
        "ikpy",
        "4 chains with full_kinematics; 18 frames",
        ways.ikpy,
        packages=("ikpy",),
        share=1 / 200,
    ),
    Poser(
        "yourdfpy",
        "update_cfg, get_transform of 18 links",
        ways.yourdfpy,
        packages=("yourdfpy",),
        share=1 / 800,
    ),
    Poser(
        "roboticstoolbox",
        "compiled ETS.eval of the whole batch for each of 18 links",
        ways.roboticstoolbox,
        packages=("roboticstoolbox-python",),
        share=1 / 10,
    ),
)
"""The other tools; which are installed is asked when they are timed."""
