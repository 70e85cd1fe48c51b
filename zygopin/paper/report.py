"""All entries, in the paper's order, as one report."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from itertools import groupby

from zygopin.paper import (
    back_toes,
    branch_section,
    caption_radius,
    convexity,
    curves,
    ellipse_errata,
    finger_model,
    grasp_readings,
    owl_poses,
    planes,
    reachable,
    small_slips,
    stability,
    talon_path,
    tangency,
    tangency_errata,
    tendon_map,
    tendon_print,
    turning_toe,
    whole_foot,
    workspace,
    zero_product,
)
from zygopin.paper.entry import Entry

_CHAPTERS: dict[str, tuple[Callable[[], Entry], ...]] = {
    "One finger on the complex plane": (
        finger_model.figure_1,
        finger_model.control_system,
        reachable.contractions,
        reachable.proposition_1,
        reachable.erratum_5,
    ),
    "The foot": (
        whole_foot.figure_2,
        planes.erratum_1,
        whole_foot.opposable_fingers,
        back_toes.erratum_2,
        back_toes.erratum_3,
        workspace.algorithm,
        workspace.figure_3,
    ),
    "Perching on a branch": (
        branch_section.figure_4,
        curves.phalanx_parametrisation,
        curves.ellipse_parametrisation,
        ellipse_errata.erratum_4,
        ellipse_errata.ellipse_centre,
        tangency.tangency_system,
        tangency_errata.erratum_6,
        tangency_errata.erratum_7,
        caption_radius.figure_5,
        caption_radius.erratum_13,
        stability.proposition_2,
        stability.erratum_9,
        zero_product.erratum_8,
        grasp_readings.scalar_product,
    ),
    "The owl's foot": (
        owl_poses.figure_6,
        turning_toe.erratum_14,
        talon_path.figure_7,
        tendon_print.erratum_12,
        tendon_map.tlm_map,
        tendon_print.erratum_10,
        convexity.erratum_11,
    ),
    "Smaller slips": (small_slips.smaller_slips,),
}
"""What makes each entry, by chapter: sections 2 and 3, 4, 4.1, 5 of the paper; all."""

ENTRIES = sum(map(len, _CHAPTERS.values()))
"""Number of entries."""


@dataclass(frozen=True, eq=False)
class Chapter:
    """Entries on one part of the paper.

    Attributes:
        title: Its heading.
        entries: The entries, in the paper's order.
    """

    title: str
    entries: tuple[Entry, ...]


@dataclass(frozen=True, eq=False)
class PaperReport:
    """The paper recomputed.

    Attributes:
        chapters: Its parts, in the paper's order.
    """

    chapters: tuple[Chapter, ...]

    @property
    def entries(self) -> tuple[Entry, ...]:
        """All entries, in the paper's order."""
        return tuple(entry for part in self.chapters for entry in part.entries)

    @property
    def holds(self) -> bool:
        """Whether every number is as it must be."""
        return all(entry.holds for entry in self.entries)


def iter_entries() -> Iterator[tuple[str, Entry]]:
    """The entries one by one, as they are computed.

    Yields:
        The chapter's title, and the entry: `ENTRIES` pairs.
    """
    for title, makers in _CHAPTERS.items():
        for make in makers:
            yield title, make()


def gathered(entries: list[tuple[str, Entry]]) -> PaperReport:
    """Entries as a report.

    Args:
        entries: What `iter_entries` yields.

    Returns:
        The report.
    """
    parts = groupby(entries, lambda pair: pair[0])
    return PaperReport(
        tuple(
            Chapter(title, tuple(entry for _, entry in part)) for title, part in parts
        )
    )


def paper_report() -> PaperReport:
    """Recompute the paper: its figures' and statements' numbers, and its errata.

    Returns:
        The report: every number with what it is held against. Nothing is drawn; that is
        for `write_paper_report`.
    """
    return gathered(list(iter_entries()))
