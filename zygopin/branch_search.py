"""All branches on which a pair of fingers is stable, for a finite set of controls.

Each prefix v₁ … vₖ of a control sequence, with the phalanx k that it places, is held
against each one of the other finger, on both sides of both toes: one 2×2 system each,
none left out (MODEL.md, section 4).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

from zygopin import checks, memory
from zygopin.branch_solutions import (
    BranchSolutions,
    Found,
    Pair,
    Search,
    with_verdicts,
)
from zygopin.control_system import Levels
from zygopin.crossings import SystemCounts, crossings
from zygopin.foot import Foot
from zygopin.grasp import Criteria
from zygopin.placement import Placement
from zygopin.records import joined, taken
from zygopin.tangent_lines import (
    TangentLines,
    line_blocks,
)

BLOCK = 4096
"""Solutions in a block of `iter_stable_branches`, about: some megabytes."""

DEFAULT_LEVELS = 2
"""Equal levels of each control, unless said otherwise: straight and closed."""


def stable_branches(
    foot: Foot,
    pair: Pair,
    levels: Levels = DEFAULT_LEVELS,
    *,
    placement: Placement | None = None,
    criteria: Criteria | None = None,
    max_bytes: int | None = None,
) -> BranchSolutions:
    """All branches of one placement on which a pair of fingers is stable.

    For controls in a finite set. A phalanx that lies along the axis has no tangent
    line; the systems that it would be in are counted as `along_axis`.

    Args:
        foot: The foot.
        pair: Two opposable fingers, by name or by number from 1.
        levels: The control set: a number of equal levels, or the levels, 0 and 1
            among them.
        placement: Where the branches lie; None: across the foot, below its base.
        criteria: What counts as contact; None: the default for the two fingers.
        max_bytes: Most memory for the solutions; None: half of the machine's.

    Returns:
        The solutions.

    Raises:
        ParameterError: The fingers are not opposable, the levels are no control set,
            or the solutions need more memory: they are counted before the verdicts.
        UnknownNameError: There is no finger of that name.
    """
    search = Search.of(foot, pair, levels, placement, criteria)
    _check_memory(search, max_bytes)
    blocks = list(_blocks(search, BLOCK))
    counts = sum((block.counts for block in blocks), SystemCounts())
    return replace(joined(blocks), counts=counts)


def iter_stable_branches(
    foot: Foot,
    pair: Pair,
    levels: Levels = DEFAULT_LEVELS,
    *,
    placement: Placement | None = None,
    criteria: Criteria | None = None,
    block: int = BLOCK,
) -> Iterator[BranchSolutions]:
    """The solutions of `stable_branches` in blocks, for more than fit in memory.

    Args:
        foot: The foot.
        pair: Two opposable fingers, by name or by number from 1.
        levels: The control set.
        placement: Where the branches lie; None: across the foot, below its base.
        criteria: What counts as contact; None: the default for the two fingers.
        block: Solutions in a block, about.

    Returns:
        Blocks in the order of the solutions; their counts add up to all systems.

    Raises:
        ParameterError: The fingers are not opposable, or the levels no control set.
        UnknownNameError: There is no finger of that name.
    """
    block = checks.integer("block", block, 1, 2**40)
    return _blocks(Search.of(foot, pair, levels, placement, criteria), block)


def count_systems(foot: Foot, pair: Pair, levels: Levels = DEFAULT_LEVELS) -> int:
    """Number of 2×2 systems that `stable_branches` solves: (2·Σₖ nᵏ)·(2·Σₖ nᵏ).

    Args:
        foot: The foot.
        pair: Two opposable fingers, by name or by number from 1.
        levels: The control set.

    Returns:
        The number.

    Raises:
        ParameterError: The fingers are not opposable, or the levels no control set.
        UnknownNameError: There is no finger of that name.
    """
    return _systems(Search.of(foot, pair, levels))


def _systems(search: Search) -> int:
    """Number of 2×2 systems of a search."""
    return search.lines[0] * search.lines[1]


def _check_memory(search: Search, max_bytes: int | None) -> None:
    """Refuse solutions that do not fit; count them where there may be too many."""
    # While they are joined they are there twice.
    each, systems = 2 * search.bytes_each, _systems(search)
    most = memory.limit(max_bytes)
    if systems * each <= most:
        return
    count = sum(len(found.height) for found, _ in _found(search))
    what = f"{count} solutions of {systems} systems"
    remedy = "stream them with iter_stable_branches, or take fewer levels"
    memory.require(what, count * each, most, remedy)


def _blocks(search: Search, block: int) -> Iterator[BranchSolutions]:
    """The solutions with their verdicts, about so many at a time."""
    held: list[Found] = []
    counts, size = SystemCounts(), 0
    for found, more in _found(search):
        counts += more
        # At least one part: an empty one brings its counts.
        for start in range(0, max(1, len(found.height)), block):
            held.append(taken(found, slice(start, start + block)))
            size += len(held[-1].height)
            if size >= block:
                yield with_verdicts(search, held, counts)
                held, counts, size = [], SystemCounts(), 0
    if held:
        yield with_verdicts(search, held, counts)


def _found(search: Search) -> Iterator[tuple[Found, SystemCounts]]:
    """Solutions of all systems, and what became of the systems."""
    missing = _systems(search)
    for one in _lines(search, 0):
        for other in _lines(search, 1):
            missing -= len(one) * len(other)
            where, counts = crossings(search.foot, search.placement, one, other)
            found = Found.at(one, other, where)
            yield found, counts
    if missing:
        yield (
            taken(found, slice(0)),
            SystemCounts(systems=missing, along_axis=missing),
        )


def _lines(search: Search, finger: int) -> Iterator[TangentLines]:
    """Blocks of a finger's tangent lines."""
    return line_blocks(search.foot, finger, search.levels, search.placement)
