"""Writing files whole or not at all."""

from __future__ import annotations

import os
import secrets
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
    target = Path(os.path.realpath(path))
    if target.exists() and not target.is_file():
        raise FileError(path, "is not a regular file", "name a file to write")
    part = target.with_name(f".{secrets.token_hex(8)}.part")
    try:
        target.parent.mkdir(parents=True, exist_ok=True)
        with part.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
        part.replace(target)
    except (OSError, UnicodeEncodeError) as error:
        problem = getattr(error, "strerror", None) or str(error)
        remedy = "name a file in a folder that can be written"
        raise FileError(path, f"cannot be written: {problem}", remedy) from error
    finally:
        part.unlink(missing_ok=True)
    return Path(path)
