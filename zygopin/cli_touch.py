"""The command on touch intervals: which branches each finger can touch."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import click

from zygopin.options import MM, axis_options, foot_options, make_foot
from zygopin.path_options import FILE
from zygopin.terminal import print_table, waiting


@click.command()
@foot_options
@click.option("--height-mm", "height", type=MM, required=True, help="z of the axis.")
@click.option(
    "--x-mm", "ahead", type=MM, default=0, show_default=True, help="x of the axis."
)
@axis_options
@click.option(
    "--png",
    type=FILE,
    help="Draw the intervals against ω and against ρ.",
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")
def touch(
    height: float,
    ahead: float,
    yaw: float,
    pitch: float,
    png: Path | None,
    as_json: bool,
    **foot: Any,  # noqa: ANN401
) -> None:
    """Say which radii of a branch each finger can touch without entering it.

    For a branch around a given axis, as long as it may be: from the radius where the
    finger just reaches it to the one where it can no longer get out of the way. What
    is found, and what is proved: no controls do with less, or with more.
    """
    from zygopin.branch import Branch, branch_axis
    from zygopin.touch import touch_intervals
    from zygopin.touch_output import touch_document, touch_lines, touch_rows

    chosen = make_foot(**foot)
    axis = Branch(1.0, (ahead, 0.0, height), branch_axis(yaw, pitch))
    with waiting("searching", quiet=as_json):
        found = touch_intervals(chosen, axis)
    if png is not None:
        from zygopin.touch_plots import plot_touch_bands

        with waiting("drawing", quiet=as_json):
            plot_touch_bands(chosen, axis, png)
    if as_json:
        click.echo(json.dumps(touch_document(found), indent=2, allow_nan=False))
        return
    click.echo(f"{chosen.name}: radii that are touched and not entered [mm]")
    headings = ("finger", "from", "no less than", "to", "no more than", "boxes")
    print_table(headings, touch_rows(found), "lrrrrr")
    for line in touch_lines(found):
        click.echo(line)
    if png is not None:
        click.echo(f"figure: {png}")
