"""ikpy: one chain for each finger."""

from xml.etree.ElementTree import parse

from ikpy.chain import Chain


class Robot:
    def __init__(self, case):
        self.chains = {
            tip: Chain.from_urdf_file(
                case["urdf"],
                base_elements=path(case["urdf"], case["base"], tip),
                symbolic=False,
            )
            for tip in case["tips"]
        }

    def poses(self, angles):
        return {
            tip: chain.forward_kinematics(
                [angles.get(link.name, 0.0) for link in chain.links]
            )
            for tip, chain in self.chains.items()
        }

    def limits(self):
        return {
            link.name: link.bounds
            for chain in self.chains.values()
            for link in chain.links
            if link.joint_type == "revolute"
        }


def path(file, base, tip):
    """Links and joints from the base to a tip; ikpy alone takes the first child."""
    joints = {
        joint.find("child").get("link"): joint
        for joint in parse(file).getroot().findall("joint")  # noqa: S314
    }
    found = [tip]
    while found[0] != base:
        joint = joints[found[0]]
        found = [joint.find("parent").get("link"), joint.get("name"), *found]
    return found
