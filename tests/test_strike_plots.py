"""Figures of the owl's strike: what they show, pixel by pixel, and bad input."""

from __future__ import annotations

import numpy as np
import pytest
from PIL import Image

from zygopin import (
    Branch,
    Closing,
    Flight,
    Foot,
    Motion,
    Sphere,
    plot_engagement,
    plot_remark,
    plot_strike,
    simulate_strike,
)
from zygopin.errors import FileError, ParameterError, UnknownNameError
from zygopin.figures import ACCENT, line_width
from zygopin.looks import finger_paint
from zygopin.remark_plots import LOST, WOOD
from zygopin.strike_plots import MODE_COLOURS

PAPER, OWL = Foot.preset("paper"), Foot.preset("owl")
FALL = Flight(Motion.through([0, 0.2], [(0, 0, 0.1), (0, 0, -0.02)]))
PERCH = Branch(0.018, (0, 0, -0.02))


def pixels(path):
    with Image.open(path) as image:
        return np.asarray(image.convert("RGB")).astype(int)


def share(picture, colour, slack=6):
    """Share of pixels of one colour, given as CSS."""
    wanted = [int(colour[place : place + 2], 16) for place in (1, 3, 5)]
    return float(np.mean(np.abs(picture - wanted).max(axis=-1) <= slack))


def chroma(picture):
    return np.ptp(picture, axis=-1)


def strike(obstacle=PERCH, reading="contact"):
    closing = Closing(reading=reading)
    return simulate_strike(OWL, obstacle, FALL, closing=closing, frames=60)


@pytest.mark.parametrize("foot", [PAPER, OWL, Foot.preset("anisodactyl")])
def test_toe_and_talon_are_drawn_side_by_side(foot, tmp_path):
    picture = pixels(plot_engagement(foot, tmp_path / "a.png"))
    height, width, _ = picture.shape
    assert width == 1650
    assert 400 < height < 1100
    coloured = chroma(picture) > 60
    toe, talon = coloured[:, : width // 2].sum(), coloured[:, width // 2 : -250].sum()
    assert toe > 4 * talon > 400


def test_more_stages_draw_more(tmp_path):
    few = pixels(plot_engagement(PAPER, tmp_path / "a.png", stages=3))
    many = pixels(plot_engagement(PAPER, tmp_path / "b.png", stages=12))
    named = pixels(plot_engagement(PAPER, tmp_path / "c.png", stages=[0.0, 0.5, 1.0]))
    assert np.sum(chroma(many) > 60) > 1.3 * np.sum(chroma(few) > 60)
    np.testing.assert_array_equal(few, named)


def test_the_finger_can_be_chosen(tmp_path):
    last = pixels(plot_engagement(PAPER, tmp_path / "a.png"))
    named = pixels(plot_engagement(PAPER, tmp_path / "b.png", finger="finger4"))
    other = pixels(plot_engagement(PAPER, tmp_path / "c.png", finger=1))
    np.testing.assert_array_equal(last, named)
    assert other.shape != last.shape or np.any(other != last)


@pytest.fixture(scope="module")
def drawn(tmp_path_factory):
    """Pictures of a strike in either reading, and of one that meets nothing."""
    folder = tmp_path_factory.mktemp("strikes")
    strikes = {reading: strike(reading=reading) for reading in ("paper", "contact")}
    strikes["miss"] = strike(Sphere(0.01, (1, 0, 0)))
    return {
        name: pixels(plot_strike(each, folder / f"{name}.png"))
        for name, each in strikes.items()
    }


@pytest.mark.parametrize("reading", ["paper", "contact"])
def test_a_strike_shows_its_modes_and_every_finger(reading, drawn):
    picture = drawn[reading]
    assert share(picture, MODE_COLOURS["closing"]) > 0.15
    assert share(picture, MODE_COLOURS["locked"]) > 0.05
    for index in range(4):
        assert share(picture, finger_paint(index).css, slack=25) > 2e-4


def test_a_strike_that_meets_nothing_shows_one_mode(drawn):
    picture, both = drawn["miss"], drawn["contact"]
    assert share(picture, MODE_COLOURS["closing"]) < 1e-4
    assert 1.8 * picture.shape[1] < both.shape[1]
    assert picture.shape[0] == both.shape[0]


@pytest.mark.parametrize("foot", [PAPER, OWL])
def test_the_remark_shows_ball_contact_and_loss(foot, tmp_path):
    picture = pixels(plot_remark(foot, tmp_path / "a.png"))
    left = picture[:, : picture.shape[1] // 2]
    assert share(left, WOOD) > 1e-4
    assert share(left, ACCENT) > 2e-3
    assert share(left, LOST) > 2e-3


def test_figures_repeat_and_name_no_program(tmp_path):
    first = plot_engagement(PAPER, tmp_path / "a.png").read_bytes()
    assert plot_engagement(PAPER, tmp_path / "b" / "a.png").read_bytes() == first
    assert b"Software" not in first


def test_lines_that_coincide_get_thinner():
    widths = [line_width(index, 4) for index in range(4)]
    assert widths == sorted(widths, reverse=True)
    assert line_width(0, 1) == widths[-1]


def test_bad_values_are_named_and_leave_no_file(tmp_path):
    file = tmp_path / "a.png"
    with pytest.raises(ParameterError, match=r"stages\[1\] = 1.5 is not in \[0, 1\]"):
        plot_engagement(PAPER, file, stages=[0, 1.5])
    with pytest.raises(ParameterError, match="number of stages = 0"):
        plot_engagement(PAPER, file, stages=[])
    with pytest.raises(ParameterError, match="stages = 1 is not an integer from 2"):
        plot_engagement(PAPER, file, stages=1)
    with pytest.raises(UnknownNameError, match="thumb"):
        plot_engagement(PAPER, file, finger="thumb")
    with pytest.raises(ParameterError, match="lost_at"):
        plot_remark(PAPER, file, lost_at=0)
    with pytest.raises(FileError, match="cannot be written"):
        plot_remark(PAPER, tmp_path)
    assert not list(tmp_path.iterdir())
