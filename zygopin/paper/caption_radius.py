"""The paper's figure 5 and its caption: on which branch do fully closed toes lie?"""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

from zygopin.branch import Branch
from zygopin.foot import Foot
from zygopin.grasp import GraspReport, check_grasp
from zygopin.paper.closed_toes import (
    READINGS,
    by_hand,
    by_scipy,
    closed_radius,
    nearest_radius,
)
from zygopin.paper.entry import (
    BY_HAND,
    EXACT,
    Entry,
    Exhibit,
    Measurement,
    at_least,
    at_most,
    equal,
)
from zygopin.paper.finger_plane import (
    ITERATED,
    PAIR,
    bark_gap,
    in_space,
    phalanx_lines,
    section,
    section_tangent,
    tilt,
    widths,
)
from zygopin.placement import Placement

CAPTION = 0.58
"""The radius that the caption states, r ∼ 0.58."""

HALF_DIGIT = 0.005
"""Half a unit of its last digit."""

NAMES = {
    "printed": "the printed ellipse (r·cos Ω, r)",
    "circle": "the circle of radius r",
    "true": "the true ellipse (r/cos Ω, r)",
}


def figure_5() -> Entry:
    """Fully closed toes on a branch under the base.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    branch = _under_base(closed_radius(foot, "true")[0])
    closed = np.ones(foot.phalanx_count)
    report = check_grasp(foot, closed, branch)
    fcl = check_grasp(foot, closed, branch, engine="fcl")
    return Entry(
        key="figure-5",
        kind="figure",
        title="Closed toes on a branch",
        place="section 4.1, figure 5",
        printed=(
            r"controls 1, $\omega=\pi/6$, $\Omega_1=\pi/12$, $\rho$ the golden mean: "
            r"stable on a cylinder of radius $r\sim0.58$, axis $x=0$, $z=-r$"
        ),
        ours=(
            "the tangency of the second phalanges, with the section read in three "
            "ways; the branch of the true section is the nearest to the caption"
        ),
        finding=(
            r"The base is on the bark and the first phalanx points down by $\pi/6$, so "
            "it starts into the branch, whatever the radius: no fully closed foot "
            "rests on a branch in this way without entering it. The second phalanges "
            "are tangent to the section at one radius in each reading: 0.6512 for the "
            r"printed ellipse, $1/\rho=0.6180$ for a circle, and 0.5868 for the true "
            "section. On this last the contact falls just short of the phalanx; the "
            "junctions between first and second phalanges are 0.00007 off the bark, "
            "and nothing is tangent. It alone begins with the caption's digits."
        ),
        measurements=(
            *(_radius_measurement(foot, name) for name in READINGS),
            *_pose_measurements(report, fcl),
        ),
        figures=(
            Exhibit(
                "figure-5.png",
                "The closed fingers 1 and 3 in their plane, axes in the paper's units, "
                "on the section of the branch in each reading (half-axes, radius and t "
                "above each panel), and below the junction $x_1$ of finger 3 enlarged. "
                "Dashed: the lines of the second phalanges; crosses: where these "
                "touch, on the phalanx, at its end, or just before it.",
                partial(_draw_readings, foot),
            ),
        ),
        scenes=(
            Exhibit(
                "figure-5.html",
                "All controls 1, on the branch of radius 0.5868 under the base, the "
                "nearest to the caption: the first phalanges enter it. The scene "
                "counts a unit of the paper as 1000 mm.",
                partial(_write_scene, report),
            ),
        ),
    )


def erratum_13() -> Entry:
    """The caption's radius, by the system in each reading.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    return Entry(
        key="erratum-13",
        kind="erratum",
        title="The caption's radius",
        place="section 4.1, caption of figure 5",
        printed=r"$r\sim0.58$",
        ours="0.6512, 0.6180 or 0.5868, as the section is read",
        finding=(
            "Tangency of the second phalanx gives, for half-axes $Ar$ and $r$, "
            r"$r=\frac{1}{\rho(S-1)}$ and "
            r"$t=\frac{\sqrt3}{2}\rho(\frac{1+(A^2-1)/S}{S-1}-1)$ with "
            r"$S=\sqrt{3A^2+1}$. SciPy, given the system's equations in $r$, $t$ and "
            r"$\theta$, finds the same. The printed ellipse and the circle solve the "
            "system at radii that are not the caption's. The true section has the "
            "radius nearest to it, but $t<0$: it is no solution either. A branch that "
            "is touched by the junction $x_1$ has almost that radius. With "
            "parallelism as it is printed, by the argument of a point, no branch "
            "under the base solves the system away from the base: a chord would have "
            "to be a tangent at its end."
        ),
        measurements=(
            *(m for name in READINGS for m in _solution_measurements(foot, name)),
            *_nearest_measurements(foot),
            _chord_measurement(foot),
        ),
    )


def _radius_measurement(foot: Foot, name: str) -> Measurement:
    """The radius of a reading, by resting_radii."""
    by_formula = by_hand(foot, widths(foot)[name])[0]
    return Measurement(
        f"radius_{name}",
        f"radius for {NAMES[name]}",
        closed_radius(foot, name)[0],
        equal(by_formula, EXACT, f"1/(ρ(S − 1)), S = √(3A² + 1), {BY_HAND}"),
    )


