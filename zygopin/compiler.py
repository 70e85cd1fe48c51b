"""Loops compiled by Numba, which is optional."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache
from typing import Any, TypeVar

Loop = TypeVar("Loop", bound=Callable[..., Any])


@cache
def has_compiler() -> bool:
    """Whether Numba is there and fits NumPy; it takes half a second to load."""
    try:
        import numba  # noqa: F401
    except ImportError:
        return False
    return True


def compiled(loop: Loop) -> Loop:
    """A loop, compiled when it is first called, kept on disk, run without the GIL."""
    import numba

    made: Loop = numba.njit(loop, cache=True, nogil=True, error_model="numpy")
    return made
