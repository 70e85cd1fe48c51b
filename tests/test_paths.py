"""Where the description is, as paths and under robot_descriptions.py's names."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from zygopin import paths, robot_description
from zygopin.foot import Foot
from zygopin.srdf import to_srdf
from zygopin.template import expand


def test_the_default_files_are_the_parrot_s():
    parrot = Foot.preset("parrot")
    assert paths.URDF_PATH.read_text(encoding="utf-8") == expand(parrot)
    assert paths.SRDF_PATH.read_text(encoding="utf-8") == to_srdf(parrot)


CONSTANTS = [name for name in vars(robot_description) if name.endswith("_PATH")]


def test_robot_descriptions_py_finds_the_names_that_its_loaders_read():
    wanted = {"REPOSITORY_PATH", "PACKAGE_PATH", "URDF_PATH", "XACRO_PATH"}
    assert wanted <= set(CONSTANTS)


@pytest.mark.parametrize("name", CONSTANTS)
def test_its_constants_are_strings_and_name_what_exists(name):
    value = getattr(robot_description, name)
    assert type(value) is str
    assert Path(value).is_absolute()
    assert Path(value).exists()
    if hasattr(paths, name):
        assert value == str(getattr(paths, name))


def test_its_repository_holds_the_package():
    assert Path(robot_description.PACKAGE_PATH).parent == Path(
        robot_description.REPOSITORY_PATH
    )


def test_the_template_with_its_arguments_is_the_default_foot(tmp_path):
    # In a process of its own: xacro changes PyYAML's safe loader for good.
    arguments = [f"{key}:={text}" for key, text in robot_description.XACRO_ARGS.items()]
    program = Path(sys.executable).with_name("xacro")
    command = [program, robot_description.XACRO_PATH, *arguments]
    done = subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)
    shipped = ET.parse(robot_description.URDF_PATH).getroot()  # noqa: S314
    expanded = ET.fromstring(done.stdout)  # noqa: S314
    assert [*map(ET.tostring, expanded)] == [*map(ET.tostring, shipped)]
