"""Atlases as files: written once, read whenever they are looked at."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from zygopin import checks, kinds
from zygopin.archive import read_archive, write_archive
from zygopin.atlas import VERDICTS, Atlas
from zygopin.branch_grid import BranchGrid
from zygopin.errors import FileError, ZygopinError
from zygopin.foot import Foot
from zygopin.toe_contacts import Answer

UNITS = {
    **dict.fromkeys(("heights", "radii", "offset"), "m"),
    **dict.fromkeys(("axis", "controls", "stable_controls", "toes"), "1"),
    "wrap": "rad",
    **dict.fromkeys(VERDICTS, "1"),
}
"""The arrays of a file, and their units."""

_LINES = ("heights", "radii", "axis", "offset")
_REMEDY = "name a file that save_atlas has written"


def save_atlas(atlas: Atlas, path: Path | str) -> Path:
    """Write an atlas for `load_atlas` and `numpy.load`.

    The arrays have the names of the attributes of `Atlas` and `BranchGrid`;
    `document` is a JSON text with the foot, the units of the arrays and the meaning of
    the codes. The same atlas gives the same bytes.

    Args:
        atlas: The atlas.
        path: The file, by custom `.npz`; its folders are made where they are missing.

    Returns:
        The path.

    Raises:
        ParameterError: It is no atlas.
        FileError: The file cannot be written.
    """
    kinds.instance("atlas", atlas, Atlas)
    document = {
        "foot": atlas.foot.to_mapping(),
        "units": UNITS,
        "answers": {str(int(code)): code.name.lower() for code in Answer},
    }
    arrays = {
        name: getattr(atlas.grid if name in _LINES else atlas, name) for name in UNITS
    }
    text = json.dumps(document, sort_keys=True, allow_nan=False)
    return write_archive(path, {**arrays, "document": text})


def load_atlas(path: Path | str) -> Atlas:
    """Read an atlas that `save_atlas` has written.

    Args:
        path: The file.

    Returns:
        The atlas.

    Raises:
        FileError: The file cannot be read, or holds no atlas.
    """
    arrays = read_archive(path, (*UNITS, "document"), "atlas")
    for name in UNITS:
        kinds_of = "iu" if name in ("toes", *VERDICTS) else "f"
        if arrays[name].dtype.kind not in kinds_of:
            problem = f"is no atlas: {name} holds {arrays[name].dtype}"
            raise FileError(path, problem, _REMEDY)
    try:
        return _atlas(arrays)
    except (ZygopinError, ValueError, KeyError, TypeError, RecursionError) as error:
        raise FileError(path, f"is no atlas: {error}", _REMEDY) from error


def _atlas(arrays: dict[str, np.ndarray[Any, Any]]) -> Atlas:
    """The atlas that a file's arrays make."""
    foot = Foot.from_mapping(json.loads(str(arrays.pop("document")))["foot"])
    grid = BranchGrid(*(arrays.pop(name) for name in _LINES))
    last = {"toes": (2,), "wrap": (2,)}
    last |= dict.fromkeys(("controls", "stable_controls"), (foot.phalanx_count,))
    highest = {"toes": len(foot.fingers), "wrap": math.tau}
    for name, values in arrays.items():
        checks.shaped(name, values, (*grid.shape, *last.get(name, ())))
        if name in VERDICTS:
            good, allowed = np.isin(values, list(Answer)), "an answer"
        else:
            most = highest.get(name, 1)
            good = (values >= 0) & (values <= most)
            if values.dtype.kind == "f":
                good |= np.isnan(values)  # where there is no pose
            allowed = f"from 0 to {most:g}"
        checks.require(name, values, good, allowed, "save the atlas again")
    return Atlas(foot, grid, **arrays)
