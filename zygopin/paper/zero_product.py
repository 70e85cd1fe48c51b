"""The paper's grasping condition where the scalar product is zero."""

from __future__ import annotations

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
    PLACE,
)
from zygopin.paper.grasp_cases import Case, quarter_turn, verdicts


def erratum_8() -> Entry:
    """Non-positive in words, negative in the formula.

    Returns:
        The entry.
    """
    case = quarter_turn()
    report, other = verdicts(case), verdicts(case, "base_to_tip")
    fcl = check_grasp(case.foot, case.controls, case.branch, engine="fcl")
    product = _printed_product(case, report)
    return Entry(
        key="erratum-8",
        kind="erratum",
        title="A scalar product of exactly zero",
        place=f"{PLACE}, condition (4)",
        printed="a non-positive product in the definition; < 0 in the formula",
        ours="≤ 0",
        finding=(
            "The two differ where the phalanges are perpendicular. Worked by hand: "
            r"with $\omega=\pi/2$, $\Omega=0$, finger 1 straight and controls 0, 1, 0, "
            "0 for finger 3, the branch of radius 0.65 with its centre at "
            r"$x=1/\rho-0.65$, $z=-0.65$ touches finger 1 from below and the last "
            "phalanx of finger 3, which hangs down, on its inner side. Nothing enters "
            "it. By the definition this is a grasp, by the formula it is none. (The "
            "paper's branches have their axes at $x=0$; the definition does not.)"
        ),
        measurements=(
            Measurement(
                "formula",
                r"the formula's product, with powers of $-i$ for $e^{-i\omega v}$",
                product,
                equal(0.0, 0.0, f"perpendicular, {BY_HAND}"),
            ),
            Measurement(
                "normals",
                "product of the contact normals, exact engine",
                float(report.scalar_product),
                equal(0.0, EXACT, f"(0, 1)·(1, 0), {BY_HAND}"),
            ),
            Measurement(
                "base_to_tip",
                "product of the directions, exact engine",
                float(report.scalar_product_base_to_tip),
                equal(0.0, EXACT, f"(−1, 0)·(0, −1), {BY_HAND}"),
            ),
            *_contacts_of_quarter_turn(case, report, fcl),
            *_both_verdicts(report, other, product),
        ),
        figures=(
            Exhibit(
                "erratum-8.png",
                "Side view, in the paper's units: finger 1 (blue) lies on the branch, "
                "the last phalanx of finger 3 (purple) hangs beside it. The contact "
                "normals (black) are perpendicular, and so are the phalanges (red).",
                _draw_quarter_turn,
            ),
        ),
    )


def _contacts_of_quarter_turn(
    case: Case, report: GraspReport, fcl: GraspReport
) -> tuple[Measurement, ...]:
    """Where the branch touches both toes."""
    rho = case.foot.rho
    return (
        Measurement(
            "t_finger1",
            r"$t$ of finger 1, first phalanx",
            float(report.t[0]),
            equal(0.65 * rho - 1, EXACT, f"(0.65 − 1/ρ)·ρ, {BY_HAND}"),
        ),
        Measurement(
            "t_finger3",
            r"$t$ of finger 3, last phalanx",
            float(report.t[5]),
            equal(
                (0.65 - rho**-2 - rho**-3) * rho**4,
                EXACT,
                f"(0.65 − ρ⁻² − ρ⁻³)·ρ⁴, {BY_HAND}",
            ),
        ),
        Measurement(
            "clearance",
            "larger distance of these two from the bark",
            float(np.abs(report.clearance[[0, 5]]).max()),
            at_most(EXACT, BY_HAND),
        ),
        Measurement(
            "clearance_fcl",
            "the same by FCL",
            float(np.abs(fcl.clearance[[0, 5]]).max()),
            at_most(ITERATED, "FCL"),
        ),
        Measurement(
            "feasible",
            "whether nothing enters the branch (1: yes)",
            float(report.feasible),
            equal(1.0, 0.0, BY_HAND),
        ),
    )


def _both_verdicts(
    report: GraspReport, other: GraspReport, product: float
) -> tuple[Measurement, ...]:
    """Grasping by the words, in both readings of the product, and by the formula."""
    return (
        Measurement(
            "in_words",
            "grasping with ≤ 0 (1: yes), normals",
            float(report.grasping),
            equal(1.0, 0.0, "the definition"),
        ),
        Measurement(
            "in_words_base_to_tip",
            "grasping with ≤ 0, directions",
            float(other.grasping),
            equal(1.0, 0.0, "the definition"),
        ),
        Measurement(
            "by_formula",
            "grasping with < 0, the formula's product",
            float(product < 0),
            equal(0.0, 0.0, "0 is not below 0"),
        ),
    )


def _printed_product(case: Case, report: GraspReport) -> float:
    """The formula's product on the quarter turn, without rounding of e^{−iπ/2}."""
    controls = case.controls.astype(int)
    one = -float(report.t[0]) / case.foot.rho
    other = float(report.t[5]) / case.foot.rho**4 * (-1j) ** int(controls[2:].sum())
    return float((one * other.conjugate()).real) + 0.0  # no minus zero


def _draw_quarter_turn(path: Path) -> Path:
    from zygopin.paper.grasp_drawings import draw_quarter_turn

    return draw_quarter_turn(path)
