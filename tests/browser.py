"""Headless Chromium: what a page looks like, what it asks for, what it complains of."""

from __future__ import annotations

import json
import os
import shutil
import signal
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from PIL import Image

CHROMIUM = "chromium"
FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-quic",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
    "--hide-scrollbars",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--enable-logging=stderr",
    "--virtual-time-budget=500",
)
TIMEOUT = 30.0
"""Seconds after which a browser hangs: five times what a scene takes."""


@dataclass(frozen=True, eq=False)
class Visit:
    """What came of opening a page.

    Attributes:
        pixels: The screenshot, shape (height, width, 3), uint8.
        requests: Addresses that pages asked for, in order; the browser's own errands
            are not among them.
        console: Lines that pages wrote to the console; remarks of the software
            renderer on its own speed are not among them.
    """

    pixels: NDArray[np.uint8]
    requests: tuple[str, ...]
    console: tuple[str, ...]


def visit(
    page: Path, size: tuple[int, int] = (1280, 800), picture: Path | None = None
) -> Visit:
    """Open a page in a new, empty browser.

    Args:
        page: The HTML file.
        size: Width and height of the window [pixels].
        picture: Where to keep the screenshot; None: nowhere.

    Returns:
        What came of it.
    """
    if shutil.which(CHROMIUM) is None and "CI" not in os.environ:
        pytest.skip(f"{CHROMIUM} is not installed: this page was not opened")
    try:
        return _visit(page, size, picture)
    except subprocess.TimeoutExpired:  # its virtual clock, rarely, never ends
        return _visit(page, size, picture)


def _visit(page: Path, size: tuple[int, int], picture: Path | None) -> Visit:
    """One attempt at a visit."""
    with tempfile.TemporaryDirectory(ignore_cleanup_errors=True) as folder:
        shot = Path(folder) / "shot.png" if picture is None else picture
        log = Path(folder) / "net.json"
        spoken = _run(
            CHROMIUM,
            *FLAGS,
            f"--user-data-dir={folder}/profile",
            f"--window-size={size[0]},{size[1]}",
            f"--screenshot={shot}",
            f"--log-net-log={log}",
            page.resolve().as_uri(),
        )
        with Image.open(shot) as image:
            pixels = np.asarray(image.convert("RGB"))
        return Visit(pixels, _requests(log), _console(spoken))


def _run(*command: str) -> str:
    """What a program writes to stderr; on a timeout it ends with all its children."""
    with subprocess.Popen(
        command,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    ) as process:
        try:
            _, spoken = process.communicate(timeout=TIMEOUT)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            raise
    if process.returncode:
        raise AssertionError(f"{command[0]} failed: {spoken[-2000:]}")
    return spoken


def _requests(log: Path) -> tuple[str, ...]:
    """Addresses of the URL requests in a net log."""
    content = json.loads(log.read_text())
    start = content["constants"]["logEventTypes"]["URL_REQUEST_START_JOB"]
    begun = [event["params"] for event in content["events"] if event["type"] == start]
    return tuple(
        params["url"]
        for params in begun
        if "url" in params and params["initiator"] != "not an origin"
    )


def _console(log: str) -> tuple[str, ...]:
    """Lines of a browser's log that come from a page's console."""
    lines = (line for line in log.splitlines() if ":CONSOLE" in line)
    return tuple(line for line in lines if "GL Driver Message" not in line)
