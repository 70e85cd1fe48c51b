"""The record of how a stance holds."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest
from stances import perched

from zygopin.branch import Branch
from zygopin.closure import closure_quality, least_friction
from zygopin.contacts import Friction, branch_contacts
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.grasp import check_grasp
from zygopin.hold import check_hold
from zygopin.load import pull_limit
from zygopin.output import hold_lines
from zygopin.strength import Strength

FIRM = Strength(1.0, Friction(0.5))


def test_the_record_says_what_its_parts_say():
    report = perched().report
    hold, contacts = check_hold(report, FIRM), branch_contacts(report)
    assert hold.held
    assert hold.quality == closure_quality(contacts, FIRM.friction)
    assert hold.least_friction == least_friction(contacts)
    assert hold.pull.force == pull_limit(contacts, FIRM, [0, 0, 1]).force > 0


def test_toes_that_lie_on_a_branch_do_not_hold():
    foot = Foot.preset("parrot")
    flat = Branch(radius=0.02, centre=(0, 0, -0.02 - foot.radii[0]))
    hold = check_hold(check_grasp(foot, np.zeros(14), flat), FIRM)
    assert not hold.held
    assert hold.pull.bound == 0


def test_nothing_that_touches_holds_nothing():
    report = check_grasp(Foot.preset("parrot"), np.zeros(14), Branch(0.01, (0, 0, -1)))
    hold = check_hold(report, FIRM)
    assert hold.contacts is None
    assert not hold.held
    assert (hold.quality.high, hold.pull.bound) == (0, 0)
    assert hold.least_friction == (math.inf, math.inf)


def test_a_batch_is_refused():
    report = check_grasp(
        Foot.preset("parrot"), np.zeros((2, 14)), Branch(0.01, (0, 0, -1))
    )
    with pytest.raises(ParameterError, match="one stance"):
        check_hold(report, FIRM)


@pytest.mark.parametrize(
    ("friction", "least", "words"),
    [
        (0.5, (0.0, 1e-6), "held yes at friction 0.5 (any above 0 would close it)"),
        (0.1, (0.41, 0.42), "held no at friction 0.1 (0.42 or more would close it)"),
        (0.5, (math.inf, math.inf), "held no at friction 0.5 (none would close it)"),
    ],
)
def test_a_terminal_reads_what_friction_it_takes(friction, least, words):
    hold = check_hold(perched().report, Strength(1.0, Friction(friction)))
    held = friction > least[1]
    said = hold_lines(dataclasses.replace(hold, held=held, least_friction=least))
    assert said[0].startswith(words)
    assert all(len(line) <= 80 for line in said)
