"""Checks of a URDF's text, before a parser that complains on stderr sees it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from xml.etree import ElementTree as ET

from zygopin import names
from zygopin.errors import DescriptionError
from zygopin.foot import Foot

REMEDY = "give the URDF of this foot, as to_urdf writes it"

_INERTIA = ("ixx", "ixy", "ixz", "iyy", "iyz", "izz")
_SINGLE = ("effort", "length", "lower", "multiplier", "offset", "radius", "upper")
_NUMBERS = {
    "xyz": 3,
    "rpy": 3,
    "size": 3,
    **dict.fromkeys((*_INERTIA, *_SINGLE, "velocity"), 1),
}
"""Attributes that hold numbers, and how many; parsers drop what they cannot read."""

_NEEDED = {
    "axis": ("xyz",),
    "box": ("size",),
    "cylinder": ("length", "radius"),
    "inertia": _INERTIA,
    "limit": ("effort", "velocity"),
    "mass": ("value",),
    "mimic": ("joint",),
    "sphere": ("radius",),
}
"""Attributes that elements must have."""

_SIZES = {"cylinder": ("length", "radius"), "mass": ("value",), "sphere": ("radius",)}
"""Attributes that are not negative."""

_TYPES = ("continuous", "fixed", "floating", "planar", "prismatic", "revolute")
"""Joints that there are."""


def check_urdf(urdf: str, foot: Foot) -> None:
    """A URDF that is well-formed and has every link and joint of a foot.

    Args:
        urdf: The text.
        foot: The foot that it shall describe.

    Raises:
        DescriptionError: Says in one line what is wrong.
    """
    root = _parsed(urdf)
    for kind, wanted in (
        ("link", (names.BASE, *names.bone_links(foot))),
        ("joint", names.moving_joints(foot)),
    ):
        there = [element.get("name") for element in root.findall(kind)]
        for name in wanted:
            if there.count(name) != 1:
                raise _problem(f"has {there.count(name)} {kind}s named {name}, not one")
    for element in root.iter():
        _check_needed(element)
        _check_numbers(element)
    links = {link.get("name") for link in root.findall("link")}
    for joint in root.findall("joint"):
        _check_joint(joint, links)


def _parsed(urdf: str) -> ET.Element:
    """The root of the text."""
    try:
        root = ET.fromstring(urdf)  # noqa: S314
    except (ET.ParseError, ValueError, TypeError) as error:
        raise DescriptionError(f"the URDF is not XML: {error}", REMEDY) from error
    if root.tag != "robot":
        raise _problem(f"has the root <{root.tag}>, not <robot>")
    return root


def _check_needed(element: ET.Element) -> None:
    """An element has the attributes that parsers complain without."""
    for attribute in _NEEDED.get(element.tag, ()):
        if element.get(attribute) is None:
            raise _problem(f"has no {attribute} in <{element.tag}>")


def _check_numbers(element: ET.Element) -> None:
    """Attributes of an element that shall be numbers are."""
    wanted = _NUMBERS | ({"value": 1} if element.tag == "mass" else {})
    for attribute, count in wanted.items():
        text = element.get(attribute)
        if text is not None and not _are_numbers(text.split(), count):
            raise _problem(f'has {attribute}="{text}" in <{element.tag}>')
    for attribute in _SIZES.get(element.tag, ()):
        if float(element.attrib[attribute]) < 0:
            raise _problem(f"has a negative {attribute} in <{element.tag}>")
    if element.tag == "axis" and not any(map(float, element.attrib["xyz"].split())):
        raise _problem("has an axis of no length")


def _are_numbers(words: Iterable[str], count: int) -> bool:
    """Whether the words are so many finite numbers."""
    try:
        numbers = [float(word) for word in words]
    except ValueError:
        return False
    return len(numbers) == count and all(map(math.isfinite, numbers))


def _check_joint(joint: ET.Element, links: set[str | None]) -> None:
    """A joint is of a known type, joins two links, and has limits where it turns."""
    if joint.get("type") not in _TYPES:
        raise _problem(f"has the type {joint.get('type')} of {joint.get('name')}")
    for end in ("parent", "child"):
        element = joint.find(end)
        if element is None or element.get("link") not in links:
            raise _problem(f"has no {end} link for the joint {joint.get('name')}")
    if joint.get("type") == "revolute" and joint.find("limit") is None:
        raise _problem(f"has no limits for the joint {joint.get('name')}")


def _problem(text: str) -> DescriptionError:
    """The error that says what a URDF has and should not have."""
    return DescriptionError(f"the URDF {text}", REMEDY)
