"""Memory that an answer takes, and may take."""

from __future__ import annotations

import os

from zygopin import checks
from zygopin.errors import ParameterError


def limit(most: int | None = None) -> int:
    """Memory that an answer may take.

    Args:
        most: What the caller allows [bytes]; None: half of the machine's.

    Returns:
        The number of bytes.

    Raises:
        ParameterError: It is no number of bytes.
    """
    if most is not None:
        return checks.integer("max_bytes", most, 0, 2**62)
    return int(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2)


def require(what: str, needed: int, most: int, remedy: str) -> None:
    """Raise unless something fits in memory.

    Args:
        what: What it is, for the message.
        needed: Bytes that it takes.
        most: Bytes that it may take.
        remedy: What to do otherwise, in words.

    Raises:
        ParameterError: It takes more.
    """
    if needed > most:
        name = f"memory for {what} [bytes]"
        raise ParameterError(name, needed, f"at most {most}", remedy)
