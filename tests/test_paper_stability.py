"""Proposition 2, both directions."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from entry_checks import broken, numbers

from zygopin import Foot, forward_kinematics, resting_radii
from zygopin.paper import stability, touched_radii
from zygopin.paper.resting_scan import RADII, scan
from zygopin.paper.stability import erratum_9, proposition_2

FOOT = Foot.preset("paper")


def test_both_directions_hold():
    found = numbers(proposition_2())
    assert found["tangent"] > 2
    assert found["families"] == 1
    assert 0 < found["opposed"] < found["solutions"]


def test_a_radius_that_the_list_lacks_is_told(monkeypatch):
    def shortened(*args, **options):
        found = resting_radii(*args, **options)
        tangent = found.on_bone & np.isfinite(found.radius)
        radius = np.where(np.cumsum(tangent) == 1, found.radius * 1.01, found.radius)
        return dataclasses.replace(found, radius=radius)

    monkeypatch.setattr(stability, "resting_radii", shortened)
    assert "radius" in broken(proposition_2())


def test_necessary_and_sufficient():
    found = numbers(erratum_9())
    assert 0 < found["stable"] < found["poses"]


def test_the_scan_finds_the_first_branch_that_a_bone_meets():
    # |p − c| = r with c = (0, −r): r = |p|²/(−2z), least over the bone's points.
    controls = np.array([0.0, 1.0, 1.0, 0.0])
    found = scan(FOOT, "finger3", np.array([0.0, 1.0]))
    whole = np.zeros(FOOT.phalanx_count)
    whole[FOOT.finger_slices["finger3"]] = controls
    bone = forward_kinematics(FOOT, whole)[FOOT.finger_slices["finger3"]][2]
    points = bone[0] + np.linspace(0, 1, 20_001)[:, None] * (bone[1] - bone[0])
    x, z = points[:, 0], points[:, 2]
    with np.errstate(divide="ignore"):
        first = np.where(z < 0, (x**2 + z**2) / (-2 * z), np.inf).min()
    case = ((0.0, 1.0, 1.0), 3)
    radii = {**found.tangent, **found.touching}
    assert radii[case] == pytest.approx(first, abs=1e-7)


def test_the_scan_ends_beyond_every_touch():
    found = scan(FOOT, "finger3", np.array([0.0, 0.5, 1.0]))
    radii = [*found.tangent.values(), *found.touching.values()]
    assert RADII[0] < min(radii)
    assert max(radii) < RADII[-1] / 2
    assert found.always == {((0.0,), 1)}


def test_poses_outside_their_interval_would_be_told(monkeypatch):
    axes = touched_radii.touch_intervals

    def narrowed(*args):
        found = axes(*args)
        return dataclasses.replace(found, most=found.most * 0.9)

    monkeypatch.setattr(touched_radii, "touch_intervals", narrowed)
    monkeypatch.setattr(touched_radii, "SAMPLES", 1000)
    found = touched_radii.touch_measurements(FOOT)
    assert {x.name for x in found if not x.holds} == {"touch_excess", "touch_attained"}
