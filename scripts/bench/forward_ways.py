"""Forward kinematics by other tools: each writes the junctions of all 14 bones.

A job is a foot with control sequences. The answer is the points where phalanges begin
and the tips, in the order of `names.bone_links`: the start and the end of every bone.
Each tool is used as its documentation shows, at its best from Python, and reads
zygopin's own URDF or MJCF.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable
from itertools import chain
from typing import Any

import numpy as np

from bench.pinocchio_loop import PinocchioLoop
from bench.posing import Posing
from zygopin import names
from zygopin.clearance import Floats

Forward = Callable[[], Floats]


def pinocchio(job: Posing) -> Forward:
    """Pinocchio: `forwardKinematics` for each row, Data used again, views are read."""
    import pinocchio as pin

    model = pin.buildModelFromXML(job.urdf)
    data, q, room = model.createData(), job.angles([*model.names][1:]), job.room()
    frames = [model.getFrameId(link, pin.FrameType.BODY) for link in job.links]
    views = [data.oMf[frame].translation for frame in frames]
    rows = room.reshape(len(q), -1)

    def forward() -> Floats:
        for row, out in zip(q, rows, strict=True):
            pin.framesForwardKinematics(model, data, row)
            np.concatenate(views, out=out)
        return room

    return forward


def mujoco(job: Posing) -> Forward:
    """MuJoCo: `mj_kinematics` of the MJCF."""
    from bench import mujoco_peer

    return mujoco_peer.forward(job)


def pybullet(job: Posing) -> Forward:
    """PyBullet, DIRECT: joints are reset together, link states asked for together."""
    import pybullet as bullet

    client = bullet.connect(bullet.DIRECT)
    with tempfile.TemporaryDirectory() as folder:
        body = bullet.loadURDF(
            job.file(folder), useFixedBase=True, physicsClientId=client
        )
    infos = [
        bullet.getJointInfo(body, i, physicsClientId=client)
        for i in range(bullet.getNumJoints(body, physicsClientId=client))
    ]
    moving = [info for info in infos if info[2] == bullet.JOINT_REVOLUTE]
    indices = [info[0] for info in moving]
    q = job.angles([info[1].decode() for info in moving])[:, :, None].tolist()
    index = {info[12].decode(): info[0] for info in infos}
    links, room = [index[link] for link in job.links], job.room()

    def forward() -> Floats:
        for row, out in zip(q, room, strict=True):
            bullet.resetJointStatesMultiDof(body, indices, row, physicsClientId=client)
            states = bullet.getLinkStates(
                body, links, computeForwardKinematics=1, physicsClientId=client
            )
            out[:] = [state[4] for state in states]
        return room

    return forward


def drake(job: Posing) -> Forward:
    """Drake: MultibodyPlant with one context; the bodies' poses are read."""
    from pydrake.multibody.parsing import Parser
    from pydrake.multibody.plant import MultibodyPlant

    plant = MultibodyPlant(0.0)
    Parser(plant).AddModelsFromString(job.urdf, "urdf")
    plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(names.BASE))
    plant.Finalize()
    context, room = plant.CreateDefaultContext(), job.room()
    place = {name: plant.GetJointByName(name).position_start() for name in job.joints}
    q = job.angles(sorted(place, key=place.__getitem__))
    bodies = [plant.GetBodyByName(link) for link in job.links]

    def forward() -> Floats:
        for row, out in zip(q, room, strict=True):
            plant.SetPositions(context, row)
            for point, body in zip(out, bodies, strict=True):
                point[:] = body.EvalPoseInWorld(context).translation()
        return room

    return forward


def pytorch_kinematics(job: Posing) -> Forward:
    """pytorch-kinematics: one batch in doubles, without gradients."""
    import pytorch_kinematics as pk
    import torch

    torch.set_num_threads(1)  # with more it takes longer, here up to ten times
    tree = pk.build_chain_from_urdf(job.urdf).to(dtype=torch.float64)
    q = torch.from_numpy(job.angles(tree.get_joint_parameter_names()))

    def forward() -> Floats:
        with torch.no_grad():
            found = tree.forward_kinematics(q)
            parts = [found[link].get_matrix()[:, :3, 3] for link in job.links]
            points: Floats = torch.stack(parts, dim=1).numpy()
        return points

    return forward


