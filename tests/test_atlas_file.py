"""Atlases as files: the same again, the same bytes, and what is no atlas."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
from made_atlases import made_atlas

from zygopin import ParameterError, load_atlas, save_atlas
from zygopin.archive import write_archive
from zygopin.atlas import VERDICTS
from zygopin.atlas_file import UNITS
from zygopin.errors import FileError


def test_what_is_saved_comes_back(tmp_path):
    atlas = made_atlas()
    found = load_atlas(save_atlas(atlas, tmp_path / "new" / "atlas.npz"))
    assert found.foot == atlas.foot
    for name in ("heights", "radii", "axis", "offset"):
        assert (getattr(found.grid, name) == getattr(atlas.grid, name)).all()
    for field in dataclasses.fields(atlas)[2:]:
        here, there = getattr(found, field.name), getattr(atlas, field.name)
        assert here.dtype == there.dtype
        np.testing.assert_array_equal(here, there)


def test_an_atlas_always_has_the_same_bytes(tmp_path):
    first = save_atlas(made_atlas(), tmp_path / "one.npz")
    again = save_atlas(load_atlas(first), tmp_path / "two.npz")
    assert first.read_bytes() == again.read_bytes()


def test_numpy_reads_it_with_its_units_and_codes(tmp_path):
    with np.load(save_atlas(made_atlas(), tmp_path / "a.npz")) as archive:
        document = json.loads(str(archive["document"]))
        assert set(archive.files) == {*UNITS, "document"}
        np.testing.assert_array_equal(archive["grasping"], made_atlas().grasping)
    assert document["units"] == UNITS
    assert document["units"]["radii"] == "m"
    assert document["answers"] == {
        "1": "yes",
        "0": "no",
        "-1": "undecided",
        "-2": "holds_base",
    }
    assert set(VERDICTS) <= set(document["units"])


def test_what_is_no_atlas_is_told(tmp_path):
    text = tmp_path / "text.npz"
    text.write_text("no archive")
    alone = tmp_path / "alone.npy"
    np.save(alone, np.zeros(3))
    part = write_archive(tmp_path / "part.npz", {"radii": [1.0]})
    for path in (text, alone, part):
        with pytest.raises(FileError, match="is no atlas"):
            load_atlas(path)
    with pytest.raises(FileError, match="cannot be read"):
        load_atlas(tmp_path / "missing.npz")


@pytest.mark.parametrize(
    ("name", "values", "words"),
    [
        ("wrap", np.zeros((2, 2)), "wrap"),
        ("radii", np.array([2.0, 1.0, 3.0]), "rising or falling"),
        ("document", "{}", "foot"),
        ("document", "[", "Expecting"),
        ("controls", np.zeros((7, 9, 3)), "controls"),
    ],
)
def test_a_damaged_atlas_says_where(tmp_path, name, values, words):
    with np.load(save_atlas(made_atlas(), tmp_path / "whole.npz")) as archive:
        arrays = {**archive, name: values}
    damaged = write_archive(tmp_path / "damaged.npz", arrays)
    with pytest.raises(FileError, match=f"is no atlas: .*{words}"):
        load_atlas(damaged)


@pytest.mark.parametrize(
    ("name", "wrong", "words"),
    [
        ("grasping", 99, "grasping.* = 99 is not an answer"),
        ("stable", -3, "stable.* = -3 is not an answer"),
        ("toes", 99, "toes.* = 99 is not from 0 to 2"),
        ("controls", 1.5, "controls.* = 1.5 is not from 0 to 1"),
        ("wrap", -1.0, "wrap.* = -1.0 is not from 0 to 6.28319"),
    ],
)
def test_what_no_atlas_holds_is_named(tmp_path, name, wrong, words):
    with np.load(save_atlas(made_atlas(), tmp_path / "whole.npz")) as archive:
        arrays = dict(archive)
    arrays[name].flat[1] = wrong
    damaged = write_archive(tmp_path / "damaged.npz", arrays)
    with pytest.raises(FileError, match=f"is no atlas: {words}"):
        load_atlas(damaged)
    for kind in (str, complex):
        other = {**arrays, name: arrays[name].astype(kind)}
        damaged = write_archive(tmp_path / "other.npz", other)
        with pytest.raises(FileError, match=f"is no atlas: {name} holds "):
            load_atlas(damaged)


def test_a_file_that_cannot_be_written_leaves_nothing(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(FileError):
        save_atlas(made_atlas(), tmp_path / "file" / "a.npz")
    with pytest.raises(ParameterError, match="atlas"):
        save_atlas("atlas", tmp_path / "a.npz")
    assert [path.name for path in tmp_path.iterdir()] == ["file"]
