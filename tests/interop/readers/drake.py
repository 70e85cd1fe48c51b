"""Drake: MultibodyPlant and SceneGraph."""

from pydrake.geometry import Capsule, Role
from pydrake.math import RigidTransform, RotationMatrix
from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import (
    AddMultibodyPlantSceneGraph,
    CoulombFriction,
    MultibodyPlant,
)
from pydrake.systems.analysis import Simulator
from pydrake.systems.framework import DiagramBuilder

from readers.settled import mimics_seen

SETTLED = 0.1
"""Seconds that a simulation takes to settle."""


class Robot:
    def __init__(self, case):
        self.case = case
        builder = DiagramBuilder()
        self.plant, self.scene = AddMultibodyPlantSceneGraph(builder, time_step=1e-3)
        (self.model,) = Parser(self.plant).AddModels(case["urdf"])
        foot = self.plant.GetFrameByName(case["base"])
        self.plant.WeldFrames(self.plant.world_frame(), foot)
        branch = case["branch"]
        self.branch = self.plant.RegisterCollisionGeometry(
            self.plant.world_body(),
            RigidTransform(RotationMatrix(branch["rotation"]), branch["centre"]),
            Capsule(branch["radius"], branch["length"]),
            "branch",
            CoulombFriction(1.0, 1.0),
        )
        self.plant.Finalize()
        diagram = builder.Build()
        self.context = diagram.CreateDefaultContext()
        self.own = self.plant.GetMyContextFromRoot(self.context)

    def _move(self, angles):
        for name in self.case["joints"]:
            joint = self.plant.GetJointByName(name)
            joint.set_angle(self.own, angles.get(name, 0.0))

    def poses(self, angles):
        self._move(angles)
        return {tip: self._pose(tip) for tip in self.case["tips"]}

    def _pose(self, link):
        frame = self.plant.GetFrameByName(link)
        return frame.CalcPoseInWorld(self.own).GetAsMatrix4()

    def mass(self):
        return self.plant.CalcTotalMass(self.own, [self.model])

    def centre(self, angles):
        self._move(angles)
        return self.plant.CalcCenterOfMassPositionInWorld(self.own, [self.model])

    def limits(self):
        joints = map(self.plant.GetJointByName, self.case["joints"])
        return {
            joint.name(): (
                joint.position_lower_limit(),
                joint.position_upper_limit(),
            )
            for joint in joints
        }

    def shapes(self):
        return self.scene.model_inspector().NumGeometriesWithRole(Role.kProximity) - 1

    def links(self):
        indices = self.plant.GetBodyIndices(self.model)
        return [self.plant.get_body(index).name() for index in indices]

    def constraints(self):
        """Drake does not show its coupler constraints: what they do in a simulation."""
        if self.plant.num_constraints() == 0:
            return {}
        return mimics_seen(self.case["leader"], self._settled)

    def _settled(self, angle):
        """Angles of the followers once the constraints have acted."""
        plant = MultibodyPlant(time_step=1e-3)  # without shapes, so without contacts
        Parser(plant).AddModels(self.case["urdf"])
        foot = plant.GetFrameByName(self.case["base"])
        plant.WeldFrames(plant.world_frame(), foot)
        plant.mutable_gravity_field().set_gravity_vector([0, 0, 0])
        plant.Finalize()
        simulator = Simulator(plant)
        leader = plant.GetJointByName(self.case["leader"])
        context = simulator.get_mutable_context()
        leader.set_angle(context, angle)
        leader.Lock(context)
        simulator.AdvanceTo(SETTLED)
        joints = map(plant.GetJointByName, self.case["followers"])
        return {joint.name(): joint.get_angle(context) for joint in joints}

    def distances(self, angles, pairs):
        self._move(angles)
        query = self.plant.get_geometry_query_input_port().Eval(self.own)
        return [
            min(
                query.ComputeSignedDistancePairClosestPoints(i, j).distance
                for i in self._geometries(first)
                for j in self._geometries(second)
            )
            for first, second in pairs
        ]

    def _geometries(self, link):
        if link == "branch":
            return [self.branch]
        body = self.plant.GetBodyByName(link)
        return self.plant.GetCollisionGeometriesForBody(body)
