"""For every finger and branch: a pose in which it is tangent, or the proof of none."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np
from numpy.typing import NDArray

from zygopin.branch_grid import BranchGrid
from zygopin.contact_hull import STAGES, Criterion
from zygopin.foot import Foot
from zygopin.projection import BACK, PALM, Floats, ProjectedFinger
from zygopin.tangent_poses import FARTHEST, tangent_poses
from zygopin.tangent_proof import unproved

Booleans = NDArray[np.bool_]
Codes = NDArray[np.int8]


class Answer(IntEnum):
    """What is known of a branch."""

    NO = 0
    YES = 1
    UNDECIDED = -1
    HOLDS_BASE = -2


@dataclass(frozen=True, eq=False)
class ToePoses:
    """A pose of each finger on each branch of a grid, where one was found.

    Attributes:
        found: Where there is a pose, shape (F, H, R).
        wrap: How far round its contact lies, if the toe's palm touches [rad], shape
            (F, H, R); NaN where its back does, or without a pose.
        controls: The poses, for each finger of shape (H, R, K); 0 without one.
    """

    found: Booleans
    wrap: Floats
    controls: tuple[Floats, ...]


@dataclass(frozen=True, eq=False)
class ToeContacts(ToePoses):
    """What is known of each finger's tangency on each branch of a grid.

    Attributes:
        answer: `Answer` for each finger and branch, shape (F, H, R).
    """

    answer: Codes


class ToeSearch:
    """A foot's fingers seen along the branches of a grid; alike ones share work."""

    def __init__(self, foot: Foot, grid: BranchGrid) -> None:
        self.grid = grid
        self.fingers = [
            ProjectedFinger.of(foot, i, grid.axis) for i in range(len(foot.fingers))
        ]
        self.counts = [finger.phalanges for finger in foot.fingers]

    def contacts(self, wanted: Booleans, criterion: Criterion) -> ToeContacts:
        """Poses wrapped as far as they are found, proofs where none is.

        Args:
            wanted: Branches in question for each finger, shape (F, H, R).
            criterion: What counts as a tangent phalanx.

        Returns:
            What is known; `Answer.UNDECIDED` also where nothing was asked.
        """
        poses = self.poses(wanted, solid=criterion.solid)
        left = self.possible(wanted & ~poses.found, criterion)
        answer = np.where(left, Answer.UNDECIDED, Answer.NO)
        answer[poses.found] = Answer.YES
        answer[~wanted] = Answer.UNDECIDED
        return ToeContacts(
            poses.found, poses.wrap, poses.controls, answer.astype(np.int8)
        )

    def poses(
        self,
        wanted: Booleans,
        *,
        solid: bool = True,
        aim: float = FARTHEST,
    ) -> ToePoses:
        """Poses wrapped as near to an angle as they are found.

        The palm of a toe is tried first, and its back only where that finds nothing.

        Args:
            wanted: Branches in question for each finger, shape (F, H, R).
            solid: Keep the phalanges before the tangent one out of the branch.
            aim: The angle [rad].

        Returns:
            The poses.
        """
        shape = (len(self.fingers), *self.grid.shape)
        wrap, found = np.full(shape, np.nan), np.zeros(shape, dtype=bool)
        controls = tuple(np.zeros((*self.grid.shape, count)) for count in self.counts)
        for side in (PALM, BACK):
            missing = wanted & ~found
            for members in self._alike():
                leader = self.fingers[members[0]]
                asked = self._by_rank(members, missing)
                poses = tangent_poses(
                    leader, self.grid, asked, side=side, solid=solid, aim=aim
                )
                for finger in members:
                    angle, pose = poses.best(self.counts[finger], aim)
                    new = missing[finger] & np.isfinite(angle)
                    found[finger] |= new
                    controls[finger][new] = pose[new]
                    if side == PALM:
                        wrap[finger][new] = angle[new]
        return ToePoses(found, wrap, controls)

    def possible(
        self,
        asked: Booleans,
        criterion: Criterion,
        beyond: Floats | None = None,
        *,
        enough: bool = False,
        stages: int = len(STAGES),
    ) -> Booleans:
        """Branches for which tangency was not disproved.

        Args:
            asked: Branches in question for each finger, shape (F, H, R).
            criterion: What counts as a tangent phalanx.
            beyond: Only contacts count whose wrap, times the criterion's sense, is
                more than this [rad], shape (F, H, R).
            enough: One finger that is left is enough for a branch: the others are not
                asked, and stay out.
            stages: How many of the search's `STAGES` are gone through.

        Returns:
            Those that are left, shape (F, H, R).
        """
        left = np.zeros_like(asked)
        # Short fingers first: their proofs cost least, and may be enough.
        for members in reversed(self._alike()):
            leader = self.fingers[members[0]]
            asked = asked & ~(left.any(axis=0) & enough)
            bounds = np.where(asked, -np.inf if beyond is None else beyond, np.inf)
            least = [
                np.min([bounds[i] for i in members if self.counts[i] > rank], axis=0)
                for rank in range(self.counts[members[0]])
            ]
            open_ = self._by_rank(members, asked)
            found = unproved(
                leader,
                self.grid,
                open_,
                criterion,
                beyond=np.stack(least),
                stages=stages,
            )
            for finger in members:
                some = found[: self.counts[finger]].any(axis=0)
                left[finger] = asked[finger] & some
        return left

    def opposed(self, i: int, j: int) -> bool:
        """Whether two fingers flex around the branches in opposite senses.

        Args:
            i: Index of one.
            j: Index of the other.
        """
        frames = (self.fingers[k].frame for k in (i, j))
        senses = [float(np.cross(*frame) @ self.grid.axis) for frame in frames]
        return senses[0] * senses[1] < 0

    def _by_rank(self, members: list[int], asked: Booleans) -> Booleans:
        """Branches in question for each phalanx of the longest of alike fingers."""
        ranks = range(self.counts[members[0]])
        return np.stack(
            [
                np.any([asked[i] for i in members if self.counts[i] > rank], axis=0)
                for rank in ranks
            ]
        )

    def _alike(self) -> list[list[int]]:
        """Fingers that are prefixes of one another, the longest first."""
        order = sorted(range(len(self.fingers)), key=lambda i: -self.counts[i])
        groups: list[list[int]] = []
        for finger in order:
            for group in groups:
                if self._same(group[0], finger):
                    group.append(finger)
                    break
            else:
                groups.append([finger])
        return groups

    def _same(self, one: int, other: int) -> bool:
        """Whether two fingers are one chain and see the branches alike."""
        lines = (self.grid.line(self.fingers[i]) for i in (one, other))
        (origin, step), (origin_too, step_too) = lines
        size = self.fingers[one].lengths[0]
        return (
            self.fingers[one].same_chain(self.fingers[other])
            and abs(origin - origin_too) <= 1e-12 * size
            and abs(step - step_too) <= 1e-12
        )
