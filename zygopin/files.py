"""Reading files, and writing them whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from zygopin.errors import FileError, ZygopinError


def read_text(path: Path | str) -> str:
    """Read a text file.

    Args:
        path: The file, in UTF-8.

    Returns:
        What it holds.

    Raises:
        FileError: It cannot be read, or is not UTF-8.
    """
    try:
        return Path(path).read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        remedy = "name a text file"
        raise FileError(
            path, "cannot be read: not a UTF-8 text file", remedy
        ) from error
    except (OSError, ValueError) as error:
        problem = getattr(error, "strerror", None) or str(error)
        remedy = "name a text file that can be read"
        raise FileError(path, f"cannot be read: {problem}", remedy) from error


def write_text(path: Path | str, text: str) -> Path:
    """Write a text file whole or not at all.

    Args:
        path: The file; missing parent folders are created.
        text: What it shall hold, stored as UTF-8, its line ends as they are.

    Returns:
        The path.

    Raises:
        FileError: The path is no regular file, or its folder cannot be written.
    """
    return write_stream(path, lambda file: file.write(text.encode("utf-8")))


def write_bytes(path: Path | str, content: bytes) -> Path:
    """Write a file whole or not at all.

    Args:
        path: The file; missing parent folders are created.
        content: What it shall hold.

    Returns:
        The path.

    Raises:
        FileError: The path is no regular file, or its folder cannot be written.
    """
    return write_stream(path, lambda file: file.write(content))


def write_stream(path: Path | str, write: Callable[[BinaryIO], object]) -> Path:
    """Write a file piece by piece, yet whole or not at all.

    It is written beside its place first, then renamed into it: whoever reads the path
    finds the old content or the new one, never a part. A symbolic link is followed.

    Args:
        path: The file; missing parent folders are created.
        write: Writes the content into the open file that it is given.

    Returns:
        The path.

    Raises:
        FileError: The path is no regular file, or its folder cannot be written.
    """
    try:
        target = _target(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        _replace(target, write)
    except ZygopinError:
        raise  # what the content could not be made for
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


def _replace(target: Path, write: Callable[[BinaryIO], object]) -> None:
    """Write beside the target and rename; leave nothing beside it on failure."""
    part = target.with_name(f".{os.urandom(8).hex()}.part")
    try:
        with part.open("xb") as file:
            write(file)
        part.replace(target)
    finally:
        part.unlink(missing_ok=True)
