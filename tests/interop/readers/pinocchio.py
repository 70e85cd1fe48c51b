"""Pinocchio with coal, the reference of the others."""

import re
from pathlib import Path

import coal
import numpy as np
import pinocchio as pin


class Robot:
    def __init__(self, case):
        text = Path(case["urdf"]).read_text()
        self.case = case
        self.model = pin.buildModelFromXML(text, mimic=True)
        self.shapes_ = pin.buildGeomFromUrdfString(
            self.model, text, pin.GeometryType.COLLISION
        )
        self.data = self.model.createData()
        branch = case["branch"]
        place = pin.SE3(np.array(branch["rotation"]), np.array(branch["centre"]))
        shape = coal.Capsule(branch["radius"], branch["length"])
        self.shapes_.addGeometryObject(pin.GeometryObject("branch", 0, place, shape))

    def _configuration(self, angles):
        q = pin.neutral(self.model)
        for name, angle in angles.items():
            joint = self.model.getJointId(name)
            if self.model.joints[joint].shortname() != "JointModelMimic":
                q[self.model.idx_qs[joint]] = angle
        return q

    def poses(self, angles):
        pin.framesForwardKinematics(self.model, self.data, self._configuration(angles))
        tips = self.case["tips"]
        frames = [self.model.getFrameId(tip, pin.FrameType.BODY) for tip in tips]
        return {
            tip: self.data.oMf[frame].homogeneous
            for tip, frame in zip(tips, frames, strict=True)
        }

    def mass(self):
        return pin.computeTotalMass(self.model)

    def centre(self, angles):
        return pin.centerOfMass(self.model, self.data, self._configuration(angles))

    def limits(self):
        low, high = self.model.lowerPositionLimit, self.model.upperPositionLimit
        return {
            name: (low[self.model.idx_qs[joint]], high[self.model.idx_qs[joint]])
            for joint, name in enumerate(self.model.names)
            if self.model.nqs[joint] and self.model.nvs[joint]
        }

    def shapes(self):
        return self.shapes_.ngeoms - 1

    def distances(self, angles, pairs):
        for first, second in pairs:
            for i in self._of(first):
                for j in self._of(second):
                    self.shapes_.addCollisionPair(pin.CollisionPair(i, j))
        q, data = self._configuration(angles), pin.GeometryData(self.shapes_)
        pin.computeDistances(self.model, self.data, self.shapes_, data, q)
        found, results = [], iter(data.distanceResults)
        for first, second in pairs:
            count = len(self._of(first)) * len(self._of(second))
            found.append(min(next(results).min_distance for _ in range(count)))
        self.shapes_.removeAllCollisionPairs()
        return found

    def _of(self, link):
        """Indices of a link's shapes, which are named after it."""
        names = [shape.name for shape in self.shapes_.geometryObjects]
        return [
            k for k, name in enumerate(names) if re.fullmatch(rf"{link}(_\d+)?", name)
        ]
