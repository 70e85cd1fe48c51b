"""A hold as it is drawn: cones, forces to scale, and the legend."""

from __future__ import annotations

import numpy as np
import pytest
import umsgpack
from stances import perched

from zygopin.canvas import Canvas
from zygopin.contacts import Friction
from zygopin.hold import check_hold
from zygopin.hold_drawing import draw_hold, pull_arrow
from zygopin.scene import export_scene
from zygopin.strength import Strength
from zygopin.viewer import Recorder


def drawn(hold, foot):
    """{path below the scene: geometry} and the legend."""
    recorder = Recorder()
    canvas = Canvas(recorder, np.zeros(3), foot.size)
    keys = draw_hold(canvas, hold, foot, np.zeros(3))
    commands = [umsgpack.unpackb(message) for message in recorder.messages]
    shapes = {
        command["path"].removeprefix("/meshcat/"): command["object"]["geometries"][0]
        for command in commands
        if command["type"] == "set_object"
    }
    return shapes, keys


def test_every_contact_has_its_cone_with_the_slope_of_friction():
    report = perched().report
    hold = check_hold(report, Strength(1.0, Friction(0.4)))
    shapes, keys = drawn(hold, report.foot)
    cones = [shape for path, shape in shapes.items() if "cone" in path]
    assert len(cones) == len(hold.contacts.points)
    for cone in cones:
        radii = sorted((cone["radiusBottom"], cone["radiusTop"]))
        assert radii[0] == 0
        assert radii[1] / cone["height"] == pytest.approx(0.4, abs=1e-4)
    assert keys[0][1] == "friction cone, μ = 0.4"


def test_arrows_are_as_long_as_forces_are_large():
    report = perched().report
    hold = check_hold(report, Strength(2.0, Friction(0.5)))
    shapes, keys = drawn(hold, report.foot)
    forces = np.linalg.norm(hold.pull.contact_forces, axis=-1)
    scales = []
    for number, force in enumerate(forces, start=1):
        parts = [s for p, s in shapes.items() if p.startswith(f"hold/force{number}/")]
        if parts:
            scales.append(sum(part["height"] for part in parts) / force)
    assert len(scales) > 4
    assert scales == pytest.approx([scales[0]] * len(scales), rel=1e-3)
    assert keys[1][1] == f"contact force, the longest {forces.max():.3g} N"


def test_without_friction_or_pull_nothing_false_is_drawn():
    report = perched().report
    slick = check_hold(report, Strength(1.0, Friction(0.0)), (0, 1, 0))
    shapes, keys = drawn(slick, report.foot)
    assert slick.pull.force == 0
    assert shapes == {}
    assert len(keys) == 1


def test_the_pull_points_where_it_pulls():
    report = perched().report
    hold = check_hold(report, Strength(1.0, Friction(0.5)), (3, 0, 4))
    start, end = pull_arrow(hold, report.foot, np.array([1.0, 2, 3]))
    assert start.tolist() == [1, 2, 3]
    assert (end - start) / np.linalg.norm(end - start) == pytest.approx([0.6, 0, 0.8])


def test_the_page_says_how_it_holds(tmp_path):
    report = perched().report
    hold = check_hold(report, Strength(1.0, Friction(0.5)))
    text = export_scene(report, tmp_path / "a.html", hold=hold).read_text()
    plain = export_scene(report, tmp_path / "b.html").read_text()
    assert "Largest pull" in text
    assert f"{hold.pull.force:.3g} N" in text
    assert "Largest pull" not in plain
