"""The bodies of a foot's MuJoCo model, each within the one that carries it."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from zygopin import names
from zygopin.finger import Finger
from zygopin.simulated import SimulatedFoot


def add_bodies(
    world: ET.Element, foot: SimulatedFoot, *, springs: bool, free: bool
) -> None:
    """Add the base and its fingers.

    Args:
        world: The element to add to.
        foot: The foot.
        springs: Whether springs open the flexion joints.
        free: Whether the base is free to move.
    """
    base = ET.SubElement(world, "body", name=names.BASE, childclass=names.BASE)
    if free:
        ET.SubElement(base, "freejoint", name=names.BASE)
    _add_inertial(base, foot)
    size = exact(foot.radius(names.BASE))
    ET.SubElement(base, "geom", name=names.BASE, type="sphere", size=size)
    for finger in foot.foot.fingers:
        _add_finger(base, foot, finger, springs)


def exact(*values: float) -> str:
    """Numbers as text that reads back as they are.

    Args:
        *values: The numbers.

    Returns:
        The shortest such text, separated by spaces.
    """
    return " ".join(repr(float(value)).removesuffix(".0") for value in values)


def brief(*values: float) -> str:
    """Chosen numbers as text, to six digits.

    Args:
        *values: The numbers.

    Returns:
        The text, separated by spaces.
    """
    return " ".join(f"{value:.6g}" for value in values)


def _add_finger(
    base: ET.Element, foot: SimulatedFoot, finger: Finger, springs: bool
) -> None:
    """Add a finger's bodies; its tip is a site."""
    parent = base
    if names.is_reversible(finger):
        joint = names.reversal_joint(finger)
        parent = _added_body(parent, foot, names.turning_link(finger), joint)
        limit = foot.joint_attributes(joint, "limit")
        turn = exact(float(limit["lower"]), float(limit["upper"]))
        _add_joint(parent, foot, joint, axis="0 0 1", range=turn)
    links = names.phalanx_links(finger)
    for link, joint in zip(links, names.flexion_joints(finger), strict=True):
        parent = _added_body(parent, foot, link, joint)
        spring = {"stiffness": brief(foot.drives[joint].spring)} if springs else {}
        _add_joint(parent, foot, joint, **spring)
        bone = exact(0, 0, 0, foot.length(link), 0, 0)
        size = exact(foot.radius(link))
        ET.SubElement(parent, "geom", name=link, fromto=bone, size=size)
    end = exact(foot.length(links[-1]), 0, 0)
    ET.SubElement(parent, "site", name=names.tip_link(finger), pos=end)


def _added_body(
    parent: ET.Element, foot: SimulatedFoot, name: str, joint: str
) -> ET.Element:
    """A new body, placed as its joint's origin says, with its inertia."""
    origin = foot.joint_attributes(joint, "origin")
    place = {
        key: [*map(float, origin[part].split())]
        for key, part in (("pos", "xyz"), ("euler", "rpy"))
    }
    given = {key: exact(*values) for key, values in place.items() if any(values)}
    body = ET.SubElement(parent, "body", {"name": name} | given)
    _add_inertial(body, foot)
    return body


def _add_inertial(body: ET.Element, foot: SimulatedFoot) -> None:
    """Add a body's mass and inertia."""
    own = foot.bodies[body.attrib["name"]]
    place = {"pos": exact(own.centre, 0, 0), "mass": exact(own.mass)}
    moments = exact(own.axial, own.transverse, own.transverse)
    ET.SubElement(body, "inertial", place, diaginertia=moments)


def _add_joint(body: ET.Element, foot: SimulatedFoot, joint: str, **own: str) -> None:
    """Add a joint with what resists its motion."""
    drive = foot.drives[joint]
    resistance = {"damping": brief(drive.damping), "armature": brief(drive.armature)}
    ET.SubElement(body, "joint", {"name": joint} | own | resistance)
