"""The command that says what a foot can do with every branch of a grid."""

from __future__ import annotations

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from zygopin.option_types import Cells, Interval, Range, finger_pair
from zygopin.options import MM, POSITIVE_MM, axis_options, foot_options, make_foot
from zygopin.path_options import FILE
from zygopin.terminal import print_table, waiting

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    import numpy as np
    from numpy.typing import NDArray

    from zygopin.atlas import Atlas
    from zygopin.branch_grid import BranchGrid
    from zygopin.foot import Foot

RADII, HEIGHTS = (0.02, 0.8), (-1.2, 0.0)
"""Ranges over the foot's size, unless said otherwise: from a twig to a branch that few
feet can wrap, from beyond the toes' reach to the base."""

_FILES = {
    "npz": ("arrays", "Write answers and poses for NumPy and load_atlas."),
    "png": ("figure", "Draw the map, and poses on some of the branches."),
    "wrap_png": ("wrap", "Draw the largest wrap, and the number of toes, as a PNG."),
    "html": ("scene", "A scene through the radii of one height."),
}
"""What the command writes: by option, what it is called, and what the help says. The
arrays come first: whatever is wrong with a picture, the work is not lost."""


def _file_options(command: Any) -> Any:
    """Add an option for each file."""
    for name, (_, words) in reversed(_FILES.items()):
        option = f"--{name.replace('_', '-')}"
        command = click.option(option, name, type=FILE, help=words)(command)
    return command


@click.command()
@foot_options
@click.option("--pair", help="Only two opposable fingers, such as finger1,finger3.")
@click.option(
    "--cells",
    type=Cells(),
    default="64",
    show_default=True,
    help="Heights and radii of the grid: 256, or 64x128.",
)
@click.option(
    "--radii-mm",
    "radii",
    type=Range(POSITIVE_MM),
    help="Radii, such as 1:28.  [default: 0.02 to 0.8 of the foot's size]",
)
@click.option(
    "--heights-mm",
    "heights",
    type=Range(MM, "-40:0"),
    help="z of the centres, such as -40:0.  [default: -1.2 to 0 of the size]",
)
@axis_options
@click.option("--x-mm", "ahead", type=MM, default=0, help="Forward place of the axes.")
@_file_options
@click.option(
    "--scene-height-mm",
    "scene_height",
    type=MM,
    help="z of the scene's branches; else as high as the base allows.",
)
@click.option(
    "--workers", type=click.IntRange(1, 1024), help="Processes; else one a processor."
)
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")
def atlas(
    scene_height: float | None, workers: int | None, as_json: bool, **options: Any
) -> None:
    """Say what a foot can do with every branch of a grid of heights and radii.

    Touchable: two opposable fingers touch at once; feasible: they are tangent;
    grasping: as a perch, a quarter turn apart; nothing enters the branch. Stable: they
    are tangent, whatever enters. Yes is shown by a pose, no is proved; what is neither
    stays undecided.

    Exit status 0: done; 2: bad input.
    """
    from zygopin import atlas_output
    from zygopin.atlas import branch_atlas

    files = {name: options.pop(name) for name in _FILES}
    if scene_height is not None and files["html"] is None:
        raise click.UsageError("--scene-height-mm goes with --html.")
    foot, grid = _task(**options)
    with waiting("starting", quiet=as_json) as sign:
        found = branch_atlas(
            foot, grid, workers=workers or os.cpu_count() or 1, progress=sign.update
        )
        written = _write(found, files, scene_height)
    if as_json:
        document = atlas_output.atlas_document(found)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
        return
    click.echo(atlas_output.title_line(found))
    rows = atlas_output.verdict_rows(found)
    print_table(("branches that are", "yes", "no", "undecided"), rows, "lrrr")
    lines = [*atlas_output.summary_lines(found), "", *atlas_output.map_lines(found)]
    for line in [*lines, *written]:
        click.echo(line)


def _task(
    pair: str | None, cells: tuple[int, int], **options: Any
) -> tuple[Foot, BranchGrid]:
    """The foot and the grid that the options ask for."""
    from zygopin.branch import branch_axis

    axis = branch_axis(options.pop("yaw"), options.pop("pitch"))
    ahead, ranges = options.pop("ahead"), [options.pop(x) for x in ("heights", "radii")]
    foot = make_foot(**options)
    if pair is not None:
        from zygopin.branch_solutions import pair_of_fingers

        foot = pair_of_fingers(foot, finger_pair(pair))
    return foot, _grid(foot, cells, ranges, axis, ahead)


def _grid(
    foot: Foot,
    cells: tuple[int, int],
    ranges: list[Interval | None],
    axis: NDArray[np.float64],
    ahead: float,
) -> BranchGrid:
    """The grid, where nothing is said in proportion to the foot."""
    import numpy as np

    from zygopin.branch_grid import BranchGrid

    usual = [(low * foot.size, high * foot.size) for low, high in (HEIGHTS, RADII)]
    ends = [given or own for given, own in zip(ranges, usual, strict=True)]
    heights, radii = (
        np.linspace(*end, count) for end, count in zip(ends, cells, strict=True)
    )
    return BranchGrid(heights, radii, axis, (ahead, 0.0))


def _write(
    found: Atlas, files: dict[str, Path | None], scene_height: float | None
) -> list[str]:
    """Write the files that are asked for; lines that name them."""
    for name, path in files.items():
        if path is None:
            continue
        if name == "npz":
            from zygopin.atlas_file import save_atlas

            save_atlas(found, path)
        elif name == "html":
            from zygopin.atlas_scene import export_atlas_scene

            export_atlas_scene(found, path, height=scene_height)
        else:
            from zygopin import atlas_plots

            wrap = name == "wrap_png"
            draw = atlas_plots.plot_atlas_wrap if wrap else atlas_plots.plot_atlas
            draw(found, path)
    return [f"{_FILES[name][0]}: {path}" for name, path in files.items() if path]
