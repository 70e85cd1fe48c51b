"""The caption of a grasp's scene: what is shown, the verdict, and the colours."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass
from html import escape

import numpy as np

from zygopin.branch import Branch, yaw_and_pitch
from zygopin.foot import Foot
from zygopin.grasp import GraspReport
from zygopin.hold import Hold

SIGNIFICANT = 4
"""Figures of a length as long as the foot; shorter ones keep the same last place."""

NONE = "none"


@dataclass(frozen=True)
class Key:
    """An entry of the legend.

    Attributes:
        colour: A CSS colour.
        meaning: What it stands for, as plain text.
    """

    colour: str
    meaning: str


def verdict_words(report: GraspReport) -> str:
    """The verdict on a grasp in one line.

    Args:
        report: Of one configuration.

    Returns:
        Plain text.
    """
    if report.grasping:
        held = "Grasping"
    elif report.stable:
        held = "Stable, not grasping"
    elif np.any(report.touching | report.tangent):
        held = "Touching, not stable"
    else:
        held = "Nothing tangent to the branch"
    if report.feasible:
        return f"{held}, feasible"
    why = "a phalanx penetrates" if np.any(report.penetrating) else "fingers collide"
    return f"{held}, not feasible: {why}"


def caption(
    report: GraspReport,
    title: str,
    colour: str,
    colours: Iterable[Key],
    hold: Hold | None = None,
) -> str:
    """The caption as HTML, every text escaped.

    Args:
        report: Of one configuration.
        title: The scene's title, as plain text.
        colour: The verdict's CSS colour.
        colours: What the colours stand for.
        hold: How it holds, where that is shown.

    Returns:
        HTML.
    """
    words = escape(verdict_words(report))
    held = [section("Hold", hold_rows(hold))] if hold else []
    return "\n".join(
        (
            f"<h1>{escape(title)}</h1>",
            f'<p class="verdict" style="border-color: {escape(colour)}">{words}</p>',
            section("Contact", contact_rows(report)),
            *held,
            legend(colours),
            section("Foot", foot_rows(report.foot)),
            section("Branch", branch_rows(report)),
        )
    )


def contact_rows(report: GraspReport) -> dict[str, str]:
    """What the check found, name by value.

    Args:
        report: Of one configuration.

    Returns:
        Plain texts.
    """
    least = float(np.min(report.clearance))
    nearest = "Largest penetration" if np.any(report.penetrating) else "Least clearance"
    lengths = Lengths(report.foot.size)
    return {
        "Tangent phalanges": f"{np.sum(report.tangent)} of {report.foot.phalanx_count}",
        "Touching phalanges": str(np.sum(report.touching)),
        "Penetrating phalanges": str(np.sum(report.penetrating)),
        "Scalar product": ratio(report.scalar_product),
        "… base to tip": ratio(report.scalar_product_base_to_tip),
        nearest: lengths(abs(least) if np.any(report.penetrating) else least),
        "Between fingers": lengths(float(report.finger_clearance)),
        "Tolerance": f"{report.tolerance * 1e3:.1e} mm",
    }


def hold_rows(hold: Hold) -> dict[str, str]:
    """What friction makes of the contacts, name by value.

    Args:
        hold: The record.

    Returns:
        Plain texts.
    """
    return {
        "Held": "yes" if hold.held else "no",
        "Friction": f"{hold.strength.friction.coefficient:g}",
        "Quality": f"{hold.quality.low:.3f} to {hold.quality.high:.3f}",
        "Each contact presses": f"{hold.strength.normal_force:g} N at most",
        "Largest pull": f"{hold.pull.force:.3g} N",
    }


def foot_rows(foot: Foot) -> dict[str, str]:
    """A foot's parameters, name by value.

    Args:
        foot: The foot.

    Returns:
        Plain texts.
    """
    lengths = Lengths(foot.size)
    return {
        "Name": foot.name,
        "Scaling factor ρ": f"{foot.rho:.6g}",
        "Largest angle ω": degrees(foot.omega),
        "Splay Ω": degrees(foot.splay),
        "Scale": lengths(foot.scale),
        "Thickness": lengths(foot.thickness),
    }


def branch_rows(report: GraspReport) -> dict[str, str]:
    """The branch's size and pose, name by value.

    Args:
        report: Of one configuration.

    Returns:
        Plain texts.
    """
    return solid_branch_rows(report.branch, report.foot.size)


def solid_branch_rows(branch: Branch, size: float) -> dict[str, str]:
    """A branch's size and pose, name by value.

    Args:
        branch: One branch.
        size: Size of the foot beside it [m].

    Returns:
        Plain texts.
    """
    lengths = Lengths(size)
    yaw, pitch = yaw_and_pitch(branch.axis)
    return {
        "Radius": lengths(float(branch.radius)),
        "Height": lengths(float(branch.centre[2])),
        "Yaw": degrees(yaw),
        "Pitch": degrees(pitch),
        "Length": "infinite"
        if branch.length is None
        else lengths(float(branch.length)),
    }


@dataclass(frozen=True)
class Lengths:
    """Lengths in millimetres, down to the same place for a foot of some size.

    Attributes:
        size: The foot's size [m].
    """

    size: float

    def __call__(self, metres: float) -> str:
        """A length as a text.

        Args:
            metres: The length [m].

        Returns:
            Millimetres with their unit, or `none` where it is not finite.
        """
        if not math.isfinite(metres):
            return NONE
        leading = math.floor(math.log10(self.size * 1e3))
        return f"{_fixed(metres * 1e3, max(0, SIGNIFICANT - leading))} mm"


def ratio(value: float | np.ndarray) -> str:
    """A number without unit, or that there is none.

    Args:
        value: The number.

    Returns:
        Plain text.
    """
    return _fixed(float(value), 4) if np.isfinite(value) else NONE


def degrees(radians: float) -> str:
    """An angle as a text.

    Args:
        radians: The angle [rad].

    Returns:
        Degrees with their sign.
    """
    return f"{_fixed(math.degrees(radians), 2)}°"


def _fixed(value: float, decimals: int) -> str:
    """A number with a true minus sign, and none on zero."""
    return f"{round(value, decimals) + 0.0:.{decimals}f}".replace("-", "−")


def section(name: str, rows: dict[str, str]) -> str:
    """A heading and a table under it.

    Args:
        name: The heading, as plain text.
        rows: Names and values, as plain text.

    Returns:
        HTML.
    """
    body = "".join(
        f'<tr><th scope="row">{escape(key)}</th><td>{escape(value)}</td></tr>'
        for key, value in rows.items()
    )
    return f"<section><h2>{escape(name)}</h2><table>{body}</table></section>"


def legend(entries: Iterable[Key]) -> str:
    """The list of colours.

    Args:
        entries: What they stand for.

    Returns:
        HTML.
    """
    swatch = '<li><span class="swatch" style="background: {}"></span>{}</li>'
    items = "".join(swatch.format(escape(e.colour), escape(e.meaning)) for e in entries)
    return f"<section><h2>Colours</h2><ul>{items}</ul></section>"
