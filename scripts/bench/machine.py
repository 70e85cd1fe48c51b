"""What the figures were measured on: processor, cores, versions."""

from __future__ import annotations

import os
import platform
from collections.abc import Iterable
from pathlib import Path

from bench.peer import cores, installed


def processor() -> str:
    """The processor's name, as Linux gives it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor()
    names = (line.partition(":")[2] for line in lines if line.startswith("model name"))
    return next(names, platform.processor()).strip()


def versions(packages: Iterable[str]) -> dict[str, str]:
    """Versions of those distributions that are installed, and of Python."""
    wanted = sorted({"zygopin", "numpy", *packages})
    found = {name: installed(name) for name in wanted}
    known = {name: number for name, number in found.items() if number}
    return {"python": platform.python_version(), **known}


def spare_memory() -> float:
    """Memory that new work may take [bytes], as Linux estimates it."""
    try:
        lines = Path("/proc/meminfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return 4e9
    row = next(line for line in lines if line.startswith("MemAvailable"))
    return 1024 * float(row.split()[1])


def description() -> dict[str, object]:
    """The machine in plain values, and how busy it is before anything is measured."""
    load, _, _ = os.getloadavg()
    busy = round(load, 1)
    return {"processor": processor(), "cores": cores(), "load_before": busy}
