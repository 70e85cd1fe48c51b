"""Forward kinematics and grasp checks by MuJoCo."""

from __future__ import annotations

from collections.abc import Callable

import mujoco as mj
import numpy as np

from bench.checking import Checking
from bench.pinocchio_foot import REACH, Check, each, stem_pose
from bench.posing import Posing
from zygopin import names, to_mjcf
from zygopin.clearance import Floats


class MujocoFoot:
    """The foot in MuJoCo, from zygopin's MJCF.

    Args:
        job: The job.
        spec: The model's description, if there is more in it than the foot.

    Attributes:
        model: The model.
        data: Its data.
        q: Configurations [rad], shape (N, P).
    """

    def __init__(self, job: Posing, spec: mj.MjSpec | None = None) -> None:
        spec = spec or mj.MjSpec.from_string(to_mjcf(job.foot))
        self.model = spec.compile()
        self.data = mj.MjData(self.model)
        order = [self.model.joint(i).name for i in range(self.model.njnt)]
        self.q = job.angles(order)
        tips = {names.tip_link(finger) for finger in job.foot.fingers}
        tip = np.array([link in tips for link in job.links])
        self.phalanges, self._tips = np.flatnonzero(~tip), np.flatnonzero(tip)
        bodies = [self.model.body(job.links[i]).id for i in self.phalanges]
        sites = [self.model.site(job.links[i]).id for i in self._tips]
        self._bodies, self._sites = np.array(bodies), np.array(sites)
        self._qpos = self.data.qpos
        self._xpos, self._site_xpos = self.data.xpos, self.data.site_xpos

    def move(self, row: Floats, points: Floats) -> None:
        """Take a configuration, and write where its junctions are, (P + F, 3)."""
        self._qpos[:] = row
        mj.mj_kinematics(self.model, self.data)
        points[self.phalanges] = self._xpos[self._bodies]
        points[self._tips] = self._site_xpos[self._sites]


def forward(job: Posing) -> Callable[[], Floats]:
    """`mj_kinematics` for each row; bodies and, for the tips, sites are read."""
    made, room = MujocoFoot(job), job.room()

    def whole() -> Floats:
        for row, out in zip(made.q, room, strict=True):
            made.move(row, out)
        return room

    return whole


def distances(job: Checking) -> Check:
    """`mj_kinematics`, then `mj_geomDistance` of each phalanx and the branch."""
    spec = mj.MjSpec.from_string(to_mjcf(job.foot))
    quaternion, (turn, centre) = np.zeros(4), stem_pose(job.branch)
    mj.mju_mat2Quat(quaternion, turn.ravel())
    spec.worldbody.add_geom(
        name="branch",
        type=mj.mjtGeom.mjGEOM_CAPSULE,
        size=[float(job.branch.radius), REACH * job.foot.size, 0],
        pos=centre,
        quat=quaternion,
    )
    made, posing = MujocoFoot(job.posing, spec), job.posing
    model, data, far = made.model, made.data, 10 * job.foot.size
    bones = [model.geom(posing.links[i]).id for i in made.phalanges]
    wood, distance = model.geom("branch").id, mj.mj_geomDistance

    def measure(row: Floats, out: Floats, junctions: Floats) -> None:
        made.move(row, junctions.reshape(-1, 3))
        out[:] = [distance(model, data, bone, wood, far, None) for bone in bones]

    return each(job, made.q, measure)
