"""Commands whose errors are one line, whatever goes wrong."""

from __future__ import annotations

import atexit
import errno
import gc
import io
import os
import sys
from typing import Any

import click

from zygopin.errors import FileError, ZygopinError

BROKEN_PIPE = 141
"""Exit status of a program whose reader has gone, as shells count it."""

LONGEST = 600
"""Characters of a complaint: what was typed may be much longer."""


class OneLineErrors(click.Group):
    """A command group whose errors are one line on stderr and an exit status."""

    def main(self, *args: Any, **kwargs: Any) -> Any:
        """Run the command line and exit.

        Args:
            *args: As for `click.Group.main`.
            **kwargs: As for `click.Group.main`.

        Returns:
            Never: raises SystemExit with the status.
        """
        if sys.stdout is None:  # closed by who started this
            _complain("the output cannot be written: it is closed")
            raise SystemExit(2)
        kwargs["standalone_mode"] = False
        # All that is left at exit goes with the process: no search for cycles in it.
        atexit.register(gc.freeze)
        for stream in (sys.stdout, sys.stderr):
            if isinstance(stream, io.TextIOWrapper):
                stream.reconfigure(errors="replace")  # ρ, on a terminal without it
        try:
            status = super().main(*args, **kwargs)
        except click.ClickException as error:
            _complain(error.format_message())
            status = error.exit_code
        except click.Abort:
            _complain("interrupted")
            status = 130
        except ZygopinError as error:
            _complain(str(error))
            status = error.exit_code
        raise SystemExit(status if isinstance(status, int) else 0)

    def invoke(self, ctx: click.Context) -> Any:
        """Run a command, and see that what it prints arrives.

        Args:
            ctx: The group's context.

        Returns:
            What the command returns.
        """
        try:
            result = super().invoke(ctx)
            sys.stdout.flush()
        except FileError:
            raise
        except OSError as error:
            # What is still buffered would complain again when Python exits.
            os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
            if error.errno != errno.EPIPE:
                _complain(f"the output cannot be written: {error.strerror}")
            ctx.exit(2 if error.errno != errno.EPIPE else BROKEN_PIPE)
        return result


def _complain(message: str) -> None:
    """One line on stderr."""
    line = " ".join(message.split())
    if len(line) > LONGEST:
        line = f"{line[: LONGEST - 3]}..."
    click.echo(f"zygopin: {line}", err=True)
