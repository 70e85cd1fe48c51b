"""The report as one HTML page: its texts, its formulas, its pictures."""

from __future__ import annotations

import base64
import html
import math
from collections.abc import Mapping
from importlib import resources

from zygopin.errors import MissingExtraError
from zygopin.paper.document import PAPER
from zygopin.paper.entry import Entry, Measurement, Reference, Unit
from zygopin.paper.report import PaperReport

try:
    from jinja2 import Environment, StrictUndefined
    from latex2mathml.converter import convert
    from markupsafe import Markup
except ImportError as error:
    raise MissingExtraError(str(error.name).partition(".")[0], "paper") from error

FIGURES = 6
"""Significant figures of a number on the page."""

SMALL = 1e-3
"""Size below which a number is written with a power of ten."""

RAISED = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")
"""Figures of a power of ten."""

KINDS = {"figure": "Figures", "statement": "Statements", "erratum": "Errata"}
"""What the contents call each kind of entry."""


def page(report: PaperReport, pictures: Mapping[str, bytes]) -> str:
    """The report as HTML that asks for no other file but the scenes it links.

    Args:
        report: The report.
        pictures: The figures' PNG files, by name.

    Returns:
        The HTML text.
    """
    environment = Environment(
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.filters.update(
        typeset=typeset, number=_number, reference=_reference, plain=plain
    )
    encoded = {
        name: base64.b64encode(content).decode() for name, content in pictures.items()
    }
    return environment.from_string(_asset("report.html")).render(
        report=report,
        paper=PAPER,
        contents=_contents(report),
        pictures=encoded,
        style=Markup(_asset("report.css")),  # noqa: S704 the project's own file
    )


def typeset(text: str) -> Markup:
    """A text with its formulas as MathML, all else escaped.

    Args:
        text: Plain text; what stands between two dollar signs is TeX.

    Returns:
        HTML.
    """
    parts = text.split("$")
    parts[::2] = map(html.escape, parts[::2])
    parts[1::2] = map(convert, parts[1::2])
    return Markup("".join(parts))  # noqa: S704 escaped, or MathML


def plain(text: str) -> str:
    """A text without its dollar signs, where there can be no formulas.

    Args:
        text: Plain text and TeX.

    Returns:
        The text.
    """
    return text.replace("$", "").replace("\\", "")


def _contents(report: PaperReport) -> dict[str, list[Entry]]:
    """The entries of each kind under its heading, numbered ones first."""
    return {
        heading: sorted(
            (entry for entry in report.entries if entry.kind == kind),
            key=lambda entry: entry.number or math.inf,
        )
        for kind, heading in KINDS.items()
    }


def _number(found: Measurement) -> str:
    """A number with its unit."""
    return _written(found.value, found.unit)


def _reference(reference: Reference, unit: Unit) -> str:
    """What a number must be."""
    value = _written(reference.value, unit)
    within = f" ± {_written(reference.tolerance, unit)}" if reference.tolerance else ""
    return f"{reference.relation} {value}{within}"


def _written(value: float, unit: Unit) -> str:
    """A number as it is written: angles in degrees."""
    if unit == "rad":
        return f"{_decimal(math.degrees(value))}°"
    return _decimal(value)


def _decimal(value: float) -> str:
    """A number with a true minus sign, and a power of ten where it is small."""
    if value == 0 or abs(value) >= SMALL:
        return f"{value:.{FIGURES}g}".replace("-", "−")
    mantissa, _, exponent = f"{value:.1e}".partition("e")
    factor = mantissa.removesuffix(".0").replace("-", "−")
    power = f"10{str(int(exponent)).translate(RAISED)}"
    return power if factor == "1" else f"{factor}·{power}"


def _asset(name: str) -> str:
    """A file of the page's own."""
    return (resources.files("zygopin") / "assets" / name).read_text("utf-8")
