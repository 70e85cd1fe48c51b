"""The whole report: complete, true, reproducible, and fit for a browser."""

from __future__ import annotations

import cmath
import json
import math
import re
from pathlib import Path

import pytest
from browser import visit
from entry_checks import check_texts
from test_startup import FCL, HOLD, TABLE, assert_only, loaded

from zygopin import FileError, write_paper_report
from zygopin.paper import report as reports
from zygopin.paper.entry import Entry, Measurement, at_most
from zygopin.paper.output import PAGE
from zygopin.paper.report import ENTRIES, PaperReport

HEAVY = TABLE | FCL | HOLD | {"matplotlib", "meshcat", "xacro"}


@pytest.fixture(scope="module")
def written(tmp_path_factory) -> tuple[Path, PaperReport]:
    folder = tmp_path_factory.mktemp("paper")
    return folder, write_paper_report(folder)


@pytest.fixture(scope="module")
def folder(written):
    return written[0]


@pytest.fixture(scope="module")
def report(written):
    return written[1]


@pytest.fixture(scope="module")
def document(folder):
    return json.loads((folder / "report.json").read_text("utf-8"))


@pytest.fixture(scope="module")
def text(folder):
    return (folder / PAGE).read_text("utf-8")


def test_every_number_is_as_it_must_be(report):
    fails = [
        (entry.key, each.name, each.value)
        for entry in report.entries
        for each in entry.measurements
        if not each.holds
    ]
    assert fails == []
    assert report.holds
    assert len(report.entries) == ENTRIES


PHI = (1 + math.sqrt(5)) / 2
COSINE, ROOT = math.cos(math.pi / 12), math.sqrt(3) / 2
TIP = sum(PHI**-k * cmath.exp(-1j * k * math.pi / 6) for k in range(1, 6))

BY_HAND = [
    ("control-system", "x4_re", (TIP - PHI**-5 * cmath.exp(-5j * math.pi / 6)).real),
    ("figure-3", "x_max", 1 / PHI + 1 / PHI**2 + 1 / PHI**3 + 1 / PHI**4),
    ("figure-3", "z_min", -(0.5 / PHI + ROOT / PHI**2 + 1 / PHI**3 + 1 / PHI**4)),
    ("erratum-5", "base_one_level", 1 / (PHI - 1)),
    ("figure-2", "angle_23", math.radians(30)),
    ("figure-2", "angle_12", math.radians(150)),
    ("figure-2", "length_4", sum(1.2**-k for k in range(1, 6))),
    ("erratum-1", "planes_13_printed", math.radians(30)),
    ("erratum-1", "planes_13_ours", 0.0),
    ("erratum-2", "z_printed", -TIP.imag),
    ("erratum-2", "z_ours", TIP.imag),
    ("erratum-3", "angle", math.radians(180 * math.pi / 6)),
    ("figure-4", "half_width", math.sqrt(6) - math.sqrt(2)),
    ("erratum-4", "printed", 1 - COSINE**2),
    ("erratum-4", "printed_once", 1 - math.pi / 12 * COSINE),
    ("erratum-13", "radius_circle", 1 / PHI),
    ("erratum-13", "radius_printed", 1 / PHI / (math.sqrt(3 * COSINE**2 + 1) - 1)),
    ("erratum-13", "radius_true", 1 / PHI / (math.sqrt(3 / COSINE**2 + 1) - 1)),
    ("erratum-8", "normals", 0.0),
    ("erratum-8", "t_finger1", 0.65 * PHI - 1),
    ("scalar-product", "perch_base_to_tip", 0.5),
    ("figure-6", "azimuth_spread", math.radians(300)),
    ("figure-7", "closed_re", TIP.real),
    ("figure-7", "turned", math.radians(150)),
    ("erratum-12", "turn_printed", 5 * math.pi**2 / 36),
    ("erratum-10", "base_off", 1 / PHI),
    ("tlm-map", "instant_ball", 0.45),
    ("erratum-11", "lost_kept", 0.5),
]
"""Entries and numbers of the report, and what they are by hand."""


@pytest.mark.parametrize(("key", "name", "value"), BY_HAND)
def test_numbers_are_those_worked_by_hand(document, key, name, value):
    found = document["entries"][key]["measurements"][name]
    assert found["value"] == pytest.approx(value, abs=found["reference"]["tolerance"])
    assert found["holds"]


def test_figures_propositions_and_errata_are_all_there(document):
    keys = set(document["entries"])
    assert keys >= {f"figure-{number}" for number in range(1, 8)}
    assert keys >= {f"erratum-{number}" for number in range(1, 15)}
    assert keys >= {"proposition-1", "proposition-2", "algorithm", "tlm-map"}


