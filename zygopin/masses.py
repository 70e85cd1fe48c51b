"""Masses and inertias of a foot's links, as its URDF has them."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree as ET


@dataclass(frozen=True)
class Inertial:
    """Mass and inertia of a link that is symmetric about its own x axis.

    Attributes:
        mass: Mass [kg].
        centre: x of the centre of mass [m].
        axial: Moment of inertia about x [kg·m²].
        transverse: Moment of inertia about y, and z, through the centre [kg·m²].
    """

    mass: float
    centre: float
    axial: float
    transverse: float

    def about(self, x: float) -> float:
        """Moment of inertia about an axis across x at a place on it [kg·m²]."""
        lever = self.centre - x
        return self.transverse + self.mass * lever * lever

    def joined(self, other: Inertial) -> Inertial:
        """This link and another of the same frame, as one body."""
        mass = self.mass + other.mass
        moment = self.mass * self.centre + other.mass * other.centre
        centre = moment / mass
        return Inertial(
            mass,
            centre,
            self.axial + other.axial,
            self.about(centre) + other.about(centre),
        )

    def moved(self, distance: float) -> Inertial:
        """This link in a frame that lies so far behind its own on x."""
        centre = self.centre + distance
        return Inertial(self.mass, centre, self.axial, self.transverse)


def link_inertials(robot: ET.Element) -> dict[str, Inertial]:
    """The inertials of a URDF that `to_urdf` wrote.

    Args:
        robot: Its root.

    Returns:
        {link: its mass and inertia, in its own frame}.
    """
    return {link.attrib["name"]: _inertial(link) for link in robot.findall("link")}


def _inertial(link: ET.Element) -> Inertial:
    """The mass and inertia of one link."""
    centre = _attributes(link, "inertial/origin")["xyz"].split()[0]
    moments = _attributes(link, "inertial/inertia")
    return Inertial(
        float(_attributes(link, "inertial/mass")["value"]),
        float(centre),
        float(moments["ixx"]),
        float(moments["iyy"]),
    )


def _attributes(link: ET.Element, path: str) -> dict[str, str]:
    """Attributes of the one element at a path."""
    return next(iter(link.findall(path))).attrib
