"""Every tool puts the tips where they are, and weighs and measures the foot aright."""

from __future__ import annotations

import os

import pytest
from compare import differences, mimic
from suite import Outcome
from tools import TOOLS

EVERY_TOOL = pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.reader)


def present(tool, outcome: Outcome) -> dict:
    """The answers of a tool that is there; a missing one fails where CI is set."""
    if outcome.missing:
        report = pytest.fail if os.environ.get("CI") else pytest.skip
        report(f"{tool.title} cannot be asked: {outcome.missing}")
    assert not outcome.failure, f"{tool.title}: {outcome.failure}"
    return outcome.answers


@EVERY_TOOL
def test_a_tool_loads_every_file_that_it_can(tool, outcomes, references):
    answers = present(tool, outcomes[tool].result())
    assert set(answers) == set(references)
    for name, right in references.items():
        error = answers[name].get("error", "")
        if right.least_inertia < tool.least_inertia:
            assert "inertia" in error, f"{name}: no longer refused"
        else:
            assert not error, f"{name}: {error}"


@EVERY_TOOL
def test_what_a_tool_answers_is_right(tool, outcomes, references):
    answers = present(tool, outcomes[tool].result())
    found = [
        each
        for name, right in references.items()
        if "error" not in answers[name]
        for each in differences(tool, right, answers[name])
    ]
    assert found
    assert [each for each in found if each.too_large] == []


@EVERY_TOOL
def test_a_tool_makes_of_mimic_what_its_row_says(tool, outcomes, references):
    answers = present(tool, outcomes[tool].result())
    verdicts = {
        name: mimic(tool, right, answers[name])
        for name, right in references.items()
        if right.case.followers and "error" not in answers[name]
    }
    assert verdicts
    assert set(verdicts.values()) == {tool.mimic}, verdicts
