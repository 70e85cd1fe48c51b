"""What commands show on a terminal: tables, and signs that work is under way."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, TypeVar

import click

if TYPE_CHECKING:  # loaded where it is used, so that --help is quick
    from rich.status import Status

Item = TypeVar("Item")
Step = Callable[[], None]

NARROWEST = 72
"""Columns that a table takes at the least: its numbers stay whole."""


def print_table(
    headings: Sequence[str], rows: Sequence[tuple[str, ...]], align: str
) -> None:
    """Print a table that fits the terminal.

    Args:
        headings: The columns' headings.
        rows: Their texts, row by row.
        align: `l` or `r` for each column.
    """
    from rich import box
    from rich.console import Console
    from rich.table import Table

    table = Table(box=box.SIMPLE_HEAD, pad_edge=False)
    for heading, side in zip(headings, align, strict=True):
        left = side == "l"
        table.add_column(heading, justify="left" if left else "right", no_wrap=not left)
    for row in rows:
        table.add_row(*row)
    console = Console(markup=False, highlight=False)
    console.width = max(console.width, NARROWEST)  # rather wrapped than cut off
    with console.capture() as text:
        console.print(table)
    click.echo(text.get(), nl=False)


def waiting(what: str, *, quiet: bool) -> Status:
    """A sign on stderr while something runs, on a terminal only.

    Args:
        what: What runs.
        quiet: Whether to show nothing at all.

    Returns:
        A context that shows the sign.
    """
    from rich.console import Console

    return Console(stderr=True, quiet=quiet).status(what)


def progress(
    items: Iterable[Item], what: str, total: int, *, quiet: bool
) -> Iterable[Item]:
    """A bar on stderr that grows with each item that is done, on a terminal only.

    Args:
        items: What is worked through.
        what: What runs.
        total: How many items there are.
        quiet: Whether to show nothing at all.

    Yields:
        The items.
    """
    from rich.console import Console
    from rich.progress import track

    console = Console(stderr=True, quiet=quiet)
    if quiet or not console.is_terminal:
        # Even a disabled bar of older rich leaves an empty line.
        yield from items
        return
    yield from track(items, what, total, console=console, transient=True)


@contextmanager
def steps(what: str, *, quiet: bool) -> Iterator[Callable[[int, int], Step]]:
    """A bar on stderr for work that is done in any order, on a terminal only.

    Args:
        what: What runs.
        quiet: Whether to show nothing at all.

    Yields:
        What starts the bar, given the number of steps and of those done before; it
        returns what is to be called for each further one.
    """
    from rich.console import Console
    from rich.progress import Progress

    console = Console(stderr=True, quiet=quiet)
    if quiet or not console.is_terminal:
        yield lambda _total, _done: lambda: None
        return
    with Progress(console=console, transient=True) as bar:

        def begun(total: int, done: int) -> Step:
            task = bar.add_task(what, total=total, completed=done)
            return lambda: bar.advance(task)

        yield begun
