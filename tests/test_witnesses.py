"""Poses that are kept show what their merit says, by another engine too."""

from __future__ import annotations

import numpy as np
import pytest

from zygopin import Foot, check_grasp
from zygopin.branch_grid import BranchGrid
from zygopin.engine import make_engine
from zygopin.grasp import Criteria
from zygopin.projection import PALM
from zygopin.toe_contacts import ToeSearch
from zygopin.touch import touch_intervals
from zygopin.witnesses import (
    MERITS,
    Witnesses,
    opposing,
    palmar,
    tangent_sides,
    touched,
)

FOOT = Foot.preset("parrot")
SIZE = FOOT.size
GRID = BranchGrid(
    np.array([-0.1, -0.2, -0.35]) * SIZE, np.array([0.06, 0.12, 0.3]) * SIZE
)


@pytest.fixture(scope="module")
def poses():
    """Poses of all toes, on each branch: wrapped as far as can be, and others."""
    every = (len(FOOT.fingers), *GRID.shape)
    wanted = np.broadcast_to(GRID.valid, every)
    cells = np.nonzero(GRID.valid)
    away = touch_intervals(FOOT, GRID.at(*cells)).most_controls
    search, made = ToeSearch(FOOT, GRID), [away]
    for aim in (9.0, 1.2, 0.5):
        laid = search.poses(wanted, aim=aim)
        found, controls = laid.found, laid.controls
        for skip in (0, 1, 2):
            whole = away.copy()
            for index, part in enumerate(FOOT.finger_slices.values()):
                mine = found[index][cells] & (index % 3 != skip - 1)
                pose = controls[index][cells]
                whole[:, part] = np.where(mine[:, None], pose, away[:, part])
            made.append(whole)
    return cells, made


@pytest.fixture(scope="module")
def kept(poses):
    cells, made = poses
    found = Witnesses(FOOT, GRID, Criteria())
    for whole in made:
        found.offer(cells, whole)
    return found


def shown(report):
    """What a pose shows, by its report alone."""
    pairs = FOOT.opposable_pairs
    touching, tangent = (
        [bool(mask[part].any()) for part in FOOT.finger_slices.values()]
        for mask in (report.touching, report.tangent)
    )
    opposed = any(touching[i] and touching[j] for i, j in pairs)
    verdict = [bool(opposed), bool(report.stable), bool(report.grasping)]
    best = max(
        (merit for has, merit in zip(verdict, MERITS.values(), strict=True) if has),
        default=0,
    )
    return (best + sum(tangent), sum(tangent)) if report.feasible and best else (0, 0)


@pytest.mark.parametrize("engine", ["exact", "fcl"])
def test_every_pose_kept_shows_what_its_merit_says(kept, engine):
    cells = np.nonzero(kept.merit)
    assert len(cells[0])
    for row, column in zip(*cells, strict=True):
        branch = GRID.at(row, column)
        report = check_grasp(FOOT, kept.controls[row, column], branch, engine=engine)
        merit, toes = shown(report)
        assert kept.merit[row, column] == merit
        assert kept.toes[row, column] == toes


def test_the_best_pose_offered_is_kept(kept, poses):
    cells, made = poses
    best = np.zeros(GRID.shape, dtype=int)
    for whole in made:
        for row, column, pose in zip(*cells, whole, strict=True):
            report = check_grasp(FOOT, pose, GRID.at(row, column))
            best[row, column] = max(best[row, column], shown(report)[0])
    assert np.array_equal(best, kept.merit)
    assert best.max() >= MERITS["grasping"]


def test_verdicts_include_those_before_them(kept):
    touching, feasible, grasping = (kept.shows(verdict) for verdict in MERITS)
    assert not (grasping & ~feasible).any()
    assert not (feasible & ~touching).any()
    assert np.array_equal(np.isnan(kept.controls).any(axis=-1), kept.merit == 0)


def test_a_worse_pose_or_none_changes_nothing(kept, poses):
    cells, made = poses
    before = kept.merit.copy(), kept.controls.copy()
    kept.offer(cells, made[0])
    none = np.zeros(0, dtype=int)
    kept.offer((none, none), np.zeros((0, FOOT.phalanx_count)))
    assert np.array_equal(kept.merit, before[0])
    assert np.array_equal(kept.controls, before[1], equal_nan=True)


def test_a_pose_that_enters_is_not_kept():
    found = Witnesses(FOOT, GRID, Criteria())
    row, column = np.argwhere(GRID.valid)[0]
    closed = np.ones((1, FOOT.phalanx_count))
    branch = GRID.at(row, column)
    assert not check_grasp(FOOT, closed[0], branch).feasible
    found.offer((np.array([row]), np.array([column])), closed)
    assert not found.merit.any()


def test_of_several_poses_for_one_branch_the_best_is_kept(kept):
    cells = np.nonzero(kept.merit)
    row, column = (axis[np.argmax(kept.merit[cells])] for axis in cells)
    best = kept.controls[row, column]
    straight = np.zeros_like(best)
    for offered in ((straight, best, straight), (best, straight)):
        found, count = Witnesses(FOOT, GRID, Criteria()), len(offered)
        cell = np.full(count, row), np.full(count, column)
        found.offer(cell, np.stack(offered))
        assert found.merit[row, column] == kept.merit[row, column]
        assert np.array_equal(found.controls[row, column], best)


def test_what_both_engines_show_is_confirmed(kept):
    found = Witnesses(FOOT, GRID, Criteria())
    cells = np.nonzero(kept.merit)
    found.offer(cells, kept.controls[cells])
    before = found.merit.copy()
    found.confirm(make_engine("fcl", FOOT))
    assert np.array_equal(found.merit, before)


@pytest.mark.parametrize("control", [0.0, 1.0])
def test_what_the_other_engine_does_not_show_is_dropped(kept, control):
    found = Witnesses(FOOT, GRID, Criteria())
    cells = np.nonzero(kept.merit)
    found.offer(cells, kept.controls[cells])
    # A pose that touches nothing, or enters, is said to show what another does.
    row, column = (axis[0] for axis in cells)
    found.controls[row, column] = control
    found.confirm(make_engine("fcl", FOOT))
    assert not found.merit[row, column]
    assert np.isnan(found.controls[row, column]).all()
    assert not found.sides[row, column].any()
    others = tuple(axis[1:] for axis in cells)
    assert np.array_equal(found.merit[others], kept.merit[others])


def test_sides_are_those_of_tangent_phalanges(kept):
    row, column = np.argwhere(kept.shows("grasping"))[0]
    report = check_grasp(FOOT, kept.controls[row, column], GRID.at(row, column))
    sides = tangent_sides(report)
    assert np.array_equal(sides != 0, report.tangent)
    assert np.array_equal(kept.sides[row, column], sides)
    assert (sides[report.tangent & palmar(report)] == PALM).all()


def test_fingers_are_touched_by_their_own_phalanges():
    marks = np.zeros((3, FOOT.phalanx_count), dtype=bool)
    marks[1, 2], marks[2, [0, 13]] = True, True  # 2, 3, 4 and 5 phalanges
    expected = [[False] * 4, [False, True, False, False], [True, False, False, True]]
    assert touched(FOOT, marks).tolist() == expected


def test_fingers_oppose_in_their_pairs_only():
    fingers = np.eye(4, dtype=bool)
    for i in range(4):
        for j in range(4):
            pair = fingers[i] | fingers[j]
            expected = tuple(sorted((i, j))) in FOOT.opposable_pairs
            assert opposing(FOOT, pair) == expected
