"""Reading files, and writing them whole or not at all."""

from __future__ import annotations

import errno
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import BinaryIO

from zygopin.errors import FileError, ParameterError, ZygopinError

LARGEST = 2**26
"""Bytes that a text file may have: a device, or a wrong file, may have no end."""


def as_path(path: Path | str) -> Path:
    """A path that names something: an empty text would be the current folder.

    Args:
        path: What was given.

    Returns:
        The path.

    Raises:
        ParameterError: It is neither a text nor a path.
        FileError: It is empty.
    """
    if not isinstance(path, (str, os.PathLike)):
        remedy = "give a text or a pathlib.Path"
        raise ParameterError("path", path, "a path", remedy)
    if not str(path):
        raise FileError(path, "names nothing", "give a name, such as out")
    return Path(path)


def read_text(path: Path | str) -> str:
    """Read a text file.

    Args:
        path: The file, in UTF-8.

    Returns:
        What it holds.

    Raises:
        FileError: It cannot be read, is not UTF-8, or is longer than `LARGEST`.
    """
    place = as_path(path)
    try:
        with place.open("rb") as file:
            content = file.read(LARGEST + 1)
    except (OSError, ValueError) as error:
        problem = getattr(error, "strerror", None) or str(error)
        remedy = "name a text file that can be read"
        raise FileError(path, f"cannot be read: {problem}", remedy) from error
    if len(content) > LARGEST:
        remedy = "name a smaller file"
        raise FileError(path, f"has more than {LARGEST} bytes", remedy)
    try:
        return content.decode("utf-8")
    except UnicodeDecodeError as error:
        remedy, problem = "name a text file", "cannot be read: not a UTF-8 text file"
        raise FileError(path, problem, remedy) from error


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
    with _named(path, "name a file in a folder that can be written"):
        target = _target(path)
        target.parent.mkdir(parents=True, exist_ok=True)
        _replace(target, write)
    return Path(path)


def check_file(path: Path | str) -> Path:
    """Raise where a file cannot be written: before the work whose result it gets.

    Args:
        path: The file.

    Returns:
        The path.

    Raises:
        FileError: It is a folder or a device, or there can be no such file.
    """
    with _named(path, "name a file in a folder that can be written"):
        _check_folder(_target(path).parent)
    return Path(path)


def check_folder(path: Path | str) -> Path:
    """Raise where files cannot be written to a folder: before they are made.

    Args:
        path: The folder, which need not be there yet.

    Returns:
        The path.

    Raises:
        FileError: It is something else, or there can be no such folder.
    """
    with _named(path, "name a folder that can be written"):
        _check_folder(Path(os.path.realpath(as_path(path))))
    return Path(path)


@contextmanager
def _named(path: Path | str, remedy: str) -> Iterator[None]:
    """See that what the system refuses is said of the path that was given."""
    try:
        yield
    except ZygopinError:
        raise  # what the content could not be made for
    except (OSError, ValueError) as error:
        problem = getattr(error, "strerror", None) or str(error)
        raise FileError(path, f"cannot be written: {problem}", remedy) from error


def _check_folder(folder: Path) -> None:
    """The nearest folder that is there can be written to."""
    there = next(each for each in (folder, *folder.parents) if each.exists())
    if not there.is_dir():
        raise NotADirectoryError(errno.ENOTDIR, os.strerror(errno.ENOTDIR))
    if not os.access(there, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))


def _target(path: Path | str) -> Path:
    """Where a path leads; a folder or a device is never replaced by a file."""
    target = Path(os.path.realpath(as_path(path)))
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
