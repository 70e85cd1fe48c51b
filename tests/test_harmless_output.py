"""What is written does no harm: words stay words, and files stay where they belong."""

from __future__ import annotations

import html
import os
import re
import subprocess
import sys
from html.parser import HTMLParser
from xml.etree import ElementTree as ET

import numpy as np
import pytest

from tests.browser import visit
from tests.made_atlases import made_atlas
from tests.made_strikes import made_strike
from zygopin import (
    Branch,
    Foot,
    check_grasp,
    export_atlas_scene,
    export_reach_scene,
    export_scene,
    export_strike,
    to_mjcf,
    to_srdf,
    to_urdf,
    write_description,
)
from zygopin.errors import FileError
from zygopin.files import within
from zygopin.paper.entry import Entry, Exhibit
from zygopin.paper.page import page
from zygopin.paper.report import Chapter, PaperReport

# What is written -------------------------------------------------------------------

NASTY = (
    "</script></title></style><script>window.top.alert(1);"
    'fetch("http://127.0.0.1:9/ran")</script>'
    "<img src=x onerror='fetch(\"http://127.0.0.1:9/ran\")'>\"'>&lt;\u2028${1+1}"
)


class Page(HTMLParser):
    """A page's elements, and the text that a reader sees in them."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.seen = [], []
        self.feed(text)
        self.close()

    def handle_starttag(self, tag, attributes):
        self.tags.append((tag, sorted(name for name, _ in attributes)))

    def handle_data(self, data):
        self.seen.append(data)


def report():
    controls = np.full(14, 0.5)
    return check_grasp(Foot.preset("parrot"), controls, Branch(0.008, (0, 0, -0.01)))


def paper_page(_, path, title):
    title = title.replace("$", "")  # where TeX begins
    exhibit = Exhibit(title, title, print)
    entry = Entry(title, "figure", *[title] * 5, (), (), (exhibit,))
    text = page(PaperReport((Chapter(title, (entry,)),)), {})
    path.write_text(text, "utf-8")


def scene(export, make):
    return lambda made, path, title: export(made(make), path, title=title)


PAGES = {
    "grasp": scene(export_scene, report),
    "strike": scene(export_strike, made_strike),
    "atlas": scene(export_atlas_scene, made_atlas),
    "reach": scene(
        export_reach_scene,
        lambda: Foot.preset("paper"),
    ),
    "paper": paper_page,
}


@pytest.fixture(scope="module")
def nasty_pages(tmp_path_factory):
    """Each kind of page, with plain words and with nasty ones."""
    folder, kept = tmp_path_factory.mktemp("pages"), {}

    def made(make):
        return kept.setdefault(make, make())

    for kind, write in PAGES.items():
        write(made, folder / f"{kind}-plain.html", "A title")
        write(made, folder / f"{kind}.html", NASTY)
    return folder


@pytest.mark.parametrize("kind", PAGES)
def test_words_make_no_element_of_any_page(kind, nasty_pages):
    texts = [
        (nasty_pages / f"{kind}{end}.html").read_text("utf-8") for end in ("", "-plain")
    ]
    nasty, plain = map(Page, texts)
    assert nasty.tags == plain.tags
    words = NASTY.replace("$", "") if kind == "paper" else NASTY
    assert any(words in seen for seen in nasty.seen)
    assert html.escape("<script>") in texts[0]


def test_words_run_nothing_in_a_browser(nasty_pages):
    frames = "".join(f'<iframe src="{kind}.html"></iframe>' for kind in PAGES)
    outer = nasty_pages / "outer.html"
    outer.write_text('<img src="http://127.0.0.1:9/control">' + frames)
    seen = visit(outer, (400, 300))
    assert seen.requests == ("http://127.0.0.1:9/control",)


def test_xml_holds_names_as_names():
    foot = Foot.preset("owl")
    for text in (to_urdf(foot), to_srdf(foot), to_mjcf(foot)):
        for element in ET.fromstring(text).iter():  # noqa: S314 our own
            assert re.fullmatch(r"[a-z_]+", str(element.tag)), element.tag


# Where it is written ---------------------------------------------------------------


@pytest.mark.parametrize("name", ["../a", "/a", "below/../../a", "link/a", "out"])
def test_no_name_leads_out_of_an_output_folder(name, tmp_path):
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "link").symlink_to(tmp_path, target_is_directory=True)
    (folder / "out").symlink_to(tmp_path / "a")
    with pytest.raises(FileError, match=r"out of its folder: remove the link"):
        within(folder, name)
    with pytest.raises(FileError, match=r"cannot be written: .*null"):
        within(folder, "a\0b")
    assert within(folder, "below", "a") == folder / "below" / "a"
    linked = tmp_path / "linked"
    linked.symlink_to(folder, target_is_directory=True)
    assert within(linked, "a") == linked / "a"


def test_a_link_in_the_folder_of_a_description_is_not_followed(tmp_path):
    kept = tmp_path / "kept"
    kept.write_text("kept")
    folder = tmp_path / "folder"
    folder.mkdir()
    (folder / "foot.srdf").symlink_to(kept)
    with pytest.raises(FileError, match="out of its folder"):
        write_description(Foot.preset("parrot"), folder)
    assert kept.read_text() == "kept"
    assert [path.name for path in folder.iterdir()] == ["foot.srdf"]


def test_an_error_s_path_is_one_line_too():
    error = FileError("a\nb\x1b[31m\udcff", "cannot be read", "name another")
    assert str(error) == r"'a\nb\x1b[31m\udcff': cannot be read: name another"


# What else goes on -----------------------------------------------------------------

WATCHED = """
import os, pathlib, sys
import numpy as np
import matplotlib.font_manager  # asks the system for its fonts, the first time
from zygopin import *
from tests import test_harmless_output as safety
folder = sys.argv[1]
told = []
FORBIDDEN = ("socket.", "subprocess.", "os.exec", "os.fork", "os.posix", "os.system")
def watch(event, values):
    if event.startswith(FORBIDDEN):
        told.append((event, str(values)[:80]))
    writes = event == "open" and (values[2] or 0) & (os.O_WRONLY | os.O_RDWR)
    if writes and not str(values[0]).startswith((folder, "/dev/null")):
        told.append((event, str(values[0])))
