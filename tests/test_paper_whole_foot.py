"""The paper's section 4: where toes stand, and what the labels say of them."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest
from entry_checks import broken, numbers, with_other_feet

from zygopin.foot import Foot
from zygopin.paper import planes, whole_foot
from zygopin.paper.top_view import assignments, fitted, label_distances, misfit_by_hand


def test_toes_are_as_long_as_their_fractions():
    found = numbers(whole_foot.figure_2())
    for number in (1, 2, 3, 4):
        terms = (Fraction(5, 6) ** k for k in range(1, number + 2))
        assert found[f"length_{number}"] == pytest.approx(float(sum(terms)), abs=1e-14)


def test_angles_make_a_full_turn():
    found = numbers(whole_foot.figure_2())
    angles = [found[f"angle_{pair}"] for pair in (12, 23, 34, 14)]
    assert sum(angles) == pytest.approx(2 * math.pi, abs=1e-14)
    assert np.degrees(angles) == pytest.approx([150, 30, 150, 30])


def test_another_splay_is_another_figure(monkeypatch):
    with_other_feet(monkeypatch, whole_foot, lambda foot: foot.replace(splay=0.3))
    assert broken(whole_foot.figure_2()) == {
        "angle_12",
        "angle_23",
        "angle_34",
        "angle_14",
        "pinocchio",
    }
    assert "apart_13_fk" in broken(whole_foot.opposable_fingers())


def test_a_tilted_pair_is_not_opposable(monkeypatch):
    def forward(foot):
        first = replace(foot.fingers[0], azimuth=-math.pi / 12)
        return foot.replace(fingers=(first, *foot.fingers[1:]))

    with_other_feet(monkeypatch, whole_foot, forward)
    assert broken(whole_foot.opposable_fingers()) == {"pairs", "wrong_pairs"}


def test_the_printed_planes_are_two_splays_apart():
    found = numbers(planes.erratum_1())
    assert math.degrees(found["planes_13_printed"]) == pytest.approx(30)
    assert math.degrees(found["planes_24_printed"]) == pytest.approx(30)
    assert (found["opposed_printed"], found["opposed_ours"]) == (0, 1)


def test_our_azimuths_do_not_pass_for_the_printed_ones(monkeypatch):
    monkeypatch.setattr(planes, "printed_foot", lambda: Foot.preset("paper-figure"))
    assert broken(planes.erratum_1()) == {
        "planes_13_printed",
        "planes_24_printed",
        "opposed_printed",
        "sides_printed",
    }


def test_labels_stand_where_the_source_puts_them():
    # By name: "Finger 1" at height 80, 2 at 263, 3 at 289, 4 at 3; the angles' labels
    # at 120 and 195.
    base = (120 + 195) / 2
    heights = [base - 80, 263 - base, 289 - base, base - 3]
    np.testing.assert_array_equal(label_distances(), heights)


def test_the_scale_is_where_no_other_fits_better():
    toes = np.array([1.5, 2.1, 2.6, 3.0])
    fit, distances = fitted(toes), label_distances()
    for scale in fit.scale * np.array([0.99, 1.01]):
        left = np.linalg.norm(distances - scale * toes) / np.linalg.norm(distances)
        assert left > fit.misfit


def test_all_assignments_are_held_against_each_other_by_hand():
    found = assignments(Foot.preset("paper-figure"))
    assert set(found) == set(permutations((2, 3, 4, 5)))
    for counts, fit in found.items():
        assert fit.misfit == pytest.approx(misfit_by_hand(1.2, counts), abs=1e-9)
    assert min(found, key=lambda counts: found[counts].misfit) == (2, 3, 4, 5)


def test_each_tip_is_within_a_few_points_of_its_label():
    foot = Foot.preset("paper-figure")
    scale = assignments(foot)[2, 3, 4, 5].scale
    toes = [(1 - 1.2**-count) / 0.2 * math.cos(math.pi / 12) for count in (2, 3, 4, 5)]
    off = label_distances() - scale * np.array(toes)
    assert np.abs(off).max() < 3  # letters are 10 points tall


def test_the_golden_mean_fits_the_drawing_badly():
    found = numbers(planes.erratum_1())
    assert found["misfit_golden"] > 8 * found["misfit"]
