"""The report's page: formulas, numbers, and nothing that a text could smuggle in."""

from __future__ import annotations

import subprocess
import sys

import pytest

from zygopin.paper.entry import Entry, Exhibit, Measurement, at_most, equal
from zygopin.paper.page import page, typeset
from zygopin.paper.report import Chapter, PaperReport

NASTY = "</title><script>alert(1)</script>"


def report(*measurements, title="About $x_1$", key="erratum-5", **more):
    entry = Entry(
        key, "erratum", title, "section 1", "printed", "ours", "found", measurements
    )
    return PaperReport((Chapter("A chapter", (entry,)),), **more)


def test_formulas_become_mathml_and_all_else_is_escaped():
    text = typeset(r"a < b, $\rho^{-k}$ & <b>")
    assert text.startswith("a &lt; b, <math")
    assert text.endswith("</math> &amp; &lt;b&gt;")
    assert "<msup>" in text


@pytest.mark.parametrize(
    ("number", "written"),
    [
        (equal(0.0, 0, "x"), "= 0"),
        (equal(-1.0022286, 1e-12, "x"), "= −1.00223 ± 10⁻¹²"),
        (at_most(2.5e-4, "x"), "≤ 2.5·10⁻⁴"),
        (equal(-3e-17, 0, "x"), "= −3·10⁻¹⁷"),
        (equal(31, 0, "x"), "= 31"),
    ],
)
def test_numbers_are_written_as_a_reader_expects(number, written):
    text = page(report(Measurement("a", "words", 1.0, number)), {})
    assert f"<td>{written}</td>" in text


def test_angles_are_shown_in_degrees():
    turn = Measurement("a", "words", 0.5235987755982988, None, "rad")
    assert "<td>30°</td>" in page(report(turn), {})


def test_a_number_that_fails_is_shown_to_fail():
    bad = Measurement("a", "words", 3.0, at_most(2.0, "x"))
    text = page(report(bad, Measurement("b", "words", 3.0)), {})
    assert "✗ fails" in text
    assert '<p class="verdict bad">' in text
    assert "0\nof 1 entries hold,\n0 of\n1 numbers are as they must be." in text
    good = Measurement("a", "words", 1.0, at_most(2.0, "x"))
    assert '<p class="verdict good">' in page(report(good), {})


def test_no_text_breaks_out_of_the_page():
    nasty = Measurement(NASTY, NASTY, 1.0, at_most(2.0, NASTY))
    entry = Entry(
        f'"{NASTY}-1',
        "figure",
        NASTY,
        NASTY,
        NASTY,
        NASTY,
        NASTY,
        (nasty,),
        (Exhibit("a.png", f'"{NASTY}', print),),
        (Exhibit(f'"{NASTY}', NASTY, print),),
    )
    text = page(PaperReport((Chapter(NASTY, (entry,)),)), {"a.png": b"picture"})
    assert "<script" not in text
    assert 'id="&#34;' in text


@pytest.mark.parametrize("package", ["jinja2", "latex2mathml"])
def test_a_package_that_is_missing_names_the_extra(package, tmp_path):
    code = (
        f"import sys; sys.modules[{package!r}] = None; from zygopin.cli import main; "
    )
    command = [sys.executable, "-c", f"{code}main(['paper', '-o', {str(tmp_path)!r}])"]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 2
    remedy = "pip install 'zygopin[paper]' adds it"
    assert done.stderr == f"zygopin: {package} is not installed: {remedy}\n"
    assert list(tmp_path.iterdir()) == []


def test_pictures_are_inside_the_page():
    entry = Entry(
        "figure-1",
        "figure",
        "A title",
        "section 1",
        "",
        "",
        "",
        (),
        (Exhibit("a.png", r"with $\rho$", print),),
    )
    text = page(PaperReport((Chapter("A chapter", (entry,)),)), {"a.png": b"picture"})
    assert 'src="data:image/png;base64,cGljdHVyZQ=="' in text
    assert 'alt="with rho"' in text
