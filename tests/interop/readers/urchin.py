"""urchin, the living fork of urdfpy."""

import urchin

from readers.parsed import Parsed


class Robot(Parsed):
    def __init__(self, case):
        self.tips = case["tips"]
        self.elements = urchin.URDF.load(case["urdf"])

    def poses(self, angles):
        known = {joint.name for joint in self.elements.actuated_joints}
        given = {name: angles[name] for name in angles if name in known}
        return self.elements.link_fk(cfg=given, links=self.tips, use_names=True)
