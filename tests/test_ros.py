"""The description as a ROS 2 package: manifest, files to install, launch file."""

from __future__ import annotations

import re
import runpy
import shlex
import shutil
import subprocess
import sys
import types
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import yaml

import zygopin
from zygopin.description import to_urdf
from zygopin.foot import Foot
from zygopin.paths import PACKAGE_PATH
from zygopin.presets import preset_names

XACRO = Path(sys.executable).with_name("xacro")
LAUNCH = PACKAGE_PATH / "launch" / "display.launch.py"


# The manifest ---------------------------------------------------------------------


@pytest.fixture(scope="module")
def manifest():
    return ET.parse(PACKAGE_PATH / "package.xml").getroot()  # noqa: S314


def test_the_manifest_has_what_format_3_demands(manifest):
    assert manifest.tag == "package"
    assert manifest.get("format") == "3"
    tags = [child.tag for child in manifest]
    for tag in ("name", "version", "description"):
        assert tags.count(tag) == 1
    for tag in ("maintainer", "license"):
        assert tags.count(tag) >= 1
    assert re.fullmatch(r"[a-z][a-z0-9_]*", manifest.findtext("name"))
    assert re.fullmatch(r"\d+\.\d+\.\d+", manifest.findtext("version"))
    assert re.fullmatch(r"\S+@\S+\.\S+", manifest.find("maintainer").get("email"))
    known = {"name", "version", "description", "maintainer", "license", "export"}
    assert set(tags) <= known | {"buildtool_depend", "exec_depend"}


def test_the_manifest_tells_the_project_s_version(manifest):
    assert manifest.findtext("version") == zygopin.__version__


def test_the_package_is_built_by_ament_and_runs_what_it_depends_on(manifest):
    assert manifest.findtext("export/build_type") == "ament_cmake"
    assert manifest.findtext("buildtool_depend") == "ament_cmake"
    needed = {depend.text for depend in manifest.findall("exec_depend")}
    text = LAUNCH.read_text(encoding="utf-8")
    started = set(re.findall(r'package="(\w+)"', text))
    imported = set(re.findall(r"^from (launch\w*)", text, re.MULTILINE))
    assert needed == started | imported | {"xacro"}


def test_every_file_of_the_package_is_installed():
    text = (PACKAGE_PATH / "CMakeLists.txt").read_text(encoding="utf-8")
    installed = {
        name
        for names in re.findall(r"(?:DIRECTORY|FILES) ([^\n]*)", text)
        for name in names.split()
    }
    there = {path.name for path in PACKAGE_PATH.iterdir()}
    # The build writes the manifest and the marker by itself.
    assert installed == there - {"CMakeLists.txt", "package.xml", "resource"}
    assert "project(zygopin_description)" in text
    assert text.rstrip().endswith("ament_package()")


def test_the_marker_of_the_index_is_named_after_the_package(manifest):
    (marker,) = (PACKAGE_PATH / "resource").iterdir()
    assert marker.name == manifest.findtext("name")


def test_rviz_shows_the_robot_from_its_own_base():
    config = yaml.safe_load((PACKAGE_PATH / "rviz" / "foot.rviz").read_text())
    manager = config["Visualization Manager"]
    assert manager["Global Options"]["Fixed Frame"] == "foot"
    classes = [display["Class"] for display in manager["Displays"]]
    assert "rviz_default_plugins/RobotModel" in classes


# The launch file ------------------------------------------------------------------
#
# ROS 2's `launch` is not on PyPI: stand-ins with the signatures that its documentation
# gives take what the file hands them, and the command is run as `launch` runs it.


class Argument:
    def __init__(self, name, *, default_value=None, description=None, choices=None):
        assert isinstance(description, str)
        self.name, self.default, self.choices = name, default_value, choices


class Configuration:
    def __init__(self, variable_name, *, default=None):
        self.name, self.default = variable_name, default


class Command:
    def __init__(self, command, *, on_stderr="fail"):
        self.words, self.on_stderr = command, on_stderr


class Value:
    def __init__(self, value, *, value_type=None):
        self.value, self.value_type = value, value_type


class Condition:
    def __init__(self, predicate_expression):
        self.predicate = predicate_expression


class Unless(Condition):
    pass


@dataclass(kw_only=True)
class Node:
    executable: str
    package: str | None = None
    name: str | None = None
    namespace: str | None = None
    parameters: list | None = None
    remappings: list | None = None
    arguments: list | None = None
    condition: Condition | None = None
    output: str = "log"


class Description:
    def __init__(self, initial_entities=None):
        self.entities = initial_entities


STAND_INS = {
    "launch": {"LaunchDescription": Description},
    "launch.actions": {"DeclareLaunchArgument": Argument},
    "launch.conditions": {"IfCondition": Condition, "UnlessCondition": Unless},
    "launch.substitutions": {"Command": Command, "LaunchConfiguration": Configuration},
    "launch_ros": {},
    "launch_ros.actions": {"Node": Node},
    "launch_ros.parameter_descriptions": {"ParameterValue": Value},
}


