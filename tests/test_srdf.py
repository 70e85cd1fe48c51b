"""The SRDF: groups, named poses, and pairs that touch by construction."""

from __future__ import annotations

from xml.etree import ElementTree as ET

import coal  # noqa: F401  (Pinocchio's shapes need its converters)
import pinocchio as pin
import pytest

from zygopin.foot import Finger, Foot
from zygopin.paths import PACKAGE_PATH
from zygopin.poses import named_poses
from zygopin.presets import preset_names
from zygopin.srdf import to_srdf


def expanded(suffix, foot, tendon):
    """A preset's shipped file; another test holds it against what is written."""
    variant = "_tendon" if tendon else ""
    name = foot.name.replace("_", "-")
    file = PACKAGE_PATH / "expanded" / f"{name}{variant}.{suffix}"
    return file.read_text(encoding="utf-8")


def urdf_of(foot, tendon=False):
    return expanded("urdf", foot, tendon)


def srdf_of(foot, tendon=False):
    return expanded("srdf", foot, tendon)


def tree(text):
    return ET.fromstring(text)  # noqa: S314


def states_of(srdf):
    """{(group, pose): {joint: angle}} as an SRDF has them."""
    return {
        (state.get("group"), state.get("name")): {
            joint.get("name"): float(joint.get("value"))
            for joint in state.findall("joint")
        }
        for state in srdf.findall("group_state")
    }


def joints_of(srdf, urdf):
    """{group: its joints in the URDF}, chains followed from their tips."""
    above = {
        joint.find("child").get("link"): (
            joint.get("name"),
            joint.find("parent").get("link"),
        )
        for joint in urdf.findall("joint")
    }
    found = {}
    for group in srdf.findall("group"):
        joints = found[group.get("name")] = []
        for chain in group.findall("chain"):
            link = chain.get("tip_link")
            while link != chain.get("base_link"):
                joint, link = above[link]
                joints.append(joint)
    return found


def free_joints(urdf):
    """Joints that a planner sets: those that move and mimic no other."""
    return {
        joint.get("name")
        for joint in urdf.findall("joint")
        if joint.get("type") != "fixed" and joint.find("mimic") is None
    }


VARIANTS = [(name, tendon) for name in preset_names() for tendon in (False, True)]


@pytest.mark.parametrize(("name", "tendon"), VARIANTS)
def test_a_state_sets_every_free_joint_of_its_group_and_no_other(name, tendon):
    foot = Foot.preset(name)
    srdf = tree(srdf_of(foot, tendon=tendon))
    urdf = tree(urdf_of(foot, tendon=tendon))
    groups, free = joints_of(srdf, urdf), free_joints(urdf)
    limits = {
        joint.get("name"): [
            float(joint.find("limit").get(k)) for k in ("lower", "upper")
        ]
        for joint in urdf.findall("joint[@type='revolute']")
    }
    states = states_of(srdf)
    assert {group for group, _ in states} == groups.keys() - {"base"}
    for (group, _), angles in states.items():
        assert angles.keys() == free & {*groups[group]}
        for joint, angle in angles.items():
            assert limits[joint][0] <= angle <= limits[joint][1]


@pytest.mark.parametrize(("name", "tendon"), VARIANTS)
def test_all_that_the_srdf_names_exists(name, tendon):
    foot = Foot.preset(name)
    srdf = tree(srdf_of(foot, tendon=tendon))
    links = {link.get("name") for link in tree(urdf_of(foot)).findall("link")}
    virtual = srdf.find("virtual_joint")
    assert virtual.get("child_link") == "foot"
    for chain in srdf.findall("group/chain"):
        assert {chain.get("base_link"), chain.get("tip_link")} <= links
    for pair in srdf.findall("disable_collisions"):
        assert {pair.get("link1"), pair.get("link2")} <= links
    names = [group.get("name") for group in srdf.findall("group")]
    assert len(set(names)) == len(names)
    assert {child.tag for child in srdf} == {
        "virtual_joint",
        "group",
        "end_effector",
        "group_state",
        "disable_collisions",
    }
    assert len(states_of(srdf)) == len(srdf.findall("group_state"))


