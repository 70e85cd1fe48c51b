"""Grasp checks by Pinocchio and python-fcl."""

from __future__ import annotations

from typing import Any

import fcl
import numpy as np

from bench.checking import Checking, decided
from bench.pinocchio_foot import REACH, Check, PinocchioFoot, each, stem_pose
from zygopin import Branch
from zygopin.clearance import Floats


def as_written(job: Checking) -> Check:
    """Objects, request and result made anew for each query, as in its README."""
    made, foot = PinocchioFoot(job), job.foot
    wood = _wood(job, job.branch)

    def measure(row: Floats, out: Floats, junctions: Floats) -> None:
        made.move(row, junctions)
        for k, middle in enumerate(made.middles):
            shape = fcl.Capsule(foot.radii[k], foot.lengths[k])
            place = fcl.Transform(middle.rotation, middle.translation)
            bone = fcl.CollisionObject(shape, place)
            request, result = fcl.DistanceRequest(), fcl.DistanceResult()
            out[k] = fcl.distance(bone, wood, request, result)

    return each(job, made.q, measure)


def at_best(job: Checking) -> Check:
    """Objects that are moved, by their setters, and no request."""
    made, wood = PinocchioFoot(job), _wood(job, job.branch)
    solids = _bones(job)
    moves = [
        (solid.setRotation, solid.setTranslation, middle.rotation, middle.translation)
        for solid, middle in zip(solids, made.middles, strict=True)
    ]
    distance = fcl.distance

    def measure(row: Floats, out: Floats, junctions: Floats) -> None:
        made.move(row, junctions)
        for turn, shift, rotation, translation in moves:
            turn(rotation)
            shift(translation)
        out[:] = [distance(solid, wood) for solid in solids]

    return each(job, made.q, measure)


def many_branches(job: Checking) -> Check:
    """One pose, whose bones stay; a new capsule for each branch."""
    made, junctions = PinocchioFoot(job), job.posing.room()
    made.move(made.q[0], junctions.reshape(-1))
    solids = _bones(job)
    for solid, middle in zip(solids, made.middles, strict=True):
        solid.setTransform(fcl.Transform(middle.rotation, middle.translation))
    room = np.empty((job.count, job.foot.phalanx_count))
    branches = [job.branch[i] for i in range(job.count)]
    poses = [(float(branch.radius), *stem_pose(branch)) for branch in branches]
    length = 2 * REACH * job.foot.size

    def check() -> Any:  # noqa: ANN401
        for out, (radius, turn, place) in zip(room, poses, strict=True):
            stem = fcl.Capsule(radius, length)
            wood = fcl.CollisionObject(stem, fcl.Transform(turn, place))
            out[:] = [fcl.distance(solid, wood) for solid in solids]
        return decided(job, junctions, room)

    return check


def _bones(job: Checking) -> list[Any]:
    """Capsules of the phalanges."""
    shapes = map(fcl.Capsule, job.foot.radii, job.foot.lengths)
    return [*map(fcl.CollisionObject, shapes)]


def _wood(job: Checking, branch: Branch) -> Any:  # noqa: ANN401
    """The capsule that stands for a branch."""
    stem = fcl.Capsule(float(branch.radius), 2 * REACH * job.foot.size)
    return fcl.CollisionObject(stem, fcl.Transform(*stem_pose(branch)))
