"""Pairs of links that touch by construction."""

from __future__ import annotations

import math

import numpy as np
import pytest

from zygopin.adjacency import touching_links
from zygopin.clearance import segment_distance
from zygopin.foot import Finger, Foot
from zygopin.kinematics import forward_kinematics
from zygopin.names import phalanx_links


def test_pairs_of_a_small_foot_by_hand():
    hallux = Finger("hallux", 2, math.pi, reversed_azimuth=0.0)
    foot = Foot(fingers=(hallux, Finger("toe", 1, 0.0)))
    assert touching_links(foot) == {
        ("foot", "hallux_base"): "Adjacent",
        ("hallux_base", "hallux_phalanx1"): "Adjacent",
        ("hallux_phalanx1", "hallux_phalanx2"): "Adjacent",
        ("hallux_phalanx2", "hallux_tip"): "Adjacent",
        ("foot", "hallux_phalanx1"): "Always",
        ("foot", "toe_phalanx1"): "Adjacent",
        ("toe_phalanx1", "toe_tip"): "Adjacent",
        ("hallux_phalanx1", "toe_phalanx1"): "Always",
    }


def test_bones_of_such_a_pair_share_a_point_whatever_the_pose():
    foot = Foot.preset("owl")
    links = [link for finger in foot.fingers for link in phalanx_links(finger)]
    bones = forward_kinematics(foot, np.random.default_rng(3).random((20, len(links))))
    pairs = [pair for pair in touching_links(foot) if {*pair} <= {*links}]
    assert len(pairs) == 10 + 6
    for first, second in pairs:
        i, j = links.index(first), links.index(second)
        apart = segment_distance(bones[:, i], bones[:, j])
        assert apart == pytest.approx(0, abs=1e-12 * foot.size)