def test_each_finger_is_a_chain_and_the_whole_holds_them_all():
    srdf, urdf = (tree(of(Foot.preset("owl"))) for of in (srdf_of, urdf_of))
    groups = joints_of(srdf, urdf)
    fingers = [f"finger{i}" for i in (1, 2, 3, 4)]
    assert [*groups] == [*fingers, "base", "foot"]
    assert groups["foot"] == [joint for name in fingers for joint in groups[name]]
    assert groups["finger1"] == [
        "finger1_tip_joint",
        "finger1_joint2",
        "finger1_joint1",
    ]
    assert groups["finger4"][-1] == "finger4_reversal"


def test_the_end_effector_hangs_on_a_group_that_holds_its_parent():
    # A group holds the links below its joints: the base's joint carries the link foot.
    srdf, urdf = (tree(of(Foot.preset("owl"))) for of in (srdf_of, urdf_of))
    effector, virtual = srdf.find("end_effector"), srdf.find("virtual_joint")
    parent = srdf.find(f"group[@name='{effector.get('parent_group')}']")
    assert [joint.get("name") for joint in parent] == [virtual.get("name")]
    assert effector.get("parent_link") == virtual.get("child_link")
    child_of = {
        joint.get("name"): joint.find("child").get("link")
        for joint in urdf.findall("joint")
    }
    own = {child_of[joint] for joint in joints_of(srdf, urdf)[effector.get("group")]}
    assert effector.get("parent_link") not in own


def test_the_whole_foot_has_the_named_poses_and_a_finger_its_share():
    foot = Foot.preset("owl")
    poses, states = named_poses(foot), states_of(tree(srdf_of(foot)))
    assert {pose: poses[pose] for pose in poses} == {
        pose: angles for (group, pose), angles in states.items() if group == "foot"
    }
    told = {pose for group, pose in states if group == "finger2"}
    assert told == {"rest", "closed", "perch"}
    assert {pose for group, pose in states if group == "finger4"} == poses.keys()
    for (_, pose), angles in states.items():
        assert angles.items() <= poses[pose].items()


def test_the_tendon_has_the_poses_that_one_leader_can_hold():
    foot = Foot.preset("owl")
    states = states_of(tree(srdf_of(foot, tendon=True)))
    leader, turn = "finger1_joint1", "finger4_reversal"
    ahead = foot.fingers[3].reversal
    assert states == {
        ("finger1", "rest"): {leader: 0},
        ("finger1", "closed"): {leader: foot.omega},
        ("finger4", "zygodactyl"): {turn: 0},
        ("finger4", "spread"): {turn: ahead},
        ("foot", "rest"): {leader: 0, turn: 0},
        ("foot", "closed"): {leader: foot.omega, turn: 0},
        ("foot", "zygodactyl"): {leader: 0, turn: 0},
        ("foot", "spread"): {leader: 0, turn: ahead},
    }


def test_groups_avoid_the_names_of_fingers():
    fingers = (Finger("foot", 1, 0.0), Finger("base", 1, 1.0))
    srdf = tree(to_srdf(Foot(fingers=fingers)))
    groups = [group.get("name") for group in srdf.findall("group")]
    assert groups == ["foot", "base", "base_group", "foot_group"]


@pytest.mark.parametrize(("name", "tendon"), VARIANTS)
def test_pinocchio_has_the_pose_of_the_whole_foot(name, tendon):
    foot = Foot.preset(name)
    model = pin.buildModelFromXML(urdf_of(foot, tendon=tendon), mimic=tendon)
    pin.loadReferenceConfigurationsFromXML(model, srdf_of(foot, tendon=tendon))
    whole = {
        pose: angles
        for (group, pose), angles in states_of(
            tree(srdf_of(foot, tendon=tendon))
        ).items()
        if group == "foot"
    }
    poses = {entry.key(): entry.data() for entry in model.referenceConfigurations}
    assert poses.keys() == whole.keys()
    for pose, angles in whole.items():
        assert len(angles) == model.nq
        for joint, angle in angles.items():
            assert poses[pose][model.idx_qs[model.getJointId(joint)]] == angle


FREE = [
    *((name, "rest") for name in preset_names()),
    ("owl", "spread"),
    *(
        (name, "perch")
        for name in preset_names()
        if "perch" in named_poses(Foot.preset(name))
    ),
]


@pytest.mark.parametrize(("name", "pose"), FREE)
def test_toes_collide_nowhere_once_the_pairs_are_removed(name, pose):
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
