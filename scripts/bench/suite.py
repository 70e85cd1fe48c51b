"""Peers and zygopin on one job: checked first, then timed in turns."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass
from typing import Any, Generic, Protocol, TypeVar

from bench.peer import Peer
from bench.quiet import quiet
from bench.timing import Spread, interleaved, ratios


class Countable(Protocol):
    """A job of which a part can be done."""

    @property
    def count(self) -> int:
        """Number of configurations."""

    def few(self: Job, count: int) -> Job:
        """The job on the first so many of them."""


Job = TypeVar("Job", bound=Countable)
Result = TypeVar("Result")

LEAST = 20
"""Configurations that even the slowest peer gets, where there are as many."""


@dataclass(frozen=True)
class Row:
    """What was measured of one way to do a job.

    Attributes:
        part: What the job is called.
        name: What the way is called.
        computes: What it does.
        threads: Threads that it used.
        configurations: How many it did in one run.
        microseconds: Time of one configuration [µs], over the runs.
        ratio: That over the time of zygopin's first row, round by round.
        ratio_alike: The same over zygopin's on one thread, for those on one.
        own: Whether it is zygopin's.
        packages: Distributions that it needs.
        remark: What the comparison of answers found.
    """

    part: str
    name: str
    computes: str
    threads: int
    configurations: int
    microseconds: Spread
    ratio: Spread
    ratio_alike: Spread | None
    own: bool
    packages: tuple[str, ...]
    remark: str

    def plain(self) -> dict[str, Any]:
        """The row for JSON."""
        return asdict(self)


@dataclass(frozen=True)
class Suite(Generic[Job, Result]):
    """One job and those who do it.

    Attributes:
        part: What the job is called.
        job: The job.
        own: Zygopin's ways; the first that can run is what others are held against.
        peers: The others.
        verify: Name, job, answer and tolerance to a remark; raises on a wrong answer.
    """

    part: str
    job: Job
    own: Sequence[Peer[Job, Result]]
    peers: Sequence[Peer[Job, Result]]
    verify: Callable[[str, Job, Result, float], str]

    def missing(self) -> dict[str, str]:
        """Those who cannot run here, and why."""
        return {p.name: p.lacking() for p in (*self.own, *self.peers) if p.lacking()}

    def measure(self, runs: int) -> list[Row]:
        """Check and time all that can run here.

        Args:
            runs: Rounds of timing.

        Returns:
            The rows, zygopin's first.

        Raises:
            WrongAnswerError: A peer gives another answer.
        """
        absent = self.missing()
        able = [p for p in (*self.own, *self.peers) if p.name not in absent]
        ready = {peer.name: self._ready(peer) for peer in able}
        works = {name: work for name, (work, _, _) in ready.items()}
        times = interleaved(works, runs)
        single = {
            name: [second / ready[name][1] for second in seconds]
            for name, seconds in times.items()
        }
        return [self._row(peer, able, single, ready[peer.name]) for peer in able]

    def _ready(self, peer: Peer[Job, Result]) -> tuple[Callable[[], Result], int, str]:
        """A peer's work, how many configurations it does, and the remark on it."""
        wanted = max(LEAST, round(self.job.count * peer.share))
        part = self.job.few(min(wanted, self.job.count))
        with quiet():
            work = peer.make(part)
            answer = work()
        remark = self.verify(peer.name, part, answer, peer.tolerance)
        return work, part.count, remark

    def _row(
        self,
        peer: Peer[Job, Result],
        able: Sequence[Peer[Job, Result]],
        single: dict[str, list[float]],
        ready: tuple[Any, int, str],
    ) -> Row:
        """The row of a peer, from the times of one configuration of all."""
        mine, (_, count, remark) = single[peer.name], ready
        alike = next((p for p in able if p in self.own and p.threads == 1), None)
        same = ratios(mine, single[alike.name]) if alike and peer.threads == 1 else None
        return Row(
            part=self.part,
            name=peer.name,
            computes=peer.computes,
            threads=peer.threads,
            configurations=count,
            microseconds=Spread.of(mine).scaled(1e6),
            ratio=ratios(mine, single[able[0].name]),
            ratio_alike=same,
            own=peer in self.own,
            packages=peer.packages,
            remark=remark,
        )
