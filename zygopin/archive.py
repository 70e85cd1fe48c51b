"""NumPy archives, written array by array and with the same bytes each time."""

from __future__ import annotations

import struct
import tokenize
import zlib
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import IO, Any, BinaryIO
from zipfile import BadZipFile, ZipFile, ZipInfo

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin.errors import FileError
from zygopin.files import as_path, write_stream

UNIX = 3
"""The system that archives name as their maker's: their bytes are the same on all."""

DAMAGE = (
    *(ArithmeticError, AttributeError, EOFError, LookupError, MemoryError),
    *(NotImplementedError, RuntimeError, SyntaxError, TypeError, ValueError),
    *(BadZipFile, zlib.error, struct.error, tokenize.TokenError),
)
"""What NumPy and the archive's readers raise over a file that is none, or damaged."""

Content = ArrayLike | Callable[[IO[bytes]], None]
"""An array, or what writes one into the open file that it is given."""


def read_archive(
    path: Path | str, names: Iterable[str], what: str
) -> dict[str, NDArray[Any]]:
    """Read arrays of a file that `write_archive` wrote.

    Args:
        path: The file.
        names: Names of the arrays.
        what: What they are together, for messages, such as `atlas`.

    Returns:
        The arrays by name.

    Raises:
        FileError: The file cannot be read, or does not hold them.
    """
    place, remedy = as_path(path), "name a file that zygopin has written"
    try:
        with place.open("rb") as file, np.load(file, allow_pickle=False) as archive:
            return {name: np.asarray(archive[name]) for name in names}
    except OSError as error:
        problem = f"cannot be read: {error.strerror or error}"
        raise FileError(path, problem, remedy) from error
    except DAMAGE as error:
        raise FileError(path, f"is no {what}", remedy) from error


def write_archive(path: Path | str, arrays: Mapping[str, Content]) -> Path:
    """Write arrays as one file for `numpy.load`, whole or not at all.

    Args:
        path: The file; missing parent folders are created.
        arrays: The arrays by name; of one that is too large to copy, its writer.

    Returns:
        The path.

    Raises:
        FileError: The file cannot be written.
    """

    def write(file: BinaryIO) -> None:
        with ZipFile(file, "w") as archive:
            for name, content in arrays.items():
                place = ZipInfo(f"{name}.npy")  # without the time of day
                place.create_system = UNIX
                with archive.open(place, "w", force_zip64=True) as member:
                    if callable(content):
                        content(member)
                    else:
                        np.lib.format.write_array(member, np.asarray(content))

    return write_stream(path, write)