sys.addaudithook(watch)
os.environ["TMPDIR"] = folder
foot = Foot.preset("parrot")
report = safety.report()
hold = check_hold(report, Strength(1.0, Friction(0.5)))
export_scene(report, folder + "/a.html", hold=hold)
export_strike(safety.made_strike(), folder + "/b.html")
atlas = safety.made_atlas()
export_atlas_scene(atlas, folder + "/c.html")
save_atlas(atlas, folder + "/c.npz")
plot_atlas(atlas, folder + "/c.png")
export_reach_scene(foot, folder + "/d.html", levels=2)
save_strike(safety.made_strike(), folder + "/e.json")
write_description(foot.replace(rho=1.3), folder + "/f", glb=True)
safety.paper_page(None, pathlib.Path(folder, "g.html"), "A title")
FootModel(foot).forward(np.ones(14))
held = []
for number in os.listdir("/proc/self/fd"):
    if os.path.islink(f"/proc/self/fd/{number}"):
        held.append(os.readlink(f"/proc/self/fd/{number}"))
print(told, [each for each in held if each.startswith("socket")])
with open(f"/proc/self/task/{os.getpid()}/children") as children:
    print(children.read().split())
"""


def test_writing_opens_no_port_starts_no_process_and_writes_nothing_else(tmp_path):
    environment = {**os.environ, "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", WATCHED, str(tmp_path)],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.stderr == ""
    assert done.stdout.splitlines() == ["[] []", "[]"]
    assert len(list(tmp_path.iterdir())) == 9
