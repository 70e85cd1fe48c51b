"""Broken off anywhere, writing leaves the old content or the new, and nothing else."""

from __future__ import annotations

import json
import os
import resource
import signal
import subprocess
import sys
import time
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest

from tests.written import KINDS, contents
from zygopin.errors import FileError

WATCHED = ("files", "exchange", "sweep_files")
"""Modules of the package whose calls are interrupted, down to the system's."""

PLACES = 25
"""Places of one writer at most."""

FOLDERS = ("description", "report")
"""Kinds that are several files, each of them old or new."""


class Interruption:
    """Counts calls and returns of the writers, and interrupts one of them.

    That is where Python looks for signals: before a call, and after what C has done.
    """

    def __init__(self, place=None):
        self.place, self.seen = place, 0

    def __call__(self, frame, event, _):
        below = frame
        while below and below.f_globals["__name__"].startswith(("pathlib", "shutil")):
            below = below.f_back
        if event == "return" or below is None:
            return
        if below.f_globals["__name__"] not in [f"zygopin.{name}" for name in WATCHED]:
            return
        if self.seen == self.place:
            sys.setprofile(None)
            raise KeyboardInterrupt
        self.seen += 1


@contextmanager
def profiled(watch):
    """Tell of calls and returns."""
    sys.setprofile(watch)
    try:
        yield
    finally:
        sys.setprofile(None)


def whole(name, folder):
    """Whether each file is of one version, and nothing else is there."""
    kind = KINDS[name]
    found = contents(folder)
    versions = [contents(folder / f"{n}") for n in (0, 1)]
    found = {key: value for key, value in found.items() if key[:2] not in ("0/", "1/")}
    if name in FOLDERS:
        assert found.keys() == versions[0].keys()
        return all(found[key] in (v[key] for v in versions) for key in found)
    assert (folder / kind.name).exists()
    return found in versions


@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
@pytest.mark.parametrize("name", ["archive", "zarr"])
def test_an_interruption_anywhere_leaves_old_or_new(name, tmp_path):
    kind = KINDS[name]
    for version in (0, 1):
        kind.put(version, tmp_path / f"{version}")
    count = Interruption()
    kind.put(0, tmp_path)
    with profiled(count):
        kind.put(1, tmp_path)
    assert count.seen > 5
    for place in range(0, count.seen, max(1, count.seen // PLACES)):
        watch = Interruption(place)
        # Python's own removal of a folder may turn it into an OSError.
        with suppress(KeyboardInterrupt, OSError), profiled(watch):
            kind.put(place % 2, tmp_path)
        assert watch.seen == place or place > count.seen / 2  # they vary a little
        assert whole(name, tmp_path), place


@pytest.mark.parametrize("name", KINDS)
def test_a_full_disk_leaves_the_old(name, tmp_path):
    kind = KINDS[name]
    for version in (0, 1):
        kind.put(version, tmp_path / f"{version}")
    kind.put(0, tmp_path)
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100, limits[1]))
    try:
        with pytest.raises(FileError, match="cannot be written") as caught:
            kind.put(1, tmp_path)
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert "\n" not in str(caught.value)
    assert whole(name, tmp_path)
    kind.put(1, tmp_path)
    assert contents(tmp_path / kind.name) == contents(tmp_path / "1" / kind.name)


# Killed ------------------------------------------------------------------------------


def test_a_kill_at_any_moment_leaves_old_or_new(tmp_path):
    command = [sys.executable, "-m", "tests.killed", str(tmp_path), "--times", "2"]
    root = Path(__file__).parent.parent
    done = subprocess.run(
        command, cwd=root, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    assert json.loads(done.stdout) == {
        name: {
            "killed": 2,
            "broken": [],
            "left after an interruption": [],
            "written again": True,
        }
        for name in KINDS
    }


def _heeds_ctrl_c():
    """What a shell starts in the background ignores it."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def test_ctrl_c_ends_the_command_its_workers_and_what_was_begun(tmp_path):
    options = ("--radius-mm", "3:60:2000", "--workers", "2", "-o", "a.nc")
    command = [sys.executable, "-m", "zygopin", "sweep", *options]
    with subprocess.Popen(
        command,
        cwd=tmp_path,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        preexec_fn=_heeds_ctrl_c,
    ) as process:
        parts = tmp_path / "a.nc.parts"
        while process.poll() is None and not list(parts.glob("*.npz")):
            time.sleep(0.02)
        os.killpg(process.pid, signal.SIGINT)
        spoken, complaint = process.communicate(timeout=60)
    assert (spoken, complaint.strip()) == ("", "zygopin: interrupted")
    assert process.returncode == 130
    left = list(tmp_path.rglob("*"))
    assert left == [parts, *parts.glob("*.npz")]
