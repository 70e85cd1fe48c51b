"""Tables of README.md that scripts make from what was measured."""

from __future__ import annotations

import argparse
import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
README = ROOT / "README.md"


@dataclass(frozen=True)
class ReadmeTable:
    """A table between two marks.

    Attributes:
        script: The script that writes it, whose name the marks have.
        title: What the table is called in messages.
        results: The JSON file that it is made from.
        make: What the file holds to the table as Markdown, with a line break at the
            end.
    """

    script: str
    title: str
    results: Path
    make: Callable[[Any], str]

    @property
    def start(self) -> str:
        """The mark before the table."""
        return f"<!-- scripts/{self.script} writes what follows -->"

    @property
    def end(self) -> str:
        """The mark behind the table."""
        return f"<!-- scripts/{self.script} wrote what precedes -->"

    def renewed(self, readme: str, results: Any) -> str:  # noqa: ANN401
        """The README with a fresh table.

        Args:
            readme: The text as it is.
            results: What the file of results holds.

        Returns:
            The text as it should be.

        Raises:
            ValueError: The README does not have the two marks, in this order.
        """
        before, start, rest = readme.partition(self.start)
        _, end, after = rest.partition(self.end)
        if not (start and end):
            raise ValueError(f"README.md needs the lines {self.start} and {self.end}")
        return f"{before}{start}\n\n{self.make(results)}\n{end}{after}"

    def main(self, description: str, readme: Path = README) -> int:
        """Do what the command line says.

        Args:
            description: What the script does, in a line.
            readme: The README.

        Returns:
            The exit status: 1 if the table is stale and only checked.
        """
        parser = argparse.ArgumentParser(description=description)
        parser.add_argument("--check", action="store_true", help="write nothing")
        check = parser.parse_args().check
        old = readme.read_text(encoding="utf-8")
        fresh = self.renewed(old, json.loads(self.results.read_text(encoding="utf-8")))
        if fresh == old:
            return 0
        if check:
            print(f"stale: {self.title} in README.md; run scripts/{self.script}")
            return 1
        readme.write_text(fresh, encoding="utf-8")
        print(f"renewed: {self.title} in README.md")
        return 0


def markdown(header: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    """A table in Markdown.

    Args:
        header: The columns' names.
        rows: Cells.

    Returns:
        Lines, with a line break at the end.
    """
    names = [*header]
    lines = [names, ["---"] * len(names), *rows]
    return "".join(f"| {' | '.join(cells)} |\n" for cells in lines)
