"""The caption's words and numbers."""

import dataclasses
import html

import numpy as np
import pytest

from zygopin.branch import Branch
from zygopin.caption import (
    Key,
    branch_rows,
    caption,
    contact_rows,
    foot_rows,
    verdict_words,
)
from zygopin.foot import Foot
from zygopin.grasp import check_grasp

NEITHER = {"grasping": False, "stable": False}


@pytest.fixture
def report():
    return check_grasp(Foot.preset("paper"), np.ones(14), Branch(0.65, (0, 0, -0.65)))


def with_verdict(report, **verdict):
    return dataclasses.replace(
        report, **{name: np.array(value) for name, value in verdict.items()}
    )


@pytest.mark.parametrize(
    ("verdict", "words"),
    [
        ({"grasping": True, "stable": True, "feasible": True}, "Grasping, feasible"),
        (
            {"grasping": False, "stable": True, "feasible": True},
            "Stable, not grasping, feasible",
        ),
        (
            {"grasping": True, "stable": True, "feasible": False},
            "Grasping, not feasible: a phalanx penetrates",
        ),
        (
            {**NEITHER, "feasible": False, "penetrating": [False] * 14}
            | {"touching": [True] * 14},
            "Touching, not stable, not feasible: fingers collide",
        ),
        (
            {**NEITHER, "feasible": True, "tangent": [False] * 14}
            | {"touching": [False] * 14},
            "Nothing tangent to the branch, feasible",
        ),
    ],
)
def test_verdict_is_said_in_words(report, verdict, words):
    assert verdict_words(with_verdict(report, **verdict)) == words


def test_fingers_that_collide_are_named_as_the_reason(report):
    clear = {"penetrating": np.zeros(14, bool), "feasible": False}
    words = verdict_words(with_verdict(report, **clear))
    assert words.endswith("not feasible: fingers collide")


def test_lengths_are_in_millimetres(report):
    assert branch_rows(report)["Radius"] == "650.0 mm"
    assert branch_rows(report)["Height"] == "−650.0 mm"
    assert foot_rows(report.foot)["Scale"] == "1000.0 mm"
    assert foot_rows(report.foot)["Largest angle ω"] == "30.00°"


def test_small_feet_get_more_decimals():
    foot, branch = Foot.preset("parrot"), Branch(0.008, (0, 0, -0.02))
    report = check_grasp(foot, np.zeros(14), branch)
    assert branch_rows(report)["Radius"] == "8.000 mm"
    assert "Least clearance" in contact_rows(report)


def test_missing_and_tiny_numbers_are_said_plainly(report):
    nothing = {"scalar_product": np.nan, "finger_clearance": np.inf}
    rows = contact_rows(with_verdict(report, **nothing))
    assert rows["Scalar product"] == rows["Between fingers"] == "none"
    rows = contact_rows(with_verdict(report, finger_clearance=-1e-17))
    assert rows["Between fingers"] == "0.0 mm"


def test_every_text_is_escaped(report):
    nasty = "<b onclick='x'>&"
    text = caption(report, nasty, '"><i>', [Key('"><i>', nasty)])
    assert "<b" not in text
    assert "<i>" not in text
    assert text.count(html.escape(nasty)) == 2
