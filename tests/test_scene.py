"""The exported scene: its bytes, its safety, and what a browser makes of it."""

import functools
import os
import re
import subprocess
import sys

import numpy as np
import pytest
from browser import visit

from zygopin.branch import Branch, branch_axis
from zygopin.drawing import GRASPING, PENETRATING, STABLE, TOUCHING, contact_paint
from zygopin.errors import FileError, ParameterError
from zygopin.foot import Foot
from zygopin.grasp import check_grasp
from zygopin.looks import FINGER_PAINTS, WOOD
from zygopin.scene import export_scene, grasp_view

HOSTILE = "</script><script>alert(1)</script><img src=x onerror=alert(2)>&\"'"
FRAME, PANE = (330, 425), 238
"""A small window's size, and the height that its scene takes [pixels]."""


def closed_on(foot, branch):
    """Close each joint in turn until its phalanx meets the branch, or a finger."""
    controls = np.zeros(foot.phalanx_count)
    for phalanx in range(foot.phalanx_count):
        trials = np.repeat(controls[None], 129, axis=0)
        low, high = 0.0, 1.0
        for _ in range(8):
            trials[:, phalanx] = np.linspace(low, high, 129)
            found = check_grasp(foot, trials, branch)
            clear = (found.clearance[:, phalanx] >= 0) & (found.finger_clearance >= 0)
            last = int(np.argmin(clear)) - 1 if not clear.all() else 128
            low, high = (
                trials[max(last, 0), phalanx],
                trials[min(last + 1, 128), phalanx],
            )
        controls[phalanx] = low
    return controls


def perched(name, radius, lift, yaw=0.0, pitch=0.0):
    """A shipped foot closed on a branch that runs a lift below its base's skin."""
    foot, axis = Foot.preset(name), branch_axis(yaw, pitch)
    up = np.cross(axis, np.cross((0.0, 0.0, 1.0), axis))
    up /= np.linalg.norm(up)
    branch = Branch(radius, -(radius + foot.radii.max() + lift) * up, axis)
    return check_grasp(foot, closed_on(foot, branch), branch)


@functools.cache
def reports():
    paper = Foot.preset("paper")
    return {
        "parrot": perched("parrot", 0.008, 0.0045),
        "paper": check_grasp(paper, np.ones(14), Branch(0.65, (0, 0, -0.65))),
        "yawed": perched("parrot", 0.008, 0.004, yaw=0.5, pitch=0.4),
        "turned": perched("owl", 0.016, 0.009, yaw=-0.7, pitch=-0.3),
        "anisodactyl": perched("anisodactyl", 0.005, 0.0025),
        "trunk": perched("parrot", 0.3, 0.0),
    }


@pytest.fixture(scope="module")
def gallery(tmp_path_factory):
    """All reports' scenes, side by side in one browser: the visit, and each picture."""
    folder = tmp_path_factory.mktemp("gallery")
    frames = []
    for name, report in reports().items():
        page = export_scene(report, folder / f"{name}.html", title=f"{name} {HOSTILE}")
        frames.append(f'<iframe src="{page.as_uri()}"></iframe>')
    width, height = FRAME
    style = (
        "body { margin: 0; display: flex; flex-wrap: wrap }"
        f"iframe {{ border: 0; width: {width}px; height: {height}px }}"
    )
    sheet = folder / "sheet.html"
    sheet.write_text(f"<style>{style}</style>{''.join(frames)}")
    seen = visit(sheet, (3 * width, 2 * height))
    pictures = {}
    for index, name in enumerate(reports()):
        top, left = index // 3 * height, index % 3 * width
        pictures[name] = seen.pixels[top : top + PANE, left : left + width]
    return seen, pictures


def coloured(pixels, colour):
    """Where pixels have a colour's hue, in whatever light, shape (H, W)."""
    wanted = np.array([colour >> shift & 0xFF for shift in (16, 8, 0)], float)
    wanted -= wanted.min()
    chroma = pixels.astype(float) - pixels.min(-1, keepdims=True)
    size = np.linalg.norm(chroma, axis=-1)
    alike = chroma @ wanted / np.maximum(size * np.linalg.norm(wanted), 1e-9)
    return (size > 25) & (alike > 0.985)


def fingers(pixels, count=4):
    masks = [coloured(pixels, paint.colour) for paint in FINGER_PAINTS[:count]]
    return np.array(masks)


def extent(mask):
    """Least and greatest place across and up the picture, from 0 to 1, shape (2, 2)."""
    rows, columns = np.nonzero(mask)
    height, width = mask.shape
    return np.array(
        [
            [columns.min() / width, columns.max() / width],
            [rows.min() / height, rows.max() / height],
        ]
    )


def test_bytes_repeat_within_a_process(tmp_path):
    report = reports()["parrot"]
    first = export_scene(report, tmp_path / "a.html").read_bytes()
    assert export_scene(report, tmp_path / "new" / "b.html").read_bytes() == first


def test_bytes_repeat_across_processes(tmp_path):
    script = (
        "import sys, numpy as np\n"
        "from zygopin.foot import Foot\n"
        "from zygopin.branch import Branch\n"
        "from zygopin.grasp import check_grasp\n"
        "from zygopin.scene import export_scene\n"
        "branch = Branch(0.65, (0, 0, -0.65))\n"
        "report = check_grasp(Foot.preset('paper'), np.ones(14), branch)\n"
        "export_scene(report, sys.argv[1])\n"
    )
    pages = []
    for seed in ("1", "2"):
        page = tmp_path / f"{seed}.html"
        environment = {**os.environ, "PYTHONHASHSEED": seed}
        command = [sys.executable, "-c", script, str(page)]
        subprocess.run(command, env=environment, check=True, timeout=60)
        pages.append(page.read_bytes())
    assert pages[0] == pages[1]
    assert (
        export_scene(reports()["paper"], tmp_path / "3.html").read_bytes() == pages[0]
    )


