"""The paper's proposition 2: which branches fingers 1 and 3 can lie on and grasp."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from zygopin.branch import Branch
from zygopin.branch_solutions import BranchSolutions
from zygopin.control_system import as_levels
from zygopin.foot import Foot
from zygopin.grasp import Criteria, check_grasp
from zygopin.paper.entry import (
    BY_HAND,
    Entry,
    Measurement,
    at_most,
    equal,
)
from zygopin.paper.finger_plane import (
    ITERATED,
    PAIR,
    PLACE,
    Floats,
    phalanx_lines,
)
from zygopin.paper.resting_scan import Case, Scan, scan
from zygopin.paper.tangency import CHANGE, solved_branches
from zygopin.paper.tangency_solver import solve
from zygopin.paper.touched_radii import touch_measurements
from zygopin.resting import resting_branches, resting_radii

LEVELS = 3
"""Equal levels of each control for which the branches under the base are sought."""


def proposition_2() -> Entry:
    """Stability and grasping by solutions of the system, both directions.

    Returns:
        The entry.
    """
    scans = _scans()
    cases = sum(found.scanned for found in scans.values())
    return Entry(
        key="proposition-2",
        kind="statement",
        title="Which branches the foot can lie on, and which it grasps",
        place=f"{PLACE}, proposition 2",
        printed=(
            r"if two control sequences, $K_1\leq2$ and $K_3\leq4$ long, solve the "
            "system with the same cylinder, the foot can be stable on it; if also the "
            "grasping condition holds, it grasps"
        ),
        ours="both directions, with the corrected system and condition",
        finding=(
            "If: on every branch on which the system has a solution with both "
            "fingers, the exact engine and FCL say stable, and grasping where the "
            "product of the contact normals is not positive. Only if: for branches "
            "under the base (axis $x=0$, $z=-r$) the search knows nothing of the "
            f"system. For each of {cases} cases, a phalanx with its controls in "
            r"$\{0,\frac12,1\}$, the radius is scanned; it enters the growing branch "
            "at one radius at most, for thicker branches hold the thinner ones; there "
            "FCL tells a tangency from a touch with an end. What is found is what "
            "resting_radii and resting_branches list, no more and no less. Over the "
            "whole of $[0,1]$ the touch intervals bound the radii that any controls "
            "can touch."
        ),
        measurements=(
            *_if(),
            *_only_if(scans),
            *_pairs(scans),
            *touch_measurements(Foot.preset("paper")),
        ),
    )


def erratum_9() -> Entry:
    """The abstract's "necessary and sufficient".

    Returns:
        The entry.
    """
    cases = solved_branches()
    solvable, stable = _verdicts(cases.foot, cases.found)
    return Entry(
        key="erratum-9",
        kind="erratum",
        title="Necessary and sufficient",
        place="abstract, and proposition 2",
        printed="a necessary and sufficient condition; the proposition: if",
        ours="both directions",
        finding=(
            "The corrected system is both: a foot is stable on a branch by fingers 1 "
            "and 3 exactly if the system has a solution for a phalanx of each. Here "
            "this is held against the exact engine's verdict on the branches of the "
            "system's entry and on the same with their radii changed. The exhaustive "
            "search, and the same for grasping, are in the entry on proposition 2."
        ),
        measurements=(
            Measurement("poses", "poses and branches compared", float(len(stable))),
            Measurement("stable", "of them stable", float(np.count_nonzero(stable))),
            Measurement(
                "sufficient",
                "solvable and not stable",
                float(np.count_nonzero(solvable & ~stable)),
                equal(0.0, 0.0, "exact engine"),
            ),
            Measurement(
                "necessary",
                "stable and not solvable",
                float(np.count_nonzero(stable & ~solvable)),
                equal(0.0, 0.0, "exact engine"),
            ),
        ),
    )


def _if() -> tuple[Measurement, ...]:
    """Solutions of the system that both engines are asked about."""
    cases = solved_branches()
    found, angle = cases.found, cases.solved.angle
    fcl = check_grasp(found.foot, found.controls, found.branches, engine="fcl")
    product = np.cos(angle[:, 0] - angle[:, 1])
    opposed = product <= ITERATED
    counts = (
        ("if_stable", "not stable by the exact engine", ~found.stable),
        ("if_stable_fcl", "not stable by FCL", ~fcl.stable),
        (
            "if_grasping",
            r"with $\cos(\theta_1-\theta_3)\leq0$ and not grasping, exact engine",
            opposed & ~found.grasping,
        ),
        ("if_grasping_fcl", "the same by FCL", opposed & ~fcl.grasping),
        (
            "only_if_grasping",
            r"grasping by either engine and $\cos(\theta_1-\theta_3)>0$",
            (found.grasping | fcl.grasping) & ~opposed,
        ),
    )
    return (
        Measurement(
            "solutions",
            "solutions of the system's entry, a family once",
            float(len(found)),
        ),
        Measurement(
            "opposed",
            r"of them with $\cos(\theta_1-\theta_3)\leq0$",
            float(np.count_nonzero(opposed)),
        ),
        *(
            Measurement(
                name, words, float(np.count_nonzero(bad)), equal(0.0, 0.0, "the claim")
            )
            for name, words, bad in counts
        ),
    )


@lru_cache(1)
def _scans() -> dict[str, Scan]:
    """The scan of each finger's control sequences."""
    foot, levels = Foot.preset("paper"), as_levels(LEVELS)
    return {finger: scan(foot, finger, levels, "fcl") for finger in PAIR}


