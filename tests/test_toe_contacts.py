"""Every toe's answer on every branch: a pose that shows it, or a proof."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zygopin import Finger, Foot
from zygopin.branch_grid import BranchGrid
from zygopin.clearance import branch_clearance
from zygopin.kinematics import forward_kinematics
from zygopin.tangent_proof import Criterion, unproved
from zygopin.toe_contacts import Answer, ToeSearch

FOOT = Foot(
    rho=1.3,
    omega=1.1,
    thickness=0.04,
    fingers=(
        Finger("one", 1, math.pi - 0.3),
        Finger("two", 2, 0.3),
        Finger("three", 2, -0.3),
        Finger("four", 1, 0.5, 0.2),
    ),
)
GRID = BranchGrid([0.3, -0.25, -0.4, -0.6, -3.0], [0.1, 0.2, 0.35])
WANTED = np.broadcast_to(GRID.valid, (4, *GRID.shape))
TIGHT = Criterion(1e-6)


@pytest.fixture(scope="module")
def search():
    return ToeSearch(FOOT, GRID)


@pytest.fixture(scope="module", params=[True, False], ids=["solid", "loose"])
def answered(request, search):
    criterion = Criterion(1e-6, request.param)
    return criterion, search.contacts(WANTED, criterion)


def test_every_yes_is_shown_by_a_pose_in_space(answered):
    criterion, found = answered
    assert np.array_equal(found.found, found.answer == Answer.YES)
    for index, part in enumerate(FOOT.finger_slices.values()):
        cells = np.nonzero(found.answer[index] == Answer.YES)
        controls = np.zeros((len(cells[0]), FOOT.phalanx_count))
        controls[:, part] = found.controls[index][cells]
        bones = forward_kinematics(FOOT, controls)
        near = branch_clearance(bones, FOOT.radii, GRID.at(*cells))
        t, distance = near.t[:, part], near.distance[:, part]
        tangent = (np.abs(distance) <= 1e-9) & (np.abs(t - 0.5) <= 0.5 + 1e-9)
        assert tangent.any(axis=-1).all()
        if criterion.solid:
            assert (distance >= -1e-9).all()


def test_there_are_answers_of_both_kinds_and_few_open(answered):
    _, found = answered
    assert (found.answer == Answer.YES).any()
    assert (found.answer[:, -1] == Answer.NO).all()
    assert np.mean(found.answer[WANTED] != Answer.UNDECIDED) > 0.9
    assert not (found.answer[~WANTED] == Answer.NO).any()
    assert np.isnan(found.wrap[~WANTED]).all()


def test_mirrored_fingers_share_their_answers(answered):
    _, found = answered
    assert np.array_equal(found.answer[1], found.answer[2])
    assert np.array_equal(found.wrap[1], found.wrap[2], equal_nan=True)
    assert np.array_equal(found.controls[1], found.controls[2])


def test_a_finger_of_a_group_is_answered_as_if_alone(answered, search):
    criterion, found = answered
    for index, finger in enumerate(FOOT.fingers):
        alone = ToeSearch(FOOT.replace(fingers=(finger,)), GRID)
        left = alone.possible(WANTED[:1], criterion)
        together = search.possible(WANTED, criterion)
        assert np.array_equal(left[0], together[index])
        assert not (left[0] & (found.answer[index] == Answer.NO)).any()


def test_what_is_possible_is_what_some_phalanx_leaves(search):
    bound = np.full(WANTED.shape, 0.4)
    left = search.possible(WANTED, TIGHT, bound)
    for index, finger in enumerate(search.fingers):
        asked = np.broadcast_to(WANTED[index], (len(finger.lengths), *GRID.shape))
        found = unproved(finger, GRID, asked, TIGHT, beyond=bound[index])
        assert np.array_equal(left[index], found.any(axis=0))
    assert not (left & ~search.possible(WANTED, TIGHT)).any()


def test_poses_wrapped_farther_refute_no_bound(search):
    wrap = search.poses(WANTED).wrap
    bound = np.where(np.isfinite(wrap), wrap - 1e-3, 9.0)
    left = search.possible(WANTED & np.isfinite(wrap), TIGHT, bound)
    assert np.array_equal(left, np.isfinite(wrap))


def test_what_was_not_asked_stays_open(search):
    none = search.contacts(np.zeros_like(WANTED), TIGHT)
    assert (none.answer == Answer.UNDECIDED).all()
    assert not none.found.any()
