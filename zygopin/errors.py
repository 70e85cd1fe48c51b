"""The errors of zygopin: one root, subclasses that keep the offending values."""

from __future__ import annotations

from collections.abc import Iterable
from difflib import get_close_matches
from pathlib import Path
from reprlib import Repr
from typing import Any

LINE, PATH = 60, 300
"""Characters of a value and of a path that a message shows: what is longer is cut."""


class ZygopinError(Exception):
    """Root of every error that zygopin raises on purpose.

    Attributes:
        exit_code: Exit status of the command line when this error ends it.
    """

    exit_code = 2

    def __reduce__(self) -> tuple[Any, ...]:
        # The constructors compose a message; a copy, as from a worker process, has it.
        return _restored, (type(self), self.args, self.__dict__)


def _restored(
    kind: type[ZygopinError], args: tuple[Any, ...], values: dict[str, Any]
) -> ZygopinError:
    """An error as it was when it was pickled."""
    error = kind.__new__(kind)
    error.args = args
    error.__dict__.update(values)
    return error


class ParameterError(ZygopinError, ValueError):
    """A value lies outside what is allowed.

    Attributes:
        name: Name of the parameter, with its index where it is in an array.
        value: The value that was given.
        allowed: What is allowed, in words.
        remedy: What to do about it, in words.
    """

    def __init__(self, name: str, value: object, allowed: str, remedy: str) -> None:
        super().__init__(f"{name} = {_shown(value)} is not {allowed}: {remedy}")
        self.name = name
        self.value = value
        self.allowed = allowed
        self.remedy = remedy


class UnknownNameError(ZygopinError, LookupError):
    """A name (of a preset, a finger, a field) that does not exist.

    Attributes:
        kind: What the name should name.
        name: The name that was given.
        known: The names that exist, in order.
    """

    def __init__(self, kind: str, name: object, known: Iterable[str]) -> None:
        self.kind = kind
        self.name = name
        self.known = tuple(known)
        close = get_close_matches(_text(name), self.known, n=1)
        hint = f"did you mean {close[0]!r}? " if close else ""
        listed = ", ".join(self.known)
        super().__init__(f"unknown {kind} {_shown(name)}: {hint}choose one of {listed}")


class FileError(ZygopinError, OSError):
    """A file that cannot be read, understood or written.

    Attributes:
        path: The file.
        problem: What is wrong with it.
        remedy: What to do about it.
    """

    def __init__(self, path: Path | str, problem: str, remedy: str) -> None:
        super().__init__(f"{_shown_path(path)}: {_one_line(problem)}: {remedy}")
        self.path = Path(path)
        self.problem = problem
        self.remedy = remedy


class DescriptionError(ZygopinError):
    """A robot description that does not expand, parse, or fit the foot.

    Attributes:
        problem: What is wrong with the description.
        remedy: What to do about it.
    """

    def __init__(self, problem: str, remedy: str) -> None:
        super().__init__(f"{_one_line(problem)}: {remedy}")
        self.problem = problem
        self.remedy = remedy


class MissingExtraError(ZygopinError, ImportError):
    """A package that only some functions need is not installed.

    Attributes:
        package: The package.
        extra: The extra of zygopin that installs it.
    """

    def __init__(self, package: str, extra: str) -> None:
        super().__init__(
            f"{package} is not installed: pip install 'zygopin[{extra}]' adds it"
        )
        self.package = package
        self.extra = extra


class WorkerError(ZygopinError, RuntimeError):
    """Processes or machines that were to share some work, and did not.

    Attributes:
        problem: What went wrong.
        remedy: What to do about it.
    """

    def __init__(self, problem: str, remedy: str) -> None:
        super().__init__(f"{_one_line(problem)}: {remedy}")
        self.problem = problem
        self.remedy = remedy


def _one_line(text: str) -> str:
    """Text with its white space folded, so that a message stays on one line."""
    return " ".join(text.split())


def _shown(value: object) -> str:
    """A value as a message shows it: one line, not longer than a line."""
    text = _one_line(repr(value) if isinstance(value, str) else _text(value))
    return text if len(text) <= LINE else f"{text[: LINE - 3]}..."


def _text(value: object) -> str:
    """A value as text, of which containers and integers may be left out in part."""
    if isinstance(value, (list, tuple, dict, set, frozenset, int)):
        return _Brief().repr(value)
    return str(value)


class _Brief(Repr):
    """Values as text that stays short however much they hold.

    One list may hold another many times over, and that again another: written in full,
    a few lines of YAML would fill the memory.
    """

    def __init__(self) -> None:
        super().__init__()
        self.maxlevel = 3
        self.maxlist = self.maxtuple = self.maxdict = LINE // 3
        self.maxset = self.maxfrozenset = LINE // 3
        self.maxstring = self.maxother = 4 * LINE

    def repr_int(self, x: int, level: int) -> str:  # noqa: ARG002
        """An integer; Python does not write those of more than 4300 digits."""
        size = x.bit_length()
        return repr(x) if size <= 4 * LINE else f"an integer of {size} bits"


def _shown_path(path: Path | str) -> str:
    """A path as a message shows it: whole, but for one that no system would take."""
    plain = str(path)
    text = plain if plain.isprintable() and plain else repr(plain)
    return text if len(text) <= PATH else f"...{text[3 - PATH :]}"
