"""One case again: what was drawn, and what each route says where they differ most."""

from __future__ import annotations

import json
import traceback
from collections.abc import Iterator

import numpy as np

from differ.comparison import Comparison
from differ.draw import Draw
from differ.route import Route, compared

DIGITS = 17


def replayed(route: Route, seed: int) -> tuple[str, bool]:
    """A seed's input and numbers.

    Args:
        route: The route.
        seed: The seed.

    Returns:
        The text, and whether the routes agree.
    """
    drawn = route.draw(seed)
    lines = [
        f"{route.name}:{seed}, {route.compares}",
        f"tolerance: {route.tolerance}",
        f"corners: {', '.join(drawn.corners) or 'none'}",
        f"foot: {json.dumps(drawn.foot.to_mapping())}",
    ]
    try:
        found = compared(route, drawn)
    except Exception:
        return "\n".join([*lines, traceback.format_exc()]), False
    with np.printoptions(precision=DIGITS, threshold=10_000, linewidth=100):
        lines += [f"{name}: {value}" for name, value in drawn.beyond.items()]
        for each in found:
            lines += _numbers(drawn, each, posed=route.posed)
    agree = not any(each.failed.any() for each in found)
    return "\n".join([*lines, "agree" if agree else "DISAGREE"]), agree


def _numbers(drawn: Draw, found: Comparison, *, posed: bool) -> Iterator[str]:
    """A quantity: how many cases differ, and both routes' numbers of the worst."""
    if not len(found.ratio):
        return
    ratio = np.where(found.decided, found.ratio, 0.0)
    row = int(np.argmax(ratio))
    yield f"{found.quantity}: worst {ratio[row]:.3g} of the tolerance, case {row}"
    yield f"  outside: {int(found.failed.sum())} of {len(ratio)}"
    if posed:
        branch = drawn.branch[row]
        yield f"  controls: {drawn.controls[row]}"
        yield f"  branch: r {branch.radius!r} at {branch.centre} along {branch.axis}"
    yield f"  one:   {found.one[row]}"
    yield f"  other: {found.other[row]}"
