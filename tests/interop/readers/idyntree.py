"""iDynTree."""

import idyntree.bindings as idyntree


class Robot:
    def __init__(self, case):
        self.case = case
        self.loader = idyntree.ModelLoader()
        if not self.loader.loadModelFromFile(case["urdf"]):
            raise ValueError("iDynTree did not load the file")
        self.model = self.loader.model()
        self.dynamics = idyntree.KinDynComputations()
        self.dynamics.loadRobotModel(self.model)
        self.dynamics.setFloatingBase(case["base"])

    def _move(self, angles):
        q = idyntree.JointPosDoubleArray(self.model)
        q.zero()
        for name, angle in angles.items():
            joint = self.model.getJoint(self.model.getJointIndex(name))
            q.setVal(joint.getPosCoordsOffset(), angle)
        still = idyntree.JointDOFsDoubleArray(self.model)
        still.zero()
        gravity = idyntree.Vector3()
        gravity.zero()
        self.dynamics.setRobotState(q, still, gravity)

    def poses(self, angles):
        self._move(angles)
        place = self.dynamics.getRelativeTransform
        return {
            tip: place(self.case["base"], tip).asHomogeneousTransform().toNumPy()
            for tip in self.case["tips"]
        }

    def mass(self):
        return self.model.getTotalMass()

    def centre(self, angles):
        self._move(angles)
        return self.dynamics.getCenterOfMassPosition().toNumPy()

    def limits(self):
        joints = {
            name: self.model.getJoint(self.model.getJointIndex(name))
            for name in self.case["joints"]
        }
        return {
            name: (joint.getMinPosLimit(0), joint.getMaxPosLimit(0))
            for name, joint in joints.items()
        }

    def shapes(self):
        shapes = self.model.collisionSolidShapes().getLinkSolidShapes()
        return sum(len(each) for each in shapes)
