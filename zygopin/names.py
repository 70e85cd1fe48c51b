"""Names of the links and joints of a foot's URDF; tools map by them, never by order."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Literal

from zygopin.finger import Finger
from zygopin.foot import Foot

BASE = "foot"
"""The rigid base link, at the junction that all fingers share."""

Pose = Literal["zygodactyl", "spread"]
"""Where a toe that can turn stands: at its azimuth, or at its reversed one."""


def phalanx_links(finger: Finger) -> tuple[str, ...]:
    """Links of a finger's phalanges, from the base outward."""
    return tuple(f"{finger.name}_phalanx{k}" for k in _ranks(finger))


def flexion_joints(finger: Finger) -> tuple[str, ...]:
    """Joints of a finger's phalanges, from the base outward; angle = omega·control."""
    return tuple(f"{finger.name}_joint{k}" for k in _ranks(finger))


def tip_link(finger: Finger) -> str:
    """Link at the end of a finger's last phalanx."""
    return f"{finger.name}_tip"


def turning_link(finger: Finger) -> str:
    """Link between the base and a reversible finger."""
    return f"{finger.name}_base"


def reversal_joint(finger: Finger) -> str:
    """Joint that turns a reversible finger about z; 0: the finger's azimuth."""
    return f"{finger.name}_reversal"


def is_reversible(finger: Finger) -> bool:
    """Whether a finger has a turning link and a reversal joint."""
    return finger.reversed_azimuth is not None


def bone_links(foot: Foot) -> Iterator[str]:
    """Links at the bones' ends: each finger's phalanges, then its tip."""
    for finger in foot.fingers:
        yield from phalanx_links(finger)
        yield tip_link(finger)


def moving_joints(foot: Foot) -> Iterator[str]:
    """Joints that move: each finger's flexion joints, then its reversal joint."""
    for finger in foot.fingers:
        yield from flexion_joints(finger)
        if is_reversible(finger):
            yield reversal_joint(finger)


def _ranks(finger: Finger) -> range:
    """Numbers k of a finger's phalanges."""
    return range(1, finger.phalanges + 1)
