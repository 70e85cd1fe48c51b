"""A foot's SRDF: what MoveIt and Pinocchio want to know beside the URDF."""

from __future__ import annotations

from itertools import chain
from xml.etree import ElementTree as ET

from zygopin import checks, kinds, names
from zygopin.adjacency import touching_links
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.poses import TURNED_POSES, named_poses

_WORLD = "world"
"""The virtual joint that fixes the foot, and the frame that it fixes it to."""

_Poses = dict[str, dict[str, float]]


def to_srdf(foot: Foot, *, tendon: bool = False) -> str:
    """The foot's SRDF: what MoveIt and Pinocchio want to know beside the URDF.

    A group for each finger, one for the whole foot, which is also an end effector, and
    one for the base that carries it; the poses of `named_poses`; pairs of links not to
    check for collision, because they touch by construction.

    A state sets every joint of its group that the planner may set, and no other: for
    the tendon's URDF that is the leader and the joints that turn a toe. MoveIt would
    take a value for a follower and pull it off its leader. Groups and poses that need
    the followers to move on their own are then left out.

    Args:
        foot: The foot.
        tendon: Whether it goes with the URDF of the same option.

    Returns:
        The SRDF [rad], indented, with a newline at the end.
    """
    kinds.instance("foot", foot, Foot)
    checks.flag("tendon", tendon)
    root = ET.Element("robot", name=foot.name)
    fixed = {"name": _WORLD, "type": "fixed", "parent_frame": _WORLD}
    ET.SubElement(root, "virtual_joint", fixed, child_link=names.BASE)
    free = _free_joints(foot, tendon)
    groups = [finger for finger in foot.fingers if free[finger.name]]
    base, whole = _unused("base", foot), _unused(names.BASE, foot)
    for finger in groups:
        _add_group(root, finger.name, (finger,))
    ET.SubElement(ET.SubElement(root, "group", name=base), "joint", name=_WORLD)
    _add_group(root, whole, foot.fingers)
    ends = {"name": whole, "parent_link": names.BASE, "group": whole}
    ET.SubElement(root, "end_effector", ends, parent_group=base)
    poses = _held_poses(foot, tendon)
    # First: Pinocchio keys poses by name alone, and keeps the first of a name.
    _add_states(root, whole, [*chain.from_iterable(free.values())], poses)
    for finger in groups:
        joints = free[finger.name]
        _add_states(root, finger.name, joints, _told(finger, joints, poses))
    for (link1, link2), reason in touching_links(foot).items():
        pair = {"link1": link1, "link2": link2, "reason": reason}
        ET.SubElement(root, "disable_collisions", pair)
    ET.indent(root)
    text = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" ?>\n{text}\n'


def _unused(name: str, foot: Foot) -> str:
    """A name for a group that no finger's group has."""
    while name in foot.finger_slices:
        name += "_group"
    return name


def _free_joints(foot: Foot, tendon: bool) -> dict[str, list[str]]:
    """Joints of each finger that mimic no other."""
    leader = names.flexion_joints(foot.fingers[0])[0]
    return {
        finger.name: [
            *(j for j in names.flexion_joints(finger) if not tendon or j == leader),
            *(names.reversal_joint(finger),) * names.is_reversible(finger),
        ]
        for finger in foot.fingers
    }


def _held_poses(foot: Foot, tendon: bool) -> _Poses:
    """Poses that the foot can hold: a tendon flexes all joints alike."""
    poses = named_poses(foot)
    if not tendon:
        return poses
    joints = [*chain.from_iterable(map(names.flexion_joints, foot.fingers))]
    return {
        pose: angles
        for pose, angles in poses.items()
        if len({angles[joint] for joint in joints}) == 1
    }


def _told(finger: Finger, joints: list[str], poses: _Poses) -> _Poses:
    """Poses that say something of a finger: how it is turned, how it is flexed."""
    turns = names.is_reversible(finger)
    flexes = names.flexion_joints(finger)[0] in joints
    return {
        pose: angles
        for pose, angles in poses.items()
        if (turns if pose in TURNED_POSES else flexes)
    }


def _add_group(root: ET.Element, name: str, fingers: tuple[Finger, ...]) -> None:
    """Add a group of whole fingers."""
    group = ET.SubElement(root, "group", name=name)
    for finger in fingers:
        ends = {"base_link": names.BASE, "tip_link": names.tip_link(finger)}
        ET.SubElement(group, "chain", ends)


def _add_states(root: ET.Element, group: str, joints: list[str], poses: _Poses) -> None:
    """Add a group's named states, in each of them the group's free joints."""
    for pose, angles in poses.items():
        state = ET.SubElement(root, "group_state", name=pose, group=group)
        for joint in joints:
            ET.SubElement(state, "joint", name=joint, value=repr(angles[joint]))
