"""A foot's SRDF: what MoveIt and Pinocchio want to know beside the URDF."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from zygopin import names
from zygopin.adjacency import touching_links
from zygopin.foot import Foot
from zygopin.poses import named_poses


def to_srdf(foot: Foot) -> str:
    """The foot's SRDF: what MoveIt and Pinocchio want to know beside the URDF.

    A group for each finger, one for the whole foot; the poses of `named_poses`; pairs
    of links not to check for collision, because they touch by construction.

    Args:
        foot: The foot.

    Returns:
        The SRDF [rad], indented, with a newline at the end.
    """
    root = ET.Element("robot", name=foot.name)
    fixed = {"name": "world", "type": "fixed", "parent_frame": "world"}
    ET.SubElement(root, "virtual_joint", fixed, child_link=names.BASE)
    whole = _add_groups(root, foot)
    ends = {"name": whole, "parent_link": names.BASE, "group": whole}
    ET.SubElement(root, "end_effector", ends)
    for pose, angles in named_poses(foot).items():
        state = ET.SubElement(root, "group_state", name=pose, group=whole)
        for joint, angle in angles.items():
            ET.SubElement(state, "joint", name=joint, value=repr(angle))
    for (link1, link2), reason in touching_links(foot).items():
        pair = {"link1": link1, "link2": link2, "reason": reason}
        ET.SubElement(root, "disable_collisions", pair)
    ET.indent(root)
    text = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" ?>\n{text}\n'


def _add_groups(root: ET.Element, foot: Foot) -> str:
    """Add a group for each finger and one of them all; return the latter's name."""
    whole = names.BASE
    while whole in foot.finger_slices:
        whole += "_whole"
    for finger in foot.fingers:
        group = ET.SubElement(root, "group", name=finger.name)
        chain = {"base_link": names.BASE, "tip_link": names.tip_link(finger)}
        ET.SubElement(group, "chain", chain)
    group = ET.SubElement(root, "group", name=whole)
    for finger in foot.fingers:
        ET.SubElement(group, "group", name=finger.name)
    return whole