def _only_if(scans: dict[str, Scan]) -> tuple[Measurement, ...]:
    """What the scans find against what is listed, finger by finger."""
    missed, unfound, apart, tangent, ends = 0, 0, 0.0, 0, 0
    for finger, found in scans.items():
        sought = {**found.tangent, **dict.fromkeys(found.always, np.nan)}
        listed = _listed(finger)
        missed += len(sought.keys() - listed.keys())
        unfound += len(listed.keys() - sought.keys())
        both = found.tangent.keys() & listed.keys()
        gaps = [abs(listed[case] - found.tangent[case]) for case in both]
        apart = max([apart, *gaps])
        tangent, ends = tangent + len(sought), ends + len(found.touching)
    return (
        Measurement(
            "scanned",
            "radii tried in all, all cases",
            float(sum(each.scanned * each.radii for each in scans.values())),
        ),
        Measurement(
            "ends_only", "cases that touch a branch with an end alone", float(ends)
        ),
        Measurement("tangent", "cases that are tangent to a branch", float(tangent)),
        Measurement(
            "missed",
            "of them not listed by resting_radii",
            float(missed),
            equal(0.0, 0.0, "the scan"),
        ),
        Measurement(
            "unfound",
            "listed and not found",
            float(unfound),
            equal(0.0, 0.0, "the scan"),
        ),
        Measurement(
            "radius",
            "largest difference of the radii",
            apart,
            at_most(ITERATED, "halving on the clearance's sign"),
        ),
    )


def _listed(finger: str) -> dict[Case, float]:
    """The radii that resting_radii lists, by the controls up to the phalanx."""
    found = resting_radii(Foot.preset("paper"), finger, LEVELS)
    rows = zip(
        found.controls[found.on_bone],
        found.phalanx[found.on_bone],
        found.radius[found.on_bone],
        strict=True,
    )
    return {
        (tuple(map(float, controls[:rank])), int(rank)): float(radius)
        for controls, rank, radius in rows
    }


def _pairs(scans: dict[str, Scan]) -> tuple[Measurement, ...]:
    """Branches to which both fingers are tangent, by the scans."""
    one, other = (scans[finger] for finger in PAIR)
    equal_radii = [
        r
        for r in one.tangent.values()
        for x in other.tangent.values()
        if abs(r - x) <= ITERATED
    ]
    single = [
        *[r for r in other.tangent.values() for _ in one.always],
        *[r for r in one.tangent.values() for _ in other.always],
        *equal_radii,
    ]
    families = len(one.always) * len(other.always)
    found = resting_branches(Foot.preset("paper"), PAIR, LEVELS)
    ours = np.sort(found.radius[~found.family])
    same = len(ours) == len(single)
    apart = np.abs(ours - np.sort(single)).max() if same else np.inf
    return (
        Measurement(
            "pairs",
            "branches that resting_branches lists, both fingers tangent",
            float(len(found)),
            equal(float(len(single) + families), 0.0, "the scans, matched by radius"),
        ),
        Measurement(
            "pairs_radius",
            "largest difference of their radii",
            float(apart),
            at_most(ITERATED, "the scans"),
        ),
        Measurement(
            "families",
            "families, in which every radius will do: straight first phalanges",
            float(np.count_nonzero(found.family)),
            equal(1.0, 0.0, f"horizontal at the base, {BY_HAND}"),
        ),
    )


def _verdicts(
    foot: Foot, found: BranchSolutions
) -> tuple[NDArray[np.bool_], NDArray[np.bool_]]:
    """Solvable by the system, and stable by the exact engine, radii changed or not."""
    solvable, stable = [], []
    for change in (0.0, CHANGE, -CHANGE):
        radius = found.radius + change
        branch = Branch(radius, found.branches.centre)
        rows = ~branch.holds_origin
        controls = found.controls[rows]
        report = check_grasp(
            found.foot, controls, branch[rows], criteria=Criteria(tolerance=ITERATED)
        )
        stable.append(report.stable)
        solvable.append(_solvable(foot, found, radius, rows))
    return np.concatenate(solvable), np.concatenate(stable)


def _solvable(
    foot: Foot, found: BranchSolutions, radius: Floats, rows: NDArray[np.bool_]
) -> NDArray[np.bool_]:
    """Whether the system has a solution for a phalanx of each finger."""
    controls = found.controls[rows]
    height, size = found.height[rows, None], radius[rows, None]
    each = [
        solve(
            foot,
            phalanx_lines(foot, finger, controls[:, part]),
            height,
            size,
        )
        for finger, part in found.foot.finger_slices.items()
    ]
    one, other = ((x.misfit <= ITERATED).any(axis=1) for x in each)
    return np.asarray(one & other)
