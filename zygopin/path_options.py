"""Options that name files: checked before the work whose result they get."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from zygopin.errors import ZygopinError
from zygopin.files import as_path, check_file, check_folder

if TYPE_CHECKING:
    from collections.abc import Callable


class _Place(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """A path that a function has nothing against.

    Args:
        kind: What the path is of.
        check: The function; it raises an error of zygopin's.
    """

    name = "path"

    def __init__(self, kind: str, check: Callable[[str], Path]) -> None:
        self.kind = kind
        self.check = check

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Path:
        """Check a path that was typed.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            The path.
        """
        if isinstance(value, Path):
            return value
        try:
            return self.check(value)
        except ZygopinError as error:
            self.fail(f"{error}.", param, ctx)


PATH = _Place("PATH", as_path)
"""What is read, or written by rules of its own."""

FILE = _Place("FILE", check_file)
"""A file to write."""

FOLDER = _Place("FOLDER", check_folder)
"""A folder to write files to."""
