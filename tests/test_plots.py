"""Figures of reachable sets: what they show, pixel by pixel, and their bytes."""

from __future__ import annotations

import io
import math
import subprocess
import sys

import numpy as np
import pytest
from browser import visit
from PIL import Image

from zygopin import Foot
from zygopin.errors import FileError, ParameterError
from zygopin.figures import unit_of
from zygopin.plots import _density, plot_box_counts, plot_convergence, plot_reach
from zygopin.reach import finger_reach
from zygopin.reach_scene import MOST_DOTS, export_reach_scene, junction_clouds

PAPER = Foot.preset("paper")


def sets(levels=5):
    feet = [PAPER.replace(omega=math.radians(angle)) for angle in (15, 30)]
    return [finger_reach(foot, 3, levels) for foot in feet]


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB"))


def chroma(picture):
    return np.ptp(picture.astype(int), axis=-1)


def test_a_figure_shows_a_panel_for_each_set(tmp_path):
    one, two = sets()[1:], sets()
    narrow = pixels(plot_reach(one, tmp_path / "one.png"))
    wide = pixels(plot_reach(two, tmp_path / "two.png"))
    assert wide.shape[1] > 1.6 * narrow.shape[1]
    middle = wide.shape[1] * 0.45
    coloured = np.nonzero(chroma(wide) > 60)[1]
    assert np.sum(coloured < middle) > 50
    assert np.sum((coloured > middle) & (coloured < 0.85 * wide.shape[1])) > 200


def test_figures_repeat_and_name_no_program(tmp_path):
    first = plot_reach(sets(), tmp_path / "a.png").read_bytes()
    assert plot_reach(sets(), tmp_path / "b" / "a.png").read_bytes() == first
    assert b"Software" not in first
    assert Image.open(io.BytesIO(first)).format == "PNG"


def red(picture):
    return (picture[..., 0] > 120) & (picture[..., 1:].max(-1) < 110)


def test_a_hull_is_drawn_on_request(tmp_path):
    plain = pixels(plot_reach(sets(), tmp_path / "a.png"))
    outlined = pixels(plot_reach(sets(), tmp_path / "b.png", hull=True))
    assert red(plain).sum() == 0
    assert red(outlined).sum() > 300


def test_hull_reproduces_the_reference_area():
    assert finger_reach(PAPER, 3, 33).hull.area == pytest.approx(0.226553, abs=1e-6)
    small = finger_reach(PAPER.replace(scale=0.01), 3, 9).hull.area
    assert small == pytest.approx(1e-4 * finger_reach(PAPER, 3, 9).hull.area)


def test_box_counts_show_a_dot_for_each_size(tmp_path):
    file = plot_box_counts(finger_reach(PAPER, 3, 3, depth=8), tmp_path / "a.png")
    rows = np.unique(np.nonzero(red(pixels(file)))[0])
    assert 1 + np.sum(np.diff(rows) > 1) >= 6


def test_density_worked_by_hand():
    points = np.array([0.1 + 0.1j, 0.2 + 0.3j, 1.5 + 0.5j, 2 + 1j])
    counts = _density(points, np.array([[0.0, 2.0], [0.0, 1.0]]), cell=1.0)
    np.testing.assert_array_equal(counts, [[2], [2]])


def test_density_counts_every_point():
    points = finger_reach(PAPER, 3, 9).points
    box = np.array([[0.6, 1.4], [-1.1, 0.0]])
    assert _density(points, box, 0.013).sum() == 9**4


def test_convergence_shows_one_colour_on_grey(tmp_path):
    reaches = [finger_reach(PAPER, 3, 3, depth=k) for k in range(1, 6)]
    picture = pixels(plot_convergence(reaches, tmp_path / "a.png"))
    assert red(picture).sum() > 200
    assert np.argwhere(red(picture))[:, 0].max() > picture.shape[0] / 2


def test_units_suit_the_foot():
    assert unit_of(PAPER).name == "m"
    assert unit_of(Foot.preset("owl")).text(0.0123456) == "12.35 mm"


def test_no_set_and_no_file_are_named(tmp_path):
    with pytest.raises(ParameterError, match="number of reachable sets = 0"):
        plot_reach([], tmp_path / "a.png")
    with pytest.raises(ParameterError, match="is not at least 2"):
        plot_convergence(sets()[:1], tmp_path / "a.png")
    with pytest.raises(FileError, match="cannot be written"):
        plot_reach(sets()[:1], tmp_path)
    assert not list(tmp_path.iterdir())


def test_without_matplotlib_the_extra_is_named():
    code = (
        "import sys; sys.modules['matplotlib'] = None\n"
        "from zygopin.errors import ZygopinError\n"
        "try:\n"
        "    import zygopin.plots\n"
        "except ZygopinError as error:\n"
        "    print(error, isinstance(error, ImportError), error.extra)\n"
    )
    command = [sys.executable, "-c", code]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    words = "matplotlib is not installed: pip install 'zygopin[plots]' adds it"
    assert result.stdout.strip() == f"{words} True plots"


def test_figures_leave_pyplot_alone():
    code = "import sys, zygopin.plots; print('matplotlib.pyplot' in sys.modules)"
    command = [sys.executable, "-c", code]
    result = subprocess.run(command, capture_output=True, text=True, check=True)
    assert result.stdout.strip() == "False"


def test_clouds_are_the_junctions_sets_thinned_by_a_stated_stride():
    clouds = list(junction_clouds(PAPER))
    assert [cloud.reach.depth for cloud in clouds] == [
        *range(1, 3),
        *range(1, 4),
        *range(1, 5),
        *range(1, 6),
    ]
    for cloud in clouds:
        levels, stride = len(cloud.reach.plane.levels), cloud.stride
        assert len(cloud.dots) <= MOST_DOTS
        assert math.gcd(stride, levels) == 1
        np.testing.assert_array_equal(cloud.dots, cloud.reach.in_space()[::stride])


def test_clouds_deepen_toward_the_tip():
    colours = [c.paint for c in junction_clouds(PAPER, 3)][-5:]
    light = [
        sum(paint.colour >> shift & 255 for shift in (0, 8, 16)) for paint in colours
    ]
    assert light == sorted(light, reverse=True)
    assert len(set(light)) == 5


def test_the_scene_repeats_byte_by_byte_and_stays_small(tmp_path):
    first = export_reach_scene(PAPER, tmp_path / "a.html").read_bytes()
    assert export_reach_scene(PAPER, tmp_path / "b.html").read_bytes() == first
    assert len(first) < 2_000_000


def test_a_hostile_title_is_text(tmp_path):
    title = "</script><script>alert(1)</script>"
    page = export_reach_scene(PAPER, tmp_path / "a.html", levels=2, title=title)
    assert title not in page.read_text("utf-8")


def test_a_browser_shows_every_fingers_cloud_and_asks_for_nothing(tmp_path):
    page = export_reach_scene(PAPER, tmp_path / "a.html", levels=8)
    seen = visit(page, (800, 400))
    assert seen.console == ()
    assert seen.requests == ()
    scene = seen.pixels[:, :460].reshape(-1, 3).astype(int)
    for cloud in junction_clouds(PAPER, 8):
        if cloud.reach.depth == cloud.reach.finger.phalanges:
            colour = [cloud.paint.colour >> shift & 255 for shift in (16, 8, 0)]
            alike = np.abs(scene - colour).max(axis=1) < 12
            assert alike.sum() > 20, cloud.reach.finger.name
    caption = seen.pixels[:, 480:]
    assert np.mean(caption.max(-1) < 110) > 0.005
