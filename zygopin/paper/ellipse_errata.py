"""Two misprints of the paper's ellipse: its half-axes and its centre."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from zygopin.foot import Foot
from zygopin.paper.branch_section import BRANCH, hits_branch, section_by_fcl
from zygopin.paper.entry import (
    BY_HAND,
    EXACT,
    ROUNDING,
    Entry,
    Exhibit,
    Measurement,
    at_least,
    at_most,
    equal,
)
from zygopin.paper.finger_plane import (
    PLACE,
    bark_gap,
    in_space,
    section,
    widths,
)

AROUND = np.linspace(0, 2 * math.pi, 1001)
"""The θ at which ellipses are held against the branch; 0 is one of them."""

BEYOND = 1.001
"""Where a point is outside the section, over its half-axis."""

RAYS = 72
"""Rays on which FCL finds the section that is drawn."""


def erratum_4() -> Entry:
    """The printed half-axes of the section.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    return Entry(
        key="erratum-4",
        kind="erratum",
        title="The half-axes of the ellipse",
        place=PLACE,
        printed=r"$(r\cos\Omega_1, r)$, and once $(r\Omega_1, r)$",
        ours=r"$(r/\cos\Omega_1, r)$",
        finding=(
            "A plane that meets a cylinder obliquely cuts it in an ellipse that is "
            "longer than the cylinder is wide. The points of the printed ellipses lie "
            "inside the branch, except at its top and bottom."
        ),
        measurements=(*_ellipses_leave(foot), *_points_collide(foot)),
        figures=(
            Exhibit(
                "erratum-4.png",
                "The plane of fingers 1 and 3, axes in the paper's units. Shaded: the "
                "section of the branch of figure 4 as FCL finds it, ray by ray. Black: "
                "the ellipse with half-axes r/cos Ω and r. Red: the printed r cos Ω "
                "and r; dashed: rΩ and r.",
                _draw_erratum_4,
            ),
        ),
    )


def ellipse_centre() -> Entry:
    """The centre of the printed γ, which lacks its i.

    Returns:
        The entry.
    """
    foot, height = Foot.preset("paper"), float(BRANCH.centre[2])
    radius, width = float(BRANCH.radius), widths(foot)["true"]
    printed = section(AROUND, 0.0, radius, width) + height
    top = bark_gap(in_space(foot, height + 1j * radius), BRANCH)
    gap = bark_gap(in_space(foot, printed), BRANCH)
    return Entry(
        key="ellipse-centre",
        kind="erratum",
        title="The centre of the ellipse",
        place=PLACE,
        printed=(
            "the centre is $ic_y$, yet "
            r"$\gamma=c_y+r(\cos\Omega_1\cos\theta+i\sin\theta)$"
        ),
        ours=r"$\gamma=ic_y+r(\frac{\cos\theta}{\cos\Omega_1}+i\sin\theta)$",
        finding=(
            "Without its $i$ the height moves the ellipse along the finger instead of "
            "down. The coordinates just before it and the sentence just after it have "
            "the centre where it belongs."
        ),
        measurements=(
            Measurement(
                "top",
                r"distance from the bark of the printed $\gamma(\pi/2)$, even with the "
                "right half-axes; $r=1$, $c_y=-1$",
                float(top),
                equal(
                    math.hypot(height * math.cos(foot.splay), radius - height) - radius,
                    EXACT,
                    f"√(c² cos²Ω + (r − c)²) − r, c the height, {BY_HAND}",
                ),
            ),
            Measurement(
                "farthest",
                "farthest that the printed curve leaves the bark",
                float(np.abs(gap).max()),
                at_least(float(top), "that of one of its points"),
            ),
        ),
    )


def _ellipses_leave(foot: Foot) -> tuple[Measurement, ...]:
    """How far the points of the true ellipse and the printed ones are from the bark."""
    radius, omega = float(BRANCH.radius), foot.splay
    farthest = {
        name: float(np.abs(bark_gap(in_space(foot, points), BRANCH)).max())
        for name, points in (
            (name, section(AROUND, -radius, radius, width))
            for name, width in widths(foot).items()
        )
    }
    return (
        Measurement(
            "true",
            r"farthest that the ellipse $(r/\cos\Omega, r)$ leaves the bark, $r=1$",
            farthest["true"],
            at_most(EXACT, ROUNDING),
        ),
        Measurement(
            "printed",
            r"the same of $(r\cos\Omega, r)$",
            farthest["printed"],
            equal(
                radius * math.sin(omega) ** 2, EXACT, f"r sin²Ω, at θ = 0, {BY_HAND}"
            ),
        ),
        Measurement(
            "printed_once",
            r"the same of $(r\Omega, r)$",
            farthest["once"],
            equal(
                radius * (1 - omega * math.cos(omega)),
                EXACT,
                f"r(1 − Ω cos Ω), at θ = 0, {BY_HAND}",
            ),
        ),
    )


def _points_collide(foot: Foot) -> tuple[Measurement, ...]:
    """FCL on a point between the ellipses, and on one beyond the true one."""
    radius, wide = float(BRANCH.radius), widths(foot)
    between = -1j * radius + (wide["printed"] + wide["true"]) / 2 * radius
    beyond = -1j * radius + BEYOND * wide["true"] * radius
    return (
        Measurement(
            "fcl_between",
            "whether the branch collides by FCL (1: yes) with a point midway between "
            "the printed ellipse's end and the true one's",
            float(hits_branch(in_space(foot, between))),
            equal(1.0, 0.0, "inside the true ellipse"),
        ),
        Measurement(
            "fcl_beyond",
            "the same with a point a thousandth beyond the true one's end",
            float(hits_branch(in_space(foot, beyond))),
            equal(0.0, 0.0, "outside the true ellipse"),
        ),
    )


def _draw_erratum_4(path: Path) -> Path:
    from zygopin.paper.branch_drawings import draw_ellipses

    return draw_ellipses(path, section_by_fcl(RAYS))
