"""A design optimiser: the foot of a family that grasps the widest range of perches."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin import checks, kinds
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.graspable import GraspableRadii, Interval, graspable_radii, radius_range
from zygopin.worker_process import MOST_WORKERS, mapping

BOUNDS: dict[str, Interval] = {
    "rho": (1.05, 1.8),
    "omega": (math.radians(30), math.radians(120)),
    "splay": (0.0, math.radians(45)),
    "scale": (0.5, 2.0),
}
"""What a design may vary, and between what; scale: over the given foot's own."""

TRIALS = 160
"""Feet that are tried: one to three minutes of one core for 14 phalanges."""

POPULATION = 16
"""Feet of a generation: four for each parameter."""

SEED = 20
"""Seed of the search, so that it always finds the same foot."""

SEARCH_LEVELS, SEARCH_SAMPLES, SEARCH_TOLERANCE = 4, 9, 0.01
"""Levels, sampled radii and tolerance (over the foot's size) during the search."""

FINALISTS = 3
"""Best feet of the search that are compared exactly."""

DIGITS = 4
"""Significant digits of a design's parameters."""

TURN_WORTH = 1e-3
"""Share of the range that a half turn of mean wrap is worth: it decides between feet
that grasp equally many perches."""

MOST_TRIALS = 1_000_000

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class Design:
    """A foot that was designed, beside the one it started from.

    Attributes:
        before: The perches of the foot that was given.
        after: Those of the foot that was found; the given one where none is better.
        bounds: Between what each parameter was free [SI].
        trials: Number of feet that the search tried.
    """

    before: GraspableRadii
    after: GraspableRadii
    bounds: Mapping[str, Interval]
    trials: int

    @property
    def foot(self) -> Foot:
        """The foot that was found."""
        return self.after.foot

    @property
    def improved(self) -> bool:
        """Whether a better foot than the given one was found."""
        return merit(self.after) > merit(self.before)


def design_foot(
    foot: Foot,
    low: float,
    high: float,
    *,
    bounds: Mapping[str, Interval | None] | None = None,
    trials: int = TRIALS,
    workers: int = 1,
) -> Design:
    """The foot of a family that grasps the widest range of perches at rest.

    Differential evolution over the free parameters. What is made large is the share of
    [low, high] that is graspable on the logarithmic scale, ∫ dr/r over the graspable
    radii: it counts ratios, so that thin perches weigh as much as thick ones and a
    similar foot of another size has as much; ties go to the larger mean wrap. The
    search is coarse; its best feet and the given one are compared by the defaults of
    `graspable_radii`, and the best of them is returned: never a worse one.

    Args:
        foot: The foot to start from.
        low: Least radius of a perch [m].
        high: Largest radius [m].
        bounds: What varies, and between what [SI]: `rho`, `omega`, `splay`, `scale`,
            with which the skin's thickness goes; None for the bounds in `BOUNDS`.
        trials: Number of feet to try, in generations of `POPULATION`.
        workers: Number of processes; the result is the same. With more than one, a
            script needs the guard `if __name__ == "__main__":`.

    Returns:
        The design, with the given foot's perches beside it.

    Raises:
        UnknownNameError: A parameter cannot be varied.
        ParameterError: A range is empty, or a number out of range.
        WorkerError: A process ended early.
    """
    kinds.instance("foot", foot, Foot)
    low, high = radius_range(low, high)
    chosen = dict.fromkeys(BOUNDS) if bounds is None else bounds
    if not isinstance(chosen, Mapping):
        remedy = "give names of parameters and their bounds"
        raise ParameterError("bounds", bounds, "a mapping", remedy)
    free = {name: _bounds(foot, name, given) for name, given in chosen.items()}
    checks.integer("number of varied parameters", len(free), 1, len(BOUNDS))
    generations = (
        checks.integer("trials", trials, POPULATION, MOST_TRIALS) // POPULATION
    )
    search = _Search(foot, low, high, tuple(free.items()))
    workers = checks.integer("workers", workers, 1, MOST_WORKERS)
    with mapping(workers) as spread:
        finalists = search.best(generations, spread)
        feet = [foot, *map(search.rounded, finalists)]
        exact = list(spread(_Exact(low, high), feet))
    best = max(exact, key=merit)  # of equals the first, the given one
    return Design(exact[0], best, free, generations * POPULATION)


