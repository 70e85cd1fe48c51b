"""Figures of an atlas: its colours, its side views, and bad input."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from made_atlases import made_atlas, pair_foot
from test_strike_plots import pixels, share

from zygopin import (
    BranchGrid,
    ParameterError,
    Region,
    forward_kinematics,
    plot_atlas,
    plot_atlas_wrap,
    region_map,
)
from zygopin.atlas_plots import REGION_COLOURS
from zygopin.errors import FileError
from zygopin.looks import finger_paint
from zygopin.side_views import side_view


def test_every_region_has_its_colour_on_the_map(tmp_path):
    atlas = made_atlas()
    picture = pixels(plot_atlas(atlas, tmp_path / "new" / "a.png"))
    for code in np.unique(region_map(atlas)):
        if code != Region.UNDECIDED:  # hatched
            assert share(picture, REGION_COLOURS[Region(code)], slack=3) > 2e-3
    for index in range(2):
        assert share(picture, finger_paint(index).css, slack=40) > 1e-4


def test_areas_on_the_map_are_those_of_the_regions(tmp_path):
    atlas = made_atlas()
    picture = pixels(plot_atlas(atlas, tmp_path / "a.png", cells=[]))
    areas = [
        share(picture, REGION_COLOURS[region], slack=3)
        for region in (Region.GRASPING, Region.HOLDS_BASE)
    ]
    counts = [
        np.sum(region_map(atlas) == region)
        for region in (Region.GRASPING, Region.HOLDS_BASE)
    ]
    assert areas[0] / areas[1] == pytest.approx(counts[0] / counts[1], rel=0.05)


def test_bytes_are_stable_and_cells_can_be_chosen(tmp_path):
    atlas = made_atlas()
    cell = tuple(map(int, np.argwhere(region_map(atlas) == Region.GRASPING)[0]))
    one, two = (
        plot_atlas(atlas, tmp_path / name, cells=[cell]) for name in ("a.png", "b.png")
    )
    assert one.read_bytes() == two.read_bytes()
    picked = plot_atlas(atlas, tmp_path / "c.png")
    assert one.read_bytes() != picked.read_bytes()


def test_the_wrap_has_two_panels_with_their_scales(tmp_path):
    picture = pixels(plot_atlas_wrap(made_atlas(), tmp_path / "w.png"))
    assert picture.shape == (810, 1800, 3)
    grey = REGION_COLOURS[Region.HOLDS_BASE]
    left, right = picture[:, :900], picture[:, 900:]
    assert share(left, grey, slack=3) > 0.02
    assert share(right, grey, slack=3) > 0.02


def test_an_atlas_of_one_branch_is_drawn(tmp_path):
    atlas = made_atlas()
    single = {
        field.name: getattr(atlas, field.name)[-1:, :1]
        for field in dataclasses.fields(atlas)[2:]
    }
    grid = BranchGrid(atlas.grid.heights[-1:], atlas.grid.radii[:1])
    few = dataclasses.replace(atlas, grid=grid, **single)
    for draw in (plot_atlas, plot_atlas_wrap):
        assert pixels(draw(few, tmp_path / "one.png")).ndim == 3


def test_the_side_view_along_y_is_x_and_z():
    points = np.array([[1.0, 2.0, 3.0], [-1.0, 5.0, -2.0]])
    for sign in (1.0, -1.0):
        seen = side_view(points, np.array([0.0, sign, 0.0]))
        np.testing.assert_allclose(seen, [1 + 3j, -1 - 2j])


@pytest.mark.parametrize("axis", [(1, 0, 0), (0, 0, 1), (1, 2, 3), (-1, 1, 0.2)])
def test_side_views_keep_distances_across_the_axis(axis):
    unit = np.array(axis, float) / np.linalg.norm(axis)
    foot = pair_foot()
    points = forward_kinematics(foot, np.full(foot.phalanx_count, 0.4)).reshape(-1, 3)
    seen = side_view(points, unit)
    flat = points - np.outer(points @ unit, unit)
    expected = np.linalg.norm(flat - flat[0], axis=1)
    np.testing.assert_allclose(np.abs(seen - seen[0]), expected, atol=1e-15)


@pytest.mark.parametrize(
    ("cells", "words"),
    [
        ([(0, 99)], "a row below 7"),
        ([(6, 8)], "a cell with a pose"),
        ([(0, 0)] * 27, "at most 26"),
    ],
)
def test_bad_cells_are_named(tmp_path, cells, words):
    with pytest.raises(ParameterError, match=words):
        plot_atlas(made_atlas(), tmp_path / "a.png", cells=cells)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("draw", [plot_atlas, plot_atlas_wrap])
def test_other_types_and_bad_files_are_told(tmp_path, draw):
    with pytest.raises(ParameterError, match="atlas"):
        draw("atlas", tmp_path / "a.png")
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError):
        draw(made_atlas(), tmp_path / "file" / "a.png")
