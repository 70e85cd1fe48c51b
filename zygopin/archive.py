"""NumPy archives, written array by array and with the same bytes each time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import IO, BinaryIO
from zipfile import ZipFile, ZipInfo

import numpy as np
from numpy.typing import ArrayLike

from zygopin.files import write_stream

UNIX = 3
"""The system that archives name as their maker's: their bytes are the same on all."""

Content = ArrayLike | Callable[[IO[bytes]], None]
"""An array, or what writes one into the open file that it is given."""


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
