"""The command that recomputes the paper."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING

import click

from zygopin.path_options import FOLDER
from zygopin.terminal import print_table, progress

if TYPE_CHECKING:  # commands load what they use, so that --help is quick
    from zygopin.paper.report import PaperReport


@click.command()
@click.option(
    "-o",
    "--output",
    required=True,
    type=FOLDER,
    help="Folder to write to.",
)
@click.option("--json", "as_json", is_flag=True, help="Print report.json as well.")
@click.pass_context
def paper(context: click.Context, /, output: Path, as_json: bool) -> None:
    """Recompute every figure, number and statement of the paper: report.html.

    One page that works offline, with what the paper prints beside what zygopin finds,
    its pictures and its scenes; report.json has the numbers.

    Exit status 0: every number is as it must be; 1: one is not; 2: bad input.
    """
    from zygopin.paper.document import paper_document
    from zygopin.paper.output import PAGE, iter_paper_report
    from zygopin.paper.report import ENTRIES, gathered

    steps = iter_paper_report(output)
    report = gathered(list(progress(steps, "recomputing", ENTRIES, quiet=as_json)))
    if as_json:
        document = paper_document(report)
        click.echo(json.dumps(document, indent=2, allow_nan=False))
    else:
        _print(report)
        click.echo(f"report: {output / PAGE}")
    context.exit(0 if report.holds else 1)


def _print(report: PaperReport) -> None:
    """A table of the entries."""
    rows = [
        (
            entry.label,
            entry.title,
            f"{sum(each.holds for each in entry.judged)} of {len(entry.judged)}",
            "yes" if entry.holds else "no",
        )
        for entry in report.entries
    ]
    print_table(("entry", "about", "numbers", "holds"), rows, "llrl")
