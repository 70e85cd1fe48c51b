"""urdf_parser_py: a parser; its origins and axes are multiplied here."""

import numpy as np
from scipy.spatial.transform import Rotation
from urdf_parser_py.urdf import URDF

from readers.parsed import Parsed


class Robot(Parsed):
    def __init__(self, case):
        self.case = case
        self.elements = URDF.from_xml_file(case["urdf"])

    def poses(self, angles):
        return {tip: self._pose(tip, angles) for tip in self.case["tips"]}

    def _pose(self, link, angles):
        pose = np.eye(4)
        for name in self.elements.get_chain(self.case["base"], link, links=False):
            joint = self.elements.joint_map[name]
            pose = pose @ matrix(Rotation.from_euler("xyz", joint.origin.rpy), joint)
            if joint.type != "fixed":
                turn = np.multiply(joint.axis, angles.get(name, 0.0))
                pose[:3, :3] @= Rotation.from_rotvec(turn).as_matrix()
        return pose


def matrix(rotation, joint):
    """The pose of a joint's origin."""
    pose = np.eye(4)
    pose[:3, :3] = rotation.as_matrix()
    pose[:3, 3] = joint.origin.xyz
    return pose
