"""The same input gives the same bytes: among threads, and in any other surroundings."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest
from plain_results import QUICK, digest, result

THREADS = 8

CHILD = """
import json, locale, os, time
locale.setlocale(locale.LC_ALL, "")
assert locale.localeconv()["decimal_point"] == ","
assert time.timezone == -20700  # of Kathmandu
os.umask(0o077)
if hasattr(os, "sched_setaffinity"):  # one core
    os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])
from plain_results import QUICK, digest, result
print(json.dumps({entry.name: digest(result(entry)) for entry in QUICK}))
"""


@pytest.fixture(scope="module")
def alone():
    """What each entry gives in this process, asked for one after the other."""
    return {entry.name: digest(result(entry)) for entry in QUICK}


@pytest.fixture
def german(tmp_path):
    """A folder with a locale of decimal commas, whose letters are not UTF-8."""
    names = ["-i", "de_DE", "-f", "ISO-8859-1", str(tmp_path / "de_DE.ISO-8859-1")]
    made = subprocess.run(["localedef", *names], capture_output=True, check=False)
    if made.returncode and not os.environ.get("CI"):
        pytest.skip("no locale of Germany can be made here")
    return tmp_path


def differing(found, expected):
    assert found.keys() == expected.keys()
    return {name for name, each in found.items() if each != expected[name]}


def test_threads_that_call_everything_at_once_get_what_one_gets(alone):
    calls = random.Random(1).sample(QUICK, len(QUICK))  # noqa: S311 an order, no secret
    with ThreadPoolExecutor(THREADS) as pool:
        found = list(pool.map(lambda entry: digest(result(entry)), calls))
    names = [entry.name for entry in calls]
    wrong = [n for n, each in zip(names, found, strict=True) if each != alone[n]]
    assert wrong == []


def test_no_other_surroundings_change_a_byte(alone, german):
    place = german / "a bird's café"
    place.mkdir()
    around = {
        "COLUMNS": "41",
        "LC_ALL": "de_DE.ISO-8859-1",
        "LOCPATH": str(german),
        "PYTHONCOERCECLOCALE": "0",
        "PYTHONUTF8": "0",
        "TMPDIR": str(german),
        "TZ": "Asia/Kathmandu",
        "PYTHONHASHSEED": "4711",
        "OMP_NUM_THREADS": "1",
        "OPENBLAS_NUM_THREADS": "1",
        "PYTHONPATH": os.pathsep.join([str(Path(__file__).parent), *sys.path]),
    }
    done = subprocess.run(
        [sys.executable, "-c", CHILD],
        cwd=place,
        env={**os.environ, **around},
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert differing(json.loads(done.stdout), alone) == set()
