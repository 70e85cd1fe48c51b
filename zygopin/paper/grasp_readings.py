"""The paper's grasping condition: its sign at zero, and what it is the product of."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np

from zygopin.grasp import GraspReport, check_grasp
from zygopin.paper.entry import (
    BY_HAND,
    EXACT,
    Entry,
    Exhibit,
    Measurement,
    at_most,
    equal,
)
from zygopin.paper.finger_plane import (
    ITERATED,
    PAIR,
    PLACE,
    phalanx_lines,
    section_tangent,
)
from zygopin.paper.grasp_cases import Case, perch, trunk, verdicts
from zygopin.paper.tangency import solved_branches

CONDITION = (
    r"$(\frac{t^{(1)}}{\rho^{K_1}}e^{-i\omega\sum "
    r"v_n^{(1)}})\cdot(\frac{t^{(3)}}{\rho^{K_3}}e^{-i\omega\sum v_n^{(3)}})<0$"
)


def scalar_product() -> Entry:
    """Which directions the product is of.

    Returns:
        The entry.
    """
    return Entry(
        key="scalar-product",
        kind="erratum",
        title="What the scalar product is of",
        place=f"{PLACE}, condition (4) and its remark",
        printed=CONDITION,
        ours=(
            r"the product of the contact normals, $\cos(\theta_1-\theta_3)\leq0$; the "
            "printed one by name, as base_to_tip"
        ),
        finding=(
            "The formula takes each phalanx from base to tip. Fingers 1 and 3 point "
            "away from each other, so on a trunk on which they lie nearly flat their "
            "product is nearly −1, which the formula calls a grasp; clasping a perch "
            "from both sides they both point down, and it is positive, which is none. "
            "The factors t make it vanish where a toe touches at the base, or with its "
            "first point. The paper's remark, that both terms are the phalanges' "
            "orientation, supports base to tip; the normals are our proposal. They are "
            "what the tangents give where all go one way around the branch, as "
            "$\\dot\\gamma$ does: seen along the branch the product of the unit "
            "tangents is that of the contact normals, and a grasp is two contacts that "
            "are at least a quarter turn apart. In the plane of the fingers, which "
            "cuts the branch obliquely, it differs from that by a little, and may do "
            "so in sign where the normals are nearly perpendicular."
        ),
        measurements=(
            *_case_measurements(trunk(), "trunk", "on the trunk"),
            *_case_measurements(perch(), "perch", "on the perch"),
            *_all_solutions(),
            *_in_the_plane(),
        ),
        figures=(
            Exhibit(
                "scalar-product.png",
                "Side views along the branch, in the paper's units. Left: toes nearly "
                "flat on a trunk of radius 22; their directions (red) are opposite, "
                "the contact normals (black) agree. Right: second phalanges clasp a "
                "perch of radius 0.698; the normals are 122° apart, the directions "
                "60°. Fingers 2 and 3, and 1 and 4, cover each other.",
                _draw_readings,
            ),
        ),
        scenes=(
            Exhibit(
                "scalar-product.html",
                "The clasped perch: a grasp by the contact normals, none by the "
                "printed product.",
                partial(_write_scene, verdicts(perch())),
            ),
        ),
    )


def _case_measurements(case: Case, name: str, where: str) -> tuple[Measurement, ...]:
    """Both products and verdicts of a pose astride a branch."""
    report, other = verdicts(case), verdicts(case, "base_to_tip")
    fcl = check_grasp(case.foot, case.controls, case.branch, engine="fcl")
    normals, along = math.cos(2 * case.seen), -math.cos(2 * case.pitch)
    return (
        Measurement(
            f"{name}_normals",
            f"{where}: product of the contact normals",
            float(report.scalar_product),
            equal(
                normals,
                EXACT,
                f"cos 2α′, tan α′ = tan α/cos Ω, α the phalanges' pitch, {BY_HAND}",
            ),
        ),
        Measurement(
            f"{name}_base_to_tip",
            f"{where}: product of the directions",
            float(report.scalar_product_base_to_tip),
            equal(along, EXACT, f"−cos 2α, {BY_HAND}"),
        ),
        Measurement(
            f"{name}_formula",
            f"{where}: the formula's product, with its factors $t/\\rho^K$",
            _formula(case, report),
            equal(_scale(case) * along, EXACT, f"−(t/ρᴷ)²·cos 2α, {BY_HAND}"),
        ),
        Measurement(
            f"{name}_grasping",
            f"{where}: grasping by the normals (1: yes)",
            float(report.grasping),
            equal(float(normals <= 0), 0.0, BY_HAND),
        ),
        Measurement(
            f"{name}_grasping_base_to_tip",
            f"{where}: grasping by the directions",
            float(other.grasping),
            equal(float(along <= 0), 0.0, BY_HAND),
        ),
        Measurement(
            f"{name}_feasible",
            f"{where}: nothing enters the branch",
            float(report.feasible),
            equal(1.0, 0.0, "the pose is one that a foot can take"),
        ),
        Measurement(
            f"{name}_fcl",
            f"{where}: largest difference of clearances to FCL",
            report.difference(fcl),
            at_most(ITERATED, "FCL"),
        ),
    )


def _rank(case: Case) -> int:
    """Number of the tangent phalanx of a pose astride a branch."""
    first = case.controls[case.foot.finger_slices[PAIR[0]]]
    return int(np.count_nonzero(first))


def _scale(case: Case) -> float:
    """(t/ρᴷ)² with t = 1/2, where the poses are touched."""
    return (0.5 * case.foot.rho ** -_rank(case)) ** 2


def _formula(case: Case, report: GraspReport) -> float:
    """The printed product: t times the phalanx, of fingers 1 and 3."""
    steps = []
    for finger in PAIR:
        part = case.foot.finger_slices[finger]
        _, step = phalanx_lines(case.foot, finger, case.controls[part])
        rank = _rank(case) - 1
        steps.append(float(report.t[part][rank]) * step[rank])
    return float((steps[0] * np.conj(steps[1])).real)


def _all_solutions() -> tuple[Measurement, ...]:
    """The readings on all stable branches of a control set."""
    found = solved_branches().found
    masks = {
        "solutions": ("solutions of the system's entry, stable", found.stable),
        "grasping": ("of them grasping by the normals", found.grasping),
        "grasping_base_to_tip": (
            "grasping by the directions",
            found.grasping_base_to_tip,
        ),
        "differ": (
            "on which the two verdicts differ",
            found.grasping != found.grasping_base_to_tip,
        ),
    }
    return tuple(
        Measurement(name, words, float(np.count_nonzero(mask)))
        for name, (words, mask) in masks.items()
    )


def _in_the_plane() -> tuple[Measurement, ...]:
    """How the product of the ellipse's tangents differs from that of the normals."""
    cases = solved_branches()
    angle, tangent = cases.solved.angle, cases.solved.tangent
    unit, splay = tangent / np.abs(tangent), cases.foot.splay
    plane = (unit[:, 0] * np.conj(unit[:, 1])).real
    normals = np.cos(angle[:, 0] - angle[:, 1])
    corners = section_tangent(np.array([1, 3]) * math.pi / 4, 1.0, 1 / math.cos(splay))
    corners = corners / np.abs(corners)
    return (
        Measurement(
            "plane",
            r"largest difference of $\dot\gamma\cdot\dot\gamma$, unit vectors of the "
            "plane, from the product of the normals",
            float(np.abs(plane - normals).max()),
            at_most(
                2 * math.tan(splay / 2) ** 2 + EXACT,
                f"2 tan²(Ω/2): each vector turns by at most asin tan²(Ω/2), {BY_HAND}",
            ),
        ),
        Measurement(
            "plane_perpendicular",
            r"$\dot\gamma\cdot\dot\gamma$, unit vectors, at $\theta=\pi/4$ and "
            r"$3\pi/4$, where the normals are perpendicular",
            float((corners[0] * np.conj(corners[1])).real),
            equal(
                math.sin(splay) ** 2 / (1 + math.cos(splay) ** 2),
                EXACT,
                f"sin²Ω/(1 + cos²Ω), {BY_HAND}",
            ),
        ),
        Measurement(
            "plane_sign",
            "branches on which these two differ in sign",
            float(np.count_nonzero((plane <= ITERATED) != (normals <= ITERATED))),
        ),
    )


def _draw_readings(path: Path) -> Path:
    from zygopin.paper.grasp_drawings import draw_readings

    return draw_readings(path)


def _write_scene(report: GraspReport, path: Path) -> Path:
    from zygopin.scene import export_scene

    return export_scene(report, path, title="Second phalanges clasp a perch")
