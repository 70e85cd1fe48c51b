"""The design optimiser: never worse, always the same, within its bounds."""

from __future__ import annotations

import math

import pytest
from PIL import Image

from tests.test_graspable import SMALL
from zygopin import Foot, design_foot, graspable_radii, plot_design
from zygopin.design import BOUNDS, Design, merit, varied_foot
from zygopin.design_output import design_document, design_rows, write_design
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.graspable import GraspableRadii

RANGE = (0.008, 0.04)
"""Radii of which the small foot grasps a part."""


FREE = {"omega": None, "scale": None}

BEFORE, AFTER = (0x22, 0x27, 0x2E), (0xC0, 0x39, 0x2B)
"""Colours of the bars."""


def colours(path):
    """How many pixels of an image have each colour."""
    counted = Image.open(path).convert("RGB").getcolors(1 << 20)
    return {colour: count for count, colour in counted}


@pytest.fixture(scope="module", autouse=True)
def one_finalist():
    """The best foot of each search alone is looked at exactly."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("zygopin.design.FINALISTS", 1)
        yield


@pytest.fixture(scope="module")
def design():
    return design_foot(SMALL, *RANGE, bounds=FREE, trials=16)


def test_a_better_foot_is_found(design):
    assert design.improved
    assert design.after.share > design.before.share + 0.05
    assert design.trials == 16
    assert design.foot.name == "parrot_design"


def test_its_perches_are_those_of_the_foot(design):
    for each in (design.before, design.after):
        assert graspable_radii(each.foot, *RANGE) == each
    assert design.before.foot == SMALL


def test_it_keeps_to_its_bounds_and_to_the_family(design):
    foot = design.foot
    assert design.bounds["scale"] == pytest.approx((0.0055, 0.022))
    for name, (low, high) in design.bounds.items():
        assert low <= getattr(foot, name) <= high
    assert (foot.rho, foot.splay) == (SMALL.rho, SMALL.splay)
    assert foot.thickness / foot.scale == pytest.approx(SMALL.thickness / SMALL.scale)


def test_other_processes_find_the_same(design):
    again = design_foot(SMALL, *RANGE, bounds=FREE, trials=16, workers=2)
    assert again.after == design.after
    assert again.before == design.before


def peaked(omega, splay):
    """Perches as if a foot grasped most with this ω and this splay."""

    def perches(foot, low, high, **_):
        miss = math.hypot(foot.omega - omega, foot.splay - splay)
        top = low * (high / low) ** math.exp(-miss)
        return GraspableRadii(foot, low, high, 1e-6, ((low, top),), 0.0, 1)

    return perches


def test_the_search_finds_a_known_best_foot(monkeypatch):
    monkeypatch.setattr("zygopin.design.graspable_radii", peaked(1.1, 0.4))
    found = design_foot(SMALL, *RANGE, bounds={"omega": None, "splay": None})
    assert found.trials == 160
    assert (found.foot.omega, found.foot.splay) == pytest.approx((1.1, 0.4), abs=0.05)
    assert found.after.share == pytest.approx(1, abs=0.05)


def test_a_foot_that_cannot_be_bettered_is_given_back(monkeypatch):
    best = peaked(SMALL.omega, SMALL.splay)
    monkeypatch.setattr("zygopin.design.graspable_radii", best)
    found = design_foot(SMALL, *RANGE, trials=16)
    assert not found.improved
    assert found.foot == SMALL


def test_wrap_decides_only_between_equals():
    one = graspable_radii(SMALL, *RANGE, levels=2, samples=3)
    wrapped = type(one)(**{**vars(one), "wrap": one.wrap + math.pi})
    assert merit(wrapped) - merit(one) == pytest.approx(1e-3)


def test_the_skin_goes_with_the_scale():
    foot = varied_foot(SMALL, {"scale": 3 * SMALL.scale, "rho": 1.5})
    assert foot.thickness == pytest.approx(3 * SMALL.thickness)
    assert foot.rho == 1.5


def test_the_foot_is_written_as_it_is_read(design, tmp_path):
    path = write_design(design, tmp_path / "foot.yaml")
    assert Foot.load(path) == design.foot
    assert "Designed from parrot for perches of radius 8 to 40 mm" in path.read_text()


def test_tables_and_documents_hold_both_feet(design):
    rows = {row[0]: row[1:] for row in design_rows(design)}
    assert rows["ω [°]"][0] == "90"
    assert rows["ω [°]"][2] == "30 to 120"
    assert rows["ρ"] == ("1.18", "1.18", "")
    assert rows["share of the range"][0] == f"{design.before.share:.1%}"
    document = design_document(design)
    assert document["improved"] is True
    assert Foot.from_mapping(document["after"]["foot"]) == design.foot
    assert document["after"]["intervals"] == [list(x) for x in design.after.intervals]


def test_a_foot_that_grew_to_metres_has_its_bar(tmp_path):
    grown = SMALL.replace(scale=SMALL.scale * 60)  # figures of it alone are in metres
    made = [
        GraspableRadii(foot, *RANGE, 1e-6, (RANGE,), 0.0, 1) for foot in (SMALL, grown)
    ]
    counts = colours(plot_design(Design(*made, {}, 16), tmp_path / "a.png"))
    shares = [counts[colour] for colour in (BEFORE, AFTER)]
    assert shares[1] == pytest.approx(shares[0], rel=0.05)


def test_the_figure_shows_the_bars_and_is_always_the_same(design, tmp_path):
    paths = [plot_design(design, tmp_path / name) for name in ("a.png", "b.png")]
    first, second = (path.read_bytes() for path in paths)
    assert first == second
    counts = colours(paths[0])
    assert counts[AFTER] > counts[BEFORE] > 5000


@pytest.mark.parametrize(
    ("options", "error", "words"),
    [
        ({"bounds": {"mass": None}}, UnknownNameError, "parameter to vary 'mass'"),
        ({"bounds": {}}, ParameterError, "number of varied parameters = 0"),
        ({"bounds": {"rho": (2.0, 1.5)}}, ParameterError, "is not ascending"),
        ({"bounds": {"rho": (0.5, 1.5)}}, ParameterError, "rho = 0.5"),
        ({"bounds": {"rho": 1.5}}, ParameterError, r"bounds\['rho'\]"),
        ({"trials": 15}, ParameterError, "trials = 15"),
        ({"workers": 0}, ParameterError, "workers = 0"),
    ],
)
def test_bad_input_is_named(options, error, words):
    with pytest.raises(error, match=words):
        design_foot(SMALL, *RANGE, **options)


def test_the_default_bounds_are_of_feet():
    for name, ends in BOUNDS.items():
        for end in ends:
            unit = SMALL.scale if name == "scale" else 1.0
            assert getattr(varied_foot(SMALL, {name: end * unit}), name) == end * unit
