"""What tools share whose model is the URDF's own elements."""


class Parsed:
    """Answers read from `elements`, which has the URDF's `links` and `joints`."""

    elements = None

    def mass(self):
        return sum(link.inertial.mass for link in self.elements.links)

    def limits(self):
        return {
            joint.name: (joint.limit.lower, joint.limit.upper)
            for joint in self.elements.joints
            if joint.limit is not None
        }

    def shapes(self):
        return sum(len(link.collisions) for link in self.elements.links)

    def mimics(self):
        return {
            joint.name: (joint.mimic.joint, joint.mimic.multiplier, joint.mimic.offset)
            for joint in self.elements.joints
            if joint.mimic is not None
        }
