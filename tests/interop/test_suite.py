"""The suite can fail: spoilt files, crashed tools and missing ones are noticed."""

from __future__ import annotations

import dataclasses
import math
import re

import pytest
import suite
from cases import make_case, random_foot
from compare import Difference, differences, mimic
from reference import Reference
from suite import Outcome, ask, digest, write_questions
from test_tools import present
from tools import TOOLS

from zygopin.foot import Foot

TOOL = {tool.reader: tool for tool in TOOLS}
OWL, TENDON = (
    Reference(make_case(Foot.preset("owl"), tendon=t)) for t in (False, True)
)


def spoilt(folder, old, new, *, reader="urchin", right=OWL):
    """Answers about a file in which the first `old` is `new`."""
    assert old in right.case.urdf
    text = right.case.urdf.replace(old, new, 1)
    case = dataclasses.replace(right.case, urdf=text)
    outcome = ask(TOOL[reader], write_questions([case], folder))
    return outcome.answers[case.name]


def wrong(answer, *, reader="urchin", right=OWL):
    found = differences(TOOL[reader], right, answer)
    return {each.quantity for each in found if each.too_large}


def test_an_unspoilt_file_is_right(tmp_path):
    assert wrong(spoilt(tmp_path, "owl", "owl")) == set()


@pytest.mark.parametrize("reader", ["urchin", "pinocchio"])
def test_a_wrong_origin_is_noticed(tmp_path, reader):
    answer = spoilt(
        tmp_path, "0 0.0 2.8797932657906435", "0 0.0 2.8797933", reader=reader
    )
    assert {"position", "rotation"} <= wrong(answer, reader=reader)


def test_a_wrong_offset_is_noticed(tmp_path):
    offset = f'<origin rpy="0 0 0" xyz="{OWL.case.foot.lengths[0]} 0 0"/>\n    <axis'
    answer = spoilt(tmp_path, offset, offset.replace("0.0254", "0.0255"))
    assert "position" in wrong(answer)
    assert "rotation" not in wrong(answer)


def test_a_wrong_limit_is_noticed(tmp_path):
    limit = f'upper="{OWL.case.foot.omega}"'
    assert wrong(spoilt(tmp_path, limit, 'upper="1.5"')) == {"limits"}


def test_a_wrong_mass_is_noticed(tmp_path):
    mass = f'<mass value="{OWL.masses["finger1_phalanx1"]}"/>'
    answer = spoilt(tmp_path, mass, '<mass value="0.00193"/>', reader="pinocchio")
    assert wrong(answer, reader="pinocchio") == {"mass", "centre of mass"}


def test_a_wrong_radius_is_noticed(tmp_path):
    link, *_ = OWL.case.gaps[0][0]
    start = OWL.case.urdf.index(f'<collision name="{link}_rod"')
    rod = OWL.case.urdf[start:].partition("</collision>")[0]
    thicker = re.sub('radius="[^"]*"', 'radius="0.0045"', rod)
    answer = spoilt(tmp_path, rod, thicker, reader="pinocchio")
    assert wrong(answer, reader="pinocchio") == {"distances"}


def test_a_missing_shape_is_noticed(tmp_path):
    start = OWL.case.urdf.index("<collision name")
    end = OWL.case.urdf.index("</collision>") + len("</collision>")
    answer = spoilt(tmp_path, OWL.case.urdf[start:end], "")
    assert wrong(answer) == {"collision shapes"}


def test_another_parent_is_noticed(tmp_path):
    old = '<parent link="foot"/>\n    <child link="finger2_phalanx1"/>'
    new = old.replace('parent link="foot"', 'parent link="finger1_phalanx1"')
    answer = spoilt(tmp_path, old, new, reader="check_urdf")
    assert wrong(answer, reader="check_urdf") == {"parents"}


def test_a_wrong_multiplier_is_noticed(tmp_path):
    answer = spoilt(tmp_path, 'multiplier="1"', 'multiplier="0.9"', right=TENDON)
    assert mimic(TOOL["urchin"], TENDON, answer).startswith("wrong mimics")


