"""The paper's reachable set of finger 3: its algorithm in space, and figure 3."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from zygopin.control_system import words
from zygopin.foot import GOLDEN_MEAN, Foot
from zygopin.hausdorff import directed_distance, hausdorff_distance
from zygopin.ifs import hutchinson
from zygopin.kinematics import forward_kinematics
from zygopin.model import FootModel
from zygopin.paper.entry import (
    EXACT,
    Entry,
    Exhibit,
    Measurement,
    at_most,
    by_hand,
    equal,
    rounding,
)
from zygopin.paper.finger_model import FINGER, junctions_of
from zygopin.paper.finger_plane import Floats
from zygopin.phalanx_sweep import about_z
from zygopin.reach import FingerReach, find_finger, finger_reach

LEVELS, MIDDLE, COARSE = 33, 17, 9
"""Equal levels of [0, 1]: of the figure's sets, and of two that are compared."""

IN_PINOCCHIO = 9
"""Equal levels of the grid that goes through Pinocchio: 6561 configurations."""

SAMPLES = 4000
"""Random controls that are held against a set's bound."""

DIRECTIONS = 2000
"""Supporting lines of a hull: none of its corners is missed."""

OMEGAS = {"15": math.pi / 12, "30": math.pi / 6}
"""The figure's largest joint angles [rad], by their degrees."""


def algorithm() -> Entry:
    """Section 4: the three steps that lead to finger 3's reachable set in space.

    Returns:
        The entry.
    """
    foot = Foot.preset("paper")
    finger = find_finger(foot, FINGER)
    plane = np.zeros(1, complex)
    for _ in range(finger.phalanges):
        plane = hutchinson(plane, IN_PINOCCHIO, foot.rho, foot.omega)
    space = np.stack([plane.real, np.zeros_like(plane.real), plane.imag], axis=-1)
    turned = space @ about_z(-foot.splay)[:3, :3].T
    tips = FootModel(foot).forward(_grid(foot))[:, foot.finger_slices[finger.name]]
    reach = finger_reach(foot, finger.name, IN_PINOCCHIO).in_space()
    what = f"Hausdorff distance of the three steps, {len(plane)} points, to "
    apart = {
        "pinocchio": (tips[:, -1, 1], "the tips of the URDF in Pinocchio"),
        "finger_reach": (reach, "finger_reach"),
    }
    return Entry(
        key="algorithm",
        kind="statement",
        title="Reachable set of finger 3 in space",
        place="section 4, algorithm",
        printed=r"iterate $F$ four times from $\{0\}$; $x+iz \mapsto (x,0,z)$; turn by "
        r"$\Omega_3$ about $z$",
        ours="",
        finding=(
            "Carried out as written, step by step, the algorithm gives the tips that "
            "Pinocchio finds when every control sequence is sent through the URDF."
        ),
        measurements=tuple(
            rounding(name, what + other, hausdorff_distance(turned, points).value)
            for name, (points, other) in apart.items()
        ),
        scenes=(
            Exhibit(
                "reach.html", "All four fingers' sets around the foot", _write_scene
            ),
        ),
    )


def figure_3() -> Entry:
    """Figure 3: R₄ of finger 3 for two joint limits.

    Returns:
        The entry.
    """
    reaches = _reaches()
    return Entry(
        key="figure-3",
        kind="figure",
        title="What finger 3 can reach",
        place="section 4, figure 3",
        printed=r"$R_4^3$ for $\omega = \pi/12$ and $\pi/6$, by a uniform "
        r"discretisation",
        ours="",
        finding=(
            "The paper justifies the discretisation by continuity of the attractor in "
            "the control set. Here the error has a number: with step $h$ between "
            r"levels, $d_H \leq \frac{\omega h}{2} \sum_{j \leq 4} j \rho^{-j}$, and "
            "random controls keep to it."
        ),
        measurements=(
            *_extent(reaches["30"]),
            *(_hull(name, reach) for name, reach in reaches.items()),
            *_continuity(reaches["30"]),
        ),
        figures=(
            Exhibit(
                "figure-3.png",
                f"Density of $R_4$ of finger 3, {LEVELS} levels of each control, in "
                r"the finger's plane: left $\omega = \pi/12$, right $\omega = \pi/6$.",
                _draw_reaches,
            ),
        ),
    )


