"""A foot as robot descriptions: URDF through xacro, and the SRDF beside it.

The URDF's numbers come from the template alone, so that what ROS users expand and
what Python returns is one text. A phalanx is a cylinder and two spheres; bare bones
(a thickness below a millionth of the scale) are drawn, and weighed, as rods whose
radius is 1 % of their length, because no loader takes a radius of zero.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import contextmanager
from itertools import chain, combinations, pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from xml.etree import ElementTree as ET
from xml.parsers.expat import ExpatError

import xacro
import yaml

from zygopin import names
from zygopin.errors import DescriptionError
from zygopin.files import write_text
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.paths import XACRO_PATH

_XACRO = threading.Lock()
"""xacro keeps what it works on in globals: one expansion at a time."""


def to_urdf(foot: Foot, *, tendon: bool = False) -> str:
    """The foot's URDF, the same text for equal feet on every machine.

    Links `<finger>_phalanx<k>` and `<finger>_tip`, joints `<finger>_joint<k>` with
    angle = omega·control, and `<finger>_reversal` where a toe turns. Map joints by
    name: tools differ in their order.

    Args:
        foot: The foot.
        tendon: Whether every flexion joint mimics the first finger's first.

    Returns:
        The URDF [m, rad, kg], indented, with a newline at the end.

    Raises:
        DescriptionError: The template is missing or does not expand.
    """
    arguments = {"tendon": "true" if tendon else "false"}
    try:
        with TemporaryDirectory(prefix="zygopin-") as folder, _expansion():
            file = Path(folder) / "foot.yaml"
            file.write_text(yaml.safe_dump(foot.to_mapping()), encoding="utf-8")
            arguments["foot"] = str(file)
            document = xacro.process_file(str(XACRO_PATH), mappings=arguments)
    except (xacro.XacroException, ExpatError, OSError, RuntimeError) as error:
        remedy = "restore the shipped template"
        raise DescriptionError(f"{XACRO_PATH.name}: {error}", remedy) from error
    for node in [*document.childNodes]:
        if node is not document.documentElement:
            document.removeChild(node)  # xacro's banner, and the template's own note
    return str(document.toprettyxml(indent="  "))


def to_srdf(foot: Foot) -> str:
    """The foot's SRDF: what MoveIt and Pinocchio want to know beside the URDF.

    A group for each finger, one for the whole foot; the poses `rest` and `closed`,
    and `zygodactyl` and `spread` where a toe turns; pairs of links not to check for
    collision, because they touch by construction.

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
    for pose, angles in _poses(foot).items():
        state = ET.SubElement(root, "group_state", name=pose, group=whole)
        for joint, angle in angles.items():
            ET.SubElement(state, "joint", name=joint, value=repr(angle))
    for (link1, link2), reason in _touching_links(foot).items():
        pair = {"link1": link1, "link2": link2, "reason": reason}
        ET.SubElement(root, "disable_collisions", pair)
    ET.indent(root)
    text = ET.tostring(root, encoding="unicode")
    return f'<?xml version="1.0" ?>\n{text}\n'


def write_description(foot: Foot, folder: Path | str) -> tuple[Path, ...]:
    """Write foot.urdf, foot_tendon.urdf and foot.srdf, ready to load elsewhere.

    Args:
        foot: The foot.
        folder: Where to; created if it is missing.

    Returns:
        The three files.

    Raises:
        DescriptionError: The template is missing or does not expand.
        FileError: The folder cannot be written.
    """
    texts = {
        "foot.urdf": to_urdf(foot),
        "foot_tendon.urdf": to_urdf(foot, tendon=True),
        "foot.srdf": to_srdf(foot),
    }
    return tuple(write_text(Path(folder) / name, text) for name, text in texts.items())


@contextmanager
def _expansion() -> Iterator[None]:
    """Use xacro alone, and leave PyYAML's safe loader as it was.

    xacro teaches that loader tags which evaluate expressions, for every later user.
    """
    with _XACRO:
        known = dict(yaml.SafeLoader.yaml_constructors)
        try:
            yield
        finally:
            yaml.SafeLoader.yaml_constructors = known


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


def _poses(foot: Foot) -> dict[str, dict[str, float]]:
    """Named poses: {pose: {joint: angle [rad]}}, every joint in each."""
    joints = [*chain.from_iterable(map(names.flexion_joints, foot.fingers))]
    turning = [*filter(names.is_reversible, foot.fingers)]
    back = {names.reversal_joint(finger): 0.0 for finger in turning}
    ahead = {names.reversal_joint(finger): finger.reversal for finger in turning}
    straight = dict.fromkeys(joints, 0.0)
    poses = {
        "rest": straight | back,
        "closed": dict.fromkeys(joints, foot.omega) | back,
    }
    if turning:
        poses |= {"zygodactyl": straight | back, "spread": straight | ahead}
    return poses


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
