"""The grid of a sweep: dimensions, cells, the foot and the branch of each."""

from __future__ import annotations

import math
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.strategies import reals
from zygopin import Foot
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.sweep_grid import SweepGrid, cell_branch, cell_foot

PARROT = Foot.preset("parrot")


@given(
    st.lists(reals(1.1, 2.0), min_size=1, max_size=4, unique=True),
    st.lists(reals(0.001, 0.1), min_size=1, max_size=4, unique=True),
    st.lists(st.sampled_from(["2-3-4-5", "3-3-3-3"]), min_size=1, unique=True),
)
def test_cells_are_the_product_in_the_order_given(rho, radius, counts):
    made = SweepGrid.of(PARROT, {"rho": rho, "radius": radius, "phalanges": counts})
    assert made.shape == (len(rho), len(radius), len(counts))
    cells = [tuple(made.cell(place).values()) for place in range(made.count)]
    assert cells == list(product(rho, radius, counts))


def test_single_values_are_fixed_and_make_no_dimension():
    made = SweepGrid.of(
        PARROT, {"radius": 0.01, "omega": 1.2, "phalanges": (1, 2, 3, 4)}
    )
    assert made.axes == {}
    assert made.count == 1
    assert made.cell(0) == {}
    expected = {"height": "rest", "yaw": 0.0, "pitch": 0.0, "radius": 0.01}
    assert made.fixed == expected | {"omega": 1.2, "phalanges": "1-2-3-4"}


def test_counts_are_labels_or_tuples():
    grid = {"radius": 0.01, "phalanges": [(1, 2, 3, 4), "05-5-5-5"]}
    assert SweepGrid.of(PARROT, grid).axes["phalanges"] == ("1-2-3-4", "5-5-5-5")
    assert SweepGrid.of(PARROT, grid).width == 5
    one = SweepGrid.of(PARROT, {"radius": 0.01, "phalanges": "1-1-1-7"})
    assert one.width == 7


def test_an_array_is_a_dimension():
    made = SweepGrid.of(PARROT, {"radius": np.linspace(0.01, 0.02, 3)})
    assert made.axes["radius"] == (0.01, 0.015, 0.02)


def test_the_foot_of_a_cell_has_what_the_cell_says():
    cell = {"rho": 1.3, "splay": 0.1, "phalanges": "1-2-3-4", "radius": 0.01}
    foot = cell_foot(PARROT, cell)
    assert (foot.rho, foot.splay, foot.omega) == (1.3, 0.1, PARROT.omega)
    assert [finger.phalanges for finger in foot.fingers] == [1, 2, 3, 4]
    assert foot.fingers[1].azimuth == pytest.approx(0.1)


def test_the_branch_of_a_cell_is_where_the_cell_says():
    cell = {"radius": 0.01, "height": -0.02, "yaw": math.pi / 2, "pitch": 0.0}
    branch = cell_branch(PARROT, cell)
    assert branch.centre == pytest.approx([0, 0, -0.02])
    assert branch.axis == pytest.approx([-1, 0, 0])
    resting = cell_branch(PARROT, cell | {"height": "rest"})
    assert resting.centre[2] == pytest.approx(-0.01 - 0.0018 / 1.18)


@pytest.mark.parametrize(
    ("grid", "words"),
    [
        ({}, "grid['radius'] = None is not given"),
        ({"radius": [0.01, 0.01]}, "is not one or more distinct values"),
        ({"radius": []}, "is not one or more distinct values"),
        ({"radius": [[0.01]]}, "grid['radius'].shape = (1, 1) is not (n,)"),
        ({"radius": [math.nan]}, "grid['radius'][0] = nan is not finite"),
        ({"radius": "thick"}, "grid['radius'] = 'thick' is not an array of numbers"),
        ({"radius": 1, "phalanges": "2-3"}, "'2-3' is not 4 numbers from 1 to 12"),
        ({"radius": 1, "phalanges": "0-1-1-1"}, "'0-1-1-1' is not 4 numbers"),
        ({"radius": 1, "phalanges": ["a"]}, "give such as 2-3-4-5"),
        ({"radius": np.arange(4e3), "rho": np.arange(4e3)}, "number of cells"),
    ],
)
def test_bad_values_are_named(grid, words):
    with pytest.raises(ParameterError) as caught:
        SweepGrid.of(PARROT, grid)
    assert words in str(caught.value)


@pytest.mark.parametrize("grid", [{"mass": 1}, {"height": "high"}])
def test_unknown_names_are_named(grid):
    with pytest.raises(UnknownNameError, match="choose one of"):
        SweepGrid.of(PARROT, {"radius": 0.01, **grid})


def test_a_sweep_starts_from_a_foot():
    with pytest.raises(ParameterError, match=r"give a zygopin\.Foot"):
        SweepGrid.of("parrot", {"radius": 0.01})
