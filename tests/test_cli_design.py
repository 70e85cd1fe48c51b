"""The command `design`."""

from __future__ import annotations

import json

import pytest

from tests.test_cli_sweep import assert_complaint
from tests.test_graspable import SMALL
from zygopin import Foot, design
from zygopin.presets import write_parameters


@pytest.fixture
def short_foot(tmp_path):
    """A file of a foot that is quick."""
    return str(write_parameters(tmp_path / "short.yaml", SMALL.to_mapping()))


def test_a_design_is_shown_written_and_drawn(run, short_foot, tmp_path, monkeypatch):
    found, real = [], design.design_foot

    def designed(*arguments, **options):
        found.append(real(*arguments, **options))
        return found[0]

    monkeypatch.setattr(design, "design_foot", designed)
    output, png = tmp_path / "d.yaml", tmp_path / "d.png"
    command = ("design", "--foot", short_foot, "--radii-mm", "8:40", "--trials", "16")
    free = ("--vary", "omega,scale", "--bounds", "omega-deg=60:120", "--workers", "1")
    result = run(*command, *free, "-o", str(output), "--png", str(png))
    assert result.returncode == 0, result.stderr
    lines = result.stdout.splitlines()
    assert lines[0] == "parrot: perches of radius 8 to 40 mm, at rest"
    assert all(len(line) <= 80 for line in lines[:-2])
    assert any("60 to 120" in line and line.startswith(" ω [°]") for line in lines)
    assert "16 feet tried: the best" in lines
    assert lines[-2:] == [f"foot: {output}", f"figure: {png}"]
    assert png.read_bytes().startswith(b"\x89PNG")
    assert Foot.load(output) == found[0].foot
    monkeypatch.setattr(design, "design_foot", lambda *_, **__: found[0])
    document = json.loads(run(*command, *free, "--json").stdout)
    assert Foot.from_mapping(document["after"]["foot"]) == Foot.load(output)
    assert document["range"] == [0.008, 0.04]
    assert list(document["bounds"]) == ["omega", "scale"]


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (("--radii-mm", "3"), "'3' is not LOW:HIGH, such as 3:20"),
        (("--radii-mm", "20:3"), "does not ascend"),
        (("--radii-mm", "3:20", "--vary", "mass"), "choose of rho, omega"),
        (("--radii-mm", "3:20", "--bounds", "mass=1:2"), "is not NAME=LOW:HIGH"),
        (("--radii-mm", "3:20", "--bounds", "rho=1"), "is not LOW:HIGH"),
        (
            ("--radii-mm", "3:20", "--vary", "rho", "--bounds", "splay-deg=1:2"),
            "--bounds splay is not among --vary",
        ),
        (("--radii-mm", "3:20", "--bounds", "rho=0.5:1.5"), "rho = 0.5 is not"),
    ],
)
def test_bad_designs_are_one_line_and_status_2(run, arguments, words):
    assert_complaint(run("design", *arguments), words)
