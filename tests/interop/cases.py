"""The feet that every tool loads, the poses they take, and what is asked of each."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np

from zygopin import names
from zygopin.branch import Branch
from zygopin.clearance import branch_clearance, skin_distance
from zygopin.description import to_urdf
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.presets import preset_names

RANDOM = (5, 1, 3, 2)
"""Fingers of the random feet; on the first, one of them turns."""

POSES = 4
"""Configurations for each file: random ones, and all joints at their upper limits."""

PAIRS = 3
"""Pairs of phalanges, and phalanges with the branch, to measure in each pose."""

APART = 0.02
"""Least distance of a pair to measure, over the foot's size: tools mean different
things by the depth of an overlap."""

LIGHTEST = 1e-6
"""Mass [kg] below which sdformat takes a link as massless and drops it."""

BRANCH = "branch"
"""The name of the branch among the links that are measured."""


@dataclass(frozen=True)
class Case:
    """One file, and what is asked of a tool that has loaded it.

    Attributes:
        name: The foot's name, with `_tendon` for that variant.
        foot: The foot.
        tendon: Whether it is the tendon variant.
        urdf: The text of the file.
    """

    name: str
    foot: Foot
    tendon: bool
    urdf: str

    @cached_property
    def controls(self) -> np.ndarray:
        """Controls of each pose, shape (POSES, P): equal ones for a tendon."""
        shape = POSES, 1 if self.tendon else self.foot.phalanx_count
        values = np.random.default_rng(7).uniform(size=shape)
        values[-1] = 1.0
        return np.broadcast_to(values, (POSES, self.foot.phalanx_count))

    @cached_property
    def turns(self) -> np.ndarray:
        """Turn of each finger from its azimuth in each pose [rad], shape (POSES, F)."""
        most = np.array([finger.reversal for finger in self.foot.fingers])
        parts = np.random.default_rng(8).uniform(size=(POSES, len(most)))
        return np.where(np.arange(POSES)[:, None] == POSES - 1, 1.0, parts) * most

    @cached_property
    def configurations(self) -> list[dict[str, float]]:
        """Angle of every joint that moves, in each pose [rad]."""
        return [
            self.angles(controls, turns)
            for controls, turns in zip(self.controls, self.turns, strict=True)
        ]

    @cached_property
    def leading(self) -> dict[str, float]:
        """The first pose with the followers left out [rad]."""
        followers = set(self.followers)
        first = self.configurations[0]
        return {name: first[name] for name in first if name not in followers}

    @cached_property
    def followers(self) -> list[str]:
        """Joints that mimic the leader."""
        joints = [
            joint
            for finger in self.foot.fingers
            for joint in names.flexion_joints(finger)
        ]
        return joints[1:] if self.tendon else []

    @property
    def leader(self) -> str:
        """The joint that the others of a tendon follow."""
        return names.flexion_joints(self.foot.fingers[0])[0]

    @property
    def tips(self) -> list[str]:
        """Links whose poses are compared."""
        return [*map(names.tip_link, self.foot.fingers)]

    @cached_property
    def bones(self) -> np.ndarray:
        """Bones in each pose [m], shape (POSES, P, 2, 3), in closed form."""
        azimuths = self.turns + [finger.azimuth for finger in self.foot.fingers]
        return forward_kinematics(self.foot, self.controls, azimuths=azimuths)

    @cached_property
    def drawn(self) -> Foot:
        """The foot as its URDF draws it: bare bones have 1 % of their length."""
        bare = self.foot.thickness < 1e-6 * self.foot.scale
        return self.foot.replace(thickness=self.foot.scale / 100) if bare else self.foot

    @cached_property
    def branch(self) -> Branch:
        """An oblique branch below the foot, its ends out of reach."""
        size = self.foot.size
        centre, axis = (0.1 * size, 0, -0.4 * size), (0.3, 1.0, -0.2)
        return Branch(0.15 * size, centre, axis, length=6 * size)

    @cached_property
    def gaps(self) -> list[list[tuple[str, str, float]]]:
        """In each pose, pairs of links that are apart, and their distance [m].

        The nearest phalanges of different fingers, and those nearest to the branch.
        """
        radii, fingers = self.drawn.radii, self.foot.finger_of_phalanx
        first, second = np.triu_indices(self.foot.phalanx_count, 1)
        other = fingers[first] != fingers[second]
        first, second = first[other], second[other]
        between = skin_distance(self.bones, radii, (first, second))
        to_branch = branch_clearance(self.bones, radii, self.branch).distance
        links = [
            link for finger in self.foot.fingers for link in names.phalanx_links(finger)
        ]
        return [
            [(links[first[k]], links[second[k]], apart[k]) for k in self._near(apart)]
            + [(links[k], BRANCH, wood[k]) for k in self._near(wood)]
            for apart, wood in zip(between, to_branch, strict=True)
        ]

    def _near(self, distances: np.ndarray) -> list[int]:
        """Indices of the PAIRS least distances that are not too small to compare."""
        order = np.argsort(distances)
        apart = distances[order] > APART * self.foot.size
        return [*map(int, order[apart][:PAIRS])]

    def angles(self, controls: np.ndarray, turns: np.ndarray) -> dict[str, float]:
        """Angle of every joint that moves [rad]."""
        found = {}
        parts = self.foot.finger_slices.values()
        for finger, part, turn in zip(self.foot.fingers, parts, turns, strict=True):
            angles = (self.foot.omega * controls[part]).tolist()
            found |= zip(names.flexion_joints(finger), angles, strict=True)
            if names.is_reversible(finger):
                found[names.reversal_joint(finger)] = float(turn)
        return found

    def question(self, folder: Path) -> dict:
        """What a reader is told, as plain values; writes the file.

        Args:
            folder: Where the URDF goes.

        Returns:
            What JSON can hold.
        """
        file = folder / f"{self.name}.urdf"
        file.write_text(self.urdf, encoding="utf-8")
        return {
            "name": self.name,
            "urdf": str(file),
            "base": names.BASE,
            "tips": self.tips,
            "joints": [*names.moving_joints(self.foot)],
            "configurations": self.configurations,
            "leading": self.leading,
            "leader": self.leader,
            "followers": self.followers,
            "pairs": [[gap[:2] for gap in gaps] for gaps in self.gaps],
            "branch": {
                "radius": self.branch.radius,
                "length": self.branch.length,
                "centre": self.branch.centre.tolist(),
                "rotation": self.branch.frame().tolist(),
            },
        }


def make_case(foot: Foot, *, tendon: bool) -> Case:
    """The case of a foot's file, as `to_urdf` writes it."""
    name = f"{foot.name}_tendon" if tendon else foot.name
    return Case(name, foot, tendon, to_urdf(foot, tendon=tendon))


