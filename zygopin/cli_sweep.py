"""The command that plans perches over a grid of feet and branches."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from zygopin.option_types import is_count
from zygopin.options import DEGREES, MM, Quantity, make_foot, preset_options
from zygopin.path_options import PATH
from zygopin.terminal import print_table, steps

RATIO = Quantity("numbers", 1.0)

MOST_VALUES = 1_000_000
"""Values of one option."""


class Grid(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """One value, values separated by commas, or START:STOP:COUNT, held in SI.

    Args:
        each: The type of each value.
    """

    def __init__(self, each: Quantity) -> None:
        self.each = each
        self.name = "grid"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> float | tuple[float, ...]:
        """Parse a text.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            One value, or several.
        """
        if not isinstance(value, str):
            return tuple(value) if isinstance(value, tuple) else float(value)
        if ":" in value:
            return self._spaced(value, param, ctx)
        parts = [self.each.convert(part, param, ctx) for part in value.split(",")]
        return parts[0] if len(parts) == 1 else tuple(parts)

    def _spaced(
        self, value: str, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, ...]:
        """Values at equal steps."""
        start, _, rest = value.partition(":")
        stop, _, count = rest.partition(":")
        if not is_count(count, MOST_VALUES):
            words = "START:STOP:COUNT with a count of 2 or more, such as 3:20:18"
            self.fail(f"{value!r} is not {words}.", param, ctx)
        first, last = (self.each.convert(end, param, ctx) for end in (start, stop))
        step = (last - first) / (int(count) - 1)
        return (*(first + step * place for place in range(int(count) - 1)), last)


class Labels(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """Labels separated by commas; one label stands for itself."""

    name = "counts"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> str | tuple[str, ...]:
        """Parse a text.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            One label, or several.
        """
        del param, ctx
        if not isinstance(value, str) or "," not in value:
            return value
        return tuple(value.split(","))


_GRIDS = {
    "--rho": (RATIO, "Scaling factor ρ > 1."),
    "--omega-deg": (DEGREES, "Joint limit ω."),
    "--splay-deg": (DEGREES, "Splay angle Ω."),
    "--scale-mm": (MM, "Length scale s; the skin stays as thick."),
    "--thickness-mm": (MM, "Skin radius."),
    "--radius-mm": (MM, "Radius of the branch."),
    "--height-mm": (MM, "z of the branch's centre; else the base is on the bark."),
    "--yaw-deg": (DEGREES, "Turn of the branch about z; 0: across the foot."),
    "--pitch-deg": (DEGREES, "Rise of the branch to the left."),
}
"""Options that take a grid: what each value is, and what the help says."""


def _grid_options(command: Any) -> Any:
    """Add an option for each quantity."""
    for name, (quantity, words) in reversed(_GRIDS.items()):
        needed = name == "--radius-mm"
        option = click.option(
            name, _field(name), type=Grid(quantity), help=words, required=needed
        )
        command = option(command)
        if needed:
            words = "Phalanges of each finger, such as 2-3-4-5,3-3-3-3."
            command = click.option("--phalanges", type=Labels(), help=words)(command)
    return command


def _field(option: str) -> str:
    """The quantity that an option is for."""
    return option.removeprefix("--").partition("-")[0]


@click.command()
@preset_options
@_grid_options
@click.option("--find-height", is_flag=True, help="Search for the best height instead.")
@click.option(
    "--levels",
    type=click.IntRange(2, 33),
    default=7,
    show_default=True,
    help="Angles that the planner tries at each joint.",
)
@click.option("-o", "--output", type=PATH, help="FILE.nc or FOLDER.zarr.")
@click.option(
    "--scheduler",
    default="processes",
    show_default=True,
    metavar="NAME|ADDRESS",
    help="processes, threads or sync; or a Dask cluster, such as tcp://HOST:8786.",
)
@click.option(
    "--workers", type=click.IntRange(1, 1024), help="Local ones; else one a processor."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")
def sweep(
    preset: str | None,
    foot_file: Path | None,
    output: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """Plan a perch for every foot and branch of a grid, save all of it.

    Each quantity takes one value, values separated by commas, or START:STOP:COUNT;
    several values make a dimension of the result, which is saved with its units for
    xarray. Finished work is kept in OUTPUT.parts until all is done: after a kill, the
    same command goes on where it was.

    Exit status 0: done; 2: bad input.
    """
    from zygopin import sweep_output
    from zygopin.design_sweep import Sweep
    from zygopin.sweep_grid import FOUND, QUANTITIES, SweepGrid
    from zygopin.sweep_run import Runner

    runner = Runner(options.pop("scheduler"), options.pop("workers"))
    levels, find = options.pop("levels"), options.pop("find_height")
    given = {name: options[name] for name in QUANTITIES if options[name] is not None}
    if find and "height" in given:
        raise click.UsageError("--find-height and --height-mm exclude each other.")
    given |= {"height": FOUND} if find else {}
    grid = SweepGrid.of(make_foot(preset, foot_file), given)
    planned = Sweep(grid, levels, output)
    with steps("sweeping", quiet=as_json) as begun:
        result = planned.run(runner, begun)
    if as_json:
        document = sweep_output.sweep_document(grid, result, output)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
        return
    click.echo(sweep_output.grid_line(grid))
    if result.kept:
        click.echo(f"{result.kept} of {result.chunks} chunks were there already")
    print_table(("outcome", "cells", "share"), sweep_output.reason_rows(result), "lrr")
    if output is not None:
        click.echo(f"dataset: {output}")
