"""The exact engine's distances by compiled loops, for few poses and for many."""

from __future__ import annotations

import math
from dataclasses import fields
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, clearance
from zygopin.blocks import entries
from zygopin.branch import Branch
from zygopin.clearance import Clearance, Floats
from zygopin.clearance_kernels import (
    Side,
    least_gap,
    least_products,
    side_clearance,
)
from zygopin.contact_products import Booleans, opposed_pairs
from zygopin.errors import ParameterError
from zygopin.foot import Foot

Pairs = tuple[NDArray[np.intp], NDArray[np.intp]]


def distances(
    bones: Floats, radii: Floats, branch: Branch, pairs: Pairs
) -> tuple[Clearance, Floats]:
    """`clearance.distances`, to the last places.

    Args:
        bones: Bones [m], shape (…, P, 2, 3).
        radii: Skin radii εₖ [m], shape (P,).
        branch: The branch, or a batch of them that broadcasts against the bones'.
        pairs: Indices of the first and of the second phalanges, shape (M,) each.

    Returns:
        The record, and signed distances [m] of the bones' own batch.

    Raises:
        ParameterError: Shapes do not fit, or a pair is none of the phalanges.
    """
    # The loops trust what they are given: copies are of one type, in C order.
    lines, skin = np.array(bones, float), np.array(radii, float)
    checks.shaped("bones", lines, (*lines.shape[:-2], 2, 3))
    checks.shaped("radii", skin, lines.shape[-3:-2])
    return _branch_clearance(lines, skin, branch), _least_gap(lines, skin, pairs)


def products(foot: Foot, tangent: Booleans, normals: Floats, bones: Floats) -> Floats:
    """`contact_products.both_products`, to the last places.

    Args:
        foot: The foot.
        tangent: Which phalanges are tangent, shape (…, P).
        normals: Unit normals at their contacts, shape (…, P, 3).
        bones: Bones [m], shape (…, P, 2, 3), which may have fewer batch axes.

    Returns:
        The two products, shape (2, …); NaN without such a pair.
    """
    batch, count = tangent.shape[:-1], foot.phalanx_count
    least = np.full((2, math.prod(batch)), np.nan)
    least_products(
        np.array(tangent).reshape(-1, count),
        np.array(normals).reshape(-1, count, 3),
        _flat(np.array(bones), batch, 3),
        opposed_pairs(foot)[:2],
        least,
    )
    return least.reshape(2, *batch)


def _branch_clearance(bones: Floats, radii: Floats, branch: Branch) -> Clearance:
    """Clearance between phalanges and branches."""
    batch = checks.common_batch(
        "bones and branch", bones.shape[:-3], branch.batch_shape
    )
    shape = (math.prod(batch), len(radii))
    side = Side(*(np.empty((*shape, *tail)) for tail in ((), (), (3,), (3,))))
    lateral, left = np.ones(shape, bool), np.zeros(shape[0], bool)
    poses, branches = _flat(bones, batch, 3), _flat(np.array(branch.rows), batch, 1)
    if side_clearance(poses, radii, branches, side, left):
        part = np.flatnonzero(left)
        some = entries(bones, batch, part, 3), radii, branch.entries(batch, part)
        exact = clearance.branch_clearance(*some)
        for room, field in zip((*side, lateral), fields(Clearance), strict=True):
            room[part] = getattr(exact, field.name)
    shaped = Side(*(x.reshape(*batch, *x.shape[1:]) for x in side))
    return Clearance(*shaped, lateral.reshape(*batch, len(radii)))


def _least_gap(bones: Floats, radii: Floats, pairs: Pairs) -> Floats:
    """Least distance between the skins of pairs of phalanges."""
    poses = bones.reshape(-1, *bones.shape[-3:])
    least = np.full(len(poses), np.inf)
    if not least_gap(poses, radii, pairs, least):
        found = [int(x) for x in np.concatenate(pairs) if not 0 <= x < len(radii)]
        allowed = f"from 0 to {len(radii) - 1}"
        raise ParameterError("pairs", found[0], allowed, "give indices of phalanges")
    return least.reshape(bones.shape[:-3])


def _flat(values: NDArray[Any], batch: tuple[int, ...], tail: int) -> NDArray[Any]:
    """Values as a flat batch; as they are where there is only one."""
    cut = values.ndim - tail
    one = values.shape[cut:]
    if math.prod(values.shape[:cut]) > 1 and values.shape[:cut] != batch:
        values = np.broadcast_to(values, (*batch, *one))
    return values.reshape(-1, *one)
