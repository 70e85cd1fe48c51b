"""The paper's figure 4: a branch's section in the plane of fingers 1 and 3.

The ellipse is held against what does not know its formula: distances in space, FCL.
"""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import fcl
import numpy as np
from scipy.optimize import brentq

from zygopin.branch import Branch
from zygopin.fcl_solids import placed, quaternions
from zygopin.foot import Foot
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
    Complexes,
    Floats,
    bark_gap,
    in_plane,
    in_space,
)
from zygopin.projection import ProjectedFinger

BRANCH = Branch(1.0, (0.0, 0.0, -1.0))
"""The branch of the paper's figure 4."""


def figure_4() -> Entry:
    """The branch, the plane of fingers 1 and 3, and the ellipse where they meet.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    straight = np.zeros(foot.phalanx_count)
    report = check_grasp(foot, straight, BRANCH)
    fcl = check_grasp(foot, straight, BRANCH, engine="fcl")
    return Entry(
        key="figure-4",
        kind="figure",
        title="A branch and its section in the plane of two fingers",
        place="section 4.1, figure 4",
        printed=r"a cylinder of radius 1, axis $x=0$, $z=-1$, and an ellipse in $p^1$",
        ours=r"the same branch; half-axes $r/\cos\Omega$ and $r$, $\Omega=\pi/12$",
        finding=(
            "The half-axes are measured by going out from the axis in the plane until "
            "the bark is reached: by distances in space, and by FCL, for which the "
            "branch is a cylinder and the point a ball of radius zero. The section is "
            "wider than the branch. The straight foot rests on this branch: its base "
            "lies on the bark."
        ),
        measurements=(*_half_axes(foot), *_straight_foot(report, fcl)),
        figures=(
            Exhibit(
                "figure-4.png",
                "The branch (brown), the plane of fingers 1 and 3 (grey) at 15° to the "
                "xz-plane, and the ellipse where they meet (black), with half-axes "
                "1.0353 and 1. Axes x, y, z in the paper's units, at equal scale.",
                _draw_figure_4,
            ),
        ),
        scenes=(
            Exhibit(
                "figure-4.html",
                "The straight foot on this branch: all four first phalanges touch it "
                "at the base. The scene counts a unit of the paper as 1000 mm.",
                partial(_write_scene, report),
            ),
        ),
    )


def section_by_fcl(count: int) -> Complexes:
    """The outline of figure 4's section, ray by ray from its centre.

    Args:
        count: Number of rays.

    Returns:
        Points of the plane, shape (count + 1,); the last is the first.
    """
    foot = Foot.preset("paper")
    rays = np.exp(2j * math.pi * np.arange(count) / count)
    reach = [_reach_by_fcl(ray) for ray in in_space(foot, rays)]
    outline = complex(in_plane(foot, BRANCH.centre)) + rays * reach
    return np.append(outline, outline[0])


def _half_axes(foot: Foot) -> tuple[Measurement, ...]:
    """The section's half-axes: by distances, by FCL, and seen along the branch."""
    level, upright = in_space(foot, np.array([1.0, 1j]))
    seen = ProjectedFinger.of(foot, 2, BRANCH.axis).forward
    wide, route = math.sqrt(6) - math.sqrt(2), f"1/cos(π/12) = √6 − √2, {BY_HAND}"
    return (
        Measurement(
            "half_width",
            "horizontal half-axis, by distances in space",
            _reach(level),
            equal(wide, ITERATED, route),
        ),
        Measurement(
            "half_height",
            "vertical half-axis, by distances in space",
            _reach(upright),
            equal(1.0, ITERATED, "the radius"),
        ),
        Measurement(
            "half_width_fcl",
            "horizontal half-axis, by FCL",
            _reach_by_fcl(level),
            equal(wide, ITERATED, route),
        ),
        Measurement(
            "half_height_fcl",
            "vertical half-axis, by FCL",
            _reach_by_fcl(upright),
            equal(1.0, ITERATED, "the radius"),
        ),
        Measurement(
            "half_width_projected",
            r"radius over the length of finger 3's unit vector seen along $y$",
            float(BRANCH.radius) / seen,
            equal(wide, EXACT, route),
        ),
    )


def _straight_foot(report: GraspReport, fcl: GraspReport) -> tuple[Measurement, ...]:
    """The straight foot on the branch of figure 4."""
    first = report.foot.rank_of_phalanx == 1
    return (
        Measurement(
            "straight_foot",
            "largest distance of the straight foot's four first phalanges to the bark",
            float(np.abs(report.clearance[first]).max()),
            at_most(EXACT, "the base lies on the bark"),
        ),
        Measurement(
            "straight_foot_fcl",
            "largest difference of all its clearances between exact engine and FCL",
            report.difference(fcl),
            at_most(ITERATED, "FCL"),
        ),
    )


def _reach(direction: Floats) -> float:
    """How far from the axis a ray of the plane meets the bark, by distances."""

    def gap(length: float) -> float:
        return float(bark_gap(BRANCH.centre + length * direction, BRANCH))

    return float(brentq(gap, 0.0, 3.0, xtol=EXACT))


def _reach_by_fcl(direction: Floats) -> float:
    """The same by halving on FCL's collision test."""
    low, high = 0.0, 3.0
    while high - low > ITERATED / 4:
        middle = (low + high) / 2
        if hits_branch(BRANCH.centre + middle * direction):
            low = middle
        else:
            high = middle
    return (low + high) / 2


def hits_branch(point: Floats) -> bool:
    """Whether a point collides with the branch of figure 4, by FCL.

    Args:
        point: The point, shape (3,).

    Returns:
        The answer: the point is a ball of radius zero.
    """
    (turn,) = quaternions(BRANCH.axis[None]).tolist()
    solid = placed(fcl.Cylinder(BRANCH.radius, 10.0), turn, BRANCH.centre)
    ball = placed(fcl.Sphere(0.0), (1.0, 0.0, 0.0, 0.0), point)
    return bool(fcl.collide(ball, solid, fcl.CollisionRequest(), fcl.CollisionResult()))


def _draw_figure_4(path: Path) -> Path:
    from zygopin.paper.branch_drawings import draw_figure_4

    return draw_figure_4(path)


def _write_scene(report: GraspReport, path: Path) -> Path:
    from zygopin.scene import export_scene

    return export_scene(report, path, title="Figure 4: the straight foot on its branch")
