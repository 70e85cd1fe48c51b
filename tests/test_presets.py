"""Parameter files: the shipped ones, and what can be wrong with the caller's."""

from __future__ import annotations

import pytest

from zygopin.errors import FileError, UnknownNameError
from zygopin.foot import Foot
from zygopin.paths import PRESETS_PATH
from zygopin.presets import preset_names, read_parameters, read_preset

FIELDS = {"rho", "omega", "splay", "scale", "thickness", "density", "fingers"}


def test_the_presets_are_the_files_that_are_there():
    names = preset_names()
    assert {"anisodactyl", "owl", "paper", "parrot"} <= set(names)
    assert list(names) == sorted(names)
    assert len(names) == len([*PRESETS_PATH.iterdir()])


@pytest.mark.parametrize("name", preset_names())
def test_every_preset_says_what_it_is_and_where_its_numbers_come_from(name):
    content = read_preset(name)
    assert content["description"]
    assert set(content["sources"]) == FIELDS
    assert content.keys() >= FIELDS


@pytest.mark.parametrize("name", preset_names())
def test_every_preset_is_a_foot_that_carries_its_name(name):
    assert Foot.preset(name).name == name.replace("-", "_")


@pytest.mark.parametrize("name", ["parot", "../presets/owl", "", None, 3])
def test_an_unknown_preset_is_refused_with_the_choice(name):
    with pytest.raises(UnknownNameError, match="choose one of anisodactyl, owl"):
        read_preset(name)


def test_a_misspelt_preset_gets_a_suggestion():
    with pytest.raises(UnknownNameError, match="did you mean 'parrot'"):
        read_preset("parot")


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (b"rho: [1", "not YAML: while parsing"),
        (b"rho: 2020-13-45", "not YAML: month must be"),
        (b"rho: !!python/object:os.system x", "not YAML: could not determine"),
        (b"[" * 1500, "not YAML"),
        (b"\xff\xfe\x00", "cannot be read: not a UTF-8 text file"),
        (b"", "holds NoneType, not a mapping"),
        (b"- 1", "holds list, not a mapping"),
        (b"text", "holds str, not a mapping"),
    ],
)
def test_a_malformed_file_is_one_line_with_its_name(tmp_path, content, message):
    file = tmp_path / "foot.yaml"
    file.write_bytes(content)
    with pytest.raises(FileError) as caught:
        read_parameters(file)
    assert str(caught.value).startswith(f"{file}: {message}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("name", ["none.yaml", ".", "a\0b"])
def test_an_unreadable_file_is_one_line_with_a_remedy(tmp_path, name):
    with pytest.raises(FileError, match="name a text file that can be read") as caught:
        read_parameters(f"{tmp_path}/{name}")
    assert "\n" not in str(caught.value)
