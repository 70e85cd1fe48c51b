"""The paper's section 2 and its proposition 1: reachable sets and their limit."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from zygopin.control_system import ControlSystem, words
from zygopin.foot import GOLDEN_MEAN, Foot
from zygopin.hausdorff import hausdorff_distance
from zygopin.ifs import ReachableSet, contraction, hutchinson, reachable_set
from zygopin.inverse import find_word, nearest_reachable
from zygopin.paper.entry import (
    EXACT,
    Entry,
    Exhibit,
    Measurement,
    at_least,
    at_most,
    equal,
    rounding,
)
from zygopin.paper.finger_model import summed
from zygopin.paper.finger_plane import Complexes
from zygopin.reach import finger_reach

OMEGA = math.pi / 6
"""The paper's largest joint angle [rad]."""

STEPS = 6
"""Steps of the Hutchinson operator that are followed."""

LEVELS, DEPTH = 9, 4
"""Levels and phalanges of the sets that are enumerated word by word: 6561 points."""

DEEP = 16
"""Depth of the set of two levels that stands for the attractor: 65 536 points."""

TURNED = 0.7
"""An initial orientation, to see that it turns the set [rad]."""

FINITE = 4
"""Deepest finite sums that are held against the attractor one by one."""

PROOF_DEPTH, WIDE_DEPTH = 60, 6
"""Depths at which points are proved to be off the attractor: of few levels, where
ρ^−60 is 3e-13, and of the interval."""


ON = (0.0, 0.5, 0.25, 0.0)
"""Controls of a short finger whose tip is also that of an endless one."""

LONG_DEPTH, CLOSE = 50, 1e-10
"""Depth of a word that shows it, and how near its tip comes: ρ^−50 is 4e-11."""


def contractions() -> Entry:
    """Section 2: contractions, and the attractor that every compact set tends to.

    Returns:
        The entry.
    """
    points = _scattered(200)
    images = contraction(points, 0.37, GOLDEN_MEAN, OMEGA)
    pairs = np.triu_indices(len(points), 1)
    before, after = (np.abs(x[pairs[0]] - x[pairs[1]]) for x in (points, images))
    start = _scattered(3)
    first = hausdorff_distance(start, np.zeros(1, complex)).value
    worst = 0.0
    one, other = start, np.zeros(1, complex)
    for step in range(1, STEPS + 1):
        one, other = (hutchinson(s, 3, GOLDEN_MEAN, OMEGA) for s in (one, other))
        apart = hausdorff_distance(one, other).value
        worst = max(worst, apart / (GOLDEN_MEAN**-step * first))
    return Entry(
        key="contractions",
        kind="statement",
        title="Contractions and their attractor",
        place="section 2; section 3, before proposition 1",
        printed=r"$f_v(x) = \frac{e^{-i\omega v}}{\rho}(x+1)$; "
        r"$F^k(S) \to R$ for every non-empty compact $S$",
        ours="",
        finding=(
            r"Each $f_v$ shrinks every distance by exactly $\rho$, so two sets come "
            r"nearer by $\rho$ at each step, wherever they start. The attractor is the "
            "one non-empty compact set that the operator leaves alone. Bounded, as "
            "the paper has it, does not single it out: the points of all words that "
            "end in zeros are a bounded set that it leaves alone too, and not closed."
        ),
        measurements=(
            rounding(
                "ratio",
                r"ratio of distances after and before $f_v$, farthest from $1/\rho$",
                float(np.abs(after / before - 1 / GOLDEN_MEAN).max()),
            ),
            Measurement(
                "approach",
                r"$d_H(F^k(S), F^k(\{0\}))$ over $\rho^{-k} d_H(S, \{0\})$, largest of "
                f"{STEPS} steps from three far points",
                worst,
                at_most(1 + EXACT, "the contraction's ratio"),
            ),
        ),
    )


