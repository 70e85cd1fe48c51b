"""Linear programmes, solved by HiGHS."""

from __future__ import annotations

from typing import Any, NamedTuple


class Optimum(NamedTuple):
    """The best solution of a linear programme.

    Attributes:
        value: The last unknown, which was to be as large as can be.
        unknowns: All unknowns, shape (n,).
    """

    value: float
    unknowns: Any


def maximise_last(unknowns: int, **constraints: Any) -> Optimum | None:  # noqa: ANN401
    """Make the last unknown as large as the constraints let it.

    Args:
        unknowns: How many unknowns there are.
        **constraints: As `scipy.optimize.linprog` takes them.

    Returns:
        The optimum; None where nothing meets the constraints.
    """
    from scipy.optimize import linprog  # a fifth of a second to load: only where used

    costs = [0.0] * (unknowns - 1) + [-1.0]
    result = linprog(costs, method="highs", **constraints)
    if result.status != 0 or result.x is None:
        return None
    return Optimum(float(result.x[-1]), result.x)
