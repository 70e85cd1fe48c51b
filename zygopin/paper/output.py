"""The report as a folder of files: the page, its pictures, its scenes, its numbers."""

from __future__ import annotations

import json
from collections.abc import Iterator
from pathlib import Path

from zygopin.files import check_folder, within, write_text
from zygopin.paper.document import paper_document
from zygopin.paper.entry import Entry
from zygopin.paper.page import page
from zygopin.paper.report import PaperReport, gathered, iter_entries

PAGE, NUMBERS = "report.html", "report.json"
"""Names of the page, and of the numbers."""


def write_paper_report(folder: Path | str) -> PaperReport:
    """Recompute the paper and write what came of it.

    `report.html`, one page that works offline; `report.json`, its numbers in the
    paper's units and radians; `figures/`, its pictures as PNG; `scenes/`, scenes to
    turn, which the page links. The same version writes the same bytes.

    Args:
        folder: Where to; created if it is missing.

    Returns:
        The report.

    Raises:
        MissingExtraError: The packages of the extra `paper` are not installed.
        FileError: A file cannot be written.
    """
    return gathered(list(iter_paper_report(folder)))


def iter_paper_report(folder: Path | str) -> Iterator[tuple[str, Entry]]:
    """Recompute the paper entry by entry, each one's files being written with it.

    The page and the numbers come last, when all has been yielded.

    Args:
        folder: Where to; created if it is missing.

    Yields:
        The chapter's title, and the entry.

    Raises:
        FileError: A file cannot be written.
    """
    check_folder(folder)
    done, pictures = [], {}
    for title, entry in iter_entries():
        for figure in entry.figures:
            path = within(folder, "figures", figure.name)
            figure.write(path)
            pictures[figure.name] = path.read_bytes()
        for scene in entry.scenes:
            scene.write(within(folder, "scenes", scene.name))
        done.append((title, entry))
        yield title, entry
    report = gathered(done)
    document = paper_document(report)
    text = json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False)
    write_text(within(folder, NUMBERS), text + "\n")
    write_text(within(folder, PAGE), page(report, pictures))
