"""The report on finger 3's workspace: the algorithm, and the sets of figure 3."""

from __future__ import annotations

import math

import numpy as np
import pytest
from entry_checks import broken, numbers
from scipy.spatial import ConvexHull

from zygopin import Foot
from zygopin.control_system import words
from zygopin.paper import workspace
from zygopin.paper.finger_model import summed

PHI = (1 + math.sqrt(5)) / 2


@pytest.fixture(scope="module")
def figure():
    return workspace.figure_3()


def test_the_three_steps_lead_to_pinocchio_s_tips():
    assert workspace.algorithm().holds


def test_a_turn_the_other_way_about_z_fails(monkeypatch):
    about_z = workspace.about_z
    monkeypatch.setattr(workspace, "about_z", lambda angle: about_z(-angle))
    assert broken(workspace.algorithm()) == {"pinocchio", "finger_reach"}


def test_the_extent_is_the_one_worked_by_hand(figure):
    assert figure.holds
    assert numbers(figure)["x_max"] == pytest.approx(
        1 / PHI + 1 / PHI**2 + 1 / PHI**3 + 1 / PHI**4, abs=1e-14
    )
    assert numbers(figure)["x_min"] == pytest.approx(0.653267, abs=5e-7)
    assert numbers(figure)["z_min"] == pytest.approx(-1.021775, abs=5e-7)
    assert numbers(figure)["z_max"] == 0


def test_the_hull_s_area_is_qhull_s(figure):
    for name, omega in (("15", math.pi / 12), ("30", math.pi / 6)):
        foot = Foot(omega=omega)
        tips = summed(foot, words(17, 4, np.arange(17**4)))[:, -1]
        area = ConvexHull(np.stack([tips.real, tips.imag], axis=-1)).volume
        # The set of 17 levels is part of that of 33, and within its bound of it.
        assert area <= numbers(figure)[f"hull_area_{name}"] <= 1.002 * area
    assert numbers(figure)["hull_area_30"] == pytest.approx(0.226553, abs=5e-7)


def test_supporting_lines_find_the_hull_of_a_wide_finger():
    assert workspace._supported_area(math.pi / 2) == pytest.approx(2.102884, abs=5e-7)


def test_coarser_levels_stay_within_the_bound(figure):
    step, ranks = 1 / 8, np.arange(1, 5)
    bound = math.pi / 6 * step / 2 * np.sum(ranks * PHI ** -ranks.astype(float))
    assert 0 < numbers(figure)["coarse"] < bound
    assert 0 < numbers(figure)["random"] < bound / 4