def _solution_measurements(foot: Foot, name: str) -> tuple[Measurement, ...]:
    """Radius and t of a reading, by resting_radii, by hand and by SciPy."""
    radius, t = closed_radius(foot, name)
    _, at = by_hand(foot, widths(foot)[name])
    sought = by_scipy(foot, widths(foot)[name])
    return (
        _radius_measurement(foot, name),
        Measurement(
            f"t_{name}",
            f"$t$ for {NAMES[name]}",
            t,
            equal(at, ITERATED, f"the formula above, {BY_HAND}"),
        ),
        Measurement(
            f"scipy_{name}",
            f"largest difference of both to SciPy, {NAMES[name]}",
            max(abs(radius - sought[0]), abs(t - sought[1])),
            at_most(ITERATED, "SciPy on the system's three equations"),
        ),
        Measurement(
            f"off_{name}",
            f"distance of the caption's 0.58 from the radius for {NAMES[name]}",
            abs(radius - CAPTION),
            at_least(HALF_DIGIT, "half a unit of the caption's last digit"),
        ),
    )


def _nearest_measurements(foot: Foot) -> tuple[Measurement, ...]:
    """What is near the caption's radius: the junction x₁ on the bark."""
    first = in_space(foot, phalanx_lines(foot, PAIR[1], np.ones(4))[0][1])

    def gap(radius: float) -> float:
        """How far the junction is outside the branch."""
        return float(bark_gap(first, _under_base(radius)))

    return (
        Measurement(
            "junction",
            "radius of the branch that the junction $x_1$ lies on",
            float(brentq(gap, 0.1, 2.0, xtol=EXACT)),
            equal(
                (3 * tilt(foot) ** 2 + 1) / (4 * foot.rho),
                ITERATED,
                f"(3 cos²Ω + 1)/(4ρ), {BY_HAND}",
            ),
        ),
        Measurement(
            "off_nearest",
            "distance of 0.58 from the nearest of all radii to which any phalanx of a "
            "closed finger is tangent, in any of the three readings",
            abs(nearest_radius(foot, CAPTION) - CAPTION),
            equal(1 / foot.rho - CAPTION, EXACT, f"1/ρ, the circle's, {BY_HAND}"),
        ),
    )


def _chord_measurement(foot: Foot) -> Measurement:
    """The printed parallelism on the printed ellipse, all around it."""
    width, turns = widths(foot)["printed"], 3600
    angle = math.pi / 2 + np.arange(1, turns) * (2 * math.pi / turns)
    chord = section(angle, -1.0, 1.0, width)
    tangent = section_tangent(angle, 1.0, width)
    sine = np.abs((chord * np.conj(tangent)).imag) / np.abs(chord * tangent)
    half = math.pi / turns
    speeds = _speed(width, half) * _speed(width, 2 * half)
    return Measurement(
        "chord",
        rf"least sine of the angle between $\gamma$ and $\dot\gamma$ at {turns - 1} "
        "points of the printed ellipse, the base left out",
        float(sine.min()),
        equal(
            width * math.sin(half) / speeds,
            EXACT,
            "A sin u/(h(u) h(2u)) > 0, h(u)² = A² cos²u + sin²u, 2u the θ from the "
            f"base to the nearest point, {BY_HAND}",
        ),
    )


def _speed(width: float, angle: float) -> float:
    """h(u) = √(A² cos² u + sin² u)."""
    return math.hypot(width * math.cos(angle), math.sin(angle))


def _pose_measurements(
    report: GraspReport, fcl: GraspReport
) -> tuple[Measurement, ...]:
    """The closed foot on the branch of the true section."""
    foot, radius = report.foot, float(report.branch.radius)
    first = foot.finger_slices[PAIR[1]].start
    seen = math.atan2(0.5, tilt(foot) * math.sqrt(3) / 2)
    x, z = math.sqrt(3) / 2 / foot.rho, -1 / (2 * foot.rho)
    return (
        Measurement(
            "first_phalanx",
            "clearance of finger 3's first phalanx on the branch of radius 0.5868",
            float(report.clearance[first]),
            equal(
                -radius * (1 - math.cos(seen)),
                EXACT,
                f"−r(1 − cos α′), tan α′ = tan(π/6)/cos Ω, {BY_HAND}",
            ),
        ),
        Measurement(
            "second_phalanx",
            "clearance of its second phalanx",
            float(report.clearance[first + 1]),
            equal(
                math.hypot(tilt(foot) * x, radius + z) - radius,
                EXACT,
                f"distance of the junction x₁ from the axis, less r, {BY_HAND}",
            ),
        ),
        Measurement(
            "tangent",
            "phalanges of the closed foot that are tangent to it",
            float(np.count_nonzero(report.tangent)),
            equal(0.0, 0.0, "t is off the bone"),
        ),
        Measurement(
            "fcl",
            "largest difference of clearances to FCL",
            report.difference(fcl),
            at_most(ITERATED, "FCL"),
        ),
    )


def _under_base(radius: float) -> Branch:
    """The branch whose top is the base."""
    return Placement().branch(-radius, radius)


def _draw_readings(foot: Foot, path: Path) -> Path:
    from zygopin.paper.branch_drawings import Panel, draw_closed_toes

    panels = [
        Panel(NAMES[name], widths(foot)[name], *closed_radius(foot, name))
        for name in READINGS
    ]
    return draw_closed_toes(path, foot, panels)


def _write_scene(report: GraspReport, path: Path) -> Path:
    from zygopin.scene import export_scene

    return export_scene(report, path, title="Figure 5: closed toes, r = 0.5868")
