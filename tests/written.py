"""Each kind of file and folder that is written, in two versions of the same size."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from tests.made_atlases import made_atlas
from zygopin import (
    Branch,
    Foot,
    check_grasp,
    export_scene,
    save_atlas,
    sweep,
    write_description,
)
from zygopin.archive import write_archive
from zygopin.figures import new_figure, save_figure
from zygopin.paper import output
from zygopin.paper.entry import Entry, Exhibit
from zygopin.sweep_files import save_dataset


@dataclass(frozen=True)
class Kind:
    """Something that is written.

    Attributes:
        name: Name of the file or folder.
        make: What is written, of a version: 0 or 1.
        write: Writes that to a path.
    """

    name: str
    make: Callable[[int], Any]
    write: Callable[[Any, Path], object]

    @cache  # noqa: B019 a handful of them, for as long as the tests
    def made(self, version: int) -> Any:
        """What is written, made once."""
        return self.make(version)

    def put(self, version: int, folder: Path) -> Path:
        """Write a version into a folder."""
        path = folder / self.name
        self.write(self.made(version), path)
        return path


def contents(path: Path) -> dict[str, bytes]:
    """What a file holds, or all files of a folder, by their names in it."""
    files = [path] if path.is_file() else sorted(path.rglob("*"))
    return {
        str(file.relative_to(path)): file.read_bytes()
        for file in files
        if file.is_file()
    }


def foot(version):
    return Foot.preset(("parrot", "anisodactyl")[version])  # none that xacro expands


def grasp(version):
    return check_grasp(
        foot(version),
        np.ones(foot(version).phalanx_count),
        Branch(0.008, (0, 0, -0.01)),
    )


def figure(version):
    made = new_figure(2, 2)
    made.subplots().plot([0, 1], [version, 1])
    return made


def dataset(version):
    return sweep(foot(version), {"radius": [0.008]}, levels=2, scheduler="sync")


def entries(version):
    drawing = Exhibit("a.png", "A", lambda path: save_figure(figure(version), path))
    scene = Exhibit("a.html", "A", lambda path: export_scene(grasp(version), path))
    texts = [f"version {version}"] * 5
    entry = Entry("a", "figure", *texts, (), (drawing,), (scene,))
    return [("A chapter", entry)]


def report(made, path):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(output, "iter_entries", lambda: iter(made))
        output.write_paper_report(path)


KINDS = {
    "description": Kind("folder", foot, write_description),
    "scene": Kind("a.html", grasp, export_scene),
    "figure": Kind(
        "a.png", int, lambda version, path: save_figure(figure(version), path)
    ),
    "archive": Kind(
        "a.npz",
        lambda version: {"a": np.full(10**5, version), "b": np.arange(9)},
        lambda made, path: write_archive(path, made),
    ),
    "atlas": Kind("b.npz", lambda n: made_atlas(rows=7 + n), save_atlas),
    "netcdf": Kind("a.nc", dataset, save_dataset),
    "zarr": Kind("a.zarr", dataset, save_dataset),
    "report": Kind("report", entries, report),
}
