"""Grasp checks by Pinocchio and coal."""

from __future__ import annotations

from functools import partial
from typing import Any

import coal
import numpy as np
import pinocchio as pin

from bench.checking import Answer, Checking, decided
from bench.peer import cores
from bench.pinocchio_foot import REACH, Check, PinocchioFoot, each, stem_pose
from zygopin.clearance import Floats
from zygopin.grasp import finger_pairs


def distances(job: Checking, *, fingers: bool = False) -> Check:
    """`computeDistances` of all pairs, without nearest points.

    Args:
        job: The job.
        fingers: Whether phalanges of different fingers are pairs, too.

    Returns:
        The check.
    """
    made = PinocchioFoot(job)
    shapes = _shapes(job, made, fingers=fingers)
    tables = pin.GeometryData(shapes)
    for request in tables.distanceRequests:
        request.enable_nearest_points = False
    count = len(shapes.collisionPairs)
    records = [tables.distanceResults[i] for i in range(count)]
    model, data = made.model, made.data

    def measure(row: Floats, out: Floats, junctions: Floats) -> None:
        pin.computeDistances(model, data, shapes, tables, row)
        pin.updateFramePlacements(model, data)
        made.read(junctions)
        out[:] = [record.min_distance for record in records]

    return each(job, made.q, measure, count - job.foot.phalanx_count)


whole = partial(distances, fingers=True)


def collisions(job: Checking) -> Check:
    """`computeCollisionsInParallel`: does any phalanx penetrate the branch."""
    made, threads = PinocchioFoot(job), cores()
    shapes = _shapes(job, made, fingers=False)
    # Thinner by the tolerance, since a touch is none.
    shapes.geometryObjects[job.foot.phalanx_count].geometry.radius -= job.tolerance
    pool = pin.GeometryPool(made.model, shapes, threads)
    q = np.asfortranarray(made.q.T)

    def check() -> Answer:
        hits = pin.computeCollisionsInParallel(threads, pool, q, True)
        return Answer(clear=~np.asarray(hits, dtype=bool))

    return check


def many_branches(job: Checking) -> Check:
    """One pose, whose bones stay; `coal.distance` to a capsule that is moved."""
    made, junctions = PinocchioFoot(job), job.posing.room()
    made.move(made.q[0], junctions.reshape(-1))
    bones = [*map(coal.Capsule, job.foot.radii, job.foot.lengths)]
    places = [coal.Transform3s(m.rotation, m.translation) for m in made.middles]
    solids = [*zip(bones, places, strict=True)]
    branches = [job.branch[i] for i in range(job.count)]
    poses = [
        (float(branch.radius), coal.Transform3s(*stem_pose(branch)))
        for branch in branches
    ]
    room = np.empty((job.count, job.foot.phalanx_count))
    stem = coal.Capsule(1.0, 2 * REACH * job.foot.size)
    request, result = coal.DistanceRequest(), coal.DistanceResult()

    def check() -> Answer:
        for out, (radius, pose) in zip(room, poses, strict=True):
            stem.radius = radius
            for k, (bone, place) in enumerate(solids):
                result.clear()
                out[k] = coal.distance(bone, place, stem, pose, request, result)
        return decided(job, junctions, room)

    return check


def _shapes(job: Checking, made: PinocchioFoot, *, fingers: bool) -> Any:  # noqa: ANN401
    """Capsules on the phalanges and one for the branch, and the pairs to measure."""
    foot, shapes = job.foot, pin.GeometryModel()
    for k, frame in enumerate(made.frames):
        middle = made.model.frames[frame]
        bone = coal.Capsule(foot.radii[k], foot.lengths[k])
        joint, place = middle.parentJoint, middle.placement
        shapes.addGeometryObject(
            pin.GeometryObject(f"bone{k}", joint, frame, place, bone)
        )
    stem = coal.Capsule(float(job.branch.radius), 2 * REACH * foot.size)
    pose = pin.SE3(*stem_pose(job.branch))
    wood = shapes.addGeometryObject(pin.GeometryObject("branch", 0, 0, pose, stem))
    for k in range(foot.phalanx_count):
        shapes.addCollisionPair(pin.CollisionPair(k, wood))
    for i, j in zip(*finger_pairs(foot), strict=True) if fingers else ():
        shapes.addCollisionPair(pin.CollisionPair(int(i), int(j)))
    return shapes