def test_starts_no_process_and_opens_no_socket(tmp_path, monkeypatch):
    def refuse(*_, **__):
        raise AssertionError("no process, no socket")

    monkeypatch.setattr("subprocess.Popen", refuse)
    monkeypatch.setattr("socket.socket", refuse)
    monkeypatch.setattr("zmq.Context.socket", refuse)
    assert export_scene(reports()["parrot"], tmp_path / "a.html").is_file()


def test_hostile_title_is_text(tmp_path):
    page = export_scene(reports()["parrot"], tmp_path / "a.html", title=HOSTILE)
    text = page.read_text("utf-8")
    assert "alert(1)</script>" not in text
    assert "<img src=x" not in text
    assert text.count("&lt;/script&gt;&lt;script&gt;alert(1)") == 3
    assert len(re.findall("(?i)</script", text)) == 3


def test_names_no_machine_and_no_time(tmp_path):
    text = export_scene(reports()["parrot"], tmp_path / "a.html").read_text("utf-8")
    assert str(tmp_path) not in text
    assert os.path.expanduser("~") + "/" not in text


def test_batch_is_refused_in_one_line(tmp_path):
    report = check_grasp(
        Foot.preset("paper"), np.ones((3, 14)), Branch(1.0, (0, 0, -2))
    )
    with pytest.raises(ParameterError, match="one configuration") as caught:
        export_scene(report, tmp_path / "a.html")
    assert "\n" not in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_unwritable_file_is_a_file_error(tmp_path):
    (tmp_path / "taken").write_text("")
    with pytest.raises(FileError):
        export_scene(reports()["parrot"], tmp_path / "taken" / "a.html")


def test_view_scales_with_the_foot():
    foot = Foot.preset("paper")
    small = check_grasp(foot, np.ones(14), Branch(0.65, (0, 0, -0.65)))
    large = check_grasp(foot.replace(scale=1e3), np.ones(14), Branch(650, (0, 0, -650)))
    views = grasp_view(small), grasp_view(large)
    assert views[1].unit == pytest.approx(1e3 * views[0].unit)
    assert views[1].half_height == pytest.approx(views[0].half_height)
    np.testing.assert_allclose(views[1].direction, views[0].direction)


def test_contacts_are_coloured_by_verdict():
    def paints(name, which):
        report = reports()[name]
        return {contact_paint(report, i) for i in np.flatnonzero(which(report))}

    assert paints("parrot", lambda report: report.tangent) == {GRASPING}
    assert paints("paper", lambda report: report.penetrating) == {PENETRATING}
    assert paints("trunk", lambda report: report.tangent) == {STABLE}
    merely = paints("trunk", lambda report: report.touching & ~report.tangent)
    assert merely <= {TOUCHING}


def test_page_writes_nothing_to_the_console(gallery):
    assert gallery[0].console == ()


def test_page_asks_for_nothing(gallery):
    assert gallery[0].requests == ()


def test_policy_stops_what_is_smuggled_in(tmp_path):
    page = export_scene(reports()["paper"], tmp_path / "a.html")
    spy = '<img src="http://127.0.0.1:9/{0}"><script>fetch("http://127.0.0.1:9/{0}")</script>'
    text = page.read_text("utf-8").replace("<body>", "<body>" + spy.format("leak"))
    page.write_text(text, "utf-8")
    outer = tmp_path / "outer.html"
    frame = f'<iframe src="{page.as_uri()}"></iframe>'
    outer.write_text('<img src="http://127.0.0.1:9/control">' + frame)
    seen = visit(outer, (300, 200))
    assert seen.requests == ("http://127.0.0.1:9/control",)
    assert any("Content Security Policy" in line for line in seen.console)


@pytest.mark.parametrize("name", ["parrot", "paper", "yawed", "turned", "anisodactyl"])
def test_frame_holds_foot_and_branch_in_its_middle(gallery, name):
    picture = gallery[1][name]
    drawn = fingers(picture).any(0) | coloured(picture, WOOD.colour)
    place = extent(drawn)
    middle, size = place.mean(axis=1), np.ptp(place, axis=1)
    assert np.all(np.abs(middle - 0.5) < 0.12)
    assert 0.6 < size.max() < 0.99
    assert 0.15 < drawn.mean() < 0.8


def test_frame_holds_the_foot_on_a_trunk(gallery):
    place = extent(fingers(gallery[1]["trunk"]).any(0))
    assert np.all(np.abs(place.mean(axis=1) - 0.5) < 0.15)
    assert 0.7 < np.ptp(place[0]) < 0.99


@pytest.mark.parametrize("name", [*reports()])
def test_fingers_and_branch_are_seen(gallery, name):
    picture = gallery[1][name]
    assert np.sum(coloured(picture, WOOD.colour)) > 1000
    seen = fingers(picture).sum(axis=(1, 2))
    assert np.sum(seen > 20) >= (2 if name == "paper" else 3)


def test_wide_window_sets_the_caption_beside_the_scene(tmp_path):
    page = export_scene(reports()["trunk"], tmp_path / "a.html")
    seen = visit(page, (1000, 420))
    scene, caption = seen.pixels[:, :660], seen.pixels[:, 680:]
    assert fingers(scene).any(0).sum() > 1000
    assert np.mean(caption.min(-1) > 240) > 0.7
    assert np.mean(caption.max(-1) < 110) > 0.005
    assert seen.console == ()
