"""What a public entry gave, as plain values that two runs can be compared by."""

from __future__ import annotations

import dataclasses
import enum
import hashlib
import inspect
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from bad_inputs import ENTRIES, Entry, good

ELSEWHERE = {"paper_report", "write_paper_report", "design_foot", "sweep"}
"""The paper's report takes twenty seconds, and is held to its bytes by its own tests;
designs and sweeps have processes of their own, and tests of those."""

READ = {"Foot.load", "load_atlas"}
"""What reads the file that it is told; others write one, each call its own."""

QUICK = [entry for entry in ENTRIES if entry.name not in ELSEWHERE]


def result(entry: Entry) -> object:
    """What an entry gives for the good arguments of the table, as plain values."""
    given = {name: good(entry, name) for name in entry.parameters}
    with tempfile.TemporaryDirectory() as folder:
        for name in {"path", "folder"} & given.keys() if entry.name not in READ else ():
            given[name] = Path(folder) / Path(given[name]).name
        return plain(entry.call(**given))


def digest(value: object) -> str:
    """A short text that differs where plain values do."""
    return hashlib.sha256(repr(value).encode()).hexdigest()


def plain(value: object) -> object:
    """A value without addresses: numbers as they are stored, files as they are read."""
    if isinstance(value, (np.ndarray, np.generic)):
        return value.shape, str(value.dtype), value.tobytes()
    if isinstance(value, Path):
        return value.read_bytes() if value.is_file() else value.name
    if isinstance(value, (str, bytes, int, float, complex, enum.Enum)) or value is None:
        return repr(value)
    if dataclasses.is_dataclass(value):
        fields = {f.name: getattr(value, f.name) for f in dataclasses.fields(value)}
        return type(value).__name__, plain(fields)
    if isinstance(value, Mapping):
        return {str(key): plain(each) for key, each in value.items()}
    if inspect.isgenerator(value) or isinstance(value, (list, tuple)):
        return [plain(each) for each in value]
    return type(value).__name__  # functions, models, data sets
