"""An atlas as users read it: a table, a map of letters, one JSON document."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from zygopin.atlas import VERDICTS, Atlas
from zygopin.atlas_regions import (
    REGION_WORDS,
    Region,
    open_share,
    region_map,
    region_shares,
)
from zygopin.branch import yaw_and_pitch
from zygopin.reason import MILLIMETRES
from zygopin.toe_contacts import Answer

LETTERS = {
    Region.GRASPING: "#",
    Region.FEASIBLE: "o",
    Region.TOUCHABLE: "+",
    Region.STABLE: "-",
    Region.NONE: ".",
    Region.UNDECIDED: "?",
    Region.HOLDS_BASE: " ",
}
"""Characters of the map."""

MAP_SHAPE = (24, 64)
"""Most lines and columns of the map on a terminal."""

RADIUS = "radius [mm]"

MARGIN = 9
"""Characters before each line of the map."""


def verdict_rows(atlas: Atlas) -> list[tuple[str, ...]]:
    """Shares of the answers, of the branches that do not hold the base.

    Args:
        atlas: The atlas.

    Returns:
        Texts: the question, shares of yes, no and undecided.
    """
    return [
        (name, *(f"{share:.1%}" for share in answer_shares(atlas, name).values()))
        for name in VERDICTS
    ]


def answer_shares(atlas: Atlas, verdict: str) -> dict[str, float]:
    """How often each answer is given.

    Args:
        atlas: The atlas.
        verdict: The question.

    Returns:
        Shares of the branches that do not hold the base, by the answer's name.
    """
    codes = atlas.answer(verdict)[atlas.grid.valid]
    answers = (Answer.YES, Answer.NO, Answer.UNDECIDED)
    count = max(len(codes), 1)
    return {code.name.lower(): float(np.sum(codes == code)) / count for code in answers}


def graspable_range(atlas: Atlas) -> tuple[float, float] | None:
    """Least and greatest radius of the grid that is grasped at some height [m].

    Args:
        atlas: The atlas.

    Returns:
        The radii; None: none is grasped. Those between need not all be.
    """
    some = atlas.grid.radii[np.any(atlas.grasping == Answer.YES, axis=0)]
    return (float(some[0]), float(some[-1])) if len(some) else None


def largest_wrap(atlas: Atlas) -> dict[str, float] | None:
    """The largest wrap of a toe that a pose shows on a branch that is grasped.

    On others a palm may touch farther back than a quarter turn, which counts as nearly
    all the way round.

    Args:
        atlas: The atlas.

    Returns:
        `wrap` and the proved `bound` on that branch [rad], its `height` and `radius`
        [m]; None: no branch is grasped.
    """
    shown = np.where(atlas.grasping == Answer.YES, atlas.wrap[..., 0], np.nan)
    if not np.isfinite(shown).any():
        return None
    row, column = np.unravel_index(np.nanargmax(shown), shown.shape)
    return {
        "wrap": float(shown[row, column]),
        "bound": float(atlas.wrap[row, column, 1]),
        "height": float(atlas.grid.heights[row]),
        "radius": float(atlas.grid.radii[column]),
    }


def title_line(atlas: Atlas) -> str:
    """Which foot and which branches, in one line."""
    rows, columns = atlas.grid.shape
    names = " and ".join(finger.name for finger in atlas.foot.fingers)
    foot = atlas.foot.name + (f", {names}" if len(atlas.foot.fingers) == 2 else "")
    yaw, pitch = (math.degrees(x) + 0.0 for x in yaw_and_pitch(atlas.grid.axis))
    turned = [f"{name} {x:.4g}°" for name, x in (("yaw", yaw), ("pitch", pitch))]
    turned = [words for words in turned if not words.endswith(" 0°")]
    across = atlas.grid.offset * MILLIMETRES
    turned += [f"x {across[0]:.4g} mm"] if across[0] else []
    return ", ".join([f"{foot}: {rows} heights x {columns} radii", *turned])


def summary_lines(atlas: Atlas) -> list[str]:
    """What the table does not say.

    Args:
        atlas: The atlas.

    Returns:
        Lines of at most 80 characters.
    """
    radii, wrap = graspable_range(atlas), largest_wrap(atlas)
    lines = ["graspable at some height: no radius of the grid"]
    if radii is not None:
        low, high = (_mm(radius) for radius in radii)
        lines = [f"graspable at some height: radii from {low} to {high} mm"]
    if wrap is not None:
        lines.append(
            f"largest wrap of a grasp: {math.degrees(wrap['wrap']):.1f}°, radius "
            f"{_mm(wrap['radius'])} mm, height {_mm(wrap['height'])} mm"
        )
    lines.append(f"more may be possible on {open_share(atlas):.1%} of the branches")
    return lines


def map_lines(atlas: Atlas) -> list[str]:
    """A map of the regions in letters, the highest branches first.

    Args:
        atlas: The atlas.

    Returns:
        Lines of at most 80 characters; larger grids are thinned.
    """
    rows, columns = (
        np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
        for count, most in zip(atlas.grid.shape, MAP_SHAPE, strict=True)
    )
    letters, radii = region_letters(atlas), atlas.grid.radii
    rows = rows[np.argsort(-atlas.grid.heights[rows])]
    heights = [f"{_mm(height):>{MARGIN - 1}} " for height in atlas.grid.heights[rows]]
    ends = [_mm(radii[columns[place]]) for place in (0, -1)]
    gap = max(len(columns) - len(ends[0]) - len(ends[1]), len(RADIUS) + 2)
    return [
        f"{'z [mm]':>{MARGIN - 1}}",
        *(
            (height + "".join(letters[row][column] for column in columns)).rstrip()
            for row, height in zip(rows, heights, strict=True)
        ),
        MARGIN * " " + ends[0] + f"{RADIUS:^{gap}}" + ends[1],
        *_key_lines(atlas),
    ]


def region_letters(atlas: Atlas) -> list[str]:
    """The regions, a line for each height of the grid and a letter for each radius."""
    return [
        "".join(LETTERS[Region(code)] for code in line) for line in region_map(atlas)
    ]


def atlas_document(atlas: Atlas) -> dict[str, Any]:
    """An atlas as plain values, all in SI; poses are in the file of `save_atlas`.

    Args:
        atlas: The atlas.

    Returns:
        A mapping for JSON.
    """
    grid, radii = atlas.grid, graspable_range(atlas)
    shares = region_shares(atlas)
    return {
        "foot": atlas.foot.to_mapping(),
        "grid": {
            "heights": grid.heights.tolist(),
            "radii": grid.radii.tolist(),
            "axis": grid.axis.tolist(),
            "offset": grid.offset.tolist(),
            "valid": int(grid.valid.sum()),
        },
        "answers": {name: answer_shares(atlas, name) for name in VERDICTS},
        "regions": {region.name.lower(): share for region, share in shares.items()},
        "open": open_share(atlas),
        "graspable_radii": None if radii is None else list(radii),
        "largest_wrap": largest_wrap(atlas),
        "map": region_letters(atlas),
        "letters": {letter: region.name.lower() for region, letter in LETTERS.items()},
    }


def _key_lines(atlas: Atlas) -> list[str]:
    """What the letters mean, three to a line."""
    shares = region_shares(atlas)
    words = [
        f"{LETTERS[region]} {REGION_WORDS[region]}"
        for region in REGION_WORDS
        if shares.get(region, 0.0) > 0
    ]
    words.append("blank: holds the base")
    return ["  ".join(words[start : start + 4]) for start in range(0, len(words), 4)]


def _mm(metres: float) -> str:
    """A length [mm] without a minus sign on zero."""
    return f"{float(metres) * MILLIMETRES + 0.0:.4g}"
