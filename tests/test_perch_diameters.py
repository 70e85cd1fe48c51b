"""The script that draws grip over the perch's diameter."""

from __future__ import annotations

import importlib.machinery
import importlib.util
import subprocess
import sys
from pathlib import Path

import pytest

from zygopin import Branch, Foot, Friction, Strength, check_hold, plan_perch

SCRIPT = Path(__file__).parent.parent / "scripts" / "perch-diameters"
STRENGTH = Strength(1.0, Friction(0.5))


@pytest.fixture(scope="module")
def script():
    name = "perch_diameters"
    loader = importlib.machinery.SourceFileLoader(name, str(SCRIPT))
    module = importlib.util.module_from_spec(
        importlib.util.spec_from_loader(name, loader)
    )
    sys.modules[name] = module
    writes, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    loader.exec_module(module)
    sys.dont_write_bytecode = writes
    return module


def test_a_row_is_what_the_public_functions_say(script):
    foot = Foot.preset("parrot")
    start = Branch(0.005, (0, 0, -0.01 - foot.thickness))
    hold = check_hold(plan_perch(foot, start, find_height=True).report, STRENGTH)
    one = script.grip(foot, 10.0, STRENGTH)
    assert (one.pull, one.quality) == (hold.pull.force, hold.quality.low)
    assert one.contacts == len(hold.contacts.points)
    assert one.grasping
    assert one.held


def test_the_figure_shows_the_rows_names_its_axes_and_its_source(script):
    grips = [
        script.Grip(5.0, grasping=True, contacts=4, held=True, quality=0.2, pull=0.8),
        script.Grip(50.0, grasping=False),
    ]
    figure = script.draw(grips, STRENGTH)
    above, below = figure.axes
    for panel, heights in ((above, [0.8, 0]), (below, [0.2, 0])):
        curves = [line for line in panel.lines if line.get_marker() == "o"]
        assert curves[0].get_xdata().tolist() == [5.0, 50.0]
        assert curves[0].get_ydata().tolist() == heights
    assert "[N]" in above.get_ylabel()
    assert "quality" in below.get_ylabel()
    assert "[mm]" in below.get_xlabel()
    said = figure.get_suptitle()
    assert "10.1242/jeb.244818" in said
    assert "Illustration" in said
    assert "assumed" in said


def test_it_prints_the_table_and_writes_the_figure(tmp_path):
    file = tmp_path / "a.png"
    words = [sys.executable, SCRIPT, "--diameters", "10", "--png", file]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert done.stdout.startswith("diameter")
    assert "jeb.244818" in done.stdout
    assert max(map(len, done.stdout.splitlines())) <= 80
    assert file.read_bytes().startswith(b"\x89PNG")
