"""Perches pulled at, tilted and locked in MuJoCo, and what the programmes say of them.

The bodies, masses and torques are those of `to_mjcf`; the branch is a static capsule.
Phalanges collide with the branch alone, at points with Coulomb friction, as in the
programmes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import mujoco
import numpy as np

from zygopin import names
from zygopin.branch import Branch
from zygopin.contacts import Contacts, Friction, branch_contacts
from zygopin.dynamics import characteristic_time
from zygopin.foot import Foot
from zygopin.load import GRAVITY, PullLimit, pull_limit
from zygopin.mjcf import to_mjcf
from zygopin.model import FootModel
from zygopin.perch import PerchPlan, plan_perch
from zygopin.strength import Drive, Strength
from zygopin.toe_torque import joint_drive, torque_matrix

EDGES = 16
"""Edges of the friction pyramids: inscribed and circumscribed differ by 2 %."""

STEPS = 250
"""Time steps in the characteristic time T: servos are stiff, contacts hard."""

SOFT = 10.0
"""Stiffness over the greatest torque of servos that are to press as told [1/rad].

A joint that gives way by 0.01 rad loses a tenth of its torque, not half of it.
"""

AT_STOP = 1e-3
"""Angle from its stop at which a joint leans on it [rad]: stops are soft."""

HARD = 50.0
"""The same of servos that are to keep their angle."""


@dataclass(frozen=True, eq=False)
class Perch:
    """A planned perch, and its model in MuJoCo's words."""

    plan: PerchPlan

    @property
    def foot(self) -> Foot:
        return self.plan.report.foot

    @cached_property
    def contacts(self) -> Contacts:
        return branch_contacts(self.plan.report)

    @cached_property
    def text(self) -> str:
        return to_mjcf(self.foot, free=True)

    @cached_property
    def weight(self) -> float:
        """The foot's weight [N]."""
        model = mujoco.MjModel.from_xml_string(self.text)
        return float(GRAVITY * model.body_subtreemass[0])

    @cached_property
    def kinematics(self) -> FootModel:
        return FootModel(self.foot)

    @cached_property
    def joints(self) -> list[str]:
        toes = self.foot.fingers
        return [joint for toe in toes for joint in names.flexion_joints(toe)]

    @cached_property
    def torques(self) -> np.ndarray:
        """The greatest torque of each joint's actuator [N·m], shape (P,)."""
        model = mujoco.MjModel.from_xml_string(self.text)
        return np.array([model.actuator(j).forcerange[1] for j in self.joints])

    def strength(self, friction: float) -> Strength:
        """The actuators' torques, and nothing else, bound the forces."""
        report = self.plan.report
        drive = joint_drive(self.kinematics, report, self.contacts, self.torques)
        return Strength(math.inf, Friction(friction, EDGES), drive)

    def needed(self, limit: PullLimit) -> np.ndarray:
        """What the joints must turn with to balance a pull [N·m], shape (P,)."""
        matrix = torque_matrix(self.kinematics, self.plan.controls, self.contacts)
        return -np.einsum("pni,ni->p", matrix, limit.contact_forces)


@dataclass(frozen=True, eq=False)
class Pull:
    """One pull at the base of a perched foot."""

    perch: Perch
    friction: float
    direction: np.ndarray

    @cached_property
    def limit(self) -> PullLimit:
        strength = self.perch.strength(self.friction)
        return pull_limit(self.perch.contacts, strength, self.direction)


def random_foot(rng) -> Foot:
    """A parrot or an owl of other proportions."""
    foot = Foot.preset(rng.choice(["parrot", "owl"]))
    return foot.replace(
        rho=foot.rho * rng.uniform(0.95, 1.08),
        omega=foot.omega * rng.uniform(0.85, 1.15),
        splay=foot.splay * rng.uniform(0.5, 1.5),
        thickness=foot.thickness * rng.uniform(0.7, 1.2),
    )


def random_perch(rng) -> Perch:
    """A grasp of a random foot on a branch that suits it."""
    while True:
        foot = random_foot(rng)
        radius = rng.uniform(0.15, 0.35) * foot.size
        branch = Branch(radius, (0, 0, -1.3 * radius - foot.radii[0]))
        plan = plan_perch(foot, branch, find_height=True)
        if plan.grasping:
            return Perch(plan)


def random_pull(rng, perch) -> Pull:
    """A pull of a random direction that can be borne at a random friction."""
    while True:
        direction = rng.normal(size=3)
        direction /= np.linalg.norm(direction)
        pull = Pull(perch, float(rng.uniform(0.2, 0.9)), direction)
        if pull.limit.force > 0:
            return pull


