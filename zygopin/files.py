"""Writing files whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

from zygopin.errors import FileError


def write_text(path: Path | str, text: str) -> Path:
    """Write a text file: beside its place first, then renamed into it.

    Whoever reads the path finds the old content or the new one, never a part. A
    symbolic link is followed.

    Args:
        path: The file; missing parent folders are created.
        text: What it shall hold, stored as UTF-8, its line ends as they are.

    Returns:
        The path.

    Raises:
        FileError: The path is no regular file, or its folder cannot be written.
    """
    try:
        target = _target(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        _replace(target, text)
    except (OSError, ValueError) as error:
        problem = getattr(error, "strerror", None) or str(error)
        remedy = "name a file in a folder that can be written"
        raise FileError(path, f"cannot be written: {problem}", remedy) from error
    return Path(path)


def _target(path: Path | str) -> Path:
    """Where a path leads; a folder or a device is never replaced by a file."""
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        raise ValueError("it is not a regular file")
    return target


def _replace(target: Path, text: str) -> None:
    """Write beside the target and rename; leave nothing beside it on failure."""
    part = target.with_name(f".{os.urandom(8).hex()}.part")
    try:
        with part.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)
