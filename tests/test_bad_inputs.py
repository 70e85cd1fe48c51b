"""No public function, constructor or method takes what is no good."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable
from pathlib import Path

import pytest
from bad_inputs import ENTRIES, Entry, accepted, bad, good
from bad_ranges import ACCEPTED, OUT
from good_inputs import GOOD, INTERNAL, OWNERS, RECORDS

from zygopin.errors import ZygopinError

LONGEST = 500
"""Characters of a message: a line, with room for a path."""


OTHERWISE = {
    "base": "pose",
    "cells": "cell",
    "fingers": "finger",
    "joints": "joint",
    "levels": "level",
    "controls": "finger",
    "prefer": "preference",
    "until": "span of motion",
    "urdf": "URDF",
    "normal_force": "toe force",
    "pair": "finger",
    "radii": "bones.shape",
    "x": "branch.centre",
    "y": "branch.centre",
}
"""What a message may call a parameter besides its name."""

BY_VALUE = ("bounds", "folder", "mapping", "name", "output", "path", "title")
"""What messages show instead: files, names, and parameters that are in others."""


def names(message: str, parameter: str, value: object) -> bool:
    """Whether a message says which value it is about."""
    called = [parameter, OTHERWISE.get(parameter, parameter)]
    called.append(parameter.replace("_", " "))
    if any(re.search(rf"(?<!\w){re.escape(text)}(?!\w)", message) for text in called):
        return True
    if parameter not in BY_VALUE:
        return False
    shown = [type(value).__name__, repr(value)[:20], str(value)[:20], str(value)[-20:]]
    if isinstance(value, dict):
        shown += [str(each) for each in value]
    return any(text and text in message for text in shown)


def complaint(call: Callable[[], object], parameter: str, value: object) -> str:
    """What is wrong with how a bad value is refused; empty where nothing is."""
    try:
        result = call()
        if inspect.isgenerator(result):
            next(result)
    except ZygopinError as error:
        message = str(error)
        if "\n" in message or len(message) > LONGEST:
            return f"not one line: {message[:LONGEST]!r}"
        return (
            "" if names(message, parameter, value) else f"does not name it: {message}"
        )
    except Exception as error:
        return f"{type(error).__name__}: {error}"
    return f"accepted: {result!r}"[:100]


@pytest.mark.parametrize("entry", ENTRIES, ids=lambda entry: entry.name)
def test_bad_values_are_refused_in_one_line_that_names_them(
    entry: Entry, tmp_path: Path
):
    found = []
    for parameter in entry.parameters:
        for label, value in bad(entry, parameter, tmp_path):
            given = {name: good(entry, name) for name in entry.parameters}
            given[parameter] = value
            wrong = complaint(lambda given=given: entry.call(**given), parameter, value)
            if wrong:
                found.append(f"{entry.name}({parameter}={label}): {wrong}")
    assert not found, "\n".join(found)


@pytest.mark.parametrize(
    "entry", [each for each in ENTRIES if each.tolerant], ids=lambda entry: entry.name
)
def test_what_is_said_to_be_legitimate_is_taken(entry: Entry, tmp_path: Path):
    for parameter in entry.parameters:
        for _, value in accepted(entry, parameter, tmp_path):
            given = {name: good(entry, name) for name in entry.parameters}
            entry.call(**{**given, parameter: value})


def test_the_table_has_no_row_for_what_is_not_there():
    known = {entry.name for entry in ENTRIES}
    full = {f"{entry.name}.{name}" for entry in ENTRIES for name in entry.parameters}
    names = full | {name for entry in ENTRIES for name in entry.parameters}
    assert {*GOOD, *ACCEPTED, *OUT} - names == set()
    classes = {name.split(".")[0] for name in known} | RECORDS
    assert {name.split(".")[0] for name in (*OWNERS, *INTERNAL)} <= classes
