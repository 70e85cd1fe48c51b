"""Sets of contacts that several tests use."""

from __future__ import annotations

from functools import cache

import numpy as np

from zygopin.branch import Branch
from zygopin.contacts import Contacts
from zygopin.foot import Foot
from zygopin.perch import PerchPlan, plan_perch


def ring(*degrees, radius=1.0, heights=0.0, scale=None):
    """Contacts around a cylinder about z, at angles from x."""
    angles = np.radians(degrees)
    normals = np.stack([np.cos(angles), np.sin(angles), 0 * angles], axis=-1)
    lifts = np.broadcast_to(heights, angles.shape)[:, None] * [0.0, 0.0, 1.0]
    points = radius * normals + lifts
    return Contacts(points, normals, scale=radius if scale is None else scale)


@cache
def perched(name="parrot", radius=0.25) -> PerchPlan:
    """A preset's perch on a branch of a radius over the foot's size."""
    foot = Foot.preset(name)
    branch = Branch(radius=radius * foot.size, centre=(0, 0, -0.3 * foot.size))
    return plan_perch(foot, branch, find_height=True)
