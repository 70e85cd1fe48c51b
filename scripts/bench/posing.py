"""The job of forward kinematics, and its answer: the junctions of all 14 bones."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property
from itertools import chain
from pathlib import Path

import numpy as np

from zygopin import Foot, names, to_urdf
from zygopin.clearance import Floats


@dataclass(frozen=True)
class Posing:
    """The job: many control sequences of one foot.

    Attributes:
        foot: The foot.
        controls: The controls, shape (N, P).
    """

    foot: Foot
    controls: Floats

    @property
    def count(self) -> int:
        """Number of control sequences."""
        return len(self.controls)

    def few(self, count: int) -> Posing:
        """The first so many of them."""
        return Posing(self.foot, self.controls[:count])

    @property
    def urdf(self) -> str:
        """The foot's URDF."""
        return _urdf(self.foot)

    @cached_property
    def links(self) -> list[str]:
        """Links whose origins are wanted, phalanges and tips."""
        return [*names.bone_links(self.foot)]

    @cached_property
    def joints(self) -> list[str]:
        """Joints in the order of the controls."""
        return [*chain.from_iterable(map(names.flexion_joints, self.foot.fingers))]

    def angles(self, order: list[str] | None = None) -> Floats:
        """Joint angles [rad], shape (N, P), contiguous, in a tool's own order."""
        columns = [self.joints.index(name) for name in order or self.joints]
        return np.ascontiguousarray(self.foot.omega * self.controls[:, columns])

    def room(self) -> Floats:
        """Where the junctions are written, shape (N, P + F, 3)."""
        return np.empty((len(self.controls), len(self.links), 3))

    def bones(self, junctions: Floats) -> Floats:
        """The bones between junctions, shape (N, P, 2, 3)."""
        starts = np.arange(self.foot.phalanx_count) + self.foot.finger_of_phalanx
        return np.stack([junctions[:, starts], junctions[:, starts + 1]], axis=2)

    def file(self, folder: str) -> str:
        """The URDF as a file in a folder."""
        path = Path(folder) / "foot.urdf"
        path.write_text(self.urdf, encoding="utf-8")
        return str(path)


@cache
def _urdf(foot: Foot) -> str:
    """A foot's URDF, which takes a tenth of a second."""
    return to_urdf(foot)
