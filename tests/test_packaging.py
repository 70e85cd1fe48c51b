"""What is shipped: the wheel carries the description and the page, the scripts run."""

from __future__ import annotations

import subprocess
import sys
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

import zygopin

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def wheel(tmp_path_factory) -> Path:
    folder = tmp_path_factory.mktemp("wheel")
    subprocess.run(
        [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(folder)],
        cwd=ROOT,
        check=True,
        capture_output=True,
    )
    (file,) = folder.glob("*.whl")
    return file


@pytest.fixture(scope="module")
def wheel_names(wheel) -> set[str]:
    with zipfile.ZipFile(wheel) as archive:
        return set(archive.namelist())


def test_the_wheel_carries_what_the_package_reads(wheel_names):
    shipped = {
        f"zygopin/urdf/{path.relative_to(ROOT / 'urdf')}"
        for path in (ROOT / "urdf").rglob("*")
        if path.is_file()
    }
    assets = ("page.html", "page.css", "page.js", "player.css", "player.js")
    shipped |= {f"zygopin/assets/{name}" for name in assets}
    assert wheel_names >= shipped | {"zygopin/py.typed", "zygopin/__init__.pyi"}


def test_the_wheel_carries_nothing_else(wheel_names):
    assert not [name for name in wheel_names if name.startswith(("tests", "scripts"))]


def test_the_wheel_s_data_is_the_package_as_ros_2_finds_it(wheel, tmp_path):
    # pip puts the folder `data` into the environment's root, which is the prefix.
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    prefix = tmp_path / f"zygopin-{zygopin.__version__}.data" / "data"
    (marker,) = (prefix / "share/ament_index/resource_index/packages").iterdir()
    share = prefix / "share" / marker.name
    for path in (ROOT / "urdf").rglob("*"):
        if path.is_file():
            copy = share / path.relative_to(ROOT / "urdf")
            assert copy.read_bytes() == path.read_bytes()
    command = [Path(sys.executable).with_name("xacro"), share / "foot.urdf.xacro"]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    shipped = ET.parse(share / "expanded" / "parrot.urdf").getroot()  # noqa: S314
    expanded = ET.fromstring(done.stdout)  # noqa: S314
    assert [*map(ET.tostring, expanded)] == [*map(ET.tostring, shipped)]


def test_an_editable_install_reads_the_checkout():
    assert ROOT / "urdf" == zygopin.PACKAGE_PATH
    for path in (
        zygopin.URDF_PATH,
        zygopin.SRDF_PATH,
        zygopin.MJCF_PATH,
        zygopin.XACRO_PATH,
    ):
        assert path.is_file()