def test_no_two_entries_or_files_share_a_name(report):
    keys = [entry.key for entry in report.entries]
    assert len(set(keys)) == len(keys)
    files = [
        each.name for entry in report.entries for each in entry.figures + entry.scenes
    ]
    assert len(set(files)) == len(files)
    for entry in report.entries:
        names = [each.name for each in entry.measurements]
        assert len(set(names)) == len(names), entry.key
        assert all(map(str.isidentifier, names)), entry.key
        assert "$" not in entry.title


def test_every_text_is_there_and_tex_ends_where_it_begins(report):
    for each in report.entries:
        check_texts(each)


def test_the_page_has_every_figure_and_links_every_scene(folder, report, text):
    figures = {each.name for entry in report.entries for each in entry.figures}
    scenes = {each.name for entry in report.entries for each in entry.scenes}
    assert {path.name for path in (folder / "figures").iterdir()} == figures
    assert {path.name for path in (folder / "scenes").iterdir()} == scenes
    assert text.count("data:image/png;base64,") == len(figures)
    assert set(re.findall(r'href="scenes/([^"]+)"', text)) == scenes


def test_links_of_the_page_lead_somewhere(folder, text):
    ids = re.findall(r'id="([^"]+)"', text)
    assert len(set(ids)) == len(ids)
    for target in re.findall(r'href="([^"]+)"', text):
        if target.startswith("#"):
            assert target[1:] in ids
        elif not target.startswith("data:"):
            assert (folder / target).is_file()


def test_no_tex_is_left_over_and_nothing_is_loaded(text):
    body = text[text.index("<body>") :]
    words = re.sub(r"<[^>]*>", "", body)
    assert "$" not in words
    assert "\\" not in words
    assert re.findall(r'\ssrc="(?!data:)[^"]*', body) == []
    assert "<script" not in text


@pytest.mark.parametrize("size", [(1280, 900), (500, 900)])
def test_a_browser_opens_it_without_complaint(folder, size):
    seen = visit(folder / PAGE, size)
    assert [address for address in seen.requests if not _own(address)] == []
    assert seen.console == ()
    assert seen.pixels.min() < 60  # dark text
    assert seen.pixels[:5].min() == 255  # on white


def _own(address: str) -> bool:
    """Whether an address is the page itself, or inside it."""
    return address.startswith("data:") or address.endswith(PAGE)


def test_the_command_writes_the_same_bytes_again(folder, tmp_path):
    again = tmp_path / "again"
    code = f"from zygopin.cli import main; main(['paper', '-o', {str(again)!r}])"
    assert_only(loaded(code), HEAVY)
    files = sorted(path.relative_to(folder) for path in folder.rglob("*"))
    assert files == sorted(path.relative_to(again) for path in again.rglob("*"))
    for file in files:
        if (folder / file).is_file():
            assert (folder / file).read_bytes() == (again / file).read_bytes(), file


def shortened(monkeypatch, *entries):
    """A report of a few entries, which are quick."""
    makers = tuple(lambda entry=entry: entry for entry in entries)
    monkeypatch.setattr(reports, "_CHAPTERS", {"A chapter": makers})


def entry(value: float) -> Entry:
    number = Measurement("size", "a size", value, at_most(2.0, "by hand"))
    return Entry("erratum-1", "erratum", "A title", "", "", "", "", (number,))


def test_the_command_s_table_and_status_say_what_holds(run, monkeypatch, tmp_path):
    shortened(monkeypatch, entry(1.0))
    done = run("paper", "-o", str(tmp_path))
    assert done.returncode == 0
    assert "Erratum 1" in done.stdout
    assert "1 of 1   yes" in done.stdout
    assert done.stdout.splitlines()[-1] == f"report: {tmp_path / PAGE}"
    shortened(monkeypatch, entry(3.0))
    done = run("paper", "-o", str(tmp_path))
    assert done.returncode == 1
    assert "0 of 1   no" in done.stdout


def test_the_command_prints_one_json_document(run, monkeypatch, tmp_path):
    shortened(monkeypatch, entry(1.0))
    done = run("paper", "-o", str(tmp_path), "--json")
    assert done.stderr == ""
    document = json.loads(done.stdout)
    assert document == json.loads((tmp_path / "report.json").read_text("utf-8"))
    assert document["entries"]["erratum-1"]["measurements"]["size"] == {
        "words": "a size",
        "value": 1.0,
        "unit": "",
        "holds": True,
        "reference": {
            "relation": "≤",
            "value": 2.0,
            "tolerance": 0.0,
            "route": "by hand",
        },
    }


def test_a_folder_that_cannot_be_written_is_one_line(run, tmp_path):
    file = tmp_path / "file"
    file.write_text("")
    done = run("paper", "-o", str(file))
    assert done.returncode == 2
    assert done.stdout == ""
    (line,) = done.stderr.splitlines()
    assert line.startswith("zygopin: ")
    assert "cannot be written" in line
    with pytest.raises(FileError):
        write_paper_report(Path(file))
