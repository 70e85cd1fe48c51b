"""Commands on reachable sets: draw and tabulate them, hold them against Pinocchio."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from zygopin.option_types import named_finger
from zygopin.options import (
    DEGREES,
    Several,
    foot_options,
    foot_options_with,
    make_foot,
)
from zygopin.path_options import FILE, PATH
from zygopin.terminal import print_table, progress

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    from zygopin.foot import Foot
    from zygopin.reach import FingerReach

_JSON = click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")

_OMEGAS = click.option(
    "--omega-deg",
    "omegas",
    type=Several(DEGREES),
    help="Joint limits ω to compare, such as 15,30; else the foot's own.",
)

DEEPEST = 8
"""Depth of the last set in a sequence that shows convergence."""

SEQUENCE_POINTS = 70_000
"""Points of that set, at most."""

_FILES = {
    "png": ("figure", "Draw the sets side by side, as densities."),
    "html": ("scene", "Draw all fingers' sets around the foot, at the first ω."),
    "npz": ("arrays", "Write points, levels and bounds for NumPy."),
    "convergence": ("convergence", "Draw R1, R2, … and their distances to the limit."),
    "dimension": ("dimension", "Draw the box counts of the first ω's set, as a PNG."),
}
"""What `reach` writes: by option, what it is called, and what the help says."""


@click.command()
@foot_options
@click.option(
    "--levels",
    type=click.IntRange(2, 40_000),
    default=33,
    show_default=True,
    help="Equal levels of each control; fewer for long fingers.",
)
@click.option("--urdf", type=PATH, help="A URDF to judge; else the foot's own.")
@_JSON
@click.pass_context
def validate(
    context: click.Context,
    /,
    levels: int,
    urdf: Path | None,
    as_json: bool,
    **foot: Any,  # noqa: ANN401
) -> None:
    """Hold each finger's reachable set against Pinocchio on the URDF.

    grid: the whole grid of controls through both, Hausdorff distance. words: the
    same, point by point. random: controls off the grid, within its bound. limit:
    the distance to the limit set, which is known exactly. A toe that can turn goes
    through grid and words in both poses, the second called spread.

    Exit status 0: every row keeps to its bound; 1: one does not; 2: bad input.
    """
    from zygopin import reach_output
    from zygopin.files import read_text
    from zygopin.validation import iter_validation, row_count

    chosen = make_foot(**foot)
    text = None if urdf is None else read_text(urdf)
    total = row_count(chosen)
    found = iter_validation(chosen, levels=levels, urdf=text)
    rows = list(progress(found, "validating", total, quiet=as_json))
    failed = sum(not row.ok for row in rows)
    if as_json:
        document = reach_output.validation_document(chosen, rows)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
    else:
        click.echo(f"{chosen.name}: reachable sets against Pinocchio")
        headings = ("finger", "check", "levels", "tips", "value [mm]", "")
        table = reach_output.validation_rows(rows)
        print_table((*headings, "bound [mm]", "ok"), table, "llrrrlrl")
        click.echo(f"{total - failed} of {total} rows keep to their bounds")
    context.exit(1 if failed else 0)


def _file_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add an option for each file that `reach` writes."""
    for name, (_, words) in reversed(_FILES.items()):
        command = click.option(f"--{name}", name, type=FILE, help=words)(command)
    return command


