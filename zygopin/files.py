"""Reading files, and writing them whole or not at all."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import BinaryIO

from zygopin.errors import FileError, ZygopinError

MOST = 2**24
"""Characters that are read of a text: a device that never ends is not waited for."""


def read_text(path: Path | str) -> str:
    """Read a text file.

    Args:
        path: The file, in UTF-8.

    Returns:
        What it holds.

    Raises:
        FileError: It cannot be read, is not UTF-8, or is longer than `MOST`.
    """
    try:
        with Path(path).open(encoding="utf-8") as file:
            text = file.read(MOST + 1)
    except UnicodeDecodeError as error:
        remedy = "name a text file"
        raise FileError(
            path, "cannot be read: not a UTF-8 text file", remedy
        ) from error
    except (OSError, ValueError) as error:
        problem = getattr(error, "strerror", None) or str(error)
        remedy = "name a text file that can be read"
        raise FileError(path, f"cannot be read: {problem}", remedy) from error
    if len(text) > MOST:
        problem = f"cannot be read: longer than {MOST} characters"
        raise FileError(path, problem, "name a shorter file")
    return text


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


def within(folder: Path | str, *names: str) -> Path:
    """Where a file of a folder is written to: in that folder.

    The folder may be a link; what is in it may be none that leads out of it, for its
    files are written over without a question.

    Args:
        folder: The folder, which need not exist.
        *names: What leads from there to the file.

    Returns:
        The path.

    Raises:
        FileError: It is not in the folder.
    """
    path = Path(folder, *names)
    try:
        real = Path(os.path.realpath(path))
        inside = real.is_relative_to(os.path.realpath(folder))
    except ValueError as error:
        raise FileError(path, f"cannot be written: {error}", "rename it") from error
    if not inside:
        problem = f"cannot be written: it leads to {real}, out of its folder"
        raise FileError(path, problem, "remove the link, or name another folder")
    return path


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
