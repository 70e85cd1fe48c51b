"""The height at which a branch below the foot is grasped best."""

from __future__ import annotations

import numpy as np

from zygopin.branch import Branch
from zygopin.clearance import Floats
from zygopin.errors import ParameterError
from zygopin.foot import Foot
from zygopin.perch_combinations import all_poses, combinations, most_worth
from zygopin.wrap import FingerPoses

COARSE_LEVELS = 4
"""Angles tried at each joint while heights are compared."""

HEIGHTS = 17
"""Heights compared in one round."""

DEEPEST = 0.6
"""Deepest gap between base and bark that is tried, over the foot's size."""

ROUNDS = 2
"""Rounds of the search for a height, the second around the best of the first."""

VERTICAL = 1e-6
"""Squared sine of the slope to the vertical below which a branch has no height."""


COLUMN = 9
"""Heights of the column in which a grasp is searched further, and disproved."""


def column_heights(foot: Foot, branch: Branch) -> Floats:
    """Heights over the range that is searched, which a proof is about.

    Args:
        foot: The foot.
        branch: The branch, at any height.

    Returns:
        z of the branch's centre, from the base's skin on the bark downwards [m].

    Raises:
        ParameterError: The branch is vertical.
    """
    gaps = np.linspace(0.0, DEEPEST * foot.size, COLUMN)
    return np.asarray(_highest(foot, branch) - gaps)


def best_height(foot: Foot, branch: Branch) -> Branch:
    """The branch moved along z to where its coarse plan is worth most.

    Args:
        foot: The foot.
        branch: The branch, at any height.

    Returns:
        The branch in its place.

    Raises:
        ParameterError: The branch is vertical.
    """
    top, low, high = _highest(foot, branch), 0.0, DEEPEST * foot.size
    for _ in range(ROUNDS):
        gaps = np.linspace(low, high, HEIGHTS)
        poses = all_poses(foot, lowered(branch, top - gaps), COARSE_LEVELS)
        # Of equally good heights the nearest: the foot sits rather than hangs.
        best = float(gaps[best_place(foot, poses, -gaps / foot.size)])
        width = (high - low) / (HEIGHTS - 1)
        low, high = max(best - width, 0.0), best + width
    return lowered(branch, top - np.asarray(best))


def best_place(foot: Foot, poses: list[FingerPoses], merits: Floats) -> int:
    """The first of the places at which the foot's pose and a place's merit are best.

    Places are tried from the most promising on, until no other can be better.

    Args:
        foot: The foot.
        poses: Poses of every finger, for all the places.
        merits: What each place is worth by itself, shape (places,).

    Returns:
        Index of the place.
    """
    places = range(len(merits))
    at = [[each.take(each.place == place) for each in poses] for place in places]
    promised = np.array([most_worth(foot, there) for there in at]) + merits
    worths = np.full(len(merits), -np.inf)
    for place in np.argsort(-promised, kind="stable"):
        if promised[place] < worths.max():
            break
        worths[place] = combinations(foot, at[place]).worth[0] + merits[place]
    return int(np.argmax(worths))


def _highest(foot: Foot, branch: Branch) -> float:
    """Height of the centre at which the base's skin rests on the branch [m].

    Solves |centre − (centre·axis) axis| = radius + skin for the centre's z; where
    the branch passes beside the base, the height of the base.
    """
    across = np.eye(3) - np.outer(branch.axis, branch.axis)
    rise, level = across[:, 2], across @ (branch.centre * (1.0, 1.0, 0.0))
    square = float(rise @ rise)
    if square < VERTICAL:
        remedy = "give the branch a slope, or its place"
        raise ParameterError("branch.axis", branch.axis, "across the z axis", remedy)
    reach = float(branch.radius) + float(foot.radii.max())
    half = float(rise @ level) / square
    # Negative where the branch passes beside the base at every height.
    inside = half**2 - (float(level @ level) - reach**2) / square
    return -half - float(np.sqrt(max(inside, 0.0)))


def lowered(branch: Branch, heights: Floats) -> Branch:
    """The branch with its centre at other heights.

    Args:
        branch: The branch.
        heights: z of the centre [m], shape (…).

    Returns:
        A batch of branches, shape (…).
    """
    level = np.broadcast_to(branch.centre[:2], (*heights.shape, 2))
    return branch.moved_to(np.concatenate([level, heights[..., None]], axis=-1))
