"""What processes do that work for another one."""

from __future__ import annotations

import multiprocessing
import os
from threading import Thread


def leave_with_parent() -> None:
    """See that this process ends when its parent does, even when that is killed.

    A worker that waits for work would otherwise wait for ever: it holds both ends of
    the pipe that it waits on.
    """
    Thread(target=_leave, daemon=True).start()


def _leave() -> None:
    """Wait for the parent's end."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)
