"""scikit-robot."""

from skrobot.models.urdf import RobotModelFromURDF


class Robot:
    def __init__(self, case):
        self.tips = case["tips"]
        self.robot = RobotModelFromURDF(urdf_file=case["urdf"])
        self.joints = {joint.name: joint for joint in self.robot.joint_list}

    def poses(self, angles):
        # Followers first, so that it shows what the leader does to them.
        for joint in self.joints.values():
            joint.joint_angle(0.0)
        for name in reversed([*angles]):
            self.joints[name].joint_angle(angles[name])
        links = {tip: getattr(self.robot, tip) for tip in self.tips}
        return {tip: link.worldcoords().T() for tip, link in links.items()}

    def mass(self):
        return sum(link.mass for link in self.robot.link_list)

    def centre(self, angles):
        self.poses(angles)
        return self.robot.centroid()

    def limits(self):
        return {
            name: (joint.min_angle, joint.max_angle)
            for name, joint in self.joints.items()
        }

    def mimics(self):
        return {
            name: (
                joint.mimic["joint"].name,
                joint.mimic["multiplier"],
                joint.mimic["offset"],
            )
            for name, joint in self.joints.items()
            if getattr(joint, "mimic", None)
        }