@click.command()
@foot_options_with(_OMEGAS)
@click.option("--finger", default="3", show_default=True, help="Its number or name.")
@click.option(
    "--levels",
    type=click.IntRange(2, 10_000_000),
    help="Equal levels of each control; else 33, or what makes two million points.",
)
@click.option(
    "--depth", type=click.IntRange(1, 20), help="Phalanges; else the finger's own."
)
@_file_options
@click.option("--hull", is_flag=True, help="Convex hulls: in figures, and as JSON.")
@_JSON
def reach(
    finger: str,
    levels: int | None,
    depth: int | None,
    as_json: bool,
    **options: Any,  # noqa: ANN401
) -> None:
    """Say what a finger's tip can reach, and how exactly; draw it.

    The set of all control sequences with the given levels, in the finger's plane.
    Its bounds: grid, how far the tip can be from it with controls between the levels;
    depth, how far the set is from that of a finger that goes on for ever.
    """
    from zygopin import reach_output

    files = {name: options.pop(name) for name in _FILES}
    omegas, hull = options.pop("omegas") or (None,), options.pop("hull")
    feet = [make_foot(**options, omega=omega) for omega in omegas]
    sets = _sets(feet, finger, levels, depth)
    found = list(progress(sets, "reaching", len(feet), quiet=as_json))
    wanted = {name: path for name, path in files.items() if path is not None}
    written = _Writers(found, levels, hull).written(wanted)
    names = list(progress(written, "writing", len(wanted), quiet=as_json))
    if as_json:
        document = reach_output.reach_document(found, hull=hull)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
        return
    _print_sets(found)
    for name in names:
        click.echo(f"{_FILES[name][0]}: {wanted[name]}")


def _sets(
    feet: Sequence[Foot], finger: str, levels: int | None, depth: int | None
) -> Iterator[FingerReach]:
    """One set for each joint limit."""
    from zygopin.reach import MOST_POINTS, find_finger, finger_reach, levels_within

    which = named_finger(finger)
    for foot in feet:
        phalanges = depth or find_finger(foot, which).phalanges
        count = levels or levels_within(phalanges, MOST_POINTS)
        yield finger_reach(foot, which, count, depth=depth)


@dataclass(frozen=True)
class _Writers:
    """What writes each file.

    Attributes:
        sets: The sets, one for each joint limit.
        levels: The number of levels that was asked for.
        hull: Whether figures show convex hulls.
    """

    sets: Sequence[FingerReach]
    levels: int | None
    hull: bool

    def written(self, files: dict[str, Path]) -> Iterator[str]:
        """Write the files; yields the name of each that is done."""
        for name, path in files.items():
            getattr(self, name)(path)
            yield name

    def png(self, path: Path) -> None:
        """The sets as densities."""
        from zygopin.plots import plot_reach

        plot_reach(self.sets, path, hull=self.hull)

    def html(self, path: Path) -> None:
        """All fingers' sets around the foot."""
        from zygopin.reach_scene import export_reach_scene

        export_reach_scene(self.sets[0].foot, path, levels=self.levels)

    def npz(self, path: Path) -> None:
        """Points, levels and bounds."""
        from zygopin.reach_output import write_arrays

        write_arrays(self.sets, path)

    def convergence(self, path: Path) -> None:
        """The sets of growing depth."""
        from zygopin.plots import plot_convergence
        from zygopin.reach import MOST_LEVELS, finger_reach, levels_within

        foot, finger = self.sets[0].foot, self.sets[0].finger.name
        count = levels_within(DEEPEST, SEQUENCE_POINTS, self.levels or MOST_LEVELS)
        depths = range(1, DEEPEST + 1)
        reaches = [finger_reach(foot, finger, count, depth=k) for k in depths]
        plot_convergence(reaches, path)

    def dimension(self, path: Path) -> None:
        """The box counts."""
        from zygopin.plots import plot_box_counts

        plot_box_counts(self.sets[0], path)


def _print_sets(sets: Sequence[FingerReach]) -> None:
    """What the sets are, and their table."""
    from zygopin.reach_output import reach_rows

    first = sets[0]
    click.echo(
        f"{first.foot.name}, {first.finger.name}: {first.depth} phalanges, "
        f"{len(first.plane.levels)} levels of each control"
    )
    headings = ("ω [°]", "points", "x [mm]", "z [mm]", "hull [mm²]", "grid", "depth")
    print_table(headings, reach_rows(sets), "rrrrrrr")
    click.echo("grid, depth: bounds of the distance to all controls, and to the limit")
