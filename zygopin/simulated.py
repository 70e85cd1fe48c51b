"""A foot as a simulation needs it: bodies with mass, solid phalanges, driven joints."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from xml.etree import ElementTree as ET

import numpy as np

from zygopin import names
from zygopin.description import to_urdf
from zygopin.dynamics import JointDynamics, joint_dynamics
from zygopin.foot import Foot
from zygopin.keyframes import keyframes
from zygopin.masses import Inertial, link_inertials


@dataclass(frozen=True)
class SimulatedFoot:
    """The numbers of a foot's URDF, and those that a URDF cannot hold.

    Attributes:
        foot: The foot.
    """

    foot: Foot

    @cached_property
    def bodies(self) -> dict[str, Inertial]:
        """{body: its mass and inertia}: the links, a tip's in its last phalanx."""
        found = link_inertials(self._urdf)
        for finger in self.foot.fingers:
            last = names.phalanx_links(finger)[-1]
            tip = found.pop(names.tip_link(finger)).moved(self.length(last))
            found[last] = found[last].joined(tip)
        return found

    @cached_property
    def drives(self) -> dict[str, JointDynamics]:
        """{joint: what drives it}; a reversal has its first phalanx's lever."""
        mass = math.fsum(body.mass for body in self.bodies.values())
        moved: dict[str, str] = {}
        for finger in self.foot.fingers:
            links = names.phalanx_links(finger)
            if names.is_reversible(finger):
                moved[names.reversal_joint(finger)] = links[0]
            moved |= zip(names.flexion_joints(finger), links, strict=True)
        return {
            joint: joint_dynamics(self.foot, mass, self.length(link))
            for joint, link in moved.items()
        }

    @cached_property
    def flexion_joints(self) -> tuple[str, ...]:
        """The joints that a tendon closes, finger by finger."""
        found = map(names.flexion_joints, self.foot.fingers)
        return tuple(chain.from_iterable(found))

    @cached_property
    def keyframes(self) -> dict[str, dict[str, float]]:
        """{pose: {joint: angle [rad]}}: poses to start from."""
        links = chain.from_iterable(map(names.phalanx_links, self.foot.fingers))
        radii = np.array([self.radius(link) for link in links])
        return keyframes(self.foot, radii)

    @cached_property
    def thinnest(self) -> float:
        """Radius of the thinnest phalanx [m]."""
        last = [names.phalanx_links(finger)[-1] for finger in self.foot.fingers]
        return min(map(self.radius, last))

    @property
    def colour(self) -> str:
        """Red, green, blue and opacity of the skin, each in [0, 1]."""
        return self._element("material/color").attrib["rgba"]

    def length(self, link: str) -> float:
        """Length of a phalanx [m]."""
        shape = self._element(f"link[@name='{link}']/collision/geometry/cylinder")
        return float(shape.attrib["length"])

    def radius(self, link: str) -> float:
        """Radius of a phalanx, or of the base's ball [m]."""
        shape = self._element(f"link[@name='{link}']/collision/geometry/sphere")
        return float(shape.attrib["radius"])

    def joint_attributes(self, joint: str, part: str) -> dict[str, str]:
        """What the URDF says in a part of a joint, such as its origin."""
        return self._element(f"joint[@name='{joint}']/{part}").attrib

    @cached_property
    def _urdf(self) -> ET.Element:
        """The URDF's root."""
        return ET.fromstring(to_urdf(self.foot))  # noqa: S314

    def _element(self, path: str) -> ET.Element:
        """The first element of the URDF at a path."""
        return next(iter(self._urdf.findall(path)))