def all_cases() -> Iterator[Case]:
    """Every preset and random foot, plain and with the tendon."""
    feet = [*map(Foot.preset, preset_names()), *map(random_foot, range(len(RANDOM)))]
    return (make_case(foot, tendon=t) for foot in feet for t in (False, True))


def random_foot(index: int) -> Foot:
    """A random foot at a size that birds have.

    Args:
        index: Which of RANDOM.

    Returns:
        The foot; none of its links that move is lighter than LIGHTEST.
    """
    rng = np.random.default_rng(index)
    turning = int(rng.integers(RANDOM[0])) if index == 0 else None
    while True:
        fingers = [_finger(k, k == turning, rng) for k in range(RANDOM[index])]
        scale = float(10 ** rng.uniform(-2, -1))
        foot = Foot(
            rho=float(rng.uniform(1.05, 1.6)),
            omega=float(rng.uniform(0.4, 2.2)),
            scale=scale,
            thickness=scale * float(rng.uniform(0.05, 0.25)),
            density=float(rng.uniform(500, 2000)),
            fingers=tuple(fingers),
            name=f"random{index + 1}",
        )
        if lightest(foot) > LIGHTEST:
            return foot


def _finger(index: int, turning: bool, rng: np.random.Generator) -> Finger:
    """A random finger, anywhere."""
    azimuth, turned = rng.uniform(-math.pi, math.pi, 2).tolist()
    return Finger(
        f"finger{index + 1}",
        int(rng.integers(2, 6)),
        azimuth,
        orientation=float(rng.uniform(-1, 1)),
        reversed_azimuth=turned if turning else None,
    )


def lightest(foot: Foot) -> float:
    """Mass of the lightest link that moves [kg]: a ball, or a capsule."""
    density, r = foot.density, foot.radii
    balls = 4 / 3 * math.pi * r**3 * density
    rods = math.pi * r**2 * foot.lengths * density
    # The hinge of a toe that turns weighs a ball of its first phalanx's radius.
    return float(min(balls.max(), (rods + balls).min()))


def with_urdf(case: Case, urdf: str) -> Case:
    """The same foot and questions, and another text."""
    return dataclasses.replace(case, urdf=urdf)
