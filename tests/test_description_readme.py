"""The README of the description: its commands work, what it names is there.

That its Python blocks print what they shall is tested where the tools are installed.
"""

from __future__ import annotations

import re
import shlex
import subprocess
import sys
from pathlib import Path
from xml.etree import ElementTree as ET

from zygopin.paths import PACKAGE_PATH

README = (PACKAGE_PATH / "README.md").read_text(encoding="utf-8")
BIN = Path(sys.executable).parent


def test_its_table_names_all_that_is_there():
    rows = re.findall(r"^\| (`[^|]*) \|", README, re.MULTILINE)
    named = {name.rstrip("/") for row in rows for name in re.findall("`([^`]*)`", row)}
    there = {path.name for path in PACKAGE_PATH.iterdir()}
    assert named == there - {"README.md"}


def test_its_two_ways_to_a_foot_lead_to_the_same_one(run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (commands,) = re.findall(r"```sh\n(zygopin urdf .*?)```", README, re.DOTALL)
    own, template = commands.splitlines()
    assert run(*shlex.split(own)[1:]).returncode == 0
    assert (tmp_path / "my_owl" / "foot.glb").exists()
    words = shlex.split(template.partition(">")[0])
    done = subprocess.run(
        [BIN / words[0], *words[1:]], cwd=PACKAGE_PATH, check=True, capture_output=True
    )
    robots = (
        ET.fromstring(done.stdout),  # noqa: S314
        ET.parse(tmp_path / "my_owl" / "foot_tendon.urdf").getroot(),  # noqa: S314
    )
    one, other = ([*map(ET.tostring, robot)] for robot in robots)
    assert one == other


def test_its_python_is_python():
    blocks = re.findall(r"```python\n(.*?)```", README, re.DOTALL)
    assert len(blocks) >= 15
    for block in blocks:
        compile(block, "README.md", "exec")


def test_it_launches_what_the_package_has_with_arguments_that_it_takes():
    text = (PACKAGE_PATH / "launch" / "display.launch.py").read_text(encoding="utf-8")
    template = (PACKAGE_PATH / "foot.urdf.xacro").read_text(encoding="utf-8")
    taken = set(re.findall(r'_argument\("(\w+)"', text))
    taken |= set(re.findall(r'<xacro:arg name="(\w+)"', template))
    lines = re.findall(r"^ros2 launch zygopin_description (.*)", README, re.MULTILINE)
    assert len(lines) == 2
    for line in lines:
        file, *arguments = shlex.split(line)
        assert (PACKAGE_PATH / "launch" / file).exists()
        assert {argument.partition(":=")[0] for argument in arguments} <= taken


def test_the_names_of_poses_and_groups_are_those_of_the_files():
    srdf = ET.parse(PACKAGE_PATH / "expanded" / "owl.srdf").getroot()  # noqa: S314
    for pose in {state.get("name") for state in srdf.iter("group_state")}:
        assert f"`{pose}`" in README
    for group in ("base", "foot"):
        assert srdf.find(f"group[@name='{group}']") is not None
        assert f"the group `{group}`" in README
