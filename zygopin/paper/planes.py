"""The printed angles of the fingers' planes, and what figure 2 says of them."""

from __future__ import annotations

import math
from functools import partial
from pathlib import Path

import numpy as np

from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.paper.entry import (
    EXACT,
    Entry,
    Exhibit,
    Measurement,
    at_least,
    equal,
)
from zygopin.paper.toe_planes import OPPOSED, SPLAY, plane_angle
from zygopin.paper.top_view import (
    COUNTS,
    Fit,
    assignments,
    label_sides,
    misfit_by_hand,
    tip_sides,
)

FROM_LABELS = "the places of the labels in the source"


def erratum_1() -> Entry:
    """The printed angles of the fingers' planes against text and figure.

    Returns:
        The entry.
    """
    foot, printed = Foot.preset("paper-figure"), printed_foot()
    return Entry(
        key="erratum-1",
        kind="erratum",
        title="Which fingers share a plane",
        place="section 4, below figure 2; section 4.1",
        printed=(
            r"$\Omega_1=\Omega_2=\pi/12$, $\Omega_3=\Omega_3=-\pi/12$; $v_0=0$ for "
            r"fingers 1 and 3, $v_0=\pi$ for 2 and 4; $p^1(=p^2)$ for the plane of "
            "fingers 1 and 3."
        ),
        ours=(
            r"$\Omega_1=\Omega_3=-\pi/12$, $\Omega_2=\Omega_4=\pi/12$; fingers 1 and 4 "
            "point back; $p^1=p^3$."
        ),
        finding=(
            r"Read with $\Omega_4$ for the second $\Omega_3$, the printed numbers put "
            r"fingers 1 and 3 in planes $\pi/6$ apart and point both forward, so that "
            "they are neither coplanar nor opposable. Figure 2 has them on opposite "
            "sides of the base, which equal $v_0$ exclude. Its labels all stand on "
            "the sides where our tips lie. Their heights over the base, halfway "
            r"between the two labels $\pi/6$, fit the phalanx counts 2, 3, 4, 5 of "
            "birds' digits I to IV with one scale; so does the proposition, which has "
            "2 and 4 phalanges for fingers 1 and 3. This is a measurement of a "
            "drawing: labels stand beside the tips, not on them."
        ),
        measurements=(*_planes(foot, printed), *_sides(foot, printed), *_fits(foot)),
        figures=(
            Exhibit(
                "erratum-1.png",
                "The labels of figure 2 where the source puts them, over straight toes "
                "at the one fitted scale, 52.8 points per unit; the base is placed by "
                "eye from left to right. Left: our foot; each name stands beside its "
                "tip. Right: the printed angles; only finger 3 ends at its name.",
                partial(_draw_labels, {"ours": foot, "printed angles": printed}),
            ),
        ),
    )


def printed_foot() -> Foot:
    """The foot by the printed angles, with Ω₄ for the second Ω₃.

    Returns:
        The foot with ρ = 1.2; toes with v₀ = π point back.
    """
    azimuths = (SPLAY, SPLAY + math.pi, -SPLAY, -SPLAY + math.pi)
    fingers = (
        Finger(f"finger{number}", count, azimuth)
        for number, (count, azimuth) in enumerate(
            zip(COUNTS, azimuths, strict=True), start=1
        )
    )
    return Foot.preset("paper-figure").replace(fingers=tuple(fingers))


def _planes(foot: Foot, printed: Foot) -> tuple[Measurement, ...]:
    """Angle between the planes of opposed fingers, and whether they oppose."""
    return (
        *_planes_of(printed, "printed", 2 * SPLAY, opposed=0),
        *_planes_of(foot, "ours", 0.0, opposed=1),
    )


def _planes_of(
    foot: Foot, key: str, angle: float, *, opposed: int
) -> tuple[Measurement, ...]:
    """The same of one foot."""
    angles = (
        Measurement(
            f"planes_{first}{second}_{key}",
            f"angle between the planes of fingers {first} and {second}, {key}",
            plane_angle(foot, (first, second)),
            equal(angle, EXACT, "difference of the azimuths"),
            unit="rad",
        )
        for first, second in OPPOSED
    )
    pair = Measurement(
        f"opposed_{key}",
        f"whether fingers 1 and 3 are an opposable pair, {key}: 1 if so",
        int((0, 2) in foot.opposable_pairs),
        equal(opposed, 0, "signs of the azimuths' cosines"),
    )
    return (*angles, pair)


def _sides(foot: Foot, printed: Foot) -> tuple[Measurement, ...]:
    """How many sides of tips agree with the labels' sides."""
    return tuple(
        Measurement(
            f"sides_{key}",
            "sides, forward or back and left or right, on which tip and label agree, "
            f"of 8, {key}",
            int(np.sum(tip_sides(each) == label_sides())),
            equal(expected, 0, route),
        )
        for key, each, expected, route in (
            ("ours", foot, 8, FROM_LABELS),
            ("printed", printed, 4, "signs of the printed azimuths, by hand"),
        )
    )


def _fits(foot: Foot) -> tuple[Measurement, ...]:
    """How the phalanx counts fit the labels' heights."""
    found = assignments(foot)
    best = found[COUNTS]
    others = sorted(fit.misfit for counts, fit in found.items() if counts != COUNTS)
    golden = assignments(Foot.preset("paper"))[COUNTS]
    return (
        Measurement(
            "scale", "points of the drawing per unit of length, fitted", best.scale
        ),
        _misfit("misfit", r"$\rho=1.2$", best, foot.rho),
        _misfit("misfit_golden", "the golden mean", golden, Foot.preset("paper").rho),
        Measurement(
            "better",
            "other assignments of 2, 3, 4, 5 phalanges to the fingers that fit as well "
            "or better, of 23",
            sum(misfit <= best.misfit for misfit in others),
            equal(0, 0, FROM_LABELS),
        ),
        Measurement(
            "runner_up",
            "misfit of the next best assignment over that of 2, 3, 4, 5",
            others[0] / best.misfit,
            at_least(
                misfit_by_hand(foot.rho, (2, 3, 5, 4))
                / misfit_by_hand(foot.rho, COUNTS)
                * (1 - EXACT),
                "2, 3, 5, 4: worked by hand",
            ),
        ),
    )


def _misfit(key: str, words: str, fit: Fit, rho: float) -> Measurement:
    """What is left of the labels' distances, for phalanx counts 2, 3, 4, 5."""
    # Of the sine of a small angle, the hand's formula keeps half of the digits.
    expected = equal(misfit_by_hand(rho, COUNTS), 1e-9, "sine of the angle between")
    text = f"norm of what is left over that of the distances, 2-3-4-5, {words}"
    return Measurement(key, text, fit.misfit, expected)


def _draw_labels(feet: dict[str, Foot], path: Path) -> object:
    """Draw the labels of figure 2 over our foot and over the printed one."""
    from zygopin.paper.foot_drawings import draw_labels

    return draw_labels(feet, path)
