"""Every public entry, and the bad values that may stand for each of its parameters.

What is public is found by inspection; what is given for a parameter follows from its
annotation, in `KINDS`. What is new here and has no row fails, and says what to add.
"""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from bad_ranges import ACCEPTED, OUT
from bad_values import (
    CALLABLES,
    FLAGS,
    INDICES,
    LISTS,
    MAPPINGS,
    NAMES,
    NOTHING,
    NUMBERS,
    OBJECTS,
    PAIRS,
    SHAPES,
    Bad,
    Kind,
    arrays,
    files_to_read,
    files_to_write,
    listed,
    paths,
    without,
)
from good_inputs import GOOD, INTERNAL, OWNERS, RECORDS

import zygopin

ARRAYS = ("ArrayLike", "Floats", "NDArray[np.float64]", "Controls", "Law | Controls")
NAMED = (
    *("Reading", "Preference", "Section", "Phalanges", "Sensing"),
    *("EngineName", "BatchName", "FasterName | Engine"),
)

LEVELS = listed(
    without(NUMBERS, "list", "array of one"),
    [
        ("outside", [0.0, 1.5]),
        ("nan inside", [0.0, math.nan]),
        ("table", [[0.0]]),
        ("ragged", [[0.0], [0.0, 1.0]]),
    ],
)
CLOSINGS = listed(
    without(NAMES, "list"),
    [
        ("nan inside", [0.0, math.nan]),
        ("one", [0.5]),
        ("table", [[0.0, 1.0]]),
    ],
)
KINDS: dict[str, Kind] = {
    "float": listed(NUMBERS),
    "int": listed(NUMBERS, [("2.5", 2.5)]),
    "complex": listed(without(NUMBERS, "complex", "numpy.complex")),
    "bool": listed(FLAGS),
    "str": listed(NAMES),
    **dict.fromkeys(NAMED, listed(NAMES)),
    "Shape": CLOSINGS,
    "str | int": listed(NAMES, without(NUMBERS, "text")),
    **dict.fromkeys(ARRAYS, arrays),
    **dict.fromkeys(("Levels", "NDArray[np.float64] | Levels"), LEVELS),
    "int | ArrayLike": listed(without(NUMBERS, "list", "array of one")),
    "Law | float": listed(without(NUMBERS, "list")),
    "tuple[int, ...]": listed(SHAPES),
    **dict.fromkeys(("NDArray[np.intp]", "NDArray[np.intp] | slice"), listed(INDICES)),
    **dict.fromkeys(("tuple", "slice", "Iterable", "Sequence"), listed(LISTS)),
    "Pair": listed(PAIRS),
    **dict.fromkeys(("Callable", "Progress"), listed(CALLABLES)),
    "Mapping": listed(MAPPINGS),
    "design_foot.bounds": listed(without(MAPPINGS, "None inside")),  # its default
    **dict.fromkeys(("Obstacle", "np.random.Generator"), listed(OBJECTS)),
    "Path | str": files_to_write,
    "write_description.folder": paths,
    "write_paper_report.folder": paths,
    "Foot.load.path": files_to_read,
    "load_atlas.path": files_to_read,
}


@dataclass(frozen=True)
class Entry:
    """A public function, constructor or method.

    Attributes:
        name: Such as `check_grasp` or `Branch.frame`.
        call: What is called.
        parameters: Its parameters without `self`.
    """

    name: str
    call: Callable[..., Any]
    parameters: dict[str, inspect.Parameter]

    @property
    def tolerant(self) -> bool:
        """Whether some of the values that are bad elsewhere are fine here."""
        return any(f"{self.name}.{name}" in ACCEPTED for name in self.parameters)


def _entries() -> Iterator[Entry]:
    """All public entries, by inspection of `zygopin.__all__`."""
    for name in zygopin.__all__:
        value = getattr(zygopin, name)
        if inspect.isclass(value):
            yield from _of_class(name, value)
        elif inspect.isfunction(value):
            yield _entry(name, value)


def _of_class(name: str, kind: type) -> Iterator[Entry]:
    """A class's constructor and its public methods."""
    if issubclass(kind, BaseException) or hasattr(kind, "__members__"):
        return  # errors take any value; the members of an enumeration are looked up
    if name not in RECORDS:
        yield _entry(name, kind)
    for method, value in vars(kind).items():
        full = f"{name}.{method}"
        # Names beyond ASCII: scripts/mutants keeps its variants beside the methods.
        if method.startswith("_") or not method.isascii() or full in INTERNAL:
            continue
        if isinstance(value, classmethod):
            yield _entry(full, getattr(kind, method))
        elif inspect.isfunction(value):
            yield _entry(full, _bound(name, method, value))


def _bound(owner: str, method: str, function: Callable[..., Any]) -> Callable[..., Any]:
    """A method of an example that is made when it is called, with its signature."""

    def call(**given: object) -> object:
        made = OWNERS.get(f"{owner}.{method}") or OWNERS[owner]
        return getattr(made(), method)(**given)

    signature = inspect.signature(function)
    _, *others = signature.parameters.values()
    call.__signature__ = signature.replace(parameters=others)  # type: ignore[attr-defined]
    return call


def _entry(name: str, call: Callable[..., Any]) -> Entry:
    """An entry by its name, what takes any number of arguments left out."""
    parameters = inspect.signature(call).parameters.values()
    named = {each.name: each for each in parameters if each.kind != each.VAR_KEYWORD}
    return Entry(name, call, named)


ENTRIES = list(_entries())


def good(entry: Entry, parameter: str) -> object:
    """A good value for a parameter."""
    full = f"{entry.name}.{parameter}"
    made = GOOD.get(full, GOOD.get(parameter))
    default = entry.parameters[parameter].default
    if made is None and default is inspect.Parameter.empty:
        raise LookupError(f"tests/good_inputs.py: add a value for {full} to GOOD")
    return default if made is None else made()


def bad(entry: Entry, parameter: str, folder: Path) -> Iterator[Bad]:
    """The values that are no good for a parameter; files are made in a folder."""
    fine = _for(ACCEPTED, entry, parameter)
    return (each for each in _values(entry, parameter, folder) if each[0] not in fine)


def accepted(entry: Entry, parameter: str, folder: Path) -> Iterator[Bad]:
    """The values that are no good elsewhere, and fine for a parameter."""
    fine = ACCEPTED.get(f"{entry.name}.{parameter}", ())
    return (each for each in _values(entry, parameter, folder) if each[0] in fine)


def _values(entry: Entry, parameter: str, folder: Path) -> Iterator[Bad]:
    """What is no good for a parameter's annotation, and what is out of its range."""
    annotation = str(entry.parameters[parameter].annotation)
    plain = annotation.removesuffix(" | None")
    yield from _for(OUT, entry, parameter)
    if plain == annotation:
        yield from NOTHING
    yield from _kind(entry, parameter, plain)(good(entry, parameter), folder)


def _for(table: dict[str, Any], entry: Entry, parameter: str) -> Any:
    """A row of a table, for this entry's parameter or for all of its name."""
    return table.get(f"{entry.name}.{parameter}", table.get(parameter, ()))


def _kind(entry: Entry, parameter: str, annotation: str) -> Kind:
    """What is no good for an annotation."""
    full = f"{entry.name}.{parameter}"
    for key in (full, annotation, annotation.split("[")[0]):
        if key in KINDS:
            return KINDS[key]
    if inspect.isclass(getattr(zygopin, annotation, None)):
        return listed(OBJECTS)
    raise LookupError(f"tests/bad_inputs.py: add {annotation!r} of {full} to KINDS")
