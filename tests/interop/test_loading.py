"""The README of the description is true: each tool's block prints where the tip is."""

from __future__ import annotations

import os
import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import zygopin
from zygopin.bundle import write_description
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.paths import PACKAGE_PATH

README = (PACKAGE_PATH / "README.md").read_text(encoding="utf-8")
SECTIONS = dict(
    re.findall(r"^### ([^\n]+)\n(?:(?!###).)*?```python\n(.*?)```", README, re.M | re.S)
)
TOOLS = {
    "Pinocchio": "pinocchio",
    "yourdfpy": "yourdfpy",
    "MuJoCo": "mujoco",
    "PyBullet": "pybullet",
    "Drake": "pydrake",
    "Robotics Toolbox for Python": "roboticstoolbox",
    "ikpy": "ikpy",
    "kinpy": "kinpy",
    "pytorch-kinematics": "pytorch_kinematics",
    "urchin": "urchin",
    "urdf_parser_py": "urdf_parser_py",
    "scikit-robot": "skrobot",
    "iDynTree": "idyntree",
    "viser": "viser",
    "robot_descriptions": "robot_descriptions",
}
"""Sections of the README, and the module that each of them needs."""

PRINTED = 1e-8
"""The last digit that NumPy prints of a number of centimetres [m]."""

NUMBER = r"(-?\d+\.\d+(?:e-?\d+)?)"
POINT = re.compile(rf"[\[(]\s*{NUMBER},?\s+{NUMBER},?\s+{NUMBER}\s*[\])]")


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """A folder as `zygopin urdf -o .` leaves it."""
    path = tmp_path_factory.mktemp("loading")
    write_description(Foot.preset("parrot"), path)
    return path


@pytest.fixture(scope="module")
def tip():
    """Where finger 3 ends with its first two joints at 0.6 and 0.9 rad [m]."""
    foot = Foot.preset("parrot")
    controls = np.zeros(foot.phalanx_count)
    part = foot.finger_slices["finger3"]
    controls[part.start : part.start + 2] = np.divide([0.6, 0.9], foot.omega)
    return forward_kinematics(foot, controls)[part.stop - 1, 1]


def test_every_block_is_of_a_tool_that_is_run():
    assert SECTIONS.keys() == TOOLS.keys()
    assert len(SECTIONS) == README.count("```python")


def test_the_readme_names_the_point(tip):
    (text,) = re.findall(r"```text\n(.*?)```", README, re.DOTALL)
    assert text == f"{tip}\n"


@pytest.mark.parametrize("name", TOOLS)
def test_a_block_prints_where_the_tip_is(name, folder, tip):
    pytest.importorskip(TOOLS[name])
    checkout = str(Path(zygopin.__file__).parent.parent)
    done = subprocess.run(
        [
            sys.executable,
            "-W",
            "error::DeprecationWarning:__main__",
            "-c",
            SECTIONS[name],
        ],
        cwd=folder,
        env={**os.environ, "PYTHONPATH": checkout},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stderr
    (found,) = POINT.findall(done.stdout)
    assert np.array(found, dtype=float) == pytest.approx(tip, abs=PRINTED)
