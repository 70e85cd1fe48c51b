"""What the tests of the paper's entries share."""

from __future__ import annotations

from pathlib import Path

from PIL import Image

from zygopin.paper.entry import Entry


def numbers(entry: Entry) -> dict[str, float]:
    """An entry's numbers by name; the entry holds, and names each number once."""
    broken = [each.name for each in entry.measurements if not each.holds]
    assert not broken, broken
    named = {each.name: each.value for each in entry.measurements}
    assert len(named) == len(entry.measurements)
    return named


def broken(entry: Entry) -> set[str]:
    """Names of the numbers that do not hold."""
    return {each.name for each in entry.measurements if not each.holds}


def check_exhibits(entry: Entry, folder: Path) -> None:
    """Every picture and scene is written, of a sane size, twice the same."""
    for exhibit in (*entry.figures, *entry.scenes):
        first, second = folder / exhibit.name, folder / f"again-{exhibit.name}"
        exhibit.write(first)
        exhibit.write(second)
        assert first.read_bytes() == second.read_bytes()
        if first.suffix == ".png":
            with Image.open(first) as picture:
                assert all(400 <= side <= 2000 for side in picture.size)
                assert len(picture.convert("L").getcolors()) > 20
        else:
            assert "<html" in first.read_text(encoding="utf-8")[:2000]
