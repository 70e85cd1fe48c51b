"""The same input gives the same bytes: from many threads, and in any environment."""

from __future__ import annotations

import json
import os
import random
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from tests.public_calls import CALLS, UNCALLED, digests, functions

THREADS = 8
ROOT = Path(__file__).parent.parent


def test_every_public_function_is_called():
    assert CALLS.keys() == functions() - UNCALLED


def german(folder: Path) -> dict[str, str]:
    """Variables for a locale with a decimal comma and letters that are not UTF-8."""
    name = "de_DE.ISO-8859-1"
    command = ["localedef", "-i", "de_DE", "-f", "ISO-8859-1", str(folder / name)]
    try:
        subprocess.run(command, check=True, capture_output=True)
    except (OSError, subprocess.CalledProcessError):
        name = "C"  # not to be had here: at least no UTF-8
    return {"LOCPATH": str(folder), "LC_ALL": name, "PYTHONUTF8": "0"}


ELSEWHERE = """
import locale, os
locale.setlocale(locale.LC_ALL, "")
os.umask(0o077)
if hasattr(os, "sched_setaffinity"):
    os.sched_setaffinity(0, [min(os.sched_getaffinity(0))])
from tests.public_calls import main
main()
"""


@pytest.fixture(scope="module")
def elsewhere(tmp_path_factory):
    """What every call gives, one after the other, in another environment."""
    folder = tmp_path_factory.mktemp("elsewhere")
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"), "1")
    environment = {
        **os.environ,
        **german(folder),
        **threads,
        "COLUMNS": "41",
        "PYTHONHASHSEED": "7",
        "PYTHONPATH": os.pathsep.join([str(ROOT), *sys.path]),
        "PYTHONCOERCECLOCALE": "0",
        "TMPDIR": str(folder),
        "TZ": "Asia/Kathmandu",
    }
    done = subprocess.run(
        [sys.executable, "-c", ELSEWHERE, "a folder"],
        cwd=folder,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout)


def test_threads_here_get_what_one_thread_gets_elsewhere(elsewhere, tmp_path):
    names = random.Random(3).sample(sorted(CALLS), len(CALLS))  # noqa: S311
    # At first all expand a template at once, and read one model.
    first = ["to_urdf", "to_srdf", "make_engine", "check_grasp", "torque_matrix"]
    lists = [[*first[n % 5 :], *names[n::THREADS]] for n in range(THREADS)]
    with ThreadPoolExecutor(THREADS) as pool:
        folders = [tmp_path / str(n) for n in range(THREADS)]
        for found in pool.map(digests, folders, lists):
            assert found == {name: elsewhere[name] for name in found}
