"""Poses on branches, a flat batch of them: what the exact engine says of some."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from zygopin.blocks import Part, entries
from zygopin.bones import posed_bones
from zygopin.branch import Branch
from zygopin.clearance import branch_clearance
from zygopin.contact_products import base_to_tip, least_products
from zygopin.directions import Floats
from zygopin.foot import Foot
from zygopin.grasp import (
    PARAMETER_SLACK,
    Booleans,
    Criteria,
    classify,
    fingers_apart,
)


@dataclass(frozen=True, eq=False)
class Cases:
    """Poses on branches, a flat batch of them.

    Attributes:
        foot: The foot.
        controls: Checked controls, shape (…, P).
        branch: The branches, which leave the base outside.
        batch: Shape of the batch.
        criteria: What counts as contact and as a grasp.
    """

    foot: Foot
    controls: Floats
    branch: Branch
    batch: tuple[int, ...]
    criteria: Criteria

    @property
    def count(self) -> int:
        """How many there are."""
        return math.prod(self.batch)

    def poses(self, part: Part) -> Floats:
        """Controls of some cases, shape (n, P), or (1, P) where all have the same."""
        return np.atleast_2d(entries(self.controls, self.batch, part, 1))

    def branches(self, part: Part) -> Branch:
        """Branches of some cases, shape (n,), or the branch where all have the same."""
        return self.branch.entries(self.batch, part)

    def checked(self, part: Part) -> Booleans:
        """Stable, grasping, feasible of some cases, shape (3, n): all is measured."""
        foot, tolerance = self.foot, self.criteria.metres(self.foot)
        bones = posed_bones(foot, self.poses(part), threads=1)
        near = branch_clearance(bones, foot.radii, self.branches(part))
        contacts = classify(near, tolerance)
        vectors = near.normal
        if self.criteria.reading == "base_to_tip":
            vectors = base_to_tip(bones)
        (least,) = least_products(foot, contacts.tangent, vectors)
        entered = contacts.penetrating.any(axis=-1)
        free = ~entered & fingers_apart(foot, bones, tolerance)
        return np.array([np.isfinite(least), least <= PARAMETER_SLACK, free])

    def apart(self, part: Part) -> Booleans:
        """Whether no two fingers collide, shape (n,) or (1,)."""
        bones = posed_bones(self.foot, self.poses(part), threads=1)
        return fingers_apart(self.foot, bones, self.criteria.metres(self.foot))
