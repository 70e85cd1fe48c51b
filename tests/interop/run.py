"""Ask one tool about files, in a process of its own.

    python run.py TOOL QUESTIONS.json ANSWERS.json

A reader module has a class `Robot` with `poses(angles)`, and with those of OPTIONAL
that its tool can answer. What raises is answered by its traceback, for one file.
"""

from __future__ import annotations

import importlib
import json
import sys
import traceback
from pathlib import Path

import numpy as np

OPTIONAL = ("mass", "limits", "shapes", "links", "parents", "mimics", "constraints")
"""Questions about a file as it stands."""

POSED = ("poses", "centre")
"""Questions about a pose."""


def ask(reader, case: dict) -> dict:
    """One file's answers, or how it failed."""
    try:
        return answers_of(reader, case)
    except Exception:
        return {"error": traceback.format_exc(limit=-3)}


def answers_of(reader, case: dict) -> dict:
    """One file's answers."""
    robot = reader.Robot(case)
    found = {name: getattr(robot, name)() for name in OPTIONAL if hasattr(robot, name)}
    poses = case["configurations"]
    for name in POSED:
        if hasattr(robot, name):
            found[name] = [plain(getattr(robot, name)(angles)) for angles in poses]
    if hasattr(robot, "distances"):
        asked = zip(poses, case["pairs"], strict=True)
        found["distances"] = [robot.distances(*each) for each in asked]
    if hasattr(robot, "poses"):
        found["led"] = plain(robot.poses(case["leading"]))
    return found


def plain(value):
    """Arrays as lists, for JSON."""
    if isinstance(value, dict):
        return {name: plain(each) for name, each in value.items()}
    return np.asarray(value, dtype=float).tolist()


def main(tool: str, questions: str, answers: str) -> None:
    """Read the questions, write the answers."""
    found = {}
    try:
        reader = importlib.import_module(f"readers.{tool}")
    except Exception:  # some tools raise more than ImportError
        found["import"] = traceback.format_exc(limit=-3)
    else:
        for case in json.loads(Path(questions).read_text()):
            found[case["name"]] = ask(reader, case)
    Path(answers).write_text(json.dumps(found))


if __name__ == "__main__":
    main(*sys.argv[1:])
