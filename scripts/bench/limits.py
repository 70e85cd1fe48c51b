"""How near to the machine's limits the measured times are.

A configuration cannot take less time than its bytes take to be read and written, nor
less than its arithmetic takes; both rates are measured on this machine, at their best.
Sine and cosine count as the polynomials that they are at least; what NumPy's own take
is told beside it.
"""

from __future__ import annotations

import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from zygopin import Foot

TRIES = 7
"""Measurements of a rate, of which the best counts."""

COPIED = 2**25
"""Bytes of the copied array for each thread: well beyond a core's own cache."""

SMALL = 64
"""Side of matrices whose product BLAS leaves to one thread."""

DOUBLE = 8
"""Bytes of a number."""

POLYNOMIAL = 17
"""Operations of a sine or a cosine in doubles: its argument reduced in 3, and 7 terms
of a polynomial at two each."""


@dataclass(frozen=True)
class Rates:
    """What the machine does in a second.

    Attributes:
        threads: Threads that it does it with.
        bandwidth: Bytes read and bytes written by a copy of a large array, together.
        flops: Additions and multiplications, of products of matrices.
        functions: NumPy's sines and cosines of numbers in the cache.
    """

    threads: int
    bandwidth: float
    flops: float
    functions: float


@dataclass(frozen=True)
class Least:
    """What one configuration needs at least.

    Attributes:
        bytes: Bytes read and written.
        flops: Additions, multiplications and the like.
        functions: Sines and cosines.
    """

    bytes: int
    flops: int
    functions: int

    def seconds(self, rates: Rates) -> float:
        """Time below which one configuration cannot be done [s]."""
        return max(self.by_memory(rates), self.by_arithmetic(rates))

    def by_memory(self, rates: Rates) -> float:
        """Time in which its bytes are read and written [s]."""
        return self.bytes / rates.bandwidth

    def by_arithmetic(self, rates: Rates) -> float:
        """Time in which its operations are done [s]."""
        return (self.flops + POLYNOMIAL * self.functions) / rates.flops


def of_kinematics(foot: Foot) -> Least:
    """Forward kinematics: controls are read, both ends of each bone are written.

    For each phalanx: the control added and scaled, sine and cosine of the pitch, both
    scaled and added to the junction, which is turned by the azimuth.
    """
    count = foot.phalanx_count
    return Least((1 + 2 * 3) * DOUBLE * count, 8 * count, 2 * count)


def of_check(foot: Foot) -> Least:
    """A check: controls are read, three booleans are written.

    For each phalanx: the junctions seen along the branch, 8 operations; three scalar
    products, a division and a clamp for the nearest point, 12; the squared distance and
    its comparison, 6. Fingers against each other and the verdicts are not counted:
    bounds may settle them.
    """
    count = foot.phalanx_count
    return Least(DOUBLE * count + 3, 26 * count, 2 * count)


def measured_rates(threads: int) -> Rates:
    """Rates of this machine on so many threads."""
    source = [np.ones(COPIED // DOUBLE) for _ in range(threads)]
    target = [np.empty_like(array) for array in source]
    stack = [np.ones((8, SMALL, SMALL)) for _ in range(threads)]
    product = [np.empty_like(array) for array in stack]
    angles = [np.linspace(0, 1, 4096) for _ in range(threads)]
    values = [np.empty_like(array) for array in angles]

    def copy(i: int) -> None:
        np.copyto(target[i], source[i])

    def multiply(i: int) -> None:
        for _ in range(20):
            np.matmul(stack[i], stack[i], out=product[i])

    def circle(i: int) -> None:
        for _ in range(20):
            np.sin(angles[i], out=values[i])
            np.cos(angles[i], out=values[i])

    return Rates(
        threads,
        threads * 2 * COPIED / _best(copy, threads),
        threads * 20 * 8 * 2 * SMALL**3 / _best(multiply, threads),
        threads * 20 * 2 * 4096 / _best(circle, threads),
    )


def _best(work: Callable[[int], None], threads: int) -> float:
    """Least time in which all threads do their part once [s]."""
    with ThreadPoolExecutor(threads) as pool:
        list(pool.map(work, range(threads)))
        times = []
        for _ in range(TRIES):
            start = time.perf_counter()
            list(pool.map(work, range(threads)))
            times.append(time.perf_counter() - start)
    return min(times)


def distance(
    name: str, least: Least, rates: Rates, microseconds: float
) -> dict[str, Any]:
    """How far a measured time is from the limit, in plain values.

    Args:
        name: What was measured.
        least: What it needs at least.
        rates: What the machine does, on as many threads.
        microseconds: Measured time of one configuration [µs].

    Returns:
        What is needed, the limit and its parts [µs], and the measured time over it.
    """
    limit = 1e6 * least.seconds(rates)
    return {
        "name": name,
        "threads": rates.threads,
        **asdict(least),
        "by_memory": 1e6 * least.by_memory(rates),
        "by_arithmetic": 1e6 * least.by_arithmetic(rates),
        "by_numpys_sines": 1e6 * least.functions / rates.functions,
        "limit": limit,
        "microseconds": microseconds,
        "over_limit": microseconds / limit,
    }
