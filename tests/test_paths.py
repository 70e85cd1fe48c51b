"""Where the description is, as paths and under robot_descriptions.py's names."""

from __future__ import annotations

from pathlib import Path

import pytest
import xacro

from zygopin import paths, robot_description
from zygopin.description import to_urdf
from zygopin.foot import Foot
from zygopin.srdf import to_srdf


def test_the_default_files_are_the_parrot_s():
    parrot = Foot.preset("parrot")
    assert paths.URDF_PATH.read_text(encoding="utf-8") == to_urdf(parrot)
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


def test_the_template_with_its_arguments_is_the_default_foot(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    arguments = dict(robot_description.XACRO_ARGS)
    assert all(type(value) is str for value in arguments.values())
    document = xacro.process_file(robot_description.XACRO_PATH, mappings=arguments)
    shipped = Path(robot_description.URDF_PATH).read_text(encoding="utf-8")
    assert document.documentElement.toprettyxml(indent="  ") in shipped
