"""Each tool in a process of its own: what it answered, and what it said meanwhile."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path

from cases import Case
from tools import Tool

HERE = Path(__file__).parent
TIME_LIMIT = 600
"""Seconds that a tool may take for all files; the slowest takes twenty."""

LINES = 6
"""Different lines of a tool's output that are kept."""


@dataclass(frozen=True)
class Outcome:
    """What one tool's process left behind.

    Attributes:
        answers: Answers by the case's name; empty where the process failed.
        missing: Why the tool cannot be imported, or is not there; empty if it can.
        failure: How the process ended, if it left no answers; empty otherwise.
        said: The first different lines that it printed.
    """

    answers: dict
    missing: str = ""
    failure: str = ""
    said: tuple[str, ...] = ()


def write_questions(cases: Iterable[Case], folder: Path) -> Path:
    """Write the URDFs and the list of what is asked about them.

    Args:
        cases: The cases.
        folder: Where to.

    Returns:
        The list's file.
    """
    file = folder / "questions.json"
    file.write_text(json.dumps([case.question(folder) for case in cases]))
    return file


def ask(tool: Tool, questions: Path) -> Outcome:
    """Run one tool's reader over all files.

    Args:
        tool: The tool.
        questions: What `write_questions` wrote.

    Returns:
        The outcome, whatever happens in that process.
    """
    if not tool.version():
        return Outcome({}, missing=f"{tool.package} is not installed")
    file = questions.with_name(f"{tool.reader}.json")
    command = [sys.executable, str(HERE / "run.py"), tool.reader, questions, file]
    try:
        status, text = _run(command, questions.with_name(f"{tool.reader}.log"))
    except subprocess.TimeoutExpired:
        return Outcome({}, failure=f"no answer in {TIME_LIMIT} s")
    if status:
        last = text.strip().splitlines()[-3:]
        return Outcome({}, failure=f"exit status {status}: {last}")
    answers = json.loads(file.read_text())
    missing = answers.pop("import", "")
    return Outcome(answers, missing=missing, said=digest(text))


def _run(command: list, log: Path) -> tuple[int, str]:
    """The exit status of a command, and all that it printed."""
    environment = {**os.environ, "OMP_NUM_THREADS": "1"}
    environment.pop("PYTHONWARNINGS", None)  # warnings as users see them
    with log.open("w+b") as output:
        done = subprocess.run(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=subprocess.STDOUT,
            env=environment,
            timeout=TIME_LIMIT,
        )
    return done.returncode, log.read_text(errors="replace")


def digest(text: str) -> tuple[str, ...]:
    """The first different lines, without what changes from file to file.

    Args:
        text: All that a tool printed.

    Returns:
        At most LINES lines, in order.
    """
    lines = {}
    for line in text.splitlines():
        line = re.sub(r"\S*/(?=[\w.-]+\.(py|urdf|sdf)\b)", "", line)
        line = re.sub(r"\[@?[^\]]*\]|\b[a-z]+\d?_(tip|phalanx|joint)\w*", "…", line)
        line = re.sub(r"\d+", "#", line).strip()
        if re.search(r"\w", line):
            lines.setdefault(line[:160], None)
    return tuple(lines)[:LINES]
