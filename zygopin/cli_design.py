"""The command that designs a foot for a range of perches."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from zygopin.option_types import Interval, Range
from zygopin.options import DEGREES, POSITIVE_MM, Quantity, foot_options, make_foot
from zygopin.path_options import FILE
from zygopin.terminal import print_table, waiting

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    from zygopin.design import Design

_FREE = {
    "rho": Quantity("numbers", 1.0),
    "omega-deg": DEGREES,
    "splay-deg": DEGREES,
    "scale-mm": POSITIVE_MM,
}
"""What may vary, as options call it."""


class Bounds(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """NAME=LOW:HIGH of what may vary, held in SI."""

    name = "name=low:high"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, Interval]:
        """Parse a text.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            The parameter's name and its bounds.
        """
        if isinstance(value, tuple):
            return value
        name, _, ends = value.partition("=")
        if name not in _FREE:
            words = f"NAME=LOW:HIGH with one of {', '.join(_FREE)} for a name"
            self.fail(f"{value!r} is not {words}.", param, ctx)
        return _plain(name), Range(_FREE[name]).convert(ends, param, ctx)


@click.command()
@foot_options
@click.option(
    "--radii-mm",
    "radii",
    type=Range(POSITIVE_MM),
    required=True,
    help="Radii of the perches, such as 3:20.",
)
@click.option("--vary", help="What is free, such as rho,omega; else all there is.")
@click.option(
    "--bounds",
    multiple=True,
    type=Bounds(),
    help="Such as rho=1.1:1.8, omega-deg=30:90; can be repeated.",
)
@click.option(
    "--trials",
    type=click.IntRange(16, 1_000_000),
    default=160,
    show_default=True,
    help="Feet to try: the time it takes.",
)
@click.option(
    "--workers", type=click.IntRange(1, 1024), help="Processes; else one a processor."
)
@click.option("-o", "--output", type=FILE, help="Write the foot, YAML for --foot.")
@click.option("--png", type=FILE, help="Draw the perches before and after.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")
def design(
    radii: Interval,
    output: Path | None,
    png: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Design the foot that grasps the widest range of perches.

    Varies ρ, ω, splay and scale of a foot, the skin in proportion to the scale, so
    that it grasps as much as it can of the asked radii, on a logarithmic scale, while
    its base sits on the bark; of equals, the foot that wraps further. Always finds the
    same foot, and never a worse one than the given.

    Exit status 0: done; 2: bad input.
    """
    from zygopin import design_output
    from zygopin.design import design_foot

    bounds = _chosen(options.pop("vary"), dict(options.pop("bounds")))
    trials, workers = options.pop("trials"), options.pop("workers")
    foot = make_foot(**options)
    with waiting(f"designing, {trials} feet", quiet=as_json):
        found = design_foot(
            foot,
            *radii,
            bounds=bounds,
            trials=trials,
            workers=workers or os.cpu_count() or 1,
        )
    if output is not None:
        design_output.write_design(found, output)
    if png is not None:
        from zygopin.design_plots import plot_design

        plot_design(found, png)
    if as_json:
        document = design_output.design_document(found)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
        return
    _print_design(found)
    for what, path in (("foot", output), ("figure", png)):
        if path is not None:
            click.echo(f"{what}: {path}")


def _chosen(
    vary: str | None, bounds: dict[str, Interval]
) -> dict[str, Interval | None]:
    """What varies, with its bounds where they are given."""
    names = [*map(_plain, _FREE)]
    chosen = names if vary is None else vary.split(",")
    for name in chosen:
        if name not in names:
            known = ", ".join(names)
            raise click.UsageError(f"--vary {name!r} is unknown: choose of {known}.")
    for name in bounds:
        if name not in chosen:
            raise click.UsageError(f"--bounds {name} is not among --vary: add it.")
    return {name: bounds.get(name) for name in chosen}


def _plain(option: str) -> str:
    """The parameter that an option's name is for."""
    return option.partition("-")[0]


def _print_design(found: Design) -> None:
    """The table, and what was tried."""
    from zygopin.design_output import design_rows

    low, high = (end * 1e3 for end in (found.before.low, found.before.high))
    name = found.before.foot.name
    click.echo(f"{name}: perches of radius {low:.6g} to {high:.6g} mm, at rest")
    print_table(("", "before", "after", "free within"), design_rows(found), "lrrr")
    better = "the best" if found.improved else "none is better"
    click.echo(f"{found.trials} feet tried: {better}")
