"""The command that lists every branch on which two fingers are stable."""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO, NamedTuple

import click

from zygopin.errors import ParameterError
from zygopin.option_types import finger_pair
from zygopin.options import MM, axis_options, foot_options, make_foot
from zygopin.path_options import FILE
from zygopin.terminal import print_table, waiting

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    from zygopin.branch_solutions import BranchSolutions
    from zygopin.crossings import SystemCounts

LISTED = 20
"""Solutions in the table, unless said otherwise."""

MOST_LISTED = 100_000
"""Solutions in the JSON, unless said otherwise: about a hundred megabytes."""

MOST_SYSTEMS = 10**12
"""Systems that are solved: at some ten million a second."""


@dataclass
class _Tally:
    """What a search has brought so far.

    Attributes:
        wanted: Verdicts that a solution must have to be listed.
        limit: Most solutions to keep.
        verify: Whether FCL checks each listed solution.
        kept: The first of the listed solutions.
        counts: What became of the systems.
        solutions: Number of all solutions.
        matching: Of those with the verdicts.
        families: Of those that are one-parameter families.
        stable: Of those that are stable on the true cylinder.
        difference: Largest distance by FCL from a tangency [m].
        disagreeing: Solutions in which FCL sees no contact.
    """

    wanted: tuple[str, ...]
    limit: int
    verify: bool
    kept: list[BranchSolutions] = field(default_factory=list)
    counts: SystemCounts | None = None
    solutions: int = 0
    matching: int = 0
    families: int = 0
    stable: int = 0
    difference: float = 0.0
    disagreeing: int = 0

    def matched(self, blocks: Iterable[BranchSolutions]) -> Iterator[BranchSolutions]:
        """The listed solutions of each block; they are counted on the way."""
        from zygopin.records import taken

        for block in blocks:
            self.counts = block.counts + self.counts if self.counts else block.counts
            self.solutions += len(block)
            for verdict in self.wanted:
                block = taken(block, getattr(block, verdict))
            room = max(0, self.limit - self.matching)
            if room or not self.kept:
                self.kept.append(taken(block, slice(room)))
            self.matching += len(block)
            self.families += int(block.family.sum())
            self.stable += int(block.stable.sum())
            if self.verify:
                self.check(block)
            yield block

    def check(self, block: BranchSolutions) -> None:
        """Hold a block against FCL."""
        apart = block.fcl_difference()
        self.difference = max(self.difference, float(apart.max(initial=0.0)))
        self.disagreeing += int((apart > block.tolerance).sum())

    def numbers(self) -> dict[str, Any]:
        """What the document tells beside the solutions."""
        fcl = {"max_difference": self.difference, "disagreeing": self.disagreeing}
        return {
            "solutions": self.solutions,
            "matching": self.matching,
            "families": self.families,
            "stable": self.stable,
            "fcl": fcl if self.verify else None,
        }


@click.command()
@foot_options
@click.option(
    "--pair",
    default="finger1,finger3",
    show_default=True,
    help="Two opposable fingers, by name or number.",
)
@click.option(
    "--levels",
    default="2",
    show_default=True,
    help="Number of equal levels of each control, or the levels: 0,0.3,1.",
)
@axis_options
@click.option("--x-mm", "x", type=MM, default=0, help="Forward place of the centre.")
@click.option("--tied", is_flag=True, help="Only branches that the base rests on.")
@click.option(
    "--section",
    type=click.Choice(["geometric", "printed", "circle"]),
    help="With --tied: the ellipse in the toe's plane.  [default: geometric]",
)
@click.option("--feasible", is_flag=True, help="List only what is feasible.")
@click.option("--grasping", is_flag=True, help="List only grasps, reading section.")
@click.option(
    "--limit",
    type=click.IntRange(1),
    help=f"Most to list.  [default: {LISTED}; with --json all]",
)
@click.option(
    "--csv",
    "file",
    type=FILE,
    help="Write all to this file, in SI, with their controls.",
)
@click.option("--verify", is_flag=True, help="Check each one by FCL.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON, in SI.")
@click.pass_context
def branches(
    context: click.Context,
    /,
    limit: int | None,
    file: Path | None,
    as_json: bool,
    **options: Any,
) -> None:
    """List every branch on which two fingers are stable, none missed.

    For controls in a finite set: each phalanx that a control sequence can place is held
    against each one of the other finger, one 2×2 system each. A starred phalanx touches
    with its back. A row with "…" is a family of branches; its verdicts are those of one
    midway. They are said of controls that stay 0 after the tangent phalanx, and of the
    true cylinder, whatever the section.

    Exit status 0: branches are listed; 1: there are none, or FCL disagrees; 2: bad
    input.
    """
    wanted = tuple(name for name in ("feasible", "grasping") if options.pop(name))
    most = MOST_LISTED if as_json else LISTED
    tally = _Tally(wanted, limit or most, options.pop("verify"))
    task = _task(**options)
    if not as_json:
        click.echo(task.title)
    with waiting("solving", quiet=as_json):
        _consume(tally, task, file)
    if as_json:
        _check_listed(tally, limit)
    _show(tally, task, as_json=as_json)
    if file is not None and not as_json:
        click.echo(f"table: {file}")
    context.exit(0 if tally.matching and not tally.disagreeing else 1)


