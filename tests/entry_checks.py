"""What tests of the paper's entries share: numbers, other feet, pictures."""

from __future__ import annotations

import struct

from zygopin import Foot

SANE = 700, 3000
"""Least and largest side of a picture [pixels]; the least for its width."""


def numbers(entry):
    """Values of an entry's measurements by their names, which are all different."""
    found = {each.name: each.value for each in entry.measurements}
    assert len(found) == len(entry.measurements)
    return found


def broken(entry):
    """Names of the measurements that do not hold."""
    return {each.name for each in entry.measurements if not each.holds}


def with_other_feet(monkeypatch, module, change):
    """Let a module's presets be changed feet."""

    class Other:
        """Stands for Foot where presets are made."""

        @staticmethod
        def preset(name):
            """A preset, changed."""
            return change(Foot.preset(name))

    monkeypatch.setattr(module, "Foot", Other)


def check_texts(entry):
    """Every text is there, and TeX ends where it begins."""
    texts = [entry.title, entry.place, entry.printed, entry.finding]
    texts += [each.words for each in entry.measurements]
    texts += [each.caption for each in (*entry.figures, *entry.scenes)]
    assert all(texts)
    for text in (*texts, entry.ours):
        assert text.count("$") % 2 == 0, text
        assert not any(sign in text for sign in "\a\b\f\n\r\t\v"), text


def check_exhibits(entry, folder):
    """Every picture and scene is written under its name, and is no empty one."""
    for exhibit in (*entry.figures, *entry.scenes):
        path = folder / exhibit.name
        exhibit.write(path)
        content = path.read_bytes()
        if path.suffix == ".html":
            assert len(content) > 100_000
            assert b"</html>" in content
            continue
        assert content.startswith(b"\x89PNG")
        width, height = struct.unpack(">II", content[16:24])
        assert SANE[0] <= width <= SANE[1]
        assert height <= SANE[1]
        assert len(content) > 20_000
