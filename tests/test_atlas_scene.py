"""The scene of a row of an atlas: its steps, its poses, and what a browser shows."""

from __future__ import annotations

import base64
import html

import numpy as np
import pytest
from browser import visit
from made_atlases import made_atlas
from test_strike_scene import scene_of

from zygopin import (
    ParameterError,
    Region,
    export_atlas_scene,
    forward_kinematics,
    region_map,
)
from zygopin.atlas_regions import REGION_WORDS, has_pose
from zygopin.atlas_row import STEP
from zygopin.atlas_scene import REGION_PAINTS
from zygopin.errors import FileError

HOSTILE = "</script><b>\"x\" & 'y'</b>"


@pytest.fixture(scope="module")
def page(tmp_path_factory):
    """The row at the middle height."""
    atlas = made_atlas()
    path = tmp_path_factory.mktemp("scene") / "new" / "row.html"
    return export_atlas_scene(atlas, path, height=float(atlas.grid.heights[2]))


def test_each_valid_radius_of_the_row_is_a_step(page):
    atlas, motion = made_atlas(), scene_of(page)["motion"]
    valid = atlas.grid.valid[2]
    np.testing.assert_allclose(motion["times"], STEP * np.arange(valid.sum()))
    radii = [float(text.split()[1].split("\xa0")[0]) for text in motion["labels"]]
    np.testing.assert_allclose(radii, atlas.grid.radii[valid] * 1e3, atol=1e-3)


def test_spans_are_the_regions_of_the_row(page):
    atlas, motion = made_atlas(), scene_of(page)["motion"]
    regions = region_map(atlas)[2][atlas.grid.valid[2]]
    times = np.array(motion["times"])
    starts = [start for start, *_ in motion["spans"]]
    for time, region in zip(times, regions, strict=True):
        _, name, colour = motion["spans"][np.searchsorted(starts, time, "right") - 1]
        assert name == REGION_WORDS[Region(region)].upper()
        assert colour == REGION_PAINTS[Region(region)].css


def test_one_branch_is_seen_at_a_time_and_the_foot_where_it_has_a_pose(page):
    atlas, motion = made_atlas(), scene_of(page)["motion"]
    posed = has_pose(atlas)[2][atlas.grid.valid[2]]
    seen = {path.rsplit("/", 1)[-1]: spans for path, spans in motion["glimpses"]}
    for step, time in enumerate(motion["times"]):
        now = {
            name
            for name, spans in seen.items()
            if any(start <= time < end for start, end in spans)
        }
        assert now == {f"step{step}"} | ({"foot"} if posed[step] else set())


def test_tracks_are_the_poses_of_the_atlas(page):
    atlas, motion = made_atlas(), scene_of(page)["motion"]
    numbers = np.frombuffer(base64.b64decode(motion["poses"]), "<i4") / 1e6
    numbers = numbers.reshape(len(motion["times"]), len(motion["tracks"]), 7)
    columns = np.flatnonzero(atlas.grid.valid[2])
    starts = numbers[..., :3]
    second = 1  # the first toe's second phalanx: its start is one phalanx from the base
    for step, column in enumerate(columns):
        controls = atlas.controls[2, column]
        if np.isnan(controls).any():
            continue
        bones = forward_kinematics(atlas.foot, controls)
        expected = bones[:, 0] - bones[0, 0]
        found = starts[step] - starts[step, 0]
        scale = np.linalg.norm(found[second]) / np.linalg.norm(expected[second])
        np.testing.assert_allclose(found, scale * expected, atol=5e-6)


def test_at_rest_the_skin_fits_between_base_and_bark(tmp_path):
    atlas = made_atlas()
    page = export_atlas_scene(atlas, tmp_path / "rest.html")
    motion = scene_of(page)["motion"]
    room = atlas.grid.base_distance[:, None] - atlas.grid.radii
    usable = (room >= atlas.foot.radii.max()).any(axis=0)
    assert len(motion["times"]) == usable.sum()


def test_bytes_are_stable_and_words_are_escaped(tmp_path):
    one, two = (
        export_atlas_scene(made_atlas(), tmp_path / name, title=HOSTILE)
        for name in ("a.html", "b.html")
    )
    assert one.read_bytes() == two.read_bytes()
    text = one.read_text("utf-8")
    assert f"<h1>{html.escape(HOSTILE)}</h1>" in text
    assert HOSTILE not in text


def test_a_browser_shows_each_step_offline(page, tmp_path):
    motion = scene_of(page)["motion"]
    times = (motion["times"][0], motion["times"][-1])
    frames = "".join(
        f'<iframe style="border: 0; width: 780px; height: 400px" '
        f'src="{page.as_uri()}#t={time}"></iframe>'
        for time in times
    )
    sheet = tmp_path / "sheet.html"
    sheet.write_text(f'<body style="margin: 0; display: flex">{frames}')
    seen = visit(sheet, (1560, 400))
    assert seen.console == ()
    assert set(seen.requests) <= {sheet.as_uri(), page.as_uri()}
    brown = []
    for part, span in zip(np.split(seen.pixels, 2, axis=1), (0, -1), strict=True):
        _, _, colour = motion["spans"][span]
        wanted = [int(colour[k : k + 2], 16) for k in (1, 3, 5)]
        bar = part[310:].reshape(-1, 3).astype(int)
        assert (np.abs(bar - wanted).max(axis=1) < 4).mean() > 1e-3
        red, _, blue = part[:300, :440].reshape(-1, 3).astype(int).T
        brown.append(np.mean(red - blue > 25))
    assert brown[1] > 2 * brown[0] > 0


def test_bad_input_is_named(tmp_path):
    with pytest.raises(ParameterError, match="farther below the base"):
        export_atlas_scene(made_atlas(), tmp_path / "a.html", height=0.0)
    with pytest.raises(ParameterError, match="height"):
        export_atlas_scene(made_atlas(), tmp_path / "a.html", height=float("nan"))
    with pytest.raises(ParameterError, match="atlas"):
        export_atlas_scene("atlas", tmp_path / "a.html")
    assert not list(tmp_path.iterdir())
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError):
        export_atlas_scene(made_atlas(), tmp_path / "file" / "a.html")
