"""Grids of parallel branches: where they are, and what is refused."""

from __future__ import annotations

import math

import numpy as np
import pytest
from axes import one_finger
from tangencies import projected

from zygopin.branch_grid import BranchGrid
from zygopin.errors import ParameterError

AXIS = (0.3, 1.0, -0.4)
GRID = BranchGrid([0.5, -0.1, -1.0], [0.1, 0.6], AXIS, (0.2, -0.3))


def test_branches_are_those_of_their_rows_and_columns():
    rows, columns = np.indices(GRID.shape)
    branches = GRID.at(rows, columns)
    assert GRID.shape == branches.batch_shape == (3, 2)
    assert np.array_equal(branches.radius, [[0.1, 0.6]] * 3)
    assert np.array_equal(branches.centre[2, 1], [0.2, -0.3, -1.0])
    assert np.allclose(branches.axis, np.array(AXIS) / np.linalg.norm(AXIS))
    assert GRID.at(1, 0).centre[2] == -0.1


def test_distances_of_the_base_are_those_of_the_branches():
    branches = GRID.at(np.arange(3), 0)
    assert np.allclose(GRID.base_distance, branches.base_distance(), rtol=1e-14)
    expected = branches.base_distance()[:, None] >= GRID.radii
    assert np.array_equal(GRID.valid, expected)
    assert 0 < GRID.valid.sum() < 6


def test_a_branch_on_which_the_base_sits_is_valid():
    grid = BranchGrid([-1.0], [0.5, 1.0, 1.5])
    assert grid.valid.tolist() == [[True, True, False]]


def test_a_finger_sees_the_centres_on_a_line():
    finger = projected(one_finger(2, 0.7), GRID.axis)
    centres = GRID.at(np.arange(3), 0).centre
    assert np.allclose(GRID.centres(finger), finger.flat(centres))
    origin, step = GRID.line(finger)
    assert finger.flat(np.array([0.2, -0.3, 2.0])) == pytest.approx(origin + 2 * step)


def test_values_are_copied_and_read_only():
    heights = np.array([-1.0, -2.0])
    grid = BranchGrid(heights, [0.1])
    heights[0] = 5.0
    assert grid.heights[0] == -1.0
    for values in (grid.heights, grid.radii, grid.axis, grid.offset):
        assert not values.flags.writeable


def test_single_numbers_are_grids_of_one():
    assert BranchGrid(-1.0, 0.1).shape == (1, 1)


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"heights": []}, "heights"),
        ({"radii": []}, "radii"),
        ({"heights": [0.0, 0.0]}, "heights .* strictly rising or falling"),
        ({"heights": [0.0, 1.0, 0.5]}, "heights"),
        ({"heights": [[0.0, 1.0]]}, "heights"),
        ({"heights": [math.nan]}, "heights.* finite"),
        ({"heights": ["high"]}, "heights"),
        ({"radii": [0.2, 0.1]}, "radii .* rising: sort them"),
        ({"radii": [0.1, 0.1]}, "radii"),
        ({"radii": [0.0, 0.1]}, "radius"),
        ({"radii": [-0.1]}, "radius"),
        ({"radii": [math.inf]}, "radii"),
        ({"axis": (0, 0, 0)}, "axis"),
        ({"axis": (0, 1)}, "axis"),
        ({"axis": [(0, 1, 0), (1, 0, 0)]}, "axis.shape"),
        ({"offset": (0.0,)}, "offset.shape"),
        ({"offset": [(0.0, 1.0)] * 2}, "offset.shape"),
        ({"offset": (0.0, math.nan)}, "offset"),
        ({"offset": (1e300, 0.0)}, "centre"),
        ({"heights": (-1e300, 0.0)}, "centre"),
        ({"heights": np.arange(4096), "radii": np.arange(1, 1026)}, "grid .* cells"),
    ],
)
def test_bad_grids_are_named(changes, words):
    with pytest.raises(ParameterError, match=words):
        BranchGrid(**{"heights": [-1.0], "radii": [0.1], **changes})


def test_the_largest_grid_is_allowed():
    assert BranchGrid(np.arange(4096), np.arange(1, 1025)).shape == (4096, 1024)