@dataclass(frozen=True, eq=False)
class Bench:
    """A model in which a foot perches, and its data.

    Attributes:
        perch: The foot in its planned pose.
        friction: Friction of its contacts.
        stiffness: Of its servos over their greatest torque [1/rad].
        model: The model, without weight.
        data: Its state.
    """

    perch: Perch
    friction: float
    stiffness: float
    model: mujoco.MjModel
    data: mujoco.MjData

    @property
    def base(self):
        return self.data.body("foot")

    @property
    def torque_error(self):
        """Of the servos beside what they were told, over their torques, shape (P,)."""
        said = self.stiffness * (self.data.ctrl[self.actuators] - self._planned())
        forces = self.data.actuator_force[self.actuators] / self.perch.torques
        return forces - said

    @cached_property
    def actuators(self):
        return [self.model.actuator(joint).id for joint in self.perch.joints]

    def squeeze(self, torques):
        """Let the servos press beyond the planned pose with some torques [N·m]."""
        beyond = torques / (self.stiffness * self.perch.torques)
        self.data.ctrl[self.actuators] = self._planned() + beyond

    def angles(self):
        """The joints' angles [rad], shape (P,)."""
        return np.array([self.data.joint(j).qpos[0] for j in self.perch.joints])

    def run(self, periods):
        """Step for a while, over T."""
        for _ in range(self.steps(periods)):
            mujoco.mj_step(self.model, self.data)

    def steps(self, periods):
        """Steps in a while, over T."""
        time = characteristic_time(self.perch.foot)
        return round(periods * time / self.model.opt.timestep)

    def offset(self, start):
        """Way of the base from somewhere, over the branch's radius."""
        way = np.linalg.norm(self.base.xpos - start)
        return float(way / self.perch.plan.branch.radius)

    def touching(self):
        """Phalanges on the branch, and where: ranks, points, outward normals."""
        links = [x for toe in self.perch.foot.fingers for x in names.phalanx_links(toe)]
        found = []
        for contact in self.data.contact:
            first, second = (self.model.geom(int(geom)).name for geom in contact.geom)
            flip = 1 if first == "branch" else -1
            link = second if flip == 1 else first
            if link in links:
                found.append((links.index(link), contact.pos, flip * contact.frame[:3]))
        return found

    def pressed(self):
        """Sum of all normal forces [N]."""
        total, force = 0.0, np.zeros(6)
        for index in range(self.data.ncon):
            mujoco.mj_contactForce(self.model, self.data, index, force)
            total += force[0]
        return total

    def contacts(self) -> Contacts:
        """The contacts of the present pose in the base's frame; there must be some."""
        to_base, place = self.base.xmat.reshape(3, 3).T, self.base.xpos
        found = self.touching()
        return Contacts(
            points=np.array([to_base @ (point - place) for _, point, _ in found]),
            normals=np.array([to_base @ normal for _, _, normal in found]),
            scale=self.perch.contacts.scale,
            phalanges=np.array([rank for rank, _, _ in found]),
        )

    def bound(self, direction):
        """The programme's upper bound of a pull on the foot in its present pose [N]."""
        if not self.touching():
            return 0.0
        contacts, foot = self.contacts(), self.perch.foot
        angles = self.angles()
        controls = np.clip(angles / foot.omega, 0, 1)
        drive = Drive(
            matrix=torque_matrix(self.perch.kinematics, controls, contacts),
            torques=np.diag(self.perch.torques),
            low=np.full(len(angles), -1.0),
            straight=angles <= AT_STOP,
            bent=angles >= foot.omega - AT_STOP,
        )
        strength = Strength(math.inf, Friction(self.friction, EDGES), drive)
        return pull_limit(
            contacts, strength, self.base.xmat.reshape(3, 3).T @ direction
        ).bound

    def _planned(self):
        return self.perch.foot.omega * self.perch.plan.controls


def bench(perch, friction, stiffness=SOFT, change=None) -> Bench:
    """The foot in its planned pose on its branch; `change` may alter the MjSpec."""
    spec = mujoco.MjSpec.from_string(perch.text)
    spec.option.gravity = [0, 0, 0]
    spec.option.timestep = characteristic_time(perch.foot) / STEPS
    spec.option.impratio = 1
    spec.option.noslip_iterations = 10  # else soft friction creeps
    for geom in spec.geoms:
        geom.contype, geom.conaffinity, geom.condim = 1, 0, 3
        geom.friction = [friction, 0, 0]
    _add_branch(spec, perch, friction)
    if change:
        change(spec)
    model = spec.compile()
    made = Bench(perch, friction, stiffness, model, mujoco.MjData(model))
    gains = stiffness * perch.torques
    model.actuator_gainprm[made.actuators, 0] = gains
    model.actuator_biasprm[made.actuators, 1] = -gains
    model.actuator_ctrllimited[made.actuators] = 0
    for joint, control in zip(perch.joints, perch.plan.controls, strict=True):
        made.data.joint(joint).qpos = perch.foot.omega * control
    made.squeeze(np.zeros(len(perch.joints)))
    mujoco.mj_forward(model, made.data)
    return made


def _add_branch(spec, perch, friction):
    """Add the branch, a capsule that does not move, as hard as the pads."""
    branch, pad = perch.plan.branch, spec.geoms[1]
    turn = np.zeros(4)
    mujoco.mju_mat2Quat(turn, np.ascontiguousarray(branch.frame()).ravel())
    spec.worldbody.add_geom(
        name="branch",
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        size=[float(branch.radius), 5 * perch.foot.size, 0],
        pos=branch.centre,
        quat=turn,
        contype=0,
        conaffinity=1,
        condim=3,
        friction=[friction, 0, 0],
        solref=pad.solref,
        solimp=pad.solimp,
    )
