"""A peer: another tool that does the same work, and the proof that it does."""

from __future__ import annotations

import os
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Generic, TypeVar

Job = TypeVar("Job")
Result = TypeVar("Result")


class WrongAnswerError(Exception):
    """A peer's answer is not zygopin's: its time would mean nothing."""

    def __init__(self, name: str, what: str) -> None:
        self.name = name
        super().__init__(f"{name} {what}: that is other work, and is not timed")


@dataclass(frozen=True)
class Peer(Generic[Job, Result]):
    """One way to do a job.

    Attributes:
        name: What it is called in the table.
        computes: What it does, as a reader should know it to compare.
        make: A job to a function that does it; its preparations do not count.
        packages: Distributions that it needs; the last is what is measured.
        needs: Why it cannot run here for other reasons; empty if it can.
        share: Part of the configurations that it gets, for slow ones less than 1.
        tolerance: Difference from zygopin's answer that is allowed, over the foot's
            size.
        threads: Threads that it uses.
    """

    name: str
    computes: str
    make: Callable[[Job], Callable[[], Result]]
    packages: tuple[str, ...] = ()
    needs: Callable[[], str] = str
    share: float = 1.0
    tolerance: float = 1e-9
    threads: int = 1

    def lacking(self) -> str:
        """Why it cannot run here; empty if it can."""
        absent = [name for name in self.packages if not installed(name)]
        return f"{', '.join(absent)} not installed" if absent else self.needs()


def installed(package: str) -> str:
    """The version of a distribution; empty where it is not installed."""
    try:
        return version(package)
    except PackageNotFoundError:
        return ""


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0))


def check(name: str, difference: float, tolerance: float) -> None:
    """Refuse an answer that is not zygopin's.

    Args:
        name: The peer's name.
        difference: How far it is off; NaN counts as too far.
        tolerance: What is allowed.

    Raises:
        WrongAnswerError: It is off by more.
    """
    if not difference <= tolerance:
        raise WrongAnswerError(name, f"is off by {difference:.2g}, > {tolerance:.2g}")
