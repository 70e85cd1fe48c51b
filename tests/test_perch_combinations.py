"""Combinations of toes' poses: which are kept, and what none of them passes."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zygopin.branch import Branch, branch_axis
from zygopin.foot import Foot
from zygopin.perch_combinations import (
    all_poses,
    best_first,
    combinations,
    most_worth,
)
from zygopin.perch_height import HEIGHTS, best_place
from zygopin.presets import preset_names


@given(st.lists(st.integers(-3, 3), min_size=1, max_size=40), st.integers(1, 45))
def test_the_best_are_those_of_a_full_stable_sort(worths, most):
    worth = np.array(worths, float)
    expected = sorted(range(len(worths)), key=lambda i: -worths[i])[:most]
    assert best_first(worth, most).tolist() == expected


def on_branches(name, share, axis):
    """Poses of a foot on a branch at several heights."""
    foot = Foot.preset(name)
    heights = -share * foot.size - np.linspace(0, 0.6, HEIGHTS) * foot.size
    centres = np.stack([0 * heights, 0 * heights, heights], axis=-1)
    branches = Branch(share * foot.size, centres, axis)
    return foot, all_poses(foot, branches, 4)


@pytest.mark.parametrize("name", preset_names())
@pytest.mark.parametrize("share", [0.1, 0.3])
def test_no_combination_passes_the_bound_and_the_best_place_is_found(name, share):
    foot, poses = on_branches(name, share, branch_axis(0.2, 0.1))
    merits = -np.linspace(0, 0.6, HEIGHTS)
    values = []
    for place, merit in enumerate(merits):
        there = [each.take(each.place == place) for each in poses]
        worth = combinations(foot, there).worth
        assert worth.max() == worth[0] <= most_worth(foot, there)
        values.append(worth[0] + merit)
    assert best_place(foot, poses, merits) == int(np.argmax(values))