def merit(perches: GraspableRadii) -> float:
    """What a foot is worth: the share of the range, and a little for its wrap."""
    return perches.share + TURN_WORTH * perches.wrap / math.pi


def varied_foot(foot: Foot, values: Mapping[str, float]) -> Foot:
    """A foot of the family.

    Args:
        foot: The foot that the family is of.
        values: The parameters that vary [SI].

    Returns:
        The foot; its skin is thicker as its scale is larger.
    """
    ratio = values.get("scale", foot.scale) / foot.scale
    return foot.replace(**(dict(values) | {"thickness": foot.thickness * ratio}))


@dataclass(frozen=True)
class _Search:
    """A search for a foot; called with parameters, it says what to make small."""

    foot: Foot
    low: float
    high: float
    free: tuple[tuple[str, Interval], ...]

    def __call__(self, values: Floats) -> float:
        foot = varied_foot(self.foot, self.named(values))
        perches = graspable_radii(
            foot,
            self.low,
            self.high,
            levels=SEARCH_LEVELS,
            samples=SEARCH_SAMPLES,
            tolerance=SEARCH_TOLERANCE * foot.size,
        )
        return -merit(perches)

    @property
    def bounds(self) -> list[Interval]:
        """Bounds of each parameter [SI]."""
        return [ends for _, ends in self.free]

    def named(self, values: Floats) -> dict[str, float]:
        """Parameters by name."""
        pairs = zip(self.free, values.tolist(), strict=True)
        return {name: value for (name, _), value in pairs}

    def rounded(self, values: Floats) -> Foot:
        """A foot with no more digits than mean something, under its own name."""
        given = self.named(values)
        short = {
            name: min(max(float(f"{given[name]:.{DIGITS}g}"), low), high)
            for name, (low, high) in self.free
        }
        name = f"{self.foot.name[:33]}_design"
        return varied_foot(self.foot, short).replace(name=name)

    def best(self, generations: int, spread: Callable[..., Any]) -> list[Floats]:
        """The best parameters after some generations, the best first."""
        from scipy.optimize import Bounds, differential_evolution

        found = differential_evolution(
            self,
            Bounds(*np.array(self.bounds).T),
            init=self._first(),
            maxiter=generations - 1,
            tol=0,  # plateaus of equal merit are no reason to stop
            polish=False,
            seed=np.random.default_rng(SEED),
            updating="deferred",  # whatever the number of workers
            workers=spread,
        )
        order = np.argsort(found.population_energies, kind="stable")
        return [found.population[place] for place in order[:FINALISTS]]

    def _first(self) -> Floats:
        """The first generation: the given foot, and others spread over the bounds."""
        low, high = np.array(self.bounds).T
        random = np.random.default_rng(SEED)
        ranks = [random.permutation(POPULATION) for _ in self.free]
        strata = np.stack(ranks, axis=1) + random.random((POPULATION, len(self.free)))
        values = low + (high - low) * strata / POPULATION
        values[0] = [getattr(self.foot, name) for name, _ in self.free]
        return np.asarray(np.clip(values, low, high))


@dataclass(frozen=True)
class _Exact:
    """The perches of a foot by the defaults."""

    low: float
    high: float

    def __call__(self, foot: Foot) -> GraspableRadii:
        return graspable_radii(foot, self.low, self.high)


def _bounds(foot: Foot, name: str, given: object) -> Interval:
    """Bounds of a parameter [SI], at both of which there is a foot."""
    kinds.one_of("parameter to vary", name, BOUNDS)
    unit = foot.scale if name == "scale" else 1.0
    if given is None:
        low, high = (end * unit for end in BOUNDS[name])
        return low, high
    ends = checks.array(f"bounds[{name!r}]", given, last=2)  # type: ignore[arg-type]
    checks.shaped(f"bounds[{name!r}]", ends, (2,))
    low, high = map(float, ends)
    if not low < high:
        remedy = "give the lesser bound first"
        raise ParameterError(f"bounds[{name!r}]", (low, high), "ascending", remedy)
    for end in (low, high):
        varied_foot(foot, {name: end})
    return low, high
