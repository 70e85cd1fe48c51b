"""A scene around a foot's MuJoCo model: light, a perch where it has one, a floor."""

from __future__ import annotations

from xml.etree import ElementTree as ET

from zygopin import kinds
from zygopin.foot import Foot
from zygopin.mjcf_bodies import brief
from zygopin.poses import PERCH_RADIUS, standard_perch

PERCH_LENGTH = 4.0
"""Length of the perch over the foot's size."""

FLOOR = 2.0
"""Depth of the floor below the foot's base, over its size."""

_NOTE = """
    A foot with light, floor, and the perch of the keyframe perch, if it has one.
  """

_SKY = {"builtin": "gradient", "rgb1": "0.3 0.5 0.7", "rgb2": "0 0 0"}
_TILES = {"builtin": "checker", "rgb1": "0.2 0.3 0.4", "rgb2": "0.1 0.2 0.3"}


def to_mjcf_scene(foot: Foot, model: str) -> str:
    """A scene for the eye, with the foot as another file has it.

    Args:
        foot: The foot.
        model: The file that `to_mjcf` wrote, as seen from the scene's folder.

    Returns:
        The scene [m], indented, with a newline at the end.
    """
    kinds.text("model", model)
    kinds.instance("foot", foot, Foot)
    root = ET.Element("mujoco", model=f"{foot.name} scene")
    root.append(ET.Comment(_NOTE))
    ET.SubElement(root, "include", file=model)
    centre = brief(0, 0, -foot.size / 4)
    ET.SubElement(root, "statistic", extent=brief(2 * foot.size), center=centre)
    view = ET.SubElement(root, "visual")
    ET.SubElement(view, "headlight", ambient="0.3 0.3 0.3", diffuse="0.5 0.5 0.5")
    ET.SubElement(view, "global", azimuth="130", elevation="-15")
    _add_materials(ET.SubElement(root, "asset"), foot)
    world = ET.SubElement(root, "worldbody")
    ET.SubElement(world, "light", pos=brief(0, 0, 5 * foot.size), dir="0 0 -1")
    ground = {"pos": brief(0, 0, -FLOOR * foot.size), "material": "floor"}
    tiles = brief(0, 0, foot.size)
    ET.SubElement(
        world, "geom", {"name": "floor", "type": "plane"} | ground, size=tiles
    )
    _add_perch(world, foot)
    ET.indent(root)
    return ET.tostring(root, encoding="unicode") + "\n"


def _add_materials(asset: ET.Element, foot: Foot) -> None:
    """Add the sky, the floor's tiles, the perch's wood."""
    sky = {"type": "skybox", "width": "512", "height": "3072"}
    ET.SubElement(asset, "texture", sky | _SKY)
    tiles = {"name": "floor", "type": "2d", "width": "300", "height": "300"}
    ET.SubElement(asset, "texture", tiles | _TILES)
    repeat = brief(*[1 / foot.size] * 2)
    floor = {"name": "floor", "texture": "floor", "texuniform": "true"}
    ET.SubElement(asset, "material", floor | {"texrepeat": repeat})
    ET.SubElement(asset, "material", name="wood", rgba="0.45 0.33 0.22 1")


def _add_perch(world: ET.Element, foot: Foot) -> None:
    """Add the perch that the keyframe `perch` holds, if the foot has that pose."""
    plan = standard_perch(foot)
    if not plan.grasping:
        return
    branch = plan.branch
    half = PERCH_LENGTH / 2 * foot.size * branch.axis
    ends = brief(*(branch.centre - half), *(branch.centre + half))
    size = brief(PERCH_RADIUS * foot.size)
    shape = {"fromto": ends, "size": size, "material": "wood"}
    ET.SubElement(world, "geom", {"name": "perch", "type": "capsule"} | shape)
