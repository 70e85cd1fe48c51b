"""Two names of one folder change places in one step."""

from __future__ import annotations

import ctypes
import os
from pathlib import Path

_HERE = -100
"""AT_FDCWD: paths are as they are written."""

_EXCHANGE = 2
"""RENAME_EXCHANGE: each becomes the other, and both are there at every moment."""


def put(part: Path, target: Path) -> None:
    """Rename a file or folder into its place; what was there is then the part.

    A folder cannot be renamed onto one that holds something, so they are exchanged:
    whoever reads the target finds the old content or the new one, even after a kill.

    Args:
        part: What is put in place.
        target: The place, in the same folder.

    Raises:
        OSError: It cannot be renamed.
    """
    try:
        part.replace(target)
    except OSError:
        if not target.is_dir() or not part.is_dir():
            raise
        if not _exchanged(part, target):
            _swap(part, target)


def _exchanged(one: Path, other: Path) -> bool:
    """Whether the system and the file system could exchange two paths."""
    rename = getattr(ctypes.CDLL(None), "renameat2", None)
    if rename is None:
        return False
    paths = (_HERE, os.fsencode(one), _HERE, os.fsencode(other))
    return bool(rename(*paths, _EXCHANGE) == 0)


def _swap(part: Path, target: Path) -> None:
    """The same by three renames, where there is no other way."""
    old = target.with_name(f".{os.urandom(8).hex()}{target.suffix}")
    target.rename(old)
    try:
        part.rename(target)
    except BaseException:
        old.rename(target)
        raise
    old.rename(part)
