"""A route of comparison, and what becomes of one of its cases."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from differ.comparison import Comparison
from differ.corners import CORNER_NAMES
from differ.draw import Draw, Size, draw

Compare = Callable[[Draw], Sequence[Comparison]]


@dataclass(frozen=True)
class Route:
    """Two or more independent ways to the same numbers.

    Attributes:
        name: What it is called on the command line.
        compares: What is held against what.
        tolerance: What is allowed, and why that.
        compare: A draw to the comparisons.
        size: How much one draw holds.
        corners: Corners that it may stand in.
        posed: Whether a case is a pose on a branch of the draw.
    """

    name: str
    compares: str
    tolerance: str
    compare: Compare
    size: Size
    corners: tuple[str, ...] = CORNER_NAMES
    posed: bool = True

    def draw(self, seed: int) -> Draw:
        """The input of a seed, the same in every process."""
        return draw(self.name, seed, self.corners, self.size)


@dataclass(frozen=True)
class Outcome:
    """What became of one seed of a route.

    Attributes:
        route: The route's name.
        seed: The seed.
        corners: The corners that it stood in.
        cases: Cases compared.
        undecided: Of them those within rounding of a threshold.
        failures: Cases in which routes disagree.
        worst: Largest difference over its tolerance.
        quantity: What that is of; the error where the case ended in one.
    """

    route: str
    seed: int
    corners: tuple[str, ...]
    cases: int
    undecided: int
    failures: int
    worst: float
    quantity: str

    @property
    def label(self) -> str:
        """What `--replay` takes."""
        return f"{self.route}:{self.seed}"


def compared(route: Route, drawn: Draw) -> tuple[Comparison, ...]:
    """All comparisons of a draw; an invalid operation in NumPy is an error.

    Args:
        route: The route.
        drawn: The draw.

    Returns:
        The comparisons; none where the draw has nothing to compare.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        return tuple(route.compare(drawn))


def outcome(route: Route, seed: int) -> Outcome:
    """What becomes of a seed; whatever is raised is a failure.

    Args:
        route: The route.
        seed: The seed.

    Returns:
        The outcome.
    """
    drawn = route.draw(seed)
    try:
        found = compared(route, drawn)
    except Exception as error:
        said = f"{type(error).__name__}: {error}"
        return Outcome(route.name, seed, drawn.corners, 1, 0, 1, np.inf, said)
    return _summed(route, drawn, found)


def _summed(route: Route, drawn: Draw, found: Sequence[Comparison]) -> Outcome:
    """Counts over all comparisons; quantities of fewer cases count by themselves."""
    cases = max((len(each.ratio) for each in found), default=0)
    failed, unsure = np.zeros(cases, dtype=bool), np.zeros(cases, dtype=bool)
    worst, quantity = 0.0, ""
    for each in found:
        failed[: len(each.ratio)] |= each.failed
        unsure[: len(each.ratio)] |= ~each.decided
        most = float(np.where(each.decided, each.ratio, 0.0).max(initial=0.0))
        if most > worst:
            worst, quantity = most, each.quantity
    counts = cases, int(unsure.sum()), int(failed.sum())
    return Outcome(route.name, drawn.seed, drawn.corners, *counts, worst, quantity)