def _extent(reach: FingerReach) -> tuple[Measurement, ...]:
    """The ranges of x and z at ω = π/6, whose ends are worked by hand."""
    points, length = reach.points, [GOLDEN_MEAN**-k for k in range(5)]
    height = math.sqrt(3) / 2
    # Straight; closed; phalanges at 30°, 60°, 90°, 90°.
    ends = {
        "x_max": (points.real.max(), math.fsum(length[1:])),
        "x_min": (
            points.real.min(),
            height * length[1] + (length[2] - length[4]) / 2,
        ),
        "z_max": (points.imag.max(), 0.0),
        "z_min": (
            points.imag.min(),
            -length[1] / 2 - height * length[2] - length[3] - length[4],
        ),
    }
    most = {"max": "largest", "min": "least"}
    return tuple(
        by_hand(
            name,
            rf"{most[name[2:]]} ${name[0]}$ of $R_4$, $\omega = \pi/6$",
            float(found),
            value,
        )
        for name, (found, value) in ends.items()
    )


def _hull(name: str, reach: FingerReach) -> Measurement:
    """The area of the convex hull, by a second route."""
    what = rf"area of the convex hull of $R_4$, $\omega = {name}°$"
    area = equal(_supported_area(reach.foot.omega), EXACT, "supporting lines")
    return Measurement(f"hull_area_{name}", what, reach.hull.area, area)


def _continuity(reach: FingerReach) -> tuple[Measurement, ...]:
    """How near coarser levels and controls between the levels stay."""
    foot = reach.foot
    coarse, middle = (
        finger_reach(foot, reach.finger.name, levels) for levels in (COARSE, MIDDLE)
    )
    random = np.zeros((SAMPLES, foot.phalanx_count))
    rng = np.random.default_rng(3)
    random[:, foot.finger_slices[reach.finger.name]] = rng.uniform(size=(SAMPLES, 4))
    tips = junctions_of(foot, forward_kinematics(foot, random))[:, -1]
    bound = r"$\frac{\omega h}{2}\sum_j j\rho^{-j}$"
    return (
        Measurement(
            "coarse",
            f"Hausdorff distance of the sets of {COARSE} and {MIDDLE} levels",
            hausdorff_distance(coarse.points, middle.points).value,
            at_most(coarse.grid_bound, f"{bound}, {COARSE} levels"),
        ),
        Measurement(
            "random",
            f"farthest that {SAMPLES} random controls stray from the {LEVELS} levels' "
            "set",
            directed_distance(tips, reach.points).value,
            at_most(reach.grid_bound, f"{bound}, {LEVELS} levels"),
        ),
    )


def _supported_area(omega: float) -> float:
    """Area of the hull of R₄ from its farthest points in many directions.

    The phalanges' pitches are multiples of a level's turn, each at most ω more than the
    one before: for each direction the best sum is found phalanx by phalanx, from the
    tip back.
    """
    directions = np.linspace(0, 2 * np.pi, DIRECTIONS)
    pitches = np.linspace(0, 4 * omega, 4 * (LEVELS - 1) + 1)
    corners = np.array([_farthest(pitches, direction) for direction in directions])
    after = np.roll(corners, -1)
    return float(np.abs(np.sum((np.conj(corners) * after).imag)) / 2)


def _farthest(pitches: Floats, direction: float) -> complex:
    """The point of R₄ that is farthest in a direction."""
    gain = np.cos(direction + pitches)
    best = np.zeros(len(pitches))
    ways: list[np.ndarray] = []
    for k in range(4, 0, -1):
        value = np.append(gain * GOLDEN_MEAN**-k + best, np.full(LEVELS, -np.inf))
        windows = np.lib.stride_tricks.sliding_window_view(value, LEVELS)
        ways.append(windows[: len(pitches)].argmax(axis=1))
        best = windows[: len(pitches)].max(axis=1)
    place, point = 0, 0j
    for k, way in enumerate(reversed(ways), 1):
        place += int(way[place])
        point += GOLDEN_MEAN**-k * np.exp(-1j * pitches[place])
    return point


def _reaches() -> dict[str, FingerReach]:
    """The figure's two sets."""
    foot = Foot.preset("paper")
    feet = {name: foot.replace(omega=omega) for name, omega in OMEGAS.items()}
    return {name: finger_reach(each, 3, LEVELS) for name, each in feet.items()}


def _grid(foot: Foot) -> Floats:
    """All controls of finger 3 from some levels, the other fingers straight."""
    finger = find_finger(foot, FINGER)
    count = IN_PINOCCHIO**finger.phalanges
    controls = np.zeros((count, foot.phalanx_count))
    every = words(IN_PINOCCHIO, finger.phalanges, np.arange(count))
    controls[:, foot.finger_slices[finger.name]] = every
    return controls


def _draw_reaches(path: Path) -> Path:
    from zygopin.plots import plot_reach

    return plot_reach(list(_reaches().values()), path)


def _write_scene(path: Path) -> Path:
    from zygopin.reach_scene import export_reach_scene

    return export_reach_scene(Foot.preset("paper"), path)
