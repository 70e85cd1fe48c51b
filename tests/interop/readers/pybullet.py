"""PyBullet, without a window; distances at a thousand times the size.

Bullet's tolerances and margins are made for things of a metre, and it makes a hull of
32 sides of a cylinder unless told to keep it.
"""

import numpy as np
import pybullet as bullet
from scipy.spatial.transform import Rotation

SCALE = 1000.0
"""What globalScaling makes of a metre where distances are measured."""

FLAGS = bullet.URDF_USE_INERTIA_FROM_FILE | bullet.URDF_USE_IMPLICIT_CYLINDER
FAR = 1e6


class Robot:
    def __init__(self, case):
        self.case = case
        if bullet.isConnected():
            bullet.resetSimulation()
        else:
            bullet.connect(bullet.DIRECT)
        self.body, self.large = (
            bullet.loadURDF(
                case["urdf"], useFixedBase=True, flags=FLAGS, globalScaling=scale
            )
            for scale in (1.0, SCALE)
        )
        infos = [*map(self._info, range(bullet.getNumJoints(self.body)))]
        self.joints = {info[1].decode(): info[0] for info in infos}
        self.indices = {info[12].decode(): info[0] for info in infos}
        self.branch = self._branch()

    def _info(self, index):
        return bullet.getJointInfo(self.body, index)

    def _move(self, angles):
        for body in (self.body, self.large):
            for name in self.case["joints"]:
                angle = angles.get(name, 0.0)
                bullet.resetJointState(body, self.joints[name], angle)

    def poses(self, angles):
        self._move(angles)
        return {tip: self._pose(self.indices[tip]) for tip in self.case["tips"]}

    def _pose(self, link):
        state = bullet.getLinkState(self.body, link, computeForwardKinematics=True)
        pose = np.eye(4)
        pose[:3, 3] = state[4]
        pose[:3, :3] = np.reshape(bullet.getMatrixFromQuaternion(state[5]), (3, 3))
        return pose

    def _masses(self):
        """Mass of each link, the base first."""
        links = (-1, *self.indices.values())
        return [bullet.getDynamicsInfo(self.body, link)[0] for link in links]

    def mass(self):
        return sum(self._masses())

    def centre(self, angles):
        self._move(angles)
        links = [*self.indices.values()]
        states = bullet.getLinkStates(self.body, links, computeForwardKinematics=True)
        centres = [bullet.getBasePositionAndOrientation(self.body)[0]]
        centres += [state[0] for state in states]
        return np.average(centres, axis=0, weights=self._masses())

    def limits(self):
        joints = self.case["joints"]
        return {name: self._info(self.joints[name])[8:10] for name in joints}

    def shapes(self):
        links = (-1, *self.indices.values())
        return sum(len(bullet.getCollisionShapeData(self.body, i)) for i in links)

    def distances(self, angles, pairs):
        self._move(angles)
        found = []
        for first, second in pairs:
            wood = second == "branch"
            other = (self.branch, -1) if wood else (self.large, self.indices[second])
            points = bullet.getClosestPoints(
                *(self.large, other[0], FAR),
                linkIndexA=self.indices[first],
                linkIndexB=other[1],
            )
            found.append(min(point[8] for point in points) / SCALE)
        return found

    def _branch(self):
        branch = self.case["branch"]
        sizes = {key: SCALE * branch[key] for key in ("radius", "length")}
        shape = bullet.createCollisionShape(
            bullet.GEOM_CAPSULE, radius=sizes["radius"], height=sizes["length"]
        )
        body = bullet.createMultiBody(0, shape)
        turn = Rotation.from_matrix(branch["rotation"]).as_quat().tolist()
        centre = [SCALE * x for x in branch["centre"]]
        bullet.resetBasePositionAndOrientation(body, centre, turn)
        return body
