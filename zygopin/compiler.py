"""Loops compiled by Numba, which is optional."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from hashlib import blake2b
from inspect import getclosurevars
from typing import Any, Literal, TypeVar

BatchName = Literal["exact", "fast"]

Loop = TypeVar("Loop", bound=Callable[..., Any])

BATCHED: tuple[BatchName, ...] = ("exact", "fast")
"""Engines that work on many poses at once: by NumPy, and by compiled loops."""


@cache
def has_compiler() -> bool:
    """Whether Numba is there and fits NumPy; it takes half a second to load."""
    try:
        import numba  # noqa: F401
    except ImportError:
        return False
    return True


def compiled(loop: Loop) -> Loop:
    """A loop, compiled when it is first called, kept on disk, run without the GIL.

    Numba drops what it kept when the loop's own module changes, not when a loop or a
    constant does that comes from another: a digest of all is made part of the name.
    """
    from numba import njit

    loop.__qualname__ += f"_{_digest(loop)}"
    make: Any = partial(njit, nogil=True, error_model="numpy")
    try:
        made: Loop = make(loop, cache=True)
    except RuntimeError:  # no folder can be written to: compiled in each process
        made = make(loop)
    return made


def _digest(loop: Callable[..., Any]) -> str:
    """A loop's code and what it takes from outside, in a few characters."""
    code, used = loop.__code__, getclosurevars(loop).globals.values()
    taken = [getattr(each, "__qualname__", each) for each in used]
    told = code.co_code, code.co_consts, code.co_names, taken
    return blake2b(repr(told).encode(), digest_size=4).hexdigest()
