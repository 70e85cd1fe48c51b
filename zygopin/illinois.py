"""The Illinois method: where functions cross zero, each inside its own bracket."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
Values = Callable[[NDArray[np.intp], Floats], Floats]
"""Values at places of some of the functions, given by their indices."""


def crossings(
    function: Values,
    ends: tuple[Floats, Floats],
    values: tuple[Floats, Floats],
    enough: Floats,
    steps: int,
) -> tuple[Floats, NDArray[np.bool_]]:
    """Where continuous functions are zero between ends at which their signs differ.

    Args:
        function: The functions.
        ends: Where they are positive and where negative, or the reverse, (n,) each.
        values: Their values there, shape (n,) each.
        enough: Values that count as zero, shape (n,).
        steps: Most steps.

    Returns:
        Places, shape (n,), and which of them have converged; the second end for others.
    """
    result, found = ends[1].copy(), np.zeros(len(ends[0]), dtype=bool)
    (a, b), (at_a, at_b), active = ends, values, np.arange(len(ends[0]))
    for _ in range(steps):
        new = b - at_b * (b - a) / (at_b - at_a)
        value = function(active, new)
        done = np.abs(value) <= enough[active]
        result[active[done]], found[active[done]] = new[done], True
        # Halving the value of an end that stays is what makes the secant superlinear.
        crossed = np.sign(value) != np.sign(at_b)
        a, at_a = np.where(crossed, b, a), np.where(crossed, at_b, at_a / 2)
        b, at_b = new, value
        active = active[~done]
        a, b, at_a, at_b = (x[~done] for x in (a, b, at_a, at_b))
        if not len(active):
            break
    return result, found
