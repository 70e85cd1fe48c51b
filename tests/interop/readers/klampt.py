"""Klampt: drivers move its joints, and one driver moves all that mimic."""

from xml.etree.ElementTree import parse

import klampt
import numpy as np


class Robot:
    def __init__(self, case):
        self.case = case
        self.world = klampt.WorldModel()
        if not self.world.readFile(case["urdf"]):
            raise ValueError("Klampt did not load the file")
        self.robot = self.world.robot(0)
        joints = parse(case["urdf"]).getroot().findall("joint")  # noqa: S314
        self.children = {
            joint.get("name"): self.robot.link(joint.find("child").get("link"))
            for joint in joints
        }

    def _move(self, angles):
        self.robot.setConfig(np.zeros(self.robot.numLinks()))
        names = {link.getName(): name for name, link in self.children.items()}
        for index in range(self.robot.numDrivers()):
            driver = self.robot.driver(index)
            driver.setValue(angles.get(names[driver.getName()], 0.0))
        self.robot.setConfig(self.robot.getConfig())  # only now do the links move

    def poses(self, angles):
        self._move(angles)
        return {tip: self._pose(tip) for tip in self.case["tips"]}

    def _pose(self, link):
        rotation, position = self.robot.link(link).getTransform()
        pose = np.eye(4)
        pose[:3, :3] = np.reshape(rotation, (3, 3)).T  # by columns
        pose[:3, 3] = position
        return pose

    def mass(self):
        links = map(self.robot.link, range(self.robot.numLinks()))
        return sum(link.getMass().getMass() for link in links)

    def centre(self, angles):
        self._move(angles)
        return self.robot.getCom()

    def limits(self):
        low, high = self.robot.getJointLimits()
        indices = {name: self.children[name].getIndex() for name in self.case["joints"]}
        return {name: (low[index], high[index]) for name, index in indices.items()}
