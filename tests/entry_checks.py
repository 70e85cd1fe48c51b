"""What tests of the paper's entries share: numbers, other feet, texts, pictures."""

from __future__ import annotations

from pathlib import Path

import pytest
from PIL import Image

from zygopin import Foot
from zygopin.paper.entry import Entry

SIDES = 400, 2000
"""Least and largest side of a picture [pixels]."""

WIDE = 700
"""Least width of a picture [pixels]."""


def numbers(entry: Entry) -> dict[str, float]:
    """An entry's numbers by name; the entry holds, and names each number once."""
    assert broken(entry) == set()
    named = {each.name: each.value for each in entry.measurements}
    assert len(named) == len(entry.measurements)
    return named


def broken(entry: Entry) -> set[str]:
    """Names of the numbers that do not hold."""
    return {each.name for each in entry.measurements if not each.holds}


def with_other_feet(monkeypatch: pytest.MonkeyPatch, module, change) -> None:
    """Let a module's presets be changed feet."""

    class Other:
        """Stands for Foot where presets are made."""

        @staticmethod
        def preset(name: str) -> Foot:
            """A preset, changed."""
            return change(Foot.preset(name))

    monkeypatch.setattr(module, "Foot", Other)


def check_texts(entry: Entry) -> None:
    """Every text is there, and TeX ends where it begins."""
    texts = [entry.title, entry.place, entry.printed, entry.finding]
    texts += [each.words for each in entry.measurements]
    texts += [each.caption for each in (*entry.figures, *entry.scenes)]
    assert all(texts)
    for text in (*texts, entry.ours):
        assert text.count("$") % 2 == 0, text
        assert not any(sign in text for sign in "\a\b\f\n\r\t\v"), text


def check_exhibits(entry: Entry, folder: Path) -> None:
    """Every picture and scene is written, of a sane size, twice the same."""
    for exhibit in (*entry.figures, *entry.scenes):
        first, second = folder / exhibit.name, folder / f"again-{exhibit.name}"
        exhibit.write(first)
        exhibit.write(second)
        content = first.read_bytes()
        assert content == second.read_bytes()
        if first.suffix == ".png":
            assert len(content) > 20_000
            with Image.open(first) as picture:
                assert all(SIDES[0] <= side <= SIDES[1] for side in picture.size)
                assert picture.width >= WIDE
                assert len(picture.convert("L").getcolors()) > 20
        else:
            assert len(content) > 100_000
            assert b"<html" in content[:2000]
            assert b"</html>" in content
