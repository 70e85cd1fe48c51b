"""Shipped URDFs answer for the presets, and only while nothing has changed since."""

from __future__ import annotations

import shutil

import pytest
from hypothesis import given
from strategies import feet

from zygopin import shipped
from zygopin.description import to_urdf
from zygopin.foot import Foot
from zygopin.paths import PACKAGE_PATH
from zygopin.presets import preset_names
from zygopin.shipped import STAMPS_PATH, shipped_urdf, sources, stamp
from zygopin.template import expand

PARROT = Foot.preset("parrot")
PRESETS = [*map(Foot.preset, preset_names())]


@pytest.fixture
def package(tmp_path, monkeypatch):
    """A copy of the description, which a test may damage."""
    folder = tmp_path / "urdf"
    shutil.copytree(PACKAGE_PATH, folder)
    monkeypatch.setattr(shipped, "PACKAGE_PATH", folder)
    monkeypatch.setattr(shipped, "STAMPS_PATH", folder / "expanded" / "stamps.txt")
    return folder


@pytest.mark.parametrize("name", preset_names())
@pytest.mark.parametrize("tendon", [False, True])
def test_a_preset_s_text_is_shipped_and_is_what_the_templates_expand_to(name, tendon):
    foot = Foot.preset(name)
    urdf = shipped_urdf(foot, tendon=tendon)
    assert urdf == expand(foot, tendon=tendon)
    assert to_urdf(foot, tendon=tendon) == urdf


def test_presets_are_known_by_their_values_not_by_their_names():
    twin = Foot.from_mapping(PARROT.to_mapping())
    assert shipped_urdf(twin, tendon=False) == to_urdf(PARROT)
    assert shipped_urdf(PARROT.replace(name="owl"), tendon=False) is None
    assert shipped_urdf(PARROT.replace(density=1100.5), tendon=False) is None


@given(feet())
def test_no_other_foot_is_answered_by_a_shipped_text(foot):
    assert foot in PRESETS or shipped_urdf(foot, tendon=False) is None


@given(feet(), feet())
def test_feet_that_differ_are_made_from_different_sources(one, other):
    same = sources(one, tendon=False) == sources(other, tendon=False)
    assert same == (one.to_mapping() == other.to_mapping())
    assert sources(one, tendon=False) != sources(one, tendon=True)


@pytest.mark.usefixtures("package")
def test_the_copy_is_trusted_while_it_is_whole():
    assert shipped_urdf(PARROT, tendon=False) == expand(PARROT)


def edited(path):
    path.write_text(path.read_text(encoding="utf-8") + "<!-- -->\n", encoding="utf-8")


def removed(path):
    path.unlink()


def unreadable(path):
    path.write_bytes(b"\xff\xfe\x00")


@pytest.mark.parametrize(
    "name", ["expanded/parrot.urdf", "finger.xacro", "foot.urdf.xacro"]
)
@pytest.mark.parametrize("damage", [edited, removed, unreadable])
def test_what_was_changed_since_is_not_trusted(package, name, damage):
    damage(package / name)
    assert shipped_urdf(PARROT, tendon=False) is None
    assert to_urdf(PARROT) == expand(PARROT)


@pytest.mark.parametrize("damage", [removed, unreadable])
def test_without_stamps_the_templates_answer(package, damage):
    damage(package / "expanded/stamps.txt")
    assert shipped_urdf(PARROT, tendon=False) is None
    assert to_urdf(PARROT) == expand(PARROT)


def test_a_text_of_another_foot_in_its_place_is_not_trusted(package):
    shutil.copy(package / "expanded/owl.urdf", package / "expanded/parrot.urdf")
    assert shipped_urdf(PARROT, tendon=False) is None


def test_every_shipped_urdf_has_its_stamp():
    lines = STAMPS_PATH.read_text(encoding="utf-8").splitlines()
    stamped = {line.split()[1]: line.split()[0] for line in lines}
    assert set(stamped) == {path.name for path in STAMPS_PATH.parent.glob("*.urdf")}
    urdf = (STAMPS_PATH.parent / "owl.urdf").read_text(encoding="utf-8")
    made_from = sources(Foot.preset("owl"), tendon=False)
    assert stamp(made_from, urdf) == stamped["owl.urdf"]
