"""What was measured, as text for a terminal."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

Found = dict[str, Any]


def text(found: Found) -> str:
    """All that was measured.

    Args:
        found: What `measure` returns.

    Returns:
        Lines.
    """
    return "\n".join(_lines(found))


def span(spread: Found, digits: int = 3) -> str:
    """A median with its least and greatest: 1.2 (1.1 to 1.9)."""
    low, high = (number(spread[key], digits) for key in ("low", "high"))
    return f"{number(spread['median'], digits)} ({low} to {high})"


def number(value: float, digits: int = 3) -> str:
    """A number in so many figures, never with an exponent."""
    if value == 0:
        return "0"
    shown = float(f"{value:.{digits}g}")
    return f"{shown:,.0f}" if abs(shown) >= 10 ** (digits - 1) else f"{shown:g}"


def _lines(found: Found) -> Iterator[str]:
    """Line after line."""
    machine = found["machine"]
    load = machine["load_before"]
    yield f"{machine['processor']}, {machine['cores']} cores, load before {load}"
    yield ", ".join(f"{name} {value}" for name, value in found["versions"].items())
    yield from _rows(found["rows"])
    for name, why in found["missing"].items():
        yield f"left out: {name}: {why}"
    yield from _limits(found["limits"])
    yield from _aims(found["aims"])
    if "scaling" in found:
        yield from _scaling(found["scaling"])
    if "calls" in found:
        yield from _times("per configuration", found["calls"]["pieces"], "µs", 1e6)
        yield from _times("per call", found["calls"]["calls"], "ms", 1e3)
    if "maps" in found:
        yield from _times("per branch of a map", found["maps"]["branches"], "ms", 1e3)
        share = found["maps"]["found_at_random"]
        yield f"The random poses grasp {share:.1%} of what the map does."


def _rows(rows: list[Found]) -> Iterator[str]:
    """A table for each kind of work."""
    part = None
    for row in rows:
        if row["part"] != part:
            part = row["part"]
            yield f"\n{part:<40}{'threads':>8}  {'µs each':<30}times zygopin's"
        times, ratio = span(row["microseconds"]), span(row["ratio"])
        alike = row["ratio_alike"]
        more = f"; {number(alike['median'])} on one thread" if alike else ""
        yield f"{row['name']:<40}{row['threads']:>8}  {times:<30}{ratio}{more}"
        yield f"    {row['computes']}; {row['configurations']:,}: {row['remark']}"


def _limits(rows: list[Found]) -> Iterator[str]:
    """How far from the machine's limits."""
    if not rows:
        return
    yield "\nlimits: the larger of bytes over bandwidth and arithmetic over its rate"
    seen: set[int] = set()
    for row in rows:
        rates = row["rates"]
        if row["threads"] not in seen:
            seen.add(row["threads"])
            yield (
                f"threads {row['threads']}: copies {rates['bandwidth'] / 1e9:.1f} GB/s,"
                f" {rates['flops'] / 1e9:.1f} Gflop/s,"
                f" {rates['functions'] / 1e6:.0f} million sines/s"
            )
    for row in rows:
        yield (
            f"{row['name']}: {number(row['by_memory'])} µs for {row['bytes']} bytes,"
            f" {number(row['by_arithmetic'])} µs for {row['flops']} flops and"
            f" {row['functions']} sines (NumPy's: {number(row['by_numpys_sines'])} µs);"
            f" measured {number(row['over_limit'])} times the larger"
        )


def _aims(rows: list[Found]) -> Iterator[str]:
    """Aims, and whether they are met."""
    if rows:
        yield "\naims"
    for row in rows:
        met = "met" if row["met"] else "MISSED"
        wanted, measured = number(row["wanted"]), number(row["measured"])
        yield f"{met:<8}{row['aim']}: {measured} (wanted {wanted})"


def _scaling(found: Found) -> Iterator[str]:
    """Time and memory against sizes."""
    yield "\nwork         configurations  phalanges  threads  MB beyond  µs each"
    for row in (*found["configurations"], *found["phalanges"]):
        yield (
            f"{row['work']:<13}{row['configurations']:>14,}{row['phalanges']:>11}"
            f"{row['threads']:>9}{row['peak'] / 1e6:>11.2f}  "
            f"{span(row['microseconds'])}"
        )
    for count in found["left_out_for_memory"]:
        yield f"left out for want of memory: {count:,} configurations"


def _times(
    title: str, rows: dict[str, float], unit: str, scale: float
) -> Iterator[str]:
    """Rows of one number."""
    yield f"\n{title:<42}{unit:>9}"
    for name, value in rows.items():
        yield f"{name:<42}{value * scale:>9.2f}"
