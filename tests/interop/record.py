"""What was measured, as a file that the README's table is made from."""

from __future__ import annotations

import json
from collections.abc import Mapping
from pathlib import Path

from compare import differences, mimic
from reference import Reference
from suite import Outcome
from tools import TOOLS, Tool

RESULTS = Path(__file__).with_name("results.json")


def write(found: Mapping[Tool, Outcome], references: Mapping[str, Reference]) -> None:
    """Renew the rows of tools that were asked; others stay as they are.

    Args:
        found: What each tool left.
        references: The right answers, by the case's name.
    """
    old = json.loads(RESULTS.read_text()) if RESULTS.exists() else {}
    new = {
        tool.title: row(tool, outcome, references)
        for tool, outcome in found.items()
        if outcome.answers
    }
    titles = {tool.title for tool in TOOLS}
    rows = {title: row for title, row in {**old, **new}.items() if title in titles}
    text = json.dumps(rows, indent=2, sort_keys=True, ensure_ascii=False)
    RESULTS.write_text(text + "\n", encoding="utf-8")


def row(tool: Tool, outcome: Outcome, references: Mapping[str, Reference]) -> dict:
    """One tool's row.

    Args:
        tool: The tool.
        outcome: What it left.
        references: The right answers, by the case's name.

    Returns:
        Plain values: the largest differences of all files, and words.
    """
    loaded = {
        name: answer
        for name, answer in outcome.answers.items()
        if "error" not in answer
    }
    largest: dict[str, float] = {}
    verdicts = set()
    for name, answer in loaded.items():
        right = references[name]
        for each in differences(tool, right, answer):
            worst = max(each.value, largest.get(each.quantity, 0.0))
            largest[each.quantity] = worst
        if right.case.followers:
            verdicts.add(mimic(tool, right, answer))
    return {
        "version": tool.version(),
        "files": len(outcome.answers),
        "loads": len(loaded),
        "largest_differences": {name: rounded(x) for name, x in largest.items()},
        "mimic": " / ".join(sorted(verdicts)),
        "notes": [*tool.notes, *refusal(tool, outcome, loaded)],
        "said": [*outcome.said],
    }


def refusal(tool: Tool, outcome: Outcome, loaded: dict) -> list[str]:
    """What to know of a tool that refused a file."""
    if len(loaded) == len(outcome.answers):
        return []
    least = f"{tool.least_inertia:.0e} kg m²"
    return [f"Refuses a file with a moment of inertia below {least}."]


def rounded(value: float) -> float:
    """A difference to one digit: what a machine can be held to."""
    return float(f"{value:.0e}")
