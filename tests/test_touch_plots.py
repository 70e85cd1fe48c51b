"""The figure of touch intervals: bands where radii can be touched, and bad input."""

from __future__ import annotations

import numpy as np
import pytest
from test_strike_plots import pixels, share

from zygopin import Branch, Foot, ParameterError, plot_touch_bands
from zygopin.errors import FileError
from zygopin.looks import finger_paint

PAPER = Foot.preset("paper")
BELOW = Branch(0.1, (0, 0, -0.6))
FEW = {"omegas": np.radians([20, 60, 100]), "rhos": [1.3, 1.7]}


def test_every_finger_has_its_band_and_bytes_are_stable(tmp_path):
    path = plot_touch_bands(PAPER, BELOW, tmp_path / "bands.png", **FEW)
    picture = pixels(path)
    assert picture.shape == (720, 1650, 3)
    for index in range(4):
        assert share(picture, finger_paint(index).css, slack=40) > 1e-4
    shaded = np.mean(np.ptp(picture, axis=-1) > 4)
    assert 0.2 < shaded < 0.9
    again = plot_touch_bands(PAPER, BELOW, tmp_path / "again.png", **FEW)
    assert path.read_bytes() == again.read_bytes()


def test_an_axis_that_is_never_clear_has_no_band(tmp_path):
    through = Branch(0.1, (0, 0, 0))
    picture = pixels(plot_touch_bands(PAPER, through, tmp_path / "none.png", **FEW))
    assert np.mean(np.ptp(picture, axis=-1) > 4) < 0.02


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"omegas": [0.5]}, "ascending"),
        ({"omegas": [0.5, 0.4]}, "ascending"),
        ({"rhos": [0.5, 1.2]}, "rho = 0.5"),
        ({"branch": Branch(0.1, np.full((2, 3), -1.0))}, "one axis at a time"),
        ({"foot": "paper"}, "zygopin.Foot"),
    ],
)
def test_bad_input_is_named(tmp_path, changes, message):
    given = {"foot": PAPER, "branch": BELOW, **FEW, **changes}
    foot, branch = given.pop("foot"), given.pop("branch")
    with pytest.raises(ParameterError, match=message):
        plot_touch_bands(foot, branch, tmp_path / "bands.png", **given)
    assert not list(tmp_path.iterdir())


def test_a_file_that_cannot_be_written_is_told(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError):
        plot_touch_bands(PAPER, BELOW, tmp_path / "file" / "bands.png", **FEW)
