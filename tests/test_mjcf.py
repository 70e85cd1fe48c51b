"""The MuJoCo model's text: what it names, what it holds, what it refuses."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from zygopin.adjacency import touching_links
from zygopin.errors import DescriptionError
from zygopin.foot import Finger, Foot
from zygopin.mjcf import to_mjcf
from zygopin.mjcf_scene import to_mjcf_scene
from zygopin.paths import MJCF_PATH
from zygopin.poses import named_poses

ROOT = Path(__file__).parent.parent
TOE = Foot(name="stub", scale=0.1, fingers=(Finger("toe", 2, 0.0),))


def tree(text):
    return ET.fromstring(text)  # noqa: S314


def names_of(root, path):
    return [element.get("name") for element in root.findall(path)]


def test_bodies_joints_and_tips_have_the_urdfs_names():
    root = tree(to_mjcf(TOE))
    assert root.get("model") == "stub"
    assert names_of(root, ".//body") == ["foot", "toe_phalanx1", "toe_phalanx2"]
    assert names_of(root, ".//body/joint") == ["toe_joint1", "toe_joint2"]
    assert names_of(root, ".//body/geom") == ["foot", "toe_phalanx1", "toe_phalanx2"]
    assert names_of(root, ".//site[@name]") == ["toe_tip"]
    assert names_of(root, "actuator/position") == ["toe_joint1", "toe_joint2"]


def test_a_tendon_takes_the_place_of_the_servos():
    root = tree(to_mjcf(Foot.preset("owl"), tendon=True))
    pulled = [joint.get("joint") for joint in root.findall("tendon/fixed/joint")]
    shares = [float(joint.get("coef")) for joint in root.findall("tendon/fixed/joint")]
    assert len(pulled) == 14
    assert sum(shares) == pytest.approx(1, rel=1e-14)
    assert names_of(root, "actuator/") == ["flexor", "finger4_reversal"]
    sprung = [j.get("name") for j in root.findall(".//joint[@stiffness]")]
    assert sprung == pulled
    plain = tree(to_mjcf(Foot.preset("owl")))
    assert plain.find("tendon") is None
    assert plain.findall(".//joint[@stiffness]") == []


def test_a_free_base_has_a_joint_and_a_place_in_every_keyframe():
    fixed, free = tree(to_mjcf(TOE)), tree(to_mjcf(TOE, free=True))
    assert fixed.find(".//freejoint") is None
    assert names_of(free, "worldbody/body/freejoint") == ["foot"]
    for one, other in zip(
        fixed.findall("keyframe/key"), free.findall("keyframe/key"), strict=True
    ):
        assert other.get("qpos") == "0 0 0 1 0 0 0 " + one.get("qpos")


def test_keyframes_are_the_named_poses():
    foot = Foot.preset("owl")
    assert names_of(tree(to_mjcf(foot)), "keyframe/key") == [*named_poses(foot)]


def test_exclusions_are_the_srdfs_pairs_without_tips():
    foot = Foot.preset("owl")
    excluded = [
        (pair.get("body1"), pair.get("body2"))
        for pair in tree(to_mjcf(foot)).findall("contact/exclude")
    ]
    assert excluded == [
        pair for pair in touching_links(foot) if not pair[1].endswith("_tip")
    ]


def test_the_header_states_units_and_what_ctrl_is():
    plain, tendon = to_mjcf(TOE), to_mjcf(TOE, tendon=True)
    for text in (plain, tendon):
        assert "Units: m, rad, kg, s, N." in text
        assert "Joint angle = omega * control" in text
        assert text.endswith("</mujoco>\n")
        assert max(map(len, text.partition("<compiler")[0].splitlines())) <= 88
    assert "ctrl is the joint's angle" in plain
    assert "One tendon over all flexion joints" in tendon


def test_equal_feet_give_equal_text_in_any_process(tmp_path):
    code = (
        "from zygopin import *; import sys;"
        "sys.stdout.buffer.write(to_mjcf(Foot.preset('parrot')).encode())"
    )
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "PYTHONHASHSEED": "7"}
    command = [sys.executable, "-c", code]
    done = subprocess.run(
        command, cwd=tmp_path, env=environment, capture_output=True, check=True
    )
    assert done.stdout.decode() == to_mjcf(Foot.preset("parrot"))
    assert done.stdout == MJCF_PATH.read_bytes()


def test_writing_a_model_needs_no_mujoco():
    code = (
        "import sys; sys.modules['mujoco'] = None; from zygopin import *;"
        "print(len(to_mjcf(Foot(scale=0.1, fingers=(Finger('toe', 2, 0.0),)))))"
    )
    command = [sys.executable, "-c", code]
    done = subprocess.run(command, check=True, cwd=ROOT, capture_output=True)
    assert int(done.stdout) > 1000


@pytest.mark.parametrize("tendon", [False, True])
def test_too_light_a_foot_is_refused_in_one_line(tendon):
    foot = Foot.preset("parrot").replace(scale=0.001, thickness=0.0001)
    with pytest.raises(DescriptionError, match="too light for MuJoCo") as caught:
        to_mjcf(foot, tendon=tendon)
    assert "\n" not in str(caught.value)
    assert "scale the foot up" in caught.value.remedy


def test_a_scene_includes_the_model_and_has_the_perch_if_there_is_one():
    parrot = tree(to_mjcf_scene(Foot.preset("parrot"), "parrot_tendon.xml"))
    assert parrot.find("include").get("file") == "parrot_tendon.xml"
    assert names_of(parrot, "worldbody/geom") == ["floor", "perch"]
    paper = tree(to_mjcf_scene(Foot.preset("paper"), "foot.xml"))
    assert names_of(paper, "worldbody/geom") == ["floor"]
