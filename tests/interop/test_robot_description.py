"""robot_descriptions.py's own loaders load the foot from our module of paths."""

from __future__ import annotations

import sys
from types import ModuleType

import numpy as np
import pytest

from zygopin import robot_description
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics

pytest.importorskip("robot_descriptions")

NAME = "zygopin_description"
FOOT = Foot.preset("parrot")
CONTROLS = np.linspace(0.1, 0.9, FOOT.phalanx_count)
BONES = forward_kinematics(FOOT, CONTROLS)
ANGLES = {
    f"{finger.name}_joint{k}": FOOT.omega * control
    for finger, part in zip(FOOT.fingers, FOOT.finger_slices.values(), strict=True)
    for k, control in enumerate(CONTROLS[part], start=1)
}
TIPS = {
    f"{name}_tip": BONES[part.stop - 1, 1] for name, part in FOOT.finger_slices.items()
}
EXACT = 1e-12 * FOOT.size


@pytest.fixture
def registered(monkeypatch):
    """The module under the name that the loaders import."""
    monkeypatch.setitem(sys.modules, f"robot_descriptions.{NAME}", robot_description)


@pytest.fixture
def template(monkeypatch, tmp_path):
    """A module with the template alone, as descriptions without a URDF have it."""
    module = ModuleType(f"robot_descriptions.{NAME}")
    vars(module).update(vars(robot_description))
    vars(module).update(__name__=f"robot_descriptions.{NAME}")
    del module.URDF_PATH
    monkeypatch.setitem(sys.modules, module.__name__, module)
    monkeypatch.setenv("ROBOT_DESCRIPTIONS_CACHE", str(tmp_path))


def pinocchio_tips(robot):
    q = np.zeros(robot.nq)
    for joint, angle in ANGLES.items():
        q[robot.model.idx_qs[robot.model.getJointId(joint)]] = angle
    robot.framesForwardKinematics(q)
    frames = {tip: robot.model.getFrameId(tip) for tip in TIPS}
    return {tip: robot.data.oMf[frame].translation for tip, frame in frames.items()}


def yourdfpy_tips(robot):
    robot.update_cfg(ANGLES)
    return {tip: robot.get_transform(tip, "foot")[:3, 3] for tip in TIPS}


def assert_there(tips):
    for tip, point in TIPS.items():
        assert tips[tip] == pytest.approx(point, abs=EXACT)


@pytest.mark.usefixtures("registered")
def test_pinocchio():
    from robot_descriptions.loaders.pinocchio import load_robot_description

    robot = load_robot_description(NAME)
    assert robot.nq == FOOT.phalanx_count
    assert len(robot.collision_model.geometryObjects) == 43
    assert_there(pinocchio_tips(robot))


@pytest.mark.usefixtures("registered")
def test_yourdfpy():
    from robot_descriptions.loaders.yourdfpy import load_robot_description

    assert_there(yourdfpy_tips(load_robot_description(NAME)))


@pytest.mark.usefixtures("registered")
@pytest.mark.skipif(
    not hasattr(robot_description, "MJCF_PATH"), reason="no MJCF among the files"
)
def test_mujoco():
    mujoco = pytest.importorskip("mujoco")
    from robot_descriptions.loaders.mujoco import load_robot_description

    model = load_robot_description(NAME)
    data = mujoco.MjData(model)
    for joint, angle in ANGLES.items():
        data.joint(joint).qpos = angle
    mujoco.mj_kinematics(model, data)
    assert_there({tip: data.site(tip).xpos for tip in TIPS})


@pytest.mark.usefixtures("registered")
def test_pybullet():
    pybullet = pytest.importorskip("pybullet")
    from robot_descriptions.loaders.pybullet import load_robot_description

    client = pybullet.connect(pybullet.DIRECT)
    try:
        robot = load_robot_description(NAME, useFixedBase=True)
        joints = range(pybullet.getNumJoints(robot))
        names = {pybullet.getJointInfo(robot, j)[1].decode() for j in joints}
    finally:
        pybullet.disconnect(client)
    assert names >= ANGLES.keys()


@pytest.mark.usefixtures("registered")
def test_idyntree():
    pytest.importorskip("idyntree.bindings")
    from robot_descriptions.loaders.idyntree import load_robot_description

    assert load_robot_description(NAME).getNrOfDOFs() == FOOT.phalanx_count


@pytest.mark.usefixtures("template")
def test_the_template_through_xacrodoc():
    pytest.importorskip("xacrodoc")
    from robot_descriptions.loaders.pinocchio import load_robot_description

    assert_there(pinocchio_tips(load_robot_description(NAME)))


@pytest.mark.usefixtures("template")
def test_the_template_with_another_foot():
    pytest.importorskip("xacrodoc")
    from robot_descriptions.loaders.yourdfpy import load_robot_description

    robot = load_robot_description(NAME, xacro_args={"foot": "presets/owl.yaml"})
    assert "finger4_reversal" in robot.actuated_joint_names


def test_catkin_pkg_accepts_the_manifest():
    package = pytest.importorskip("catkin_pkg.package")
    warnings: list[str] = []
    manifest = package.parse_package(robot_description.PACKAGE_PATH)
    manifest.validate(warnings=warnings)
    assert warnings == []
    assert manifest.get_build_type() == "ament_cmake"