def test_a_missing_mimic_is_noticed(tmp_path):
    element = '<mimic joint="finger1_joint1" multiplier="1" offset="0"/>'
    answer = spoilt(tmp_path, element, "", right=TENDON)
    assert mimic(TOOL["urchin"], TENDON, answer).startswith("wrong mimics")
    del answer["mimics"]
    assert mimic(TOOL["urchin"], TENDON, answer).startswith("wrong: the followers")


@pytest.mark.parametrize(("moment", "refused"), [(0.99e-14, True), (1.01e-14, False)])
def test_mujoco_refuses_the_moment_of_inertia_that_its_row_names(
    tmp_path, moment, refused
):
    tip = OWL.case.urdf.partition('<link name="finger1_tip">')[2].partition("</link>")[
        0
    ]
    smaller = re.sub('(i..)="[^0"][^"]*"', rf'\1="{moment}"', tip)
    case = dataclasses.replace(OWL.case, urdf=OWL.case.urdf.replace(tip, smaller))
    outcome = ask(TOOL["mujoco"], write_questions([case], tmp_path))
    answer = present(TOOL["mujoco"], outcome)["owl"]
    assert ("inertia" in answer.get("error", "")) == refused


@pytest.mark.parametrize(
    ("value", "too_large"),
    [(0.0, False), (1e-9, False), (2e-9, True), (math.inf, True), (math.nan, True)],
)
def test_what_is_no_number_is_too_large(value, too_large):
    assert Difference("position", "owl", value, 1e-9).too_large == too_large


def test_a_joint_without_limits_is_noticed():
    answer = {"limits": dict(list(OWL.limits.items())[1:])}
    assert wrong(answer) == {"limits"}


def test_followers_of_a_tendon_need_no_limits():
    followers = set(TENDON.case.followers)
    limits = {
        name: pair for name, pair in TENDON.limits.items() if name not in followers
    }
    assert wrong({"limits": limits}, right=TENDON) == set()


def test_a_file_that_does_not_load_is_answered_by_its_error(tmp_path):
    answer = spoilt(tmp_path, "</robot>", "", reader="pinocchio")
    assert "Error" in answer["error"]


def test_a_tool_that_dies_is_reported_by_how_it_ended(tmp_path):
    questions = tmp_path / "questions.json"
    questions.write_text("no JSON")
    outcome = ask(TOOL["yourdfpy"], questions)
    assert outcome.failure.startswith("exit status 1")
    with pytest.raises(AssertionError, match="yourdfpy: exit status 1"):
        present(TOOL["yourdfpy"], outcome)


def test_a_tool_that_hangs_is_reported(tmp_path, monkeypatch):
    monkeypatch.setattr(suite, "TIME_LIMIT", 0.01)
    outcome = ask(TOOL["urchin"], write_questions([OWL.case], tmp_path))
    assert outcome.failure == "no answer in 0.01 s"


@pytest.mark.parametrize(
    ("ci", "reported"), [("true", pytest.fail.Exception), ("", pytest.skip.Exception)]
)
def test_a_missing_tool_fails_where_ci_is_set_and_is_skipped_elsewhere(
    monkeypatch, tmp_path, ci, reported
):
    monkeypatch.setenv("CI", ci)
    tool = dataclasses.replace(TOOL["drake"], package="no-such-distribution")
    outcome = ask(tool, tmp_path / "questions.json")
    with pytest.raises(reported, match="Drake cannot be asked: no-such-distribution"):
        present(tool, outcome)


def test_a_tool_that_cannot_be_imported_is_missing(tmp_path):
    questions = write_questions([OWL.case], tmp_path)
    outcome = ask(dataclasses.replace(TOOL["ikpy"], reader="no_reader"), questions)
    assert "No module named 'readers.no_reader'" in outcome.missing
    assert outcome == Outcome({}, missing=outcome.missing, said=outcome.said)


def test_output_is_kept_once_without_what_changes():
    text = "a/b/x.py:12: odd [1]\nb/c/x.py:13: odd [2]\n---\n" + "z\n" * 9
    assert digest(text) == ("x.py:#: odd …", "z")


def test_random_feet_are_the_same_each_time():
    assert random_foot(0) == random_foot(0)
    assert random_foot(0) != random_foot(1)


def test_one_random_foot_turns_a_toe():
    assert [f.reversal != 0 for f in random_foot(0).fingers].count(True) == 1
