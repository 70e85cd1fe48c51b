"""Dataclasses that hold arrays with one first axis: parts of them, and joins."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields, replace
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Record = TypeVar("Record")


def taken(record: Record, which: slice | NDArray[Any]) -> Record:
    """Some rows of a record.

    Args:
        record: A dataclass; whatever in it is no array is kept.
        which: Indices, a mask, or a slice of the arrays' first axis.

    Returns:
        A new record.
    """
    arrays = {name: getattr(record, name)[which] for name in _arrays(record)}
    rows: Record = replace(record, **arrays)  # type: ignore[type-var]
    return rows


def joined(parts: Sequence[Record]) -> Record:
    """Several records as one: their arrays one after another.

    Args:
        parts: Dataclasses of one type, at least one; whatever is no array is that of
            the first.

    Returns:
        A new record.
    """
    arrays = {
        name: np.concatenate([getattr(part, name) for part in parts])
        for name in _arrays(parts[0])
    }
    whole: Record = replace(parts[0], **arrays)  # type: ignore[type-var]
    return whole


def _arrays(record: Any) -> list[str]:  # noqa: ANN401
    """Names of the fields that are arrays."""
    names = (field.name for field in fields(record))
    return [name for name in names if isinstance(getattr(record, name), np.ndarray)]
