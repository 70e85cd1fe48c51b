"""No command takes what is no good: one line, status 2, nothing written."""

from __future__ import annotations

import pytest
from bad_commands import Row, furnish, rows

LONGEST = 700
"""Characters of a complaint: a line, with room for a path."""


def complaint(run, row: Row, text: str) -> str:
    """What is wrong with how a bad text is refused; empty where nothing is."""
    try:
        result = run(*row.arguments(text))
    except Exception as error:
        return f"{type(error).__name__}: {error}"[:300]
    if result.returncode != 2 or result.stdout:
        said = f"{result.stdout[:60]!r}, {result.stderr[:99]!r}"
        return f"status {result.returncode}, {said}"
    first, *others = result.stderr.splitlines()
    if others or not first.startswith("zygopin: ") or len(first) > LONGEST:
        return f"not one line: {result.stderr[:300]!r}"
    return ""


@pytest.mark.parametrize("row", [*rows()], ids=lambda row: f"{row.command} {row.name}")
def test_bad_texts_are_refused_in_one_line(row, run, tmp_path, monkeypatch):
    furnish(tmp_path)
    monkeypatch.chdir(tmp_path)
    before = sorted(tmp_path.rglob("*"))
    found = []
    for text in row.texts:
        wrong = complaint(run, row, text)
        if wrong:
            found.append(f"{row.command} {row.name}={text[:30]!r}: {wrong}")
    assert not found, "\n".join(found)
    assert sorted(tmp_path.rglob("*")) == before
    assert (tmp_path / "kept").read_text() == "kept"
