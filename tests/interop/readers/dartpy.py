"""DART, by its bindings dartpy."""

import dartpy
import numpy as np

from readers.settled import mimics_seen

STEPS = 1000
"""Steps of a millisecond that a simulation takes to settle."""


class Robot:
    def __init__(self, case):
        self.case = case
        self.skeleton = self._load()

    def _load(self):
        options = dartpy.utils.DartLoaderOptions()
        options.mDefaultRootJointType = dartpy.utils.DartLoaderRootJointType.FIXED
        loader = dartpy.utils.DartLoader()
        loader.setOptions(options)
        return loader.parseSkeleton(self.case["urdf"])

    def _move(self, angles):
        for name in self.case["joints"]:
            self.skeleton.getJoint(name).setPosition(0, angles.get(name, 0.0))

    def poses(self, angles):
        self._move(angles)
        bodies = map(self.skeleton.getBodyNode, self.case["tips"])
        return {body.getName(): body.getWorldTransform().matrix() for body in bodies}

    def mass(self):
        return self.skeleton.getMass()

    def centre(self, angles):
        self._move(angles)
        return self.skeleton.getCOM()

    def limits(self):
        joints = map(self.skeleton.getJoint, self.case["joints"])
        return {
            joint.getName(): (
                joint.getPositionLowerLimit(0),
                joint.getPositionUpperLimit(0),
            )
            for joint in joints
        }

    def shapes(self):
        bodies = map(self.skeleton.getBodyNode, range(self.skeleton.getNumBodyNodes()))
        nodes = [node for body in bodies for node in body.getShapeNodes()]
        return sum(node.hasCollisionAspect() for node in nodes)

    def constraints(self):
        """Followers have actuators of the type MIMIC: what these do in a simulation."""
        kinds = dartpy.dynamics.ActuatorType
        joints = map(self.skeleton.getJoint, self.case["followers"])
        if all(joint.getActuatorType() != kinds.MIMIC for joint in joints):
            return {}
        return mimics_seen(self.case["leader"], self._settled)

    def _settled(self, angle):
        """Angles of the followers once the constraints have acted."""
        world, skeleton = dartpy.simulation.World(), self._load()
        world.addSkeleton(skeleton)
        world.setGravity(np.zeros(3))
        leader = skeleton.getJoint(self.case["leader"])
        leader.setActuatorType(dartpy.dynamics.ActuatorType.LOCKED)
        leader.setPosition(0, angle)
        for joint in map(skeleton.getJoint, self.case["followers"]):
            # A foot of 3 m is too heavy for the URDF's effort to settle.
            joint.setForceLowerLimit(0, -np.inf)
            joint.setForceUpperLimit(0, np.inf)
        for _ in range(STEPS):
            world.step()
        joints = map(skeleton.getJoint, self.case["followers"])
        return {joint.getName(): joint.getPosition(0) for joint in joints}