class _Task(NamedTuple):
    """What is searched for.

    Attributes:
        title: What it is, with the number of systems.
        levels: The control set.
        section: Of branches under the base, the reading of their section; else None.
        run: Starts the search; yields blocks of solutions.
    """

    title: str
    levels: list[float]
    section: str | None
    run: Callable[[], Iterable[BranchSolutions]]


def _task(pair: str, levels: str, tied: bool, section: Any, **options: Any) -> _Task:
    """What the options ask for; nothing is solved yet."""
    from zygopin.branch import branch_axis
    from zygopin.tangent_lines import control_set

    axis = branch_axis(options.pop("yaw"), options.pop("pitch"))
    x, foot = options.pop("x"), make_foot(**options)
    fingers, values = finger_pair(pair), _levels(levels)
    name, known = f"{foot.name}, {pair}, levels {levels}", control_set(values).tolist()
    if not tied:
        if section is not None:
            raise click.UsageError("--section goes with --tied.")
        from zygopin.branch_search import count_systems, iter_stable_branches
        from zygopin.placement import Placement

        count = count_systems(foot, fingers, values)
        if count > MOST_SYSTEMS:
            allowed = f"at most {MOST_SYSTEMS:.0e}, hours of work"
            raise ParameterError(
                "number of systems", count, allowed, "take fewer levels"
            )
        title = f"{name}: {count} systems"
        there = Placement(axis, x)
        run = partial(iter_stable_branches, foot, fingers, values, placement=there)
        return _Task(title, known, None, run)
    if x:
        raise click.UsageError("--tied has its branches under the base: no --x-mm.")
    from zygopin.branch_solutions import Search
    from zygopin.resting import resting_branches

    reading: Any = section or "geometric"
    title = f"{name}: {sum(Search.of(foot, fingers, values).lines)} equations"
    rest = partial(resting_branches, foot, fingers, values, section=reading, axis=axis)
    return _Task(f"{title}, branches under the base", known, reading, lambda: [rest()])


def _levels(text: str) -> int | tuple[float, ...]:
    """The number of levels, or the levels."""
    try:
        if "," in text:
            return tuple(float(level) for level in text.split(","))
        return int(text)
    except ValueError as error:
        message = f"--levels = {text} is neither a number nor levels: try 0,0.5,1."
        raise click.UsageError(message) from error


def _consume(tally: _Tally, task: _Task, file: Path | None) -> None:
    """Work through all solutions, and write them."""
    from zygopin.branch_output import csv_header, csv_lines
    from zygopin.files import write_stream

    def write(stream: BinaryIO) -> None:
        begun = False
        for block in tally.matched(task.run()):
            text = csv_lines(block) if begun else csv_header(block) + csv_lines(block)
            stream.write(text.encode("ascii"))
            begun = True

    if file is not None:
        write_stream(file, write)
        return
    for _ in tally.matched(task.run()):
        pass


def _check_listed(tally: _Tally, limit: int | None) -> None:
    """A document holds all, unless a limit was asked for."""
    if limit is None and tally.matching > MOST_LISTED:
        remedy = "give --limit, or write them with --csv"
        name, allowed = "number of branches in the JSON", f"at most {MOST_LISTED}"
        raise ParameterError(name, tally.matching, allowed, remedy)


def _show(tally: _Tally, task: _Task, *, as_json: bool) -> None:
    """Print what was found."""
    from zygopin import branch_output
    from zygopin.crossings import SystemCounts
    from zygopin.records import joined

    found, counts = joined(tally.kept), tally.counts or SystemCounts()
    if as_json:
        numbers = {"levels": task.levels, "section": task.section, **tally.numbers()}
        document = branch_output.solutions_document(found, counts, numbers)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
        return
    if len(found):
        rows = branch_output.solution_rows(found)
        print_table(branch_output.HEADINGS, rows, "rrrrrr")
    tied = task.section is not None
    for line in branch_output.summary_lines(counts, tally.numbers(), tied=tied):
        click.echo(line)
    if len(found) < tally.matching:
        click.echo(f"the first {len(found)} are listed: --limit, --csv give more")
