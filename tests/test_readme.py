"""The README is true: its Python runs and prints what it says, its commands work."""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent
README = (ROOT / "README.md").read_text(encoding="utf-8")
SNIPPETS = re.findall(r"```python\n(.*?)```\n\n```text\n(.*?)```", README, re.DOTALL)
COMMANDS = re.findall(r"^zygopin [^#\n]*", README, re.MULTILINE)


@pytest.mark.parametrize(("code", "printed"), SNIPPETS)
def test_snippets_print_what_the_readme_says(code, printed):
    result = subprocess.run(
        [sys.executable, "-W", "error", "-c", code],
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.stderr == ""
    assert result.stdout == printed


def test_every_python_block_has_its_output():
    assert len(SNIPPETS) == README.count("```python") == 4


def test_the_commands_work_in_the_order_of_the_readme(tmp_path):
    assert len(COMMANDS) == 16
    for line in COMMANDS:
        words, _, file = line.partition(">")
        result = subprocess.run(
            [sys.executable, "-m", *shlex.split(words)],
            capture_output=True,
            text=True,
            check=False,
            cwd=tmp_path,
        )
        assert result.returncode == 0, f"{line}: {result.stderr}"
        if file:
            (tmp_path / file.strip()).write_text(result.stdout)
    assert (tmp_path / "perch.html").exists()
    assert (tmp_path / "my_owl" / "foot.urdf").exists()


def test_links_lead_to_files():
    for target in re.findall(r"\]\(([^)#]+)\)", README):
        assert (ROOT / target).exists(), target


def test_presets_of_the_table_are_those_that_exist():
    listed = set(re.findall(r"^\| `([a-z-]+)` \|", README, re.MULTILINE))
    assert listed == {path.stem for path in (ROOT / "urdf/presets").glob("*.yaml")}


def test_the_foot_file_of_the_readme_grasps(tmp_path):
    (text,) = re.findall(r"```yaml\n(.*?)```", README, re.DOTALL)
    file = tmp_path / "foot.yaml"
    file.write_text(text)
    command = ["perch", "--foot", str(file), "--radius-mm", "12"]
    result = subprocess.run(
        [sys.executable, "-m", "zygopin", *command],
        capture_output=True,
        text=True,
        check=False,
    )
    assert result.returncode == 0, result.stderr
