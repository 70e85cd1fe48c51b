"""Checks of numbers at the edge: each returns the value as the type it is used as."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from zygopin.errors import ParameterError

REAL = "iuf"
"""NumPy's kinds of real numbers."""

MOST_TURNED = 1e6
"""Largest angle [rad]: above, its rounding is seen in its sine."""

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
    result = _as_float(value)
    if not math.isfinite(result) or not where(result):
        raise ParameterError(name, value, allowed, remedy)
    return result


def _as_float(value: object) -> float:
    """A real number as a float; NaN for what is none, or too large for one."""
    kind = type(value)
    if kind is float:
        return value  # type: ignore[return-value]
    if kind in (bool, np.bool_) or not hasattr(kind, "__float__"):
        return math.nan  # without that method: text and bytes, which float() reads
    if isinstance(value, (np.ndarray, np.generic)) and not _holds_one_real(value):
        return math.nan
    try:
        return float(value)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        return math.nan


def _holds_one_real(value: NDArray[Any] | np.generic) -> bool:
    """Whether a value of NumPy's is one number: no list, date or complex one."""
    return value.ndim == 0 and value.dtype.kind in REAL


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


def array_of(
    name: str, value: ArrayLike, kinds: str, allowed: str, remedy: str
) -> NDArray[Any]:
    """An array of certain kinds of entries.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.
        kinds: NumPy's letters of the kinds.
        allowed: What is allowed, in words.
        remedy: What to do otherwise, in words.

    Returns:
        The array: what was given, where it is one.

    Raises:
        ParameterError: It is none, or of another kind.
    """
    try:
        given = np.asarray(value)
    except (TypeError, ValueError, OverflowError, RuntimeError) as error:
        # ValueError: rows differ in length. RuntimeError: PyTorch's, of gradients.
        raise ParameterError(name, value, allowed, remedy) from error
    if given.dtype.kind not in kinds:
        raise ParameterError(name, value, allowed, remedy)
    return given


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
    what, remedy = "an array of numbers", "give numbers, in a sequence or an array"
    given = array_of(name, value, REAL, what, remedy)
    with np.errstate(over="ignore"):  # what is too long for a double becomes infinite
        result = np.array(given, dtype=float)
    if last is not None and (result.ndim == 0 or result.shape[-1] != last):
        allowed = f"of shape (…, {last})"
        remedy = f"give {last} numbers along the last axis"
        raise ParameterError(f"{name}.shape", result.shape, allowed, remedy)
    require(name, result, np.isfinite(result), "finite", "give finite numbers")
    return result


def flag(name: str, value: object) -> bool:
    """A truth value: a text such as "no" would count as true.

    Args:
        name: Name of the parameter, for the message.
        value: What was given.

    Returns:
        The value.

    Raises:
        ParameterError: It is neither True nor False.
    """
    if not isinstance(value, (bool, np.bool_)):
        raise ParameterError(name, value, "True or False", "give one of these")
    return bool(value)


def indices(name: str, value: ArrayLike, count: int) -> NDArray[np.intp]:
    """Places in a list, counted from 0; from its end where they are negative.

    Args:
        name: Name of the parameter, for the message.
        value: What was given, shape (…).
        count: Length of the list.

    Returns:
        The indices, shape (…).

    Raises:
        ParameterError: One is no integer, or out of range.
    """
    given = array(name, value)
    good = (given >= -count) & (given < count) & (given == np.floor(given))
    allowed = f"an integer from 0 to {count - 1}"
    require(name, given, good, allowed, "count from 0")
    return given.astype(np.intp)


def angle(name: str, value: object) -> float:
    """An angle of not so many turns that rounding is seen in its sine.

    Args:
        name: Name of the parameter, for the message.
        value: What was given [rad].

    Returns:
        The angle [rad].

    Raises:
        ParameterError: It is none, or beyond `MOST_TURNED`.
    """
    return number(
        name,
        value,
        allowed=f"an angle within {MOST_TURNED:g}",
        where=lambda x: abs(x) <= MOST_TURNED,
        remedy="give radians",
    )


def unit(name: str, value: object) -> float:
    """A number in [0, 1].

    Args:
        name: Name of the parameter, for the message.
        value: What was given.

    Returns:
        The number.

    Raises:
        ParameterError: It is none, or outside.
    """
    return number(
        name,
        value,
        allowed="in [0, 1]",
        where=lambda x: 0 <= x <= 1,
        remedy="give a share, such as 0.5",
    )


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


def length(name: str, value: ArrayLike) -> float:
    """One positive length, whose square neither vanishes nor overflows.

    Args:
        name: Name of the parameter, for the message.
        value: What was given [m].

    Returns:
        The length [m].

    Raises:
        ParameterError: It is none, or not in [`SMALLEST`, `LARGEST`].
    """
    one = lengths(name, value)
    shaped(name, one, ())
    return float(one)


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
    if values.shape == shape:
        return
    same = len(values.shape) == len(shape)
    if same and all(b in (a, None) for a, b in zip(values.shape, shape, strict=True)):
        return
    axes = ", ".join("…" if n is None else str(n) for n in shape)
    allowed = f"({axes}{',' if len(shape) == 1 else ''})"
    raise ParameterError(f"{name}.shape", values.shape, allowed, "give it that shape")


def read_only(values: NDArray[Any]) -> NDArray[Any]:
    """The array itself, made read-only."""
    values.setflags(write=False)
    return values


def freeze(record: Any) -> None:  # noqa: ANN401
    """Replace the arrays of a frozen dataclass by copies that are read-only.

    Args:
        record: The record, while it is being made.
    """
    values = vars(record)
    for name, value in values.items():
        if isinstance(value, np.ndarray):
            values[name] = read_only(value.copy("K"))
        elif isinstance(value, np.generic):
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
    good = np.asarray(good)
    if good.all():
        return
    index = tuple(int(i) for i in np.argwhere(~good)[0])
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
    known = {shape for shape in shapes if shape}
    if len(known) <= 1:  # mostly, and NumPy takes its time
        return known.pop() if known else ()
    try:
        return np.broadcast_shapes(*shapes)
    except ValueError as error:
        allowed, remedy = "broadcastable", "give them equal leading axes"
        raise ParameterError(
            f"batch shapes of {what}", shapes, allowed, remedy
        ) from error
