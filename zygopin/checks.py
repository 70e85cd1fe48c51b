"""Checks of numbers at the edge: each returns the value as the type it is used as."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin.errors import ParameterError

_NAME = re.compile(r"[a-z][a-z0-9_]*")

SMALLEST, LARGEST = 1e-12, 1e12
"""Lengths that a solid may have [m]: their squares neither vanish nor overflow."""


def number(
    name: str,
    value: object,
    *,
    allowed: str = "a finite number",
    where: Callable[[float], bool] = lambda _: True,
    remedy: str = "give a finite number",
) -> float:
    """A finite float for which a condition holds.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.
        allowed: What is allowed, in words.
        where: The condition.
        remedy: What to do otherwise, in words.

    Returns:
        The value as a float.

    Raises:
        ParameterError: The value is not a number, not finite, or fails the condition.
    """
    if isinstance(value, (bool, str)) or value is None:
        raise ParameterError(name, value, allowed, remedy)
    try:
        result = float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError) as error:
        raise ParameterError(name, value, allowed, remedy) from error
    if not math.isfinite(result) or not where(result):
        raise ParameterError(name, value, allowed, remedy)
    return result


def integer(name: str, value: object, low: int, high: int) -> int:
    """An integer in [low, high].

    Args:
        name: Name of the parameter, for the message.
        value: What was given.
        low: Smallest value allowed.
        high: Largest value allowed.

    Returns:
        The value as an int.

    Raises:
        ParameterError: The value is no integer or out of range.
    """
    allowed = f"an integer from {low} to {high}"
    result = number(
        name,
        value,
        allowed=allowed,
        where=lambda x: x == int(x) and low <= x <= high,
        remedy=f"give {allowed}",
    )
    return int(result)


def array(name: str, value: ArrayLike, *, last: int | None = None) -> NDArray[Any]:
    """A finite float array, copied.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.
        last: Length of the last axis; None: no demand.

    Returns:
        A new float array.

    Raises:
        ParameterError: Not numbers, not finite, or of the wrong shape.
    """
    allowed, remedy = "an array of numbers", "give numbers, in a sequence or an array"
    try:
        given = np.asarray(value)
        result = np.array(given, dtype=float)
    except (TypeError, ValueError, OverflowError) as error:
        raise ParameterError(name, value, allowed, remedy) from error
    if given.dtype.kind not in "iuf":  # text, truth values, dates, complex numbers
        raise ParameterError(name, value, allowed, remedy)
    if last is not None and (result.ndim == 0 or result.shape[-1] != last):
        allowed = f"of shape (…, {last})"
        remedy = f"give {last} numbers along the last axis"
        raise ParameterError(f"{name}.shape", result.shape, allowed, remedy)
    require(name, result, np.isfinite(result), "finite", "give finite numbers")
    return result


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
        raise ParameterError(name, given, f"a {wanted}", f"give a zygopin.{wanted}")


def lengths(name: str, value: ArrayLike, *, last: int | None = None) -> NDArray[Any]:
    """Positive lengths, whose squares neither vanish nor overflow.

    Args:
        name: Name of the parameter, for the message.
        value: What was given [m].
        last: Length of the last axis; None: no demand.

    Returns:
        A new array, read-only.

    Raises:
        ParameterError: A length is not in [`SMALLEST`, `LARGEST`].
    """
    result = array(name, value, last=last)
    good = (result >= SMALLEST) & (result <= LARGEST)
    allowed = f"a positive number, from {SMALLEST:g} to {LARGEST:g} m"
    require(name, result, good, allowed, "give metres, such as 0.008 for 8 mm")
    return read_only(result)


def places(name: str, value: ArrayLike) -> NDArray[Any]:
    """Points that are not too far for their squares.

    Args:
        name: Name of the parameter, for the message.
        value: What was given [m], shape (…, 3).

    Returns:
        A new array, read-only.

    Raises:
        ParameterError: A coordinate is beyond `LARGEST`.
    """
    result = array(name, value, last=3)
    near = np.abs(result) <= LARGEST
    remedy = "give metres, in the world frame"
    require(name, result, near, f"within {LARGEST:g} m", remedy)
    return read_only(result)


def shaped(name: str, values: NDArray[Any], shape: tuple[int | None, ...]) -> None:
    """Raise unless an array has a shape.

    Args:
        name: Name of the parameter, for the message.
        values: The array.
        shape: Length of each axis; None: any.

    Raises:
        ParameterError: Names the shape that it has.
    """
    same = len(values.shape) == len(shape)
    if same and all(b in (a, None) for a, b in zip(values.shape, shape, strict=True)):
        return
    axes = ", ".join("…" if n is None else str(n) for n in shape)
    allowed = f"({axes}{',' if len(shape) == 1 else ''})"
    raise ParameterError(f"{name}.shape", values.shape, allowed, "give it that shape")


def read_only(values: NDArray[Any]) -> NDArray[Any]:
    """The array itself, made read-only."""
    values.flags.writeable = False
    return values


def freeze(record: Any) -> None:  # noqa: ANN401
    """Replace the arrays of a frozen dataclass by copies that are read-only.

    Args:
        record: The record, while it is being made.
    """
    values = vars(record)
    for name, value in values.items():
        if isinstance(value, (np.ndarray, np.generic)):
            values[name] = read_only(np.array(value))


def require(
    name: str, values: NDArray[Any], good: NDArray[Any], allowed: str, remedy: str
) -> None:
    """Raise for the first entry of an array that is not good.

    Args:
        name: Name of the parameter, for the message.
        values: The array.
        good: Which entries are allowed, of the same shape.
        allowed: What is allowed, in words.
        remedy: What to do otherwise, in words.

    Raises:
        ParameterError: Names the first bad entry and its index.
    """
    if np.all(good):
        return
    index = tuple(int(i) for i in np.argwhere(~np.asarray(good))[0])
    at = f"[{', '.join(map(str, index))}]" if index else ""
    raise ParameterError(f"{name}{at}", values[index], allowed, remedy)


def common_batch(what: str, *shapes: tuple[int, ...]) -> tuple[int, ...]:
    """The batch shape that some shapes broadcast to.

    Args:
        what: What they are the shapes of, for the message.
        *shapes: The leading axes of each.

    Returns:
        The common shape.

    Raises:
        ParameterError: They do not broadcast.
    """
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError as error:
        allowed, remedy = "broadcastable", "give them equal leading axes"
        raise ParameterError(
            f"batch shapes of {what}", shapes, allowed, remedy
        ) from error


def memory_limit(most: int | None = None) -> int:
    """Memory that an answer may take.

    Args:
        most: What the caller allows [bytes]; None: half of the machine's.

    Returns:
        The number of bytes.
    """
    if most is not None:
        return most
    return int(os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") // 2)


def memory(what: str, needed: int, most: int, remedy: str) -> None:
    """Raise unless something fits in memory.

    Args:
        what: What it is, for the message.
        needed: Bytes that it takes.
        most: Bytes that it may take.
        remedy: What to do otherwise, in words.

    Raises:
        ParameterError: It takes more.
    """
    if needed > most:
        name = f"memory for {what} [bytes]"
        raise ParameterError(name, needed, f"at most {most}", remedy)


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
