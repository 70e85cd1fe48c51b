"""pytorch-kinematics, in double precision as far as it goes."""

from pathlib import Path

import pytorch_kinematics
import torch


class Robot:
    def __init__(self, case):
        self.tips = case["tips"]
        text = Path(case["urdf"]).read_text()
        chain = pytorch_kinematics.build_chain_from_urdf(text)
        self.chain = chain.to(dtype=torch.float64)

    def poses(self, angles):
        known = self.chain.get_joint_parameter_names()
        given = {name: angles.get(name, 0.0) for name in known}
        found = self.chain.forward_kinematics(given)
        return {tip: found[tip].get_matrix()[0].numpy() for tip in self.tips}

    def limits(self):
        known = self.chain.get_joint_parameter_names()
        return dict(
            zip(known, zip(*self.chain.get_joint_limits(), strict=True), strict=True)
        )