def proposition_1() -> Entry:
    """Proposition 1: reachable sets as iterates, and their limit (corrected).

    Returns:
        The entry.
    """
    return Entry(
        key="proposition-1",
        kind="statement",
        title="Reachable sets are iterates, and tend to the attractor",
        place="section 3, proposition 1",
        printed=r"$R_k = e^{-i\omega v_0} F^k(\{x_0\})$; "
        r"$R_\infty = e^{-i\omega v_0} R$, with $R_\infty$ the closure of $\bigcup "
        "R_k$",
        ours=r"$R_k = e^{-iv_0} F^k(\{x_0\})$; $R_\infty = \lim R_k$ in the Hausdorff "
        r"metric",
        finding=(
            r"Both parts hold with $R_\infty$ read as the limit and $v_0$ as an angle. "
            r"With $0 \in R$ the distance to the limit is known exactly: it is the "
            r"length of the phalanges that are left out, $\rho^{-k}/(\rho-1)$."
        ),
        measurements=(*_iterates(), *_limit()),
        figures=(
            Exhibit(
                "convergence.png",
                r"Some of $R_1, \dots, R_8$ for three levels (red) over $R_9$ (grey). "
                "Below, dots: Hausdorff distance to $R_9$; bars: the most that "
                "remains from there to the limit; line: the exact distance to the "
                "limit.",
                _draw_convergence,
            ),
        ),
    )


def erratum_5() -> Entry:
    """Erratum 5: the closure of the union of all Rₖ is not the attractor.

    Returns:
        The entry.
    """
    return Entry(
        key="erratum-5",
        kind="erratum",
        title="The closure of all finite sums is too large",
        place="section 3, definition of the asymptotic reachable set",
        printed=r"$R_\infty = \overline{\bigcup_k R_k}$, said to be the attractor",
        ours=r"$R_\infty = \lim_k R_k$ in the Hausdorff metric",
        finding=(
            "Finite sums are tips of short fingers: they need not lie on the "
            r"attractor. With $R = \{0\}$ the union is the partial sums of $\rho^{-1} "
            r"+ \rho^{-2} + \dots$ and the attractor one point. The base $x_0 = 0$, "
            "which is in the union, is far from every tip of an endless finger. With "
            r"$R = \{0, 1\}$ none of the sums of up to four phalanges is on the "
            "attractor; with $R = [0, 1]$ some are."
        ),
        measurements=(*_base_off(), _sums_off(), _sum_on()),
        figures=(
            Exhibit(
                "erratum-5.png",
                rf"The attractor for $R = \{{0, 1\}}$ (grey) and the sums of 0 to "
                f"{FINITE} phalanges (red), all of which the printed closure has.",
                _draw_finite_sums,
            ),
        ),
    )


def finite_sums(depth: int) -> Complexes:
    """All points of R₀, R₁, … for the levels 0 and 1.

    Args:
        depth: The last k.

    Returns:
        The points, x₀ first.
    """
    sets = [_two_levels(k).points for k in range(1, depth + 1)]
    return np.concatenate([np.zeros(1, complex), *sets])


def _iterates() -> tuple[Measurement, ...]:
    """Part 1: words one by one against the operator and the library's set."""
    foot = Foot.preset("paper")
    every = words(LEVELS, DEPTH, np.arange(LEVELS**DEPTH))
    tips = summed(foot, every)[:, -1]
    points = np.zeros(1, complex)
    for _ in range(DEPTH):
        points = hutchinson(points, LEVELS, foot.rho, foot.omega)
    turned = reachable_set(
        foot.rho, foot.omega, LEVELS, DEPTH, orientation=TURNED
    ).points
    sets = {
        "operator": (rf"$F^{DEPTH}(\{{0\}})$", points),
        "orientation": (
            f"reachable_set with $v_0 = {TURNED}$, turned back",
            np.exp(1j * TURNED) * turned,
        ),
    }
    return tuple(
        rounding(
            name,
            f"Hausdorff distance of the tips, {LEVELS**DEPTH} sequences, to {what}",
            hausdorff_distance(tips, found).value,
        )
        for name, (what, found) in sets.items()
    )


