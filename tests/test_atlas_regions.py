"""Regions of an atlas: what counts for what, what stays open, cells to look at."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from made_atlases import UNDECIDED_COLUMN, made_atlas, pair_foot

from zygopin import Answer, Atlas, BranchGrid, ParameterError, Region, region_map
from zygopin.atlas_regions import (
    has_pose,
    open_cells,
    open_share,
    picked_cells,
    pose_report,
    region_shares,
)

YES, NO, OPEN = Answer.YES, Answer.NO, Answer.UNDECIDED

ROWS = (
    # touchable, stable, feasible, grasping: the region, and whether more is possible
    ((YES, YES, YES, YES), Region.GRASPING, False),
    ((YES, YES, YES, NO), Region.FEASIBLE, False),
    ((YES, YES, YES, OPEN), Region.FEASIBLE, True),
    ((YES, NO, NO, NO), Region.TOUCHABLE, False),
    ((YES, OPEN, NO, NO), Region.TOUCHABLE, False),
    ((YES, YES, OPEN, NO), Region.TOUCHABLE, True),
    ((NO, YES, NO, NO), Region.STABLE, False),
    ((OPEN, YES, NO, NO), Region.STABLE, True),
    ((NO, NO, NO, NO), Region.NONE, False),
    ((NO, OPEN, NO, NO), Region.UNDECIDED, True),
    ((OPEN, OPEN, OPEN, OPEN), Region.UNDECIDED, True),
)


def written_atlas():
    """An atlas of one height with a branch for each row of the table, and no pose."""
    foot, count = pair_foot(), len(ROWS) + 1
    radii = np.linspace(0.01, 0.1, count) * foot.size
    grid = BranchGrid([-0.5 * float(radii[-1] + radii[-2])], radii)
    answers = np.array([codes for codes, _, _ in ROWS]).T
    held = np.full((4, 1), Answer.HOLDS_BASE)
    codes = np.concatenate([answers, held], axis=1)[:, None].astype(np.int8)
    poses = np.full((1, count, foot.phalanx_count), np.nan)
    toes, wrap = np.zeros((1, count, 2), np.int8), np.full((1, count, 2), np.nan)
    grid = BranchGrid(-(radii[-2:-1] + radii[-1:]) / 2, radii)
    return Atlas(foot, grid, *codes, toes, wrap, poses, poses)


def test_the_best_answer_names_the_region():
    atlas = written_atlas()
    assert region_map(atlas)[0].tolist() == [
        *(region for _, region, _ in ROWS),
        Region.HOLDS_BASE,
    ]


def test_only_a_question_that_would_better_it_leaves_a_branch_open():
    atlas = written_atlas()
    assert open_cells(atlas)[0].tolist() == [*(more for *_, more in ROWS), False]
    assert open_share(atlas) == pytest.approx(5 / 11)


def test_shares_are_of_the_branches_that_do_not_hold_the_base():
    shares = region_shares(written_atlas())
    assert sum(shares.values()) == pytest.approx(1)
    assert shares[Region.FEASIBLE] == pytest.approx(2 / 11)
    assert Region.HOLDS_BASE not in shares


def test_regions_keep_to_the_poses():
    atlas = made_atlas()
    regions, posed = region_map(atlas), has_pose(atlas)
    known = (regions > Region.NONE) & atlas.grid.valid
    assert (posed == known).all()
    assert (regions[:, UNDECIDED_COLUMN] != Region.NONE).all()
    for cell in map(tuple, np.argwhere(regions == Region.GRASPING)):
        report = pose_report(atlas, cell)
        assert report.grasping
        assert report.feasible
    for cell in map(tuple, np.argwhere(regions == Region.STABLE)):
        assert pose_report(atlas, cell).stable


@pytest.mark.parametrize("count", [1, 2, 6, 26])
def test_picked_cells_have_poses_and_ascend_in_radius(count):
    atlas = made_atlas()
    cells = picked_cells(atlas, count)
    posed = has_pose(atlas)
    assert len(cells) == len(set(cells)) <= count
    assert all(posed[cell] for cell in cells)
    assert [cell[1] for cell in cells] == sorted(cell[1] for cell in cells)
    regions = [region_map(atlas)[cell] for cell in cells]
    assert Region.GRASPING in regions
    if count >= 6:
        assert set(regions) == {
            code for code in np.unique(region_map(atlas)) if code > 0
        }


def test_an_atlas_without_poses_has_nothing_to_pick():
    assert picked_cells(written_atlas(), 6) == []


@pytest.mark.parametrize("cell", [(0, 99), (-1, 0), (0,), (7, 0)])
def test_a_cell_off_the_grid_is_named(cell):
    with pytest.raises(ParameterError, match="a row below 7 and a column below 9"):
        pose_report(made_atlas(), cell)


def test_a_cell_without_a_pose_is_named():
    atlas = dataclasses.replace(
        made_atlas(),
        controls=np.full_like(made_atlas().controls, np.nan),
        stable_controls=np.full_like(made_atlas().controls, np.nan),
    )
    with pytest.raises(ParameterError, match="a cell with a pose"):
        pose_report(atlas, (0, 0))
