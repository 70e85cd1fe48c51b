"""Finished chunks of a sweep, kept on disk until all are done."""

from __future__ import annotations

import os
import re
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from fcntl import LOCK_EX, LOCK_NB, LOCK_SH, flock
from pathlib import Path

from zygopin.archive import read_archive, write_archive
from zygopin.errors import FileError
from zygopin.files import within
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
        write_archive(within(self.folder, self._path(chunk).name), arrays)

    @contextmanager
    def shared(self) -> Iterator[None]:
        """Use the folder, maybe with other runs; who ends last removes the parts.

        Where the work in between fails, they stay. Parts of earlier questions go with
        them; files of others stay.

        Raises:
            FileError: The folder cannot be made, or a part cannot be removed.
        """
        with _told(self.folder, "written", "name an output in another folder"):
            handle = self._opened()
        try:
            yield
            with _told(self.folder, "removed", "remove the folder yourself"):
                self._remove(handle)
        finally:
            os.close(handle)
            with suppress(OSError):  # not empty: parts, or files of others
                self.folder.rmdir()

    def _opened(self) -> int:
        """The folder, locked against the removal of parts."""
        while True:
            self.folder.mkdir(parents=True, exist_ok=True)
            with suppress(FileNotFoundError):  # another run has just removed it
                handle = os.open(self.folder, os.O_RDONLY | os.O_DIRECTORY)
                _locked(handle, LOCK_SH)
                return handle

    def _remove(self, handle: int) -> None:
        """Remove the parts, unless another run has its own among them."""
        if not _locked(handle, LOCK_EX | LOCK_NB):
            return
        for path in self.folder.iterdir():
            if _PART.fullmatch(path.name):
                path.unlink()

    def _path(self, chunk: Chunk) -> Path:
        """The file of a chunk."""
        return self.folder / f"{chunk.digest}.npz"


@contextmanager
def _told(folder: Path, done: str, remedy: str) -> Iterator[None]:
    """What the system says about a folder is told as ours."""
    try:
        yield
    except OSError as error:
        problem = f"cannot be {done}: {error.strerror}"
        raise FileError(folder, problem, remedy) from error


def _locked(handle: int, how: int) -> bool:
    """Whether a lock is ours; where there are no locks, nobody shares."""
    try:
        flock(handle, how)
    except BlockingIOError:
        return False
    except OSError:
        return True
    return True
