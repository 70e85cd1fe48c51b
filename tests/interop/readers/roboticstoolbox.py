"""Peter Corke's Robotics Toolbox."""

import numpy as np
from roboticstoolbox import Robot as Toolbox
from roboticstoolbox.models.URDF.URDFRobot import URDF_file


class Robot:
    def __init__(self, case):
        self.case = case
        links, name, *_ = URDF_file(case["urdf"])
        self.robot = Toolbox(links, name=name)
        self.moving = [link for link in self.robot.links if link.isjoint]

    def poses(self, angles):
        q = np.zeros(self.robot.n)
        for link in self.moving:
            q[link.jindex] = angles.get(link._joint_name, 0.0)
        return {tip: self.robot.fkine(q, end=tip).A for tip in self.case["tips"]}

    def mass(self):
        return sum(link.m for link in self.robot.links)

    def limits(self):
        return {link._joint_name: link.qlim.tolist() for link in self.moving}

    def shapes(self):
        return sum(len(link.collision) for link in self.robot.links)
