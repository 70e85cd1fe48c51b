"""Every option and argument of every command, and the texts that are no good for it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import click

from zygopin.cli import main

LONG = "9" * 10**5
WORDS = ["", " ", "nonsense", "\ud800", "a\nb", LONG]
NUMBERS = [*WORDS, "nan", "inf", "-inf", "1e400", "1j", "0x10", "1,2:", "1e308"]
WHOLE = [*NUMBERS, "2.5", "-1", "99999999999999999999", "9" * 5000]
RANGES = [*NUMBERS, "3", "3:", ":3", "5:3", "3:3", "nan:3", "3:inf", "1:2:3"]
FOLDERS = ["", "a\0b", "\ud800", LONG, "kept/out", "kept", "/dev/null/out"]
FILES = [*FOLDERS[:-3], "kept/out", "folder", "/dev/full", "/dev/null/out"]
READ = [*FILES, "missing", "binary", "malformed", "list", "empty", "deep", "bomb"]

TEXTS = {
    "degrees": NUMBERS[:-1],
    "degrees, …": [*NUMBERS[:-1], "10,x", ","],
    "millimetres": NUMBERS,
    "millimetres, …": [*NUMBERS, "1,x", ","],
    "metres per second": NUMBERS,
    "milliseconds": NUMBERS,
    "float": NUMBERS,
    "float range": [*NUMBERS, "1.5", "-0.5"],
    "integer range": WHOLE,
    "choice": WORDS,
    "count": WHOLE,
    "low:high": RANGES,
    "name=low:high": [*RANGES, "rho", "rho=", "rho=3", "rho=5:3", "x=1:2", "rho=nan:2"],
    "grid": [
        *NUMBERS[:-1],
        "1:2",
        "1:2:1.5",
        "1:2:99999999999",
        "1,1",
        "1:nan:3",
    ],
    "counts": [*WORDS, "2-3", "2-3-4-5,2-3-4-5", "0-3-4-5", "2-3-4-99", "1.5"],
    "--preset": WORDS,
    "--finger": [*WORDS, "0", "9"],
    "--pair": [*WORDS, "1", "1,1", "1,2,3", "1,9", "finger1,x", "9" * 5000 + ",1"],
    "--levels": [*WORDS, "1", "0.5,2", "nan,1", "0,x", "9" * 5000, "1e400"],
    "--vary": [*WORDS, "rho,x", ","],
    "--scheduler": WORDS,
    "--controls": [*NUMBERS, "0,1", "[", "{}", '{"a": [1]}', *READ],
    "name": WORDS[1:],
    "FOLDER": FOLDERS,
    "FILE": FILES,
    "PATH": READ,
}
"""By an option's name, or by its type's: what is no good for it."""

BASES = {
    "atlas": ["--cells", "2"],
    "branches": ["--pair", "1,3"],
    "check": [
        "--radius-mm",
        "8",
        "--height-mm",
        "-20",
        "--controls",
        ",".join("0" * 14),
    ],
    "design": ["--radii-mm", "3:20"],
    "paper": ["-o", "out"],
    "perch": ["--radius-mm", "8", "--height-mm", "-20"],
    "presets": [],
    "reach": ["--finger", "1"],
    "strike": ["--prey-radius-mm", "15"],
    "sweep": ["--radius-mm", "8"],
    "touch": ["--height-mm", "-30"],
    "urdf": ["-o", "out"],
    "validate": [],
}
"""What each command is given besides."""

ACCEPTED = {"branches --limit": ("99999999999999999999",)}  # the most to list


@dataclass(frozen=True)
class Row:
    """An option or argument of a command.

    Attributes:
        command: The command.
        name: The option, such as `--rho`; the argument's name.
        texts: What is no good for it.
    """

    command: str
    name: str
    texts: tuple[str, ...]

    def arguments(self, text: str) -> list[str]:
        """The command line with one of the texts."""
        given = [*BASES[self.command]]
        if self.name in given:
            place = given.index(self.name)
            del given[place : place + 2]
        own = [f"{self.name}={text}"] if self.name.startswith("--") else [text]
        return [self.command, *given, *own]


def rows() -> Iterator[Row]:
    """All options and arguments of all commands, by click's own tree; no flags."""
    for command, found in main.commands.items():
        if command not in BASES:
            raise LookupError(f"tests/bad_commands.py: add {command} to BASES")
        for parameter in found.params:
            if not getattr(parameter, "is_flag", False):
                yield _row(command, parameter)


def _row(command: str, parameter: click.Parameter) -> Row:
    """One of them, with what its name or type says is no good."""
    name = parameter.opts[-1]
    own = name if isinstance(parameter, click.Option) else parameter.name
    place = getattr(parameter.type, "kind", parameter.type.name)
    for key in (own, place):
        if key in TEXTS:
            fine = ACCEPTED.get(f"{command} {name}", ACCEPTED.get(name, ()))
            return Row(command, name, tuple(t for t in TEXTS[key] if t not in fine))
    raise LookupError(f"tests/bad_commands.py: add {place!r} of {name} to TEXTS")


def furnish(folder: Path) -> None:
    """Make the files that some of the texts name."""
    (folder / "kept").write_text("kept")
    (folder / "folder").mkdir()
    (folder / "binary").write_bytes(bytes(range(256)))
    (folder / "malformed").write_text("rho: [")
    (folder / "list").write_text("- 1")
    (folder / "empty").write_text("")
    (folder / "deep").write_text("[" * 400)
    bomb = [
        "a0: &a0 [0]",
        *(f"a{k}: &a{k} [{', '.join([f'*a{k - 1}'] * 9)}]" for k in range(1, 9)),
    ]
    (folder / "bomb").write_text("\n".join(bomb))
