"""Options that hold two values: ranges, numbers of cells, pairs of fingers."""

from __future__ import annotations

from typing import Any

import click

from zygopin.options import Quantity

Interval = tuple[float, float]

MOST_CELLS = 4096
"""Cells along one side of a grid."""

DIGITS = 9
"""Digits of a text that is read as a number of a finger."""


class Range(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """LOW:HIGH, held in SI.

    Args:
        each: The type of both.
        example: What a message shows.
    """

    def __init__(self, each: Quantity, example: str = "3:20") -> None:
        self.each = each
        self.example = example
        self.name = "low:high"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> Interval:
        """Parse a text.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            Both ends, the lesser first.
        """
        if isinstance(value, tuple):
            return value
        low, colon, high = value.partition(":")
        if not colon:
            words = f"LOW:HIGH, such as {self.example}"
            self.fail(f"{value!r} is not {words}.", param, ctx)
        ends = self.each.convert(low, param, ctx), self.each.convert(high, param, ctx)
        if not ends[0] < ends[1]:
            self.fail(f"{value!r} does not ascend: give LOW:HIGH.", param, ctx)
        return ends


class Cells(click.ParamType):  # type: ignore[type-arg,unused-ignore]
    """COUNT, or ROWSxCOLUMNS."""

    name = "count"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[int, int]:
        """Parse a text.

        Args:
            value: What was typed.
            param: The option.
            ctx: The command's context.

        Returns:
            Numbers of rows and columns.
        """
        if isinstance(value, tuple):
            return value
        rows, cross, columns = str(value).partition("x")
        counts = [text.strip() for text in (rows, columns if cross else rows)]
        if not all(is_count(text, MOST_CELLS) for text in counts):
            words = f"a number from 2 to {MOST_CELLS}, or two such as 64x128"
            self.fail(f"{value!r} is not {words}.", param, ctx)
        return int(counts[0]), int(counts[1])


def is_count(text: str, most: int) -> bool:
    """Whether a text is a whole number of at least 2.

    Args:
        text: What was typed.
        most: The largest number that it may be.

    Returns:
        The answer; a text longer than the largest number is not read as one.
    """
    return text.isdecimal() and len(text) <= len(str(most)) and 2 <= int(text) <= most


def named_finger(text: str) -> str | int:
    """A finger's number, where digits are given, or its name.

    Args:
        text: What was typed.

    Returns:
        The number or the name.
    """
    return int(text) if text.isdecimal() and len(text) <= DIGITS else text


def finger_pair(text: str) -> tuple[str | int, str | int]:
    """The two fingers that `--pair` names.

    Args:
        text: Names or numbers, such as 1,3.

    Returns:
        The names and numbers as they were given.

    Raises:
        UsageError: They are not two.
    """
    names = [named_finger(name) for name in text.split(",")]
    if len(names) != 2:
        raise click.UsageError(f"--pair = {text} is not two fingers: try 1,3.")
    return names[0], names[1]
