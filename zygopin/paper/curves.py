"""The two curves of the paper's tangency system: phalanx and section of the branch."""

from __future__ import annotations

import math
from functools import partial

import numpy as np

from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.paper.entry import EXACT, ROUNDING, Entry, Measurement, at_most
from zygopin.paper.finger_plane import (
    PAIR,
    PLACE,
    Floats,
    bark_gap,
    in_space,
    phalanx_lines,
    section,
    section_tangent,
    widths,
)
from zygopin.placement import Placement

RANDOM = 1000
"""Random cases on which two routes are held against each other."""

STEP = 1e-4
"""Step of the central difference; its error is at most r·width·STEP²/6."""


def phalanx_parametrisation() -> Entry:
    """The parametrisation φ of a phalanx.

    Returns:
        The entry.
    """
    foot, chance = Foot.preset("paper"), np.random.default_rng(0)
    controls = chance.uniform(size=(RANDOM, foot.phalanx_count))
    t = chance.uniform(size=(RANDOM, 1))
    bones = forward_kinematics(foot, controls)
    along = bones[..., 0, :] + t[..., None] * (bones[..., 1, :] - bones[..., 0, :])
    cases: tuple[tuple[str, str, Floats | float, Floats], ...] = (
        ("start", r"$\phi(0)$ to the phalanx's first junction", 0.0, bones[..., 0, :]),
        ("end", r"$\phi(1)$ to its last junction", 1.0, bones[..., 1, :]),
        ("between", r"$\phi(t)$ to its bone's point, $t$ random", t, along),
    )
    return Entry(
        key="phalanx-parametrisation",
        kind="statement",
        title="The points of a phalanx",
        place=PLACE,
        printed=(
            r"$\phi(t;(v),k)=x_{k-1}+\frac{t}{\rho^k}e^{-i\omega(v_0+\dots+v_k)}$, "
            r"$t\in[0,1]$"
        ),
        ours=(
            r"the same, $\omega$ for the printed $w$; finger 1 is the mirror image "
            r"$-\bar\phi$, $v_0=0$"
        ),
        finding=(
            "For random controls the points are those of the bones of forward "
            "kinematics in space, for all phalanges of fingers 1 and 3."
        ),
        measurements=tuple(
            Measurement(
                name,
                f"largest distance of {text}; {RANDOM} control sequences",
                _phalanx_distance(foot, controls, place, points),
                at_most(EXACT, ROUNDING),
            )
            for name, text, place, points in cases
        ),
    )


def ellipse_parametrisation() -> Entry:
    """The ellipse γ and its derivative, with the right half-axes and centre.

    Returns:
        The entry.
    """
    foot, (angle, height, radius) = Foot.preset("paper"), _random_sections()
    width = widths(foot)["true"]
    branch, space = Placement().branch(height, radius), partial(in_space, foot)
    tangent = section_tangent(angle, radius, width)
    gap = bark_gap(space(section(angle, height, radius, width)), branch)
    ends = (section(angle + x, height, radius, width) for x in (STEP, -STEP))
    slope = (next(ends) - next(ends)) / (2 * STEP)
    normal = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], axis=-1)
    leaving = np.sum(space(tangent / abs(tangent)) * normal, axis=-1)
    bound = width * float(radius.max()) * STEP**2 / 6 + 10 * EXACT
    return Entry(
        key="ellipse-parametrisation",
        kind="statement",
        title="The ellipse and its tangent",
        place=PLACE,
        printed=(
            r"$\gamma(\theta)=c_y+r(\cos\Omega_1\cos\theta+i\sin\theta)$, "
            r"$\dot\gamma(\theta)=-r\cos\Omega_1\sin\theta+ir\cos\theta$"
        ),
        ours=(
            r"$\gamma(\theta)=ic_y+r(\frac{\cos\theta}{\cos\Omega_1}+i\sin\theta)$, "
            r"$\dot\gamma(\theta)=-\frac{r\sin\theta}{\cos\Omega_1}+ir\cos\theta$"
        ),
        finding=(
            "With the half-axes and the centre put right, every point of the ellipse "
            "is on the cylinder and every tangent vector is tangent to it. What the "
            "printed half-axes and the printed centre do is measured on their own."
        ),
        measurements=(
            Measurement(
                "on_the_cylinder",
                rf"largest distance of $\gamma(\theta)$ from the bark, {RANDOM} random "
                r"$\theta$, $r$, $c_y$",
                float(np.abs(gap).max()),
                at_most(EXACT, "distance to the axis less the radius"),
            ),
            Measurement(
                "derivative",
                r"largest distance of $\dot\gamma$ from a central difference",
                float(np.abs(slope - tangent).max()),
                at_most(bound, r"Taylor remainder $\frac{r}{6\cos\Omega}h^2$"),
            ),
            Measurement(
                "tangent",
                r"largest product of $\dot\gamma/|\dot\gamma|$ with the bark's normal",
                float(np.abs(leaving).max()),
                at_most(EXACT, ROUNDING),
            ),
        ),
    )


def _phalanx_distance(
    foot: Foot, controls: Floats, t: Floats | float, points: Floats
) -> float:
    """Largest distance of φ(t) of fingers 1 and 3 to points of their bones."""
    worst = 0.0
    for finger in PAIR:
        part = foot.finger_slices[finger]
        start, step = phalanx_lines(foot, finger, controls[:, part])
        apart = in_space(foot, start + t * step) - points[:, part]
        worst = max(worst, float(np.linalg.norm(apart, axis=-1).max()))
    return worst


def _random_sections() -> tuple[Floats, Floats, Floats]:
    """Random θ, heights and radii."""
    chance = np.random.default_rng(1)
    angle = chance.uniform(0, 2 * math.pi, RANDOM)
    return angle, chance.uniform(-3, 1, RANDOM), chance.uniform(0.05, 3, RANDOM)