@pytest.fixture
def launch(monkeypatch):
    """Entities that the launch file at a path describes."""
    for name, members in STAND_INS.items():
        module = types.ModuleType(name)
        vars(module).update(members)
        monkeypatch.setitem(sys.modules, name, module)

    def run(path=LAUNCH):
        return runpy.run_path(str(path))["generate_launch_description"]().entities

    return run


def arguments_of(entities):
    return {entity.name: entity for entity in entities if isinstance(entity, Argument)}


def performed(words, values):
    """The text of a list of substitutions."""
    parts = words if isinstance(words, list) else [words]
    return "".join(
        values[part.name] if isinstance(part, Configuration) else part for part in parts
    )


def urdf_of(entities, **given):
    """What robot_state_publisher gets, for arguments given as to `ros2 launch`."""
    values = {}
    for argument in arguments_of(entities).values():
        values[argument.name] = performed(argument.default, values)
        if argument.name in given:
            values[argument.name] = given.pop(argument.name)
            assert values[argument.name] in (argument.choices or values.values())
    assert not given
    (node,) = (e for e in entities if getattr(e, "parameters", None))
    (parameters,) = node.parameters
    value = parameters["robot_description"]
    assert value.value_type is str
    program, *words = shlex.split(performed(value.value.words, values))
    assert program == "xacro"
    done = subprocess.run([XACRO, *words], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert done.stderr == ""  # else `Command` fails
    return done.stdout


def links(text):
    """The elements of a URDF, without its comments."""
    return ET.canonicalize(text, strip_text=True, with_comments=False)


def test_without_arguments_the_launch_file_shows_the_parrot(launch):
    assert links(urdf_of(launch())) == links(to_urdf(Foot.preset("parrot")))


def test_arguments_reach_the_template(launch):
    urdf = urdf_of(launch(), preset="owl", tendon="true", rho="1.25", density="900")
    foot = Foot.preset("owl").replace(rho=1.25, density=900)
    assert links(urdf) == links(to_urdf(foot, tendon=True))


def test_a_file_of_one_s_own_takes_the_preset_s_place(launch, tmp_path):
    file = tmp_path / "my foot.yaml"
    file.write_text(yaml.safe_dump(Foot.preset("anisodactyl").to_mapping()))
    urdf = urdf_of(launch(), foot=str(file))
    assert links(urdf) == links(to_urdf(Foot.preset("anisodactyl")))


def test_the_package_may_lie_anywhere(launch, tmp_path):
    package = shutil.copytree(PACKAGE_PATH, tmp_path / "a bird's café")
    urdf = urdf_of(launch(package / "launch" / LAUNCH.name))
    assert links(urdf) == links(to_urdf(Foot.preset("parrot")))


def test_the_presets_and_the_template_s_arguments_are_those_that_exist(launch):
    arguments = arguments_of(launch())
    assert tuple(arguments["preset"].choices) == preset_names()
    template = (PACKAGE_PATH / "foot.urdf.xacro").read_text(encoding="utf-8")
    taken = set(re.findall(r'<xacro:arg name="(\w+)"', template))
    assert arguments.keys() == taken | {"preset", "gui", "rviz_config"}


def test_one_joint_state_publisher_runs_with_sliders_or_without(launch):
    nodes = {entity.package: entity for entity in launch() if isinstance(entity, Node)}
    with_gui = nodes["joint_state_publisher_gui"].condition
    without = nodes["joint_state_publisher"].condition
    assert type(with_gui) is Condition
    assert type(without) is Unless
    assert with_gui.predicate.name == without.predicate.name == "gui"
    assert all(node.executable == package for package, node in nodes.items())


def test_rviz_gets_the_package_s_configuration(launch):
    entities = launch()
    (node,) = (e for e in entities if getattr(e, "package", None) == "rviz2")
    flag, configuration = node.arguments
    assert flag == "-d"
    default = arguments_of(entities)[configuration.name].default
    assert Path(default) == PACKAGE_PATH / "rviz" / "foot.rviz"


# The template elsewhere -----------------------------------------------------------


def test_the_template_expands_alike_from_any_folder(tmp_path):
    (tmp_path / "below").mkdir()
    texts = set()
    for folder, template in (
        (tmp_path, PACKAGE_PATH / "foot.urdf.xacro"),
        (PACKAGE_PATH, "foot.urdf.xacro"),
        (PACKAGE_PATH / "presets", "../foot.urdf.xacro"),
    ):
        command = [XACRO, template, "foot:=presets/owl.yaml"]
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        assert done.stderr == ""
        texts.add(links(done.stdout))
    assert texts == {links(to_urdf(Foot.preset("owl")))}


def test_the_templates_need_no_package_index():
    for file in PACKAGE_PATH.glob("*.xacro"):
        text = file.read_text(encoding="utf-8")
        assert "$(find" not in text
        assert "package://" not in text
