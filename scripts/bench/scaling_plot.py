"""The figure of scaling: time and memory, side by side."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from pathlib import Path

from bench.scaling import Point
from zygopin.figures import ACCENT, INK, PALE, Axes, new_figure, save_figure

COLOURS = {"kinematics": INK, "checks": ACCENT}
LABELS = {"kinematics": "forward kinematics", "checks": "grasp checks"}

WIDTH, HEIGHT = 11.0, 8.0
"""Size of the figure [inches]."""

MEGABYTE = 1e6

HEADROOM = 100
"""What is left free above the memory for its legend, as a factor."""

Value = Callable[[Point], float]


def draw(counts: Sequence[Point], phalanges: Sequence[Point], path: Path) -> Path:
    """Draw time and memory.

    Args:
        counts: Measurements against the number of configurations.
        phalanges: Measurements against the number of phalanges.
        path: The PNG file.

    Returns:
        The path.
    """
    figure = new_figure(WIDTH, HEIGHT)
    (time, memory), (toes, threads) = figure.subplots(2, 2)
    _curves(time, counts, lambda p: p.configurations, lambda p: p.microseconds.median)
    _spans(time, counts)
    _logarithmic(time)
    _plain_numbers(time)
    _name(time, "number of configurations", "time per configuration [µs]")
    _memory(memory, counts)
    _curves(toes, phalanges, lambda p: p.phalanges, lambda p: p.microseconds.median)
    toes.set_xlim(left=0)
    toes.set_ylim(bottom=0)
    number = phalanges[0].configurations
    _name(toes, "number of phalanges", "time per configuration [µs]")
    toes.set_title(f"{number:,} configurations", fontsize=9)
    _threads(threads, counts)
    for panel in (time, memory, toes, threads):
        panel.grid(color=PALE, linewidth=0.5)
        panel.legend(fontsize=8, framealpha=1)
        panel.tick_params(labelsize=8, which="both")
    return save_figure(figure, path)


def _curves(panel: Axes, points: Sequence[Point], x: Value, y: Value) -> None:
    """A curve for each kind of work and number of threads."""
    for (work, threads), some in _series(points).items():
        panel.plot(
            [x(p) for p in some],
            [y(p) for p in some],
            "o-" if threads == 1 else "s--",
            color=COLOURS[work],
            markersize=4,
            label=f"{LABELS[work]}, {_in_words(threads)}",
        )


def _spans(panel: Axes, points: Sequence[Point]) -> None:
    """From the least to the greatest of several runs."""
    for (work, _), some in _series(points).items():
        low = [p.microseconds.low for p in some]
        high = [p.microseconds.high for p in some]
        sizes = [p.configurations for p in some]
        panel.fill_between(
            sizes, low, high, color=COLOURS[work], alpha=0.12, linewidth=0
        )


def _memory(panel: Axes, points: Sequence[Point]) -> None:
    """Memory beyond the result, and the result's own for comparison."""
    # Below a kilobyte it is bookkeeping, and zero has no logarithm.
    _curves(
        panel,
        points,
        lambda p: p.configurations,
        lambda p: max(p.peak, 1e3) / MEGABYTE,
    )
    results = _series([p for p in points if p.threads == 1])
    for (work, _), some in results.items():
        sizes = [p.result / MEGABYTE for p in some]
        panel.plot(
            [p.configurations for p in some],
            sizes,
            ":",
            color=COLOURS[work],
            label=f"{LABELS[work]}, the result itself",
        )
    _logarithmic(panel)
    panel.set_ylim(top=HEADROOM * panel.get_ylim()[1])
    _name(panel, "number of configurations", "memory beyond the result [MB]")


def _threads(panel: Axes, points: Sequence[Point]) -> None:
    """Configurations in a second against the number of threads, at the largest N."""
    most = max(p.configurations for p in points)
    some = sorted(
        (p for p in points if p.configurations == most), key=lambda p: p.threads
    )
    for work in COLOURS:
        mine = [p for p in some if p.work == work]
        rates = [1 / p.microseconds.median for p in mine]
        threads = [p.threads for p in mine]
        panel.plot(threads, rates, "o-", color=COLOURS[work], label=LABELS[work])
        ideal = [rates[0] * n / threads[0] for n in threads]
        label = None if work == "kinematics" else "in proportion"
        panel.plot(threads, ideal, ":", color=COLOURS[work], label=label)
    panel.set_xticks(sorted({p.threads for p in some}))
    panel.set_xlim(0.5, max(p.threads for p in some) + 0.5)
    panel.set_ylim(bottom=0)
    _name(panel, "threads", "millions of configurations per second")
    panel.set_title(f"{most:,} configurations", fontsize=9)


def _series(points: Sequence[Point]) -> dict[tuple[str, int], list[Point]]:
    """Points by kind of work and number of threads."""
    found: dict[tuple[str, int], list[Point]] = {}
    for point in points:
        found.setdefault((point.work, point.threads), []).append(point)
    return found


def _in_words(threads: int) -> str:
    """A number of threads."""
    return "1 thread" if threads == 1 else f"{threads} threads"


def _logarithmic(panel: Axes) -> None:
    """Both axes in powers of ten."""
    panel.set_xscale("log")
    panel.set_yscale("log")


def _plain_numbers(panel: Axes) -> None:
    """Powers of ten, and 2 and 5 between them, written out along y."""
    low, high = panel.get_ylim()
    powers = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
    ticks = [digit * 10.0**power for power in powers for digit in (1, 2, 5)]
    inside = [tick for tick in ticks if low <= tick <= high]
    panel.set_yticks(inside, [f"{tick:g}" for tick in inside])
    panel.set_yticks([], minor=True)


def _name(panel: Axes, x: str, y: str) -> None:
    """Say what is along the axes."""
    panel.set_xlabel(x, fontsize=9)
    panel.set_ylabel(y, fontsize=9)
