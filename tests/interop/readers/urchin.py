"""urchin, the living fork of urdfpy."""

import urchin


class Robot:
    def __init__(self, case):
        self.tips = case["tips"]
        self.urdf = urchin.URDF.load(case["urdf"])

    def poses(self, angles):
        known = {joint.name for joint in self.urdf.actuated_joints}
        given = {name: angles[name] for name in angles if name in known}
        return self.urdf.link_fk(cfg=given, links=self.tips, use_names=True)

    def mass(self):
        return sum(link.inertial.mass for link in self.urdf.links)

    def limits(self):
        return {
            joint.name: (joint.limit.lower, joint.limit.upper)
            for joint in self.urdf.joints
            if joint.joint_type == "revolute"
        }

    def shapes(self):
        return sum(len(link.collisions) for link in self.urdf.links)

    def mimics(self):
        return {
            joint.name: (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
            for joint in self.urdf.joints
            if joint.mimic is not None
        }
