"""Finished chunks of a sweep, kept on disk until all are done."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from zygopin.archive import read_archive, write_archive
from zygopin.errors import FileError
from zygopin.sweep_cell import RESULTS, Arrays, Chunk

_PART = re.compile(r"[0-9a-f]{64}\.npz|\.[0-9a-f]{16}\.part")


@dataclass(frozen=True)
class Parts:
    """A folder with a file for each finished chunk, named after the chunk's digest.

    The digest covers all that determines the results, so that a changed question
    finds no old answer, and a larger grid finds the chunks it shares with a smaller.

    Attributes:
        folder: The folder; made with the first part.
    """

    folder: Path

    @classmethod
    def beside(cls, output: Path | str) -> Parts:
        """The parts of an output, in the folder of its name with `.parts` added."""
        path = Path(output)
        return cls(path.with_name(f"{path.name}.parts"))

    def read(self, chunk: Chunk) -> Arrays | None:
        """A finished chunk's arrays; None where there is no sound file of them.

        Args:
            chunk: The chunk.

        Returns:
            Arrays by the names of `RESULTS`, or None.
        """
        try:
            arrays = read_archive(self._path(chunk), RESULTS, "chunk")
        except FileError:
            return None
        sound = all(
            arrays[name].shape == shape and arrays[name].dtype == RESULTS[name].dtype
            for name, shape in chunk.shapes.items()
        )
        return arrays if sound else None

    def write(self, chunk: Chunk, arrays: Arrays) -> None:
        """Keep a finished chunk: whole or not at all.

        Args:
            chunk: The chunk.
            arrays: Its arrays.

        Raises:
            FileError: The file cannot be written.
        """
        write_archive(self._path(chunk), arrays)

    def remove(self) -> None:
        """Remove the parts, of earlier questions too; files of others stay.

        Raises:
            FileError: A part cannot be removed.
        """
        if not self.folder.is_dir():
            return
        try:
            for path in self.folder.iterdir():
                if _PART.fullmatch(path.name):
                    path.unlink()
            if not any(self.folder.iterdir()):
                self.folder.rmdir()
        except OSError as error:
            remedy = "remove the folder yourself"
            problem = f"cannot be removed: {error.strerror}"
            raise FileError(self.folder, problem, remedy) from error

    def _path(self, chunk: Chunk) -> Path:
        """The file of a chunk."""
        return self.folder / f"{chunk.digest}.npz"
