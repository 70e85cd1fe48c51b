"""Kill writers at random moments: python -m tests.killed FOLDER --times 300."""

from __future__ import annotations

import argparse
import json
import os
import random
import signal
import time
from itertools import count
from pathlib import Path

from tests.written import KINDS, contents

LONGEST = 0.1
"""Seconds within which a writer is killed."""


def main() -> None:
    """Kill, look, and tell as JSON what was found."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("folder", type=Path)
    parser.add_argument("--times", type=int, default=300)
    parser.add_argument("--kind", choices=KINDS, action="append")
    given = parser.parse_args()
    told = {
        name: _tried(name, given.folder / name, given.times)
        for name in given.kind or KINDS
    }
    print(json.dumps(told))  # noqa: T201


def _tried(name: str, folder: Path, times: int) -> dict[str, object]:
    """What came of killing the writers of one kind."""
    kind, place, rng = KINDS[name], folder / "place", random.Random(name)  # noqa: S311
    versions = [
        contents(kind.put(version, folder / f"{version}")) for version in (0, 1)
    ]
    kind.put(0, place)
    broken, left = [], []
    for number in range(times):
        how = (signal.SIGKILL, signal.SIGINT)[number % 2]
        before = set(place.rglob("*"))
        _killed(kind, place, how, rng.uniform(0, LONGEST))
        broken += _broken(contents(place / kind.name), versions)
        if how == signal.SIGINT:
            left += [str(path) for path in set(place.rglob("*")) - before]
    kind.put(1, place)
    again = versions[1].items() <= contents(place / kind.name).items()
    return {
        "killed": times,
        "broken": broken,
        "left after an interruption": left,
        "written again": again,
    }


def _killed(kind, place: Path, how: signal.Signals, after: float) -> None:
    """Write in another process, over and over, until it is killed."""
    ready, begun = os.pipe()
    child = os.fork()
    if child == 0:
        _write_for_ever(kind, place, begun)
    os.read(ready, 1)
    time.sleep(after)
    for waited in count():
        if waited % 500 == 0:  # again: HDF5 pays no attention while it writes
            os.kill(child, how)
        time.sleep(0.01)
        ended, status = os.waitpid(child, os.WNOHANG)
        if ended:
            break
    os.close(ready)
    os.close(begun)
    if how == signal.SIGKILL and status != signal.SIGKILL:
        raise SystemExit(f"the writer ended by itself with the status {status}")


def _write_for_ever(kind, place: Path, begun: int) -> None:
    """Write both versions in turn, until that is interrupted.

    Some libraries make another error of an interruption, or none.
    """
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.write(begun, b"!")
        while True:
            for version in (1, 0):
                kind.put(version, place)
    finally:
        os._exit(1)


def _broken(found: dict[str, bytes], versions: list[dict[str, bytes]]) -> list[str]:
    """Files that are of neither version, but for those left beside them."""
    missing = [name for name in versions[0] if name not in found]
    return missing + [
        name
        for name, content in found.items()
        if not Path(name).name.startswith(".")
        and content not in [version.get(name) for version in versions]
    ]


if __name__ == "__main__":
    main()
