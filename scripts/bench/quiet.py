"""What other tools print about our files, kept away from the table and the JSON."""

from __future__ import annotations

import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager


@contextmanager
def quiet() -> Iterator[None]:
    """Nothing reaches the standard streams, not even from compiled code."""
    kept = [os.dup(number) for number in (1, 2)]
    try:
        with open(os.devnull, "w", encoding="utf-8") as nowhere:
            _flush()
            for number in (1, 2):
                os.dup2(nowhere.fileno(), number)
            yield
    finally:
        _flush()
        for number, copy in enumerate(kept, start=1):
            os.dup2(copy, number)
            os.close(copy)


def _flush() -> None:
    """What is buffered goes where it was meant to go."""
    sys.stdout.flush()
    sys.stderr.flush()
