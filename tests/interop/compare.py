"""A tool's answers against the right ones, each difference in its own unit."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import chain

import numpy as np
from reference import Poses, Reference
from tools import Mimic, Tool

from zygopin import names


@dataclass(frozen=True)
class Difference:
    """How far one quantity of one file is off.

    Attributes:
        quantity: Its name: position, rotation, mass, …
        file: The name of the case.
        value: The difference: lengths over the foot's size, masses over the foot's,
            angles in rad; counts as they are. NaN where the answer is not a number.
        allowed: What it may be.
    """

    quantity: str
    file: str
    value: float
    allowed: float

    @property
    def too_large(self) -> bool:
        """Whether it is more than allowed, or not a number."""
        return not self.value <= self.allowed


def differences(tool: Tool, right: Reference, answer: dict) -> list[Difference]:
    """All that a tool answered about one file, against what is right.

    Args:
        tool: The tool.
        right: The right answers.
        answer: What its reader gave.

    Returns:
        One entry for each quantity that it answered.
    """
    found = []
    for quantity, value, allowed in _values(tool, right, answer):
        found.append(Difference(quantity, right.case.name, float(value), allowed))
    return found


def _values(
    tool: Tool, right: Reference, answer: dict
) -> Iterator[tuple[str, float, float]]:
    """Quantity, difference and what is allowed."""
    yield from _moved(tool, right, answer)
    yield from _weighed(tool, right, answer)
    yield from _listed(right, answer)


def _moved(
    tool: Tool, right: Reference, answer: dict
) -> Iterator[tuple[str, float, float]]:
    """Poses, limits and distances."""
    size = right.case.foot.size
    if "poses" in answer:
        poses = right.closed_form if tool.reader == "pinocchio" else right.poses
        apart = [*map(pose_difference, poses, answer["poses"])]
        yield "position", max(apart)[0] / size, tool.precision
        yield "rotation", max(rotation for _, rotation in apart), tool.precision
    if "limits" in answer:
        yield "limits", _limits_apart(right, answer["limits"]), tool.precision
    if "distances" in answer:
        yield "distances", _gaps_apart(right, answer["distances"]) / size, tool.gap


def _weighed(
    tool: Tool, right: Reference, answer: dict
) -> Iterator[tuple[str, float, float]]:
    """Mass and centre of mass."""
    size, base = right.case.foot.size, tool.weighs_base
    if "mass" in answer:
        mass = right.mass(base=base)
        yield "mass", abs(answer["mass"] - mass) / mass, tool.precision
    if "centre" in answer:
        off = np.subtract(answer["centre"], right.centres(base=base))
        yield (
            "centre of mass",
            np.linalg.norm(off, axis=-1).max() / size,
            tool.precision,
        )


def _listed(right: Reference, answer: dict) -> Iterator[tuple[str, float, float]]:
    """What there is: shapes, links, parents."""
    if "shapes" in answer:
        yield "collision shapes", abs(answer["shapes"] - right.shapes), 0
    if "links" in answer:
        there = set(answer["links"]) - set(right.case.tips)
        wanted = {names.BASE, *right.parents} - set(right.case.tips)
        yield "links", len(there ^ wanted), 0
    if "parents" in answer:
        wrong = set(answer["parents"].items()) ^ set(right.parents.items())
        yield "parents", len(wrong), 0


def pose_difference(right: Poses, given: dict) -> tuple[float, float]:
    """Largest distance of a tip [m], and largest entry of the rotations' difference."""
    if set(right) - set(given):
        return math.inf, math.inf
    off = np.array([np.subtract(given[tip], right[tip]) for tip in right])
    return (
        float(np.linalg.norm(off[:, :3, 3], axis=-1).max()),
        float(np.abs(off[:, :3, :3]).max()),
    )


def _limits_apart(right: Reference, given: dict) -> float:
    """Largest difference of a limit; followers may be left out, no other joint."""
    if set(right.limits) - set(given) - set(right.case.followers):
        return math.inf
    pairs = [(given[name], right.limits[name]) for name in given]
    return float(np.abs([np.subtract(*pair) for pair in pairs]).max())


def _gaps_apart(right: Reference, given: list) -> float:
    """Largest difference of a distance [m]."""
    apart = [gap for gaps in right.case.gaps for *_, gap in gaps]
    return float(np.abs(np.subtract([*chain.from_iterable(given)], apart)).max())


def mimic(tool: Tool, right: Reference, answer: dict) -> Mimic | str:
    """What became of the followers when only the leader was set.

    Args:
        tool: The tool.
        right: The right answers for a tendon's file.
        answer: What its reader gave.

    Returns:
        A word of Mimic, or what is wrong.
    """
    if "led" not in answer:
        return "-"
    wanted = dict.fromkeys(right.case.followers, (right.case.leader, 1.0, 0.0))
    given = {}
    for source in ("mimics", "constraints"):
        given[source] = answer.get(source, {})
        if given[source] and not _same_mimics(given[source], wanted):
            return f"wrong {source}: {given[source]}"
    if _near(tool, right, right.poses[0], answer["led"]):
        return "honoured"
    if not _near(tool, right, right.held, answer["led"]):
        return "wrong: the followers neither follow nor stay"
    if given["constraints"]:
        return "as constraint"
    return "ignored" if given["mimics"] else "not read"


def _near(tool: Tool, right: Reference, poses: Poses, given: dict) -> bool:
    """Whether poses agree."""
    position, rotation = pose_difference(poses, given)
    return max(position / right.case.foot.size, rotation) <= tool.precision


CONSTRAINED = 1e-5
"""Difference allowed in a multiplier or an offset [rad], as seen in a simulation."""


def _same_mimics(given: dict, wanted: dict) -> bool:
    """Whether every follower has its leader, multiplier and offset."""
    return set(given) == set(wanted) and all(
        given[name][0] == wanted[name][0]
        and np.allclose(given[name][1:], wanted[name][1:], rtol=0, atol=CONSTRAINED)
        for name in wanted
    )
