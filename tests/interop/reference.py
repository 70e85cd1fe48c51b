"""What each tool's answers are held against.

Poses are Pinocchio's, whose own are held against the closed form; masses come from
the text, and all else from the foot's numbers.
"""

from __future__ import annotations

from functools import cached_property
from xml.etree import ElementTree as ET

import numpy as np
import pinocchio as pin
from cases import Case

from zygopin import names
from zygopin.description import to_urdf

Poses = dict[str, np.ndarray]
"""Pose of each tip in the frame of the link foot, shape (4, 4) each."""


class Reference:
    """The right answers for one file."""

    def __init__(self, case: Case) -> None:
        self.case = case
        # Not the file's text, which a test may have spoilt.
        self.urdf = to_urdf(case.foot, tendon=case.tendon)

    @cached_property
    def poses(self) -> list[Poses]:
        """Pinocchio's poses of the tips."""
        model = pin.buildModelFromXML(self.urdf, mimic=True)
        return [_poses(model, self.case, angles) for angles in self.case.configurations]

    @cached_property
    def held(self) -> Poses:
        """Poses of the tips with the leader set, and every follower at 0."""
        model = pin.buildModelFromXML(to_urdf(self.case.foot))
        return _poses(model, self.case, self.case.leading)

    @cached_property
    def closed_form(self) -> list[Poses]:
        """Poses of the tips from the controls, without any URDF."""
        foot, found = self.case.foot, []
        parts = [*foot.finger_slices.values()]
        for bones, controls, turns in zip(
            self.case.bones, self.case.controls, self.case.turns, strict=True
        ):
            poses = {}
            for finger, part, turn in zip(foot.fingers, parts, turns, strict=True):
                pitch = finger.orientation + foot.omega * controls[part].sum()
                pose = np.eye(4)
                pose[:3, :3] = _about_z(finger.azimuth + turn) @ _about_y(pitch)
                pose[:3, 3] = bones[part.stop - 1, 1]
                poses[names.tip_link(finger)] = pose
            found.append(poses)
        return found

    @cached_property
    def inertials(self) -> dict[str, ET.Element]:
        """The inertial element of each link."""
        links = ET.fromstring(self.urdf).findall("link")  # noqa: S314
        return {link.get("name"): link.find("inertial") for link in links}

    @cached_property
    def masses(self) -> dict[str, float]:
        """Mass of each link [kg]."""
        return {
            link: float(inertial.find("mass").get("value"))
            for link, inertial in self.inertials.items()
        }

    @cached_property
    def least_inertia(self) -> float:
        """The least principal moment of all links [kg m²]; none has products."""
        return min(
            float(inertial.find("inertia").get(axis))
            for inertial in self.inertials.values()
            for axis in ("ixx", "iyy", "izz")
        )

    def mass(self, *, base: bool) -> float:
        """Mass of the foot [kg], with or without the link foot."""
        return sum(self.masses.values()) - (0 if base else self.masses[names.BASE])

    def centres(self, *, base: bool) -> list[np.ndarray]:
        """Centre of mass in each pose [m]: phalanges weigh midway, tips at the end."""
        foot, found = self.case.foot, []
        parts = foot.finger_slices.values()
        for bones in self.case.bones:
            moment = np.zeros(3)
            for finger, part in zip(foot.fingers, parts, strict=True):
                links = names.phalanx_links(finger)
                for link, bone in zip(links, bones[part], strict=True):
                    moment += self.masses[link] * bone.mean(axis=0)
                moment += self.masses[names.tip_link(finger)] * bones[part.stop - 1, 1]
            found.append(moment / self.mass(base=base))
        return found

    @cached_property
    def limits(self) -> dict[str, tuple[float, float]]:
        """Lower and upper limit of each joint that moves [rad]."""
        foot, found = self.case.foot, {}
        for finger in foot.fingers:
            joints = names.flexion_joints(finger)
            found |= dict.fromkeys(joints, (0.0, foot.omega))
            if names.is_reversible(finger):
                turn = finger.reversal
                found[names.reversal_joint(finger)] = min(0, turn), max(0, turn)
        return found

    @cached_property
    def shapes(self) -> int:
        """Collision shapes: a rod and two balls for each phalanx, and the base."""
        return 3 * self.case.foot.phalanx_count + 1

    @cached_property
    def parents(self) -> dict[str, str]:
        """Parent of each link but the base."""
        found = {}
        for finger in self.case.foot.fingers:
            turning = [names.turning_link(finger)] * names.is_reversible(finger)
            chain = [names.BASE, *turning, *names.phalanx_links(finger)]
            chain.append(names.tip_link(finger))
            found |= zip(chain[1:], chain[:-1], strict=True)
        return found


def _poses(model: pin.Model, case: Case, angles: dict[str, float]) -> Poses:
    """Poses of the tips, joints that are not given at 0, or where the leader says."""
    q = pin.neutral(model)
    for joint, angle in angles.items():
        index = model.getJointId(joint)
        if model.nvs[index]:
            q[model.idx_qs[index]] = angle
    data = model.createData()
    pin.framesForwardKinematics(model, data, q)
    return {
        tip: data.oMf[model.getFrameId(tip, pin.FrameType.BODY)].homogeneous
        for tip in case.tips
    }


def _about_z(angle: float) -> np.ndarray:
    """Rotation about z."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])


def _about_y(angle: float) -> np.ndarray:
    """Rotation about y."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
