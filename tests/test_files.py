"""Files are written whole or not at all."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from zygopin.errors import FileError
from zygopin.files import (
    check_file,
    check_folder,
    read_text,
    write_bytes,
    write_stream,
    write_text,
)


def test_it_writes_the_text_and_creates_folders(tmp_path):
    path = write_text(tmp_path / "a" / "b.txt", "ρ\n")
    assert path == tmp_path / "a" / "b.txt"
    assert path.read_bytes() == "ρ\n".encode()


def test_it_replaces_a_file_and_leaves_nothing_beside_it(tmp_path):
    path = tmp_path / "a.txt"
    path.write_text("old")
    write_text(str(path), "new")
    assert path.read_text() == "new"
    assert list(tmp_path.iterdir()) == [path]


def test_it_follows_a_link(tmp_path):
    (tmp_path / "target").write_text("old")
    (tmp_path / "link").symlink_to(tmp_path / "target")
    write_text(tmp_path / "link", "new")
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "target").read_text() == "new"


def test_a_failure_keeps_the_old_file(tmp_path, monkeypatch):
    path = tmp_path / "a.txt"
    path.write_text("old")

    def fail(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(Path, "replace", fail)
    with pytest.raises(FileError, match=r"No space left on device: name a file"):
        write_text(path, "new")
    monkeypatch.undo()
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_text_that_is_not_unicode_is_refused(tmp_path):
    with pytest.raises(FileError, match="cannot be written"):
        write_text(tmp_path / "a.txt", "\ud800")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("path", ["", os.devnull])
def test_folders_and_devices_are_refused(tmp_path, path):
    with pytest.raises(FileError, match="not a regular file"):
        write_text(tmp_path / path, "text")
    assert not Path(os.devnull).is_file()


def test_it_writes_bytes_as_they_are(tmp_path):
    path = write_bytes(tmp_path / "a" / "b.bin", b"\x00\r\n\xff")
    assert path.read_bytes() == b"\x00\r\n\xff"


def test_it_writes_piece_by_piece_and_stands_when_all_is_written(tmp_path):
    path = tmp_path / "a.bin"

    def write(file):
        file.write(b"one ")
        assert not path.exists()
        file.write(b"two")

    assert write_stream(path, write) == path
    assert path.read_bytes() == b"one two"


@pytest.mark.parametrize("error", [KeyError, KeyboardInterrupt, MemoryError])
def test_a_writer_that_breaks_off_leaves_the_old_file(tmp_path, error):
    path = write_bytes(tmp_path / "a.bin", b"old")

    def write(file):
        file.write(b"new")
        raise error

    with pytest.raises(error):
        write_stream(path, write)
    assert path.read_bytes() == b"old"
    assert list(tmp_path.iterdir()) == [path]


def test_bytes_for_a_folder_are_refused(tmp_path):
    with pytest.raises(FileError, match="not a regular file"):
        write_bytes(tmp_path, b"")


def test_what_has_no_end_is_not_read_to_it():
    with pytest.raises(FileError, match="/dev/zero: has more than 67108864 bytes"):
        read_text("/dev/zero")


@pytest.mark.parametrize("check", [check_file, check_folder])
def test_a_place_is_checked_before_the_work_and_nothing_is_made(check, tmp_path):
    (tmp_path / "file").write_text("kept")
    assert check(tmp_path / "a" / "b") == tmp_path / "a" / "b"
    for path in ("", tmp_path / "file" / "b", "/dev/null/b"):
        with pytest.raises(FileError):
            check(path)
    assert [*tmp_path.iterdir()] == [tmp_path / "file"]


def test_it_reads_text_or_says_why_not(tmp_path):
    (tmp_path / "a.txt").write_bytes("ρ\n".encode())
    assert read_text(tmp_path / "a.txt") == "ρ\n"
    (tmp_path / "b.txt").write_bytes(b"\xff")
    for name in ("b.txt", "none.txt"):
        with pytest.raises(FileError, match=r"cannot be read: .*: name a text file"):
            read_text(tmp_path / name)
