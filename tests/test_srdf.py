"""The SRDF: groups, named poses, and pairs that touch by construction."""

from __future__ import annotations

from functools import cache
from xml.etree import ElementTree as ET

import coal  # noqa: F401  (Pinocchio's shapes need its converters)
import pinocchio as pin
import pytest

from zygopin.description import to_urdf
from zygopin.foot import Finger, Foot
from zygopin.poses import named_poses
from zygopin.presets import preset_names
from zygopin.srdf import to_srdf

urdf_of, srdf_of = cache(to_urdf), cache(to_srdf)


def tree(text):
    return ET.fromstring(text)  # noqa: S314


def poses_of(foot):
    """{pose: {joint: angle}} as the SRDF has them."""
    return {
        state.get("name"): {
            joint.get("name"): float(joint.get("value"))
            for joint in state.findall("joint")
        }
        for state in tree(srdf_of(foot)).findall("group_state")
    }


def test_srdf_groups_are_chains_of_existing_links():
    foot = Foot.preset("owl")
    srdf, urdf = tree(srdf_of(foot)), tree(urdf_of(foot))
    links = {link.get("name") for link in urdf.findall("link")}
    chains = srdf.findall("group/chain")
    assert [chain.get("tip_link") for chain in chains] == [
        f"finger{i}_tip" for i in (1, 2, 3, 4)
    ]
    assert {chain.get("base_link") for chain in chains} == {"foot"}
    for pair in srdf.findall("disable_collisions"):
        assert {pair.get("link1"), pair.get("link2")} <= links
    assert srdf.find("virtual_joint").get("child_link") == "foot"


def test_srdf_poses_are_the_named_ones_and_set_every_joint_within_limits():
    foot = Foot.preset("owl")
    limits = {
        joint.get("name"): [
            float(joint.find("limit").get(k)) for k in ("lower", "upper")
        ]
        for joint in tree(urdf_of(foot)).findall("joint[@type='revolute']")
    }
    for angles in poses_of(foot).values():
        assert angles.keys() == limits.keys()
        for name, angle in angles.items():
            assert limits[name][0] <= angle <= limits[name][1]
    assert poses_of(foot) == named_poses(foot)


def test_the_whole_group_avoids_a_finger_of_its_name():
    srdf = tree(to_srdf(Foot(fingers=(Finger("foot", 1, 0.0),))))
    groups = [group.get("name") for group in srdf.findall("group")]
    assert groups == ["foot", "foot_whole"]


STRAIGHT = [(name, "rest") for name in preset_names()] + [("owl", "spread")]


@pytest.mark.parametrize(("name", "pose"), STRAIGHT)
def test_straight_toes_collide_nowhere_once_the_pairs_are_removed(name, pose):
    foot = Foot.preset(name)
    urdf, srdf = urdf_of(foot), srdf_of(foot)
    model = pin.buildModelFromXML(urdf)
    pin.loadReferenceConfigurationsFromXML(model, srdf)
    shapes = pin.buildGeomFromUrdfString(model, urdf, pin.GeometryType.COLLISION)
    shapes.addAllCollisionPairs()
    everything = len(shapes.collisionPairs)
    pin.removeCollisionPairsFromXML(model, shapes, srdf)
    assert 0 < len(shapes.collisionPairs) < everything
    q = model.referenceConfigurations[pose]
    data, shape_data = model.createData(), shapes.createData()
    assert not pin.computeCollisions(model, data, shapes, shape_data, q, True)
