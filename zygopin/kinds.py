"""Checks of what a value is: of a class, a name that exists, a text, a shape."""

from __future__ import annotations

import re
from collections.abc import Collection
from typing import TypeVar

from zygopin.errors import ParameterError, UnknownNameError

Kind = TypeVar("Kind")

_NAME = re.compile(r"[a-z][a-z0-9_]*")

LONGEST = 2**40
"""Entries along an axis that an array may have: more than any memory holds."""


def instance(name: str, value: object, kind: type) -> None:
    """Raise unless a value is of a class.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.
        kind: The class.

    Raises:
        ParameterError: Names the class that it is of.
    """
    if not isinstance(value, kind):
        given, wanted = type(value).__name__, kind.__name__
        home = kind.__module__.split(".")[0]
        place = "" if home == "builtins" else f"{home}."
        raise ParameterError(name, given, f"a {wanted}", f"give a {place}{wanted}")


def optional(name: str, value: Kind | None, kind: type[Kind]) -> Kind:
    """A value of a class; the class's defaults where none is given.

    Args:
        name: Name of the parameter, for the message.
        value: What was given, or None.
        kind: The class, whose fields all have defaults.

    Returns:
        The value.

    Raises:
        ParameterError: Names the class that it is of.
    """
    if value is None:
        return kind()
    instance(name, value, kind)
    return value


def one_of(kind: str, value: object, known: Collection[str]) -> str:
    """A name that exists.

    Args:
        kind: What it names, for the message.
        value: What was given.
        known: The names that exist.

    Returns:
        The name.

    Raises:
        UnknownNameError: It is none of them.
    """
    if isinstance(value, str) and value in known:
        return value
    raise UnknownNameError(kind, value, known)


def text(name: str, value: object) -> str:
    """A text.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.

    Returns:
        The text.

    Raises:
        ParameterError: It is none.
    """
    if not isinstance(value, str):
        raise ParameterError(name, value, "a text", "give a str")
    return value


def callable_given(name: str, value: object) -> None:
    """Raise unless a value can be called.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.

    Raises:
        ParameterError: It cannot be called.
    """
    if not callable(value):
        raise ParameterError(name, value, "a function", "give what can be called")


def shape(name: str, value: object) -> None:
    """Raise unless a value is a shape: a tuple of lengths of axes.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.

    Raises:
        ParameterError: It is none.
    """
    whole = isinstance(value, tuple) and all(isinstance(n, int) for n in value)
    if not whole or not all(0 <= n <= LONGEST for n in value):  # type: ignore[attr-defined]
        allowed = f"a tuple of integers from 0 to {LONGEST}"
        raise ParameterError(name, value, allowed, "give such as (3, 4)")


def identifier(name: str, value: object) -> str:
    """A name that is safe in XML, in file names and as a key.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.

    Returns:
        The value.

    Raises:
        ParameterError: Not a lower-case identifier.
    """
    if isinstance(value, str) and len(value) <= 40 and _NAME.fullmatch(value):
        return value
    allowed = "a lower-case identifier of at most 40 characters"
    raise ParameterError(name, value, allowed, "use letters a-z, digits and _")
