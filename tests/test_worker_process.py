"""Worker processes end with the process that they work for."""

from __future__ import annotations

import subprocess
import sys

CHILD = """
import multiprocessing, os, signal, sys
from concurrent.futures import ProcessPoolExecutor
from zygopin.worker_process import leave_with_parent
if __name__ == "__main__":
    context = multiprocessing.get_context("spawn")
    pool = ProcessPoolExecutor(1, context, initializer=leave_with_parent)
    print(pool.submit(os.getpid).result() != os.getpid(), flush=True)
    os.kill(os.getpid(), signal.SIGKILL)
"""


def test_a_worker_leaves_when_its_parent_is_killed(tmp_path):
    script = tmp_path / "child.py"
    script.write_text(CHILD)
    command = [sys.executable, str(script)]
    # The output ends when the last process that holds it does: the worker.
    done = subprocess.run(command, stdout=subprocess.PIPE, timeout=60, check=False)
    assert done.returncode == -9
    assert done.stdout == b"True\n"


BROKEN_OFF = """
import time
from contextlib import suppress
from zygopin.worker_process import mapping, worker_pool
if __name__ == "__main__":
    for _ in range(6):
        with suppress(KeyboardInterrupt), mapping(2) as apply:
            for _ in apply(time.sleep, [0.01] * 200):
                raise KeyboardInterrupt
    # Before the pool has started what it will wait for.
    with suppress(KeyboardInterrupt), worker_pool(2) as pool:
        pool._executor_manager_thread = __import__("threading").Thread()
        raise KeyboardInterrupt
"""


def test_work_that_is_broken_off_ends_without_a_word(tmp_path):
    script = tmp_path / "broken_off.py"
    script.write_text(BROKEN_OFF)
    done = subprocess.run(
        [sys.executable, str(script)],
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
