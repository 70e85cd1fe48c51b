"""The files of a foot in one folder."""

from __future__ import annotations

import pytest

from zygopin.bundle import write_description
from zygopin.description import to_urdf
from zygopin.errors import DescriptionError, FileError
from zygopin.foot import Foot
from zygopin.mjcf import to_mjcf
from zygopin.srdf import to_srdf


def test_write_description_writes_a_urdf_and_an_srdf_of_each_variant(tmp_path):
    foot = Foot.preset("owl")
    files = write_description(foot, tmp_path / "new" / "folder")
    assert [file.name for file in files] == [
        "foot.urdf",
        "foot_tendon.urdf",
        "foot.srdf",
        "foot_tendon.srdf",
    ]
    texts = [file.read_bytes().decode() for file in files]
    assert texts == [
        *(to_urdf(foot, tendon=tendon) for tendon in (False, True)),
        *(to_srdf(foot, tendon=tendon) for tendon in (False, True)),
    ]
    assert sorted(tmp_path.rglob("*.*")) == sorted(files)


def test_mujoco_models_come_with_a_scene_that_includes_one(tmp_path):
    foot = Foot.preset("parrot")
    files = write_description(foot, tmp_path, mjcf=True)
    texts = {file.name: file.read_bytes().decode() for file in files}
    assert [*texts][4:] == ["foot.xml", "foot_tendon.xml", "scene.xml"]
    assert texts["foot.xml"] == to_mjcf(foot)
    assert texts["foot_tendon.xml"] == to_mjcf(foot, tendon=True)
    assert '<include file="foot_tendon.xml" />' in texts["scene.xml"]


def test_too_light_a_foot_leaves_no_file(tmp_path):
    foot = Foot.preset("parrot").replace(scale=0.001, thickness=0.0001)
    with pytest.raises(DescriptionError, match="too light for MuJoCo"):
        write_description(foot, tmp_path / "new", mjcf=True)
    assert not (tmp_path / "new").exists()


def test_an_unwritable_folder_is_one_line(tmp_path):
    (tmp_path / "file").write_text("kept")
    with pytest.raises(FileError, match="cannot be written") as caught:
        write_description(Foot.preset("parrot"), tmp_path / "file" / "below")
    assert "\n" not in str(caught.value)
    assert (tmp_path / "file").read_text() == "kept"
