"""Values that are no good, by what they are given for: each with a label."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator
from pathlib import Path

import numpy as np

Bad = tuple[str, object]
Kind = Callable[[object, Path], Iterator[Bad]]
"""The bad values that stand beside a good one; files are made in the folder."""


class Refuses:
    """Numbers on another device, which NumPy may not have."""

    def __array__(self, *_: object, **__: object) -> np.ndarray:
        raise RuntimeError("copy it to the host first")


MANY = 10**6
LONG = "x" * 10**5

NOTHING = [("None", None)]
OBJECTS = [
    ("text", "foot"),
    ("number", 3),
    ("list", [1.0]),
    ("mapping", {"rho": 2}),
    ("class", object),
]
NUMBERS = [
    ("text", "1"),
    ("bytes", b"1"),
    ("True", True),
    ("numpy.True_", np.True_),
    ("nan", math.nan),
    ("inf", math.inf),
    ("-inf", -math.inf),
    ("numpy.nan", np.float32("nan")),
    ("1e308", 1e308),
    ("-1e308", -1e308),
    ("10**400", 10**400),
    ("10**5000", 10**5000),
    ("complex", 1j),
    ("numpy.complex", np.complex128(1 + 1j)),
    ("date", np.datetime64("2020-01-01")),
    ("span", np.timedelta64(1, "s")),
    ("list", [1.0]),
    ("array of one", np.array([1.0])),
    ("array", np.array([1.0, 2.0])),
    ("empty", []),
    ("mapping", {}),
    ("object", object()),
    ("a million", np.zeros(MANY)),
]
NAMES = [
    ("number", 1.5),
    ("bytes", b"exact"),
    ("empty", ""),
    ("unknown", "nonsense"),
    ("capitals", "EXACT"),
    ("two lines", "a\nb"),
    ("surrogate", "\ud800"),
    ("long", LONG),
    ("list", ["exact"]),
    ("mapping", {}),
]
FLAGS = [("text", "no"), ("number", 2), ("array", np.array([True, False]))]
SHAPES = [
    ("number", 3),
    ("text", "3"),
    ("fraction", (2.5,)),
    ("negative", (-1,)),
    ("huge", (10**400,)),
    ("nan", (math.nan,)),
]
INDICES = [
    ("nan", [math.nan]),
    ("fraction", [0.5]),
    ("text", "a"),
    ("texts", ["a"]),
    ("huge", [10**400]),
    ("beyond", [10**9]),
    ("far below", [-(10**9)]),
    ("mapping", {}),
    ("objects", [None]),
]
LISTS = [
    ("number", 3),
    ("text", "foot"),
    ("numbers", [1.0]),
    ("nothing in it", [None]),
    ("unknown", ["nonsense"]),
    ("mapping", {1: 2}),
]
PAIRS = [
    ("number", 3),
    ("text", "foot"),
    ("one", (1,)),
    ("three", (1, 2, 1)),
    ("same", (1, 1)),
    ("beyond", (1, 9)),
    ("unknown", ("ahead", "x")),
    ("None inside", (1, None)),
    ("nan", (1, math.nan)),
    ("lists", ([1], [2])),
]
CALLABLES = [("number", 3), ("text", "sin")]
MAPPINGS = [
    ("number", 3),
    ("text", "rho"),
    ("list", [1]),
    ("unknown", {"nonsense": 1}),
    ("no text", {3: 1}),
    ("None inside", {"rho": None}),
    ("nan inside", {"rho": math.nan}),
    ("texts", {"rho": "x"}),
]


def without(values: list[Bad], *labels: str) -> list[Bad]:
    """Bad values but for some."""
    return [bad for bad in values if bad[0] not in labels]


def listed(*groups: list[Bad]) -> Kind:
    """The kind that has the same bad values beside every good one."""
    return lambda _good, _folder: iter([bad for group in groups for bad in group])


def arrays(good: object, _folder: Path) -> Iterator[Bad]:
    """What is no array of finite numbers of the shape of a good one."""
    yield from arrays_of_any_shape(good, _folder)
    values = np.array(good, dtype=complex).real
    if not values.ndim:
        return
    for label, shape in (
        ("last axis longer", (*values.shape[:-1], values.shape[-1] + 1)),
        ("last axis empty", (*values.shape[:-1], 0)),
        ("a number", ()),
    ):
        yield label, np.full(shape, values.flat[0])


def arrays_of_any_shape(good: object, _folder: Path) -> Iterator[Bad]:
    """What is no array of finite numbers, whatever shape is asked for."""
    values = np.array(good, dtype=complex).real
    for label, entry in (("nan", math.nan), ("inf", math.inf), ("-inf", -math.inf)):
        spoilt = np.atleast_1d(values).copy()
        spoilt.flat[-1] = entry
        yield label, spoilt.reshape(values.shape)
    yield "complex", values + 1j
    yield "truth values", np.ones(values.shape, bool)
    yield "texts", np.full(values.shape, "1")
    yield "objects", np.full(values.shape, None)
    yield "dates", np.full(values.shape, np.datetime64("2020-01-01"))
    yield "ragged", [[1.0], [1.0, 2.0]]
    yield "10**400", [10**400]
    yield "text", "abc"
    yield "mapping", {"x": 1.0}
    yield "object", object()
    yield "tensor", Refuses()


def paths(_good: object, folder: Path) -> Iterator[Bad]:
    """What cannot be written to, as a file or as a folder with files."""
    file = folder / "file"
    file.write_text("kept")
    yield "number", 3
    yield "list", ["a"]
    yield "empty", ""
    yield "zero byte", "a\0b"
    yield "surrogate", str(folder / "\ud800")
    yield "long", str(folder / LONG)
    yield "deep", str(folder / "/".join(["x"] * 3000))
    yield "file as parent", file / "out"
    yield "device as parent", Path(os.devnull) / "out"


def files_to_write(good: object, folder: Path) -> Iterator[Bad]:
    """What cannot be written to, as a file."""
    yield from paths(good, folder)
    yield "folder", folder
    yield "device", "/dev/full"


def files_to_read(good: object, folder: Path) -> Iterator[Bad]:
    """What cannot be read as text or as an archive."""
    yield from paths(good, folder)
    yield "folder", folder
    yield "missing", folder / "missing"
    for label, content in (
        ("binary", bytes(range(256)) * 4),
        ("empty file", b""),
        ("zeros", bytes(4096)),
        ("text file", b"neither"),
        ("cut archive", b"PK\x03\x04" + bytes(40)),
        ("empty archive", b"PK\x05\x06" + bytes(18)),
        ("array file", b"\x93NUMPY\x01\x00v\x00{}"),
        ("pickle", b"\x80\x04K\x01."),
    ):
        place = folder / label.replace(" ", "_")
        place.write_bytes(content)
        yield label, place