def kinpy(job: Posing) -> Forward:
    """kinpy: `forward_kinematics` for each row; its transforms' positions are read."""
    import kinpy as kp

    tree = kp.build_chain_from_urdf(job.urdf)
    q, room = job.angles(tree.get_joint_parameter_names()).tolist(), job.room()

    def forward() -> Floats:
        for row, out in zip(q, room, strict=True):
            found = tree.forward_kinematics(row)
            out[:] = [found[link].pos for link in job.links]
        return room

    return forward


def ikpy(job: Posing) -> Forward:
    """ikpy: one chain for each finger, the frames of all its links."""
    from ikpy.chain import Chain

    chains = []
    with tempfile.TemporaryDirectory() as folder:
        file = job.file(folder)
        for finger in job.foot.fingers:
            links = [*names.phalanx_links(finger), names.tip_link(finger)]
            joints = [*names.flexion_joints(finger), f"{links[-1]}_joint"]
            path = [names.BASE, *chain.from_iterable(zip(joints, links, strict=True))]
            chains.append(Chain.from_urdf_file(file, base_elements=path))
    parts, q, room = job.foot.finger_slices.values(), job.angles(), job.room()

    def forward() -> Floats:
        for row, out in zip(q, room, strict=True):
            at = 0
            for tree, part in zip(chains, parts, strict=True):
                # One link before the first joint and one after the last stay.
                frames = tree.forward_kinematics(
                    [0.0, *row[part], 0.0], full_kinematics=True
                )
                for frame in frames[1:]:
                    out[at] = frame[:3, 3]
                    at += 1
        return room

    return forward


def yourdfpy(job: Posing) -> Forward:
    """yourdfpy: `update_cfg`, then `get_transform` of each link."""
    import yourdfpy as yd

    with tempfile.TemporaryDirectory() as folder:
        robot = yd.URDF.load(job.file(folder), load_meshes=False)
    q, room = job.angles([*robot.actuated_joint_names]), job.room()

    def forward() -> Floats:
        for row, out in zip(q, room, strict=True):
            robot.update_cfg(row)
            for point, link in zip(out, job.links, strict=True):
                point[:] = robot.get_transform(link, names.BASE)[:3, 3]
        return room

    return forward


def roboticstoolbox(job: Posing) -> Forward:
    """Robotics Toolbox: its compiled `fkine` of a whole batch, link after link."""
    from roboticstoolbox import Robot
    from roboticstoolbox.models.URDF.URDFRobot import URDF_file

    with tempfile.TemporaryDirectory() as folder:
        links, name, *_ = URDF_file(job.file(folder))
    robot: Any = Robot(links, name=name)
    moving = sorted((x for x in robot.links if x.isjoint), key=lambda x: x.jindex)
    q, room = job.angles([link._joint_name for link in moving]), job.room()
    paths = [robot.ets(end=link) for link in job.links]

    def forward() -> Floats:
        for column, path in enumerate(paths):
            room[:, column] = path.eval(q[:, path.jindices])[..., :3, 3]
        return room

    return forward


def loop(threads: int) -> Callable[[Posing], Forward]:
    """Pinocchio in C++, on so many threads: placements, and the junctions from them."""

    def make(job: Posing) -> Forward:
        made = PinocchioLoop(job.urdf, job.links)
        return made.points(job.angles(made.joints), threads)

    return make


def bare_loop(threads: int) -> Callable[[Posing], Callable[[], Forward]]:
    """Pinocchio in C++: placements alone; its answer is a function that reads them."""

    def make(job: Posing) -> Callable[[], Forward]:
        made = PinocchioLoop(job.urdf, job.links)
        q = job.angles(made.joints)
        place, read = made.placements(q, threads), made.points(q, threads)

        def whole() -> Forward:
            place()
            return read

        return whole

    return make
