"""Tables of the README that scripts write between their marks."""

from __future__ import annotations

import json
import sys

import pytest
from readme_table import ReadmeTable, markdown


@pytest.fixture
def table(tmp_path):
    results = tmp_path / "results.json"
    results.write_text(json.dumps({"one": 1}))
    return ReadmeTable("made-table", "the table of things", results, _made)


def _made(results):
    return markdown(("thing", "number"), [(k, str(v)) for k, v in results.items()])


@pytest.fixture
def readme(table, tmp_path):
    file = tmp_path / "README.md"
    file.write_text(f"# a\n\n{table.start}\nold\n{table.end}\nz\n")
    return file


def test_a_stale_table_is_renewed_and_the_rest_is_kept(table, readme):
    fresh = table.renewed(readme.read_text(), {"one": 1})
    lines = "| thing | number |\n| --- | --- |\n| one | 1 |\n"
    assert fresh == f"# a\n\n{table.start}\n\n{lines}\n{table.end}\nz\n"
    assert table.renewed(fresh, {"one": 1}) == fresh


def test_a_stale_table_is_named_and_left_alone_by_check(
    table, readme, monkeypatch, capsys
):
    stale = readme.read_text()
    monkeypatch.setattr(sys, "argv", ["made-table", "--check"])
    assert table.main("", readme) == 1
    said = "stale: the table of things in README.md; run scripts/made-table\n"
    assert capsys.readouterr().out == said
    assert readme.read_text() == stale


def test_a_stale_table_is_written_and_then_fresh(table, readme, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["made-table"])
    assert table.main("", readme) == 0
    assert capsys.readouterr().out == "renewed: the table of things in README.md\n"
    monkeypatch.setattr(sys, "argv", ["made-table", "--check"])
    assert table.main("", readme) == 0
    assert capsys.readouterr().out == ""
    assert "| one | 1 |" in readme.read_text()


def test_a_readme_without_the_marks_is_refused(table):
    with pytest.raises(ValueError, match="needs the lines"):
        table.renewed("# no marks", {})
