"""MuJoCo: its URDF reader as it comes, which fuses fixed tips into their phalanges.

A site that is put into each tip before the model is compiled moves along with it.
"""

import mujoco
import numpy as np


class Robot:
    def __init__(self, case):
        self.case = case
        spec = mujoco.MjSpec.from_file(case["urdf"])
        for tip in case["tips"]:
            spec.body(tip).add_site(name=tip)
        branch = case["branch"]
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.ravel(branch["rotation"]))
        spec.worldbody.add_geom(
            name="branch",
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            size=[branch["radius"], branch["length"] / 2, 0],
            pos=branch["centre"],
            quat=quaternion,
        )
        self.model = spec.compile()
        self.data = mujoco.MjData(self.model)

    def _move(self, angles):
        self.data.qpos[:] = 0.0
        for name, angle in angles.items():
            self.data.joint(name).qpos[0] = angle
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_comPos(self.model, self.data)

    def poses(self, angles):
        self._move(angles)
        return {tip: self._pose(tip) for tip in self.case["tips"]}

    def _pose(self, tip):
        pose = np.eye(4)
        pose[:3, :3] = self.data.site(tip).xmat.reshape(3, 3)
        pose[:3, 3] = self.data.site(tip).xpos
        return pose

    def mass(self):
        return float(self.model.body_mass.sum())

    def centre(self, angles):
        self._move(angles)
        return self.data.subtree_com[0]

    def limits(self):
        return {
            self.model.joint(i).name: self.model.joint(i).range.tolist()
            for i in range(self.model.njnt)
        }

    def shapes(self):
        return self.model.ngeom - 1

    def constraints(self):
        found = {}
        for i in range(self.model.neq):
            assert self.model.eq_type[i] == mujoco.mjtEq.mjEQ_JOINT
            assert not self.model.eq_data[i, 2:5].any()
            offset, multiplier = self.model.eq_data[i, :2].tolist()
            follower = self.model.joint(self.model.eq_obj1id[i]).name
            leader = self.model.joint(self.model.eq_obj2id[i]).name
            found[follower] = leader, multiplier, offset
        return found

    def distances(self, angles, pairs):
        self._move(angles)
        return [
            min(
                mujoco.mj_geomDistance(self.model, self.data, i, j, 1e3, None)
                for i in self._geoms(first)
                for j in self._geoms(second)
            )
            for first, second in pairs
        ]

    def _geoms(self, link):
        if link == "branch":
            return [self.model.geom("branch").id]
        body = self.model.body(link).id
        return np.flatnonzero(self.model.geom_bodyid == body).tolist()
