"""Branches under the base, sought without the equations that list them.

The branch of radius r has its axis at x = 0, z = −r. Thicker ones hold the thinner, so
a phalanx that starts outside goes in once as r grows, or never: its clearance changes
sign at one radius, which a scan over r brackets and halving finds.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np
from numpy.typing import NDArray

from zygopin.engine import EngineName
from zygopin.foot import Foot
from zygopin.grasp import check_grasp
from zygopin.paper.finger_plane import Floats
from zygopin.placement import Placement

RADII = np.geomspace(0.05, 100.0, 400)
"""Radii of the scan, over the foot's scale. A phalanx that reaches below the base by
z at a distance p touches no later than at p²/2z; the scan ends beyond all of these."""

HALVINGS = 60
"""Halvings of a bracket: below the spacing of doubles."""

TOUCH = 1e-12
"""Clearance that is rounding."""

Case = tuple[tuple[float, ...], int]
"""Controls v₁ … vₖ of a phalanx, and k."""


@dataclass(frozen=True, eq=False)
class Scan:
    """What a scan over the radius finds for one finger.

    Attributes:
        tangent: The radius for each case whose phalanx is tangent there.
        touching: The radius for those that only touch with an end.
        always: Cases that are tangent at every radius.
        scanned: Number of cases.
        radii: Number of radii on which each was tried.
    """

    tangent: dict[Case, float]
    touching: dict[Case, float]
    always: set[Case]
    scanned: int
    radii: int


def scan(foot: Foot, finger: str, levels: Floats, engine: EngineName = "exact") -> Scan:
    """Scan all control sequences of a finger.

    Args:
        foot: The foot.
        finger: Its name.
        levels: The control set, shape (n,).
        engine: What tells tangencies at the radii that are found.

    Returns:
        What it finds.
    """
    alone = foot.replace(fingers=[x for x in foot.fingers if x.name == finger])
    cases, controls = _cases(alone.phalanx_count, levels)
    row = np.arange(len(cases))
    rank = np.array([len(values) - 1 for values, _ in cases])
    report = check_grasp(alone, controls[:, None], Placement().branch(-RADII, RADII))
    gap = report.clearance[row, :, rank]
    always = report.tangent[row, :, rank].all(axis=1)
    enters = (gap[:, 0] > TOUCH) & (gap[:, -1] < -TOUCH)
    kept = np.flatnonzero(enters & ~always)
    first = np.argmax(gap[kept] < 0, axis=1)
    radius = _halved(alone, controls[kept], rank[kept], first)
    found = check_grasp(
        alone, controls[kept], Placement().branch(-radius, radius), engine=engine
    )
    tangent = found.tangent[np.arange(len(kept)), rank[kept]]
    pairs = list(zip(kept, radius, tangent, strict=True))
    return Scan(
        tangent={cases[i]: float(r) for i, r, yes in pairs if yes},
        touching={cases[i]: float(r) for i, r, yes in pairs if not yes},
        always={cases[i] for i in np.flatnonzero(always)},
        scanned=len(cases),
        radii=len(RADII),
    )


def _cases(phalanges: int, levels: Floats) -> tuple[list[Case], Floats]:
    """All v₁ … vₖ, k up to K, and the controls with zeros after them."""
    cases = [
        (values, k)
        for k in range(1, phalanges + 1)
        for values in product(map(float, levels), repeat=k)
    ]
    padded = [(*values, *(0.0,) * (phalanges - k)) for values, k in cases]
    return cases, np.array(padded)


def _halved(
    foot: Foot, controls: Floats, rank: NDArray[np.intp], first: NDArray[np.intp]
) -> Floats:
    """The radii between the last grid value outside and the first inside."""
    low, high = RADII[first - 1], RADII[first]
    for _ in range(HALVINGS):
        middle = (low + high) / 2
        report = check_grasp(foot, controls, Placement().branch(-middle, middle))
        outside = report.clearance[np.arange(len(rank)), rank] > 0
        low, high = np.where(outside, middle, low), np.where(outside, high, middle)
    return np.asarray((low + high) / 2)
