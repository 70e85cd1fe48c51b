"""A foot's SRDF: what MoveIt and Pinocchio want to know beside the URDF."""

from __future__ import annotations

from itertools import combinations, pairwise
from xml.etree import ElementTree as ET

from zygopin import names
from zygopin.finger import Finger
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
    for (link1, link2), reason in _touching_links(foot).items():
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


def _touching_links(foot: Foot) -> dict[tuple[str, str], str]:
    """Pairs of links that touch by construction, and why.

    Neighbours in a chain share a junction, and so do all first phalanges, whatever
    the pose; a fingertip is a frame at the end of its phalanx.
    """
    pairs: dict[tuple[str, str], str] = {}
    for finger in foot.fingers:
        pairs |= dict.fromkeys(pairwise(_chain(finger)), "Adjacent")
        pairs.setdefault((names.BASE, names.phalanx_links(finger)[0]), "Always")
    first = [names.phalanx_links(finger)[0] for finger in foot.fingers]
    return pairs | dict.fromkeys(combinations(first, 2), "Always")


def _chain(finger: Finger) -> tuple[str, ...]:
    """Links of a finger from the foot's base to the tip."""
    between = (names.turning_link(finger),) * names.is_reversible(finger)
    tip = names.tip_link(finger)
    return (names.BASE, *between, *names.phalanx_links(finger), tip)
