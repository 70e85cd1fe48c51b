"""The README's table of tools is made from what was measured."""

from __future__ import annotations

import json
import subprocess
import sys
from importlib.machinery import SourceFileLoader
from importlib.util import module_from_spec, spec_from_loader
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
SCRIPT = ROOT / "scripts" / "interop-table"
ROW = {
    "version": "1.2",
    "files": 18,
    "loads": 18,
    "largest_differences": {"position": 2e-16, "rotation": 5e-16, "mass": 1.0},
    "mimic": "honoured",
    "notes": [],
}


@pytest.fixture(scope="module")
def script():
    loader = SourceFileLoader("interop_table", str(SCRIPT))
    module = module_from_spec(spec_from_loader("interop_table", loader))
    loader.exec_module(module)
    return module


def test_the_table_of_the_readme_is_fresh():
    command = [sys.executable, str(SCRIPT), "--check"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")


def test_the_table_has_a_row_for_each_tool_that_was_measured(script):
    results = json.loads(script.RESULTS.read_text(encoding="utf-8"))
    lines = script.table(results).splitlines()
    titles = {
        line.split(" | ")[0].removeprefix("| ") for line in lines[2:] if "|" in line
    }
    assert titles == set(results)
    assert len(titles) >= 15


def test_a_row_by_hand(script):
    lines = script.table({"Tool": ROW}).splitlines()
    assert lines[2] == "| Tool | 1.2 | all 18 | 5e-16 | honoured |  |"


def test_files_that_do_not_load_are_counted(script):
    assert script.loads(ROW | {"loads": 8}) == "8 of 18"


def test_a_parser_that_moves_nothing_has_no_difference(script):
    assert script.difference(ROW | {"largest_differences": {"parents": 0.0}}) == "-"


def test_notes_that_tools_share_are_written_once(script):
    first = ROW | {"notes": ["One.", "Two."]}
    second = ROW | {"notes": ["Three.", "One."]}
    lines = script.table({"b": second, "A": first}).splitlines()
    assert [line.rpartition(" | ")[2] for line in lines[2:4]] == ["1, 2 |", "1, 3 |"]
    assert lines[5:] == ["1. One.", "2. Two.", "3. Three."]