def _limit() -> tuple[Measurement, ...]:
    """Part 2: the exact distance to the limit, and the limit's invariance."""
    deep = _two_levels(DEEP)
    worst = max(
        abs(
            hausdorff_distance(_two_levels(k).points, deep.points).value
            + deep.depth_bound
            - GOLDEN_MEAN**-k / (GOLDEN_MEAN - 1)
        )
        for k in range(1, 9)
    )
    image = hutchinson(deep.points, [0.0, 1.0], GOLDEN_MEAN, OMEGA)
    return (
        Measurement(
            "depth",
            r"$d_H(R_k, R_\infty)$ for $R = \{0,1\}$, $k = 1, \dots, 8$: farthest from "
            r"$\rho^{-k}/(\rho-1)$",
            worst,
            at_most(EXACT, "the phalanges left out"),
        ),
        Measurement(
            "invariance",
            rf"$d_H(F(R_{{{DEEP}}}), R_{{{DEEP}}})$: the limit is invariant",
            hausdorff_distance(image, deep.points).value,
            equal(
                GOLDEN_MEAN ** -(DEEP + 1), EXACT, r"one phalanx more: $\rho^{-k-1}$"
            ),
        ),
    )


def _base_off() -> tuple[Measurement, ...]:
    """How far the base is from the attractor, for three control sets."""
    deep, what = _two_levels(DEEP), r"distance of $x_0$ from the attractor"
    near = float(np.abs(deep.points).min())
    interval = ControlSystem(GOLDEN_MEAN, OMEGA)
    answer = find_word(0, interval, WIDE_DEPTH, tolerance=1.0)
    return (
        Measurement(
            "base_one_level",
            rf"$R = \{{0\}}$: {what}, $\{{1/(\rho-1)\}}$",
            _off([0.0], 0),
            equal(GOLDEN_MEAN, EXACT, r"$1/(\rho-1) = \rho$"),
        ),
        Measurement(
            "base_two_levels",
            rf"$R = \{{0, 1\}}$: {what}",
            _off([0.0, 1.0], 0),
            equal(near, deep.depth_bound, f"$R_{{{DEEP}}}$, point by point"),
        ),
        Measurement(
            "base_interval",
            rf"$R = [0, 1]$: {what}, a lower bound",
            answer.lower_bound - interval.tail(WIDE_DEPTH),
            at_least(0.9, "branch and bound"),
        ),
    )


def _sums_off() -> Measurement:
    """Which finite sums are proved to be off the attractor."""
    sums = finite_sums(FINITE)
    off = sum(_off([0.0, 1.0], point) > 0 for point in sums)
    words = rf"$R = \{{0, 1\}}$: sums of up to {FINITE} phalanges off the attractor"
    every = equal(len(sums), 0, "all of them, by an exhausted tree of words")
    return Measurement("sums_off", words, float(off), every)


def _sum_on() -> Measurement:
    """A finite sum of the interval that endless words come as near to as one likes."""
    interval = ControlSystem(GOLDEN_MEAN, OMEGA)
    tip = summed(Foot.preset("paper"), np.array(ON))[-1]
    answer = find_word(tip, interval, LONG_DEPTH, tolerance=CLOSE)
    return Measurement(
        "sum_on",
        f"$R = [0, 1]$: distance of the sum with controls {', '.join(map(str, ON))} "
        "from the attractor, at most",
        answer.distance + interval.tail(LONG_DEPTH),
        at_most(CLOSE, f"a word of {LONG_DEPTH} controls"),
    )


def _off(levels: list[float], point: complex) -> float:
    """A lower bound of a point's distance to the attractor, proved."""
    system = ControlSystem(GOLDEN_MEAN, OMEGA, levels)
    answer = nearest_reachable(point, system, PROOF_DEPTH)
    return max(0.0, answer.lower_bound - system.tail(PROOF_DEPTH))


def _two_levels(depth: int) -> ReachableSet:
    """Rₖ for the levels 0 and 1."""
    return reachable_set(GOLDEN_MEAN, OMEGA, [0.0, 1.0], depth)


def _scattered(count: int) -> Complexes:
    """Random points, several lengths of a finger apart."""
    rng = np.random.default_rng(1)
    return np.asarray(5 * (rng.normal(size=count) + 1j * rng.normal(size=count)))


def _draw_convergence(path: Path) -> Path:
    from zygopin.plots import plot_convergence

    foot = Foot.preset("paper")
    reaches = [finger_reach(foot, 3, 3, depth=depth) for depth in range(1, 10)]
    return plot_convergence(reaches, path)


def _draw_finite_sums(path: Path) -> Path:
    from zygopin.paper.finger_drawings import draw_finite_sums

    return draw_finite_sums(path, _two_levels(DEEP).points, finite_sums(FINITE))
