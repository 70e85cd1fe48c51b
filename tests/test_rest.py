"""The branch on which a foot sits at rest."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given

from tests.strategies import feet, reals
from zygopin import Foot, check_grasp
from zygopin.errors import ParameterError
from zygopin.rest import resting_branch

PARROT = Foot.preset("parrot")


@given(feet(), reals(0.01, 10.0), reals(-3.0, 3.0), reals(-1.4, 1.4))
def test_the_base_is_a_skin_away_from_the_bark(foot, share, yaw, pitch):
    radius = share * foot.size
    branch = resting_branch(foot, radius, yaw=yaw, pitch=pitch)
    skin = foot.thickness / foot.rho
    assert float(branch.base_distance()) == pytest.approx(radius + skin, rel=1e-9)
    assert branch.centre[2] < 0


def test_the_thickest_phalanx_of_a_straight_foot_touches():
    # 8 mm and a skin of 1.8/1.18 mm: the centre is 9.5254 mm below the base.
    branch = resting_branch(PARROT, 0.008)
    assert branch.centre == pytest.approx([0, 0, -0.0095254237])
    report = check_grasp(PARROT, np.zeros(14), branch)
    first = report.clearance[[0, 2, 5, 9]]
    assert first == pytest.approx(np.zeros(4), abs=1e-9)


@pytest.mark.parametrize("pitch", [math.pi / 2, -math.pi / 2])
def test_no_foot_sits_on_an_upright_branch(pitch):
    with pytest.raises(ParameterError, match="is not a slope: give a slope"):
        resting_branch(PARROT, 0.008, pitch=pitch)


@pytest.mark.parametrize("radius", [0.0, -1.0, math.nan])
def test_a_branch_has_a_radius(radius):
    with pytest.raises(ParameterError, match="radius"):
        resting_branch(PARROT, radius)
