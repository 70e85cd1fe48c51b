"""kinpy."""

from pathlib import Path

import kinpy


class Robot:
    def __init__(self, case):
        self.tips = case["tips"]
        self.chain = kinpy.build_chain_from_urdf(Path(case["urdf"]).read_text())

    def poses(self, angles):
        known = self.chain.get_joint_parameter_names()
        given = {name: angles.get(name, 0.0) for name in known}
        found = self.chain.forward_kinematics(given)
        return {tip: found[tip].matrix() for tip in self.tips}
