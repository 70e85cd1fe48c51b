"""What is fuzzed: each parser of the package, from bytes to what it makes of them.

A target returns, or raises an error that is documented: one of zygopin's or of click's,
of one line. Anything else that it raises is a find.
"""

from __future__ import annotations

import io
import json
import tempfile
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path

import click
import numpy as np

from zygopin import checks
from zygopin.archive import read_archive
from zygopin.atlas import Atlas
from zygopin.atlas_file import load_atlas, save_atlas
from zygopin.branch_grid import BranchGrid
from zygopin.cli import main
from zygopin.errors import ZygopinError
from zygopin.foot import Foot
from zygopin.given_controls import read_controls
from zygopin.kinematics import by_finger
from zygopin.model import FootModel

COMMANDS = ("check", "perch", "atlas", "sweep", "design", "reach", "strike", "branches")


def fuzz(target: str, data: bytes) -> None:
    """Give bytes to a target.

    Args:
        target: One of `TARGETS`.
        data: The bytes.

    Raises:
        Exception: A find: the target fails otherwise than it should.
    """
    try:
        TARGETS[target](data)
    except (ZygopinError, click.ClickException) as error:
        message = str(error) if isinstance(error, ZygopinError) else error.message
        if isinstance(error, ZygopinError) and "\n" in message:
            raise AssertionError(f"not one line: {message!r}") from error
    except click.exceptions.Exit:
        pass  # --help


def _foot(data: bytes) -> None:
    """A foot of the caller's own, in YAML."""
    foot = Foot.load(_file("foot.yaml", data))
    if Foot.from_mapping(foot.to_mapping()) != foot:
        raise AssertionError(f"does not come back: {foot}")


def _controls(data: bytes) -> None:
    """Controls: in a file where the first byte is odd, else in place."""
    given = str(_file("controls.json", data[1:]))
    if not data[:1] or data[0] % 2 == 0:
        given = data[1:].decode("utf-8", "replace")
        if given.lstrip()[:1] not in "[{0123456789-+.,":
            return  # a path, to whatever is there
    values = read_controls(given, _parrot())
    if not ((values >= 0) & (values <= 1)).all():
        raise AssertionError(f"outside [0, 1]: {values}")


def _options(data: bytes) -> None:
    """A command's options: the first byte says which, zero bytes part the words."""
    command = COMMANDS[data[0] % len(COMMANDS)] if data else COMMANDS[0]
    words = data[1:].decode("utf-8", "surrogateescape").split("\0")
    main.commands[command].make_context(command, words)


def _atlas(data: bytes) -> None:
    """An atlas's file: as it is, or with the bytes as one of its members."""
    content = data[1:]
    members = sorted(_atlas_members())
    place = data[0] if data else 0
    if place:
        own = dict(_atlas_members())
        own[members[place % len(members)]] = content
        content = _zipped(own)
    load_atlas(_file("atlas.npz", content))


def _archive(data: bytes) -> None:
    """A part of a sweep."""
    read_archive(_file("part.npz", data), ("wrap",), "chunk")


def _urdf(data: bytes) -> None:
    """A foot's URDF, all the way into Pinocchio."""
    bones = FootModel(_parrot(), data.decode("utf-8", "replace")).forward(np.zeros(14))
    checks.array("bones", bones)


TARGETS: dict[str, Callable[[bytes], None]] = {
    "foot": _foot,
    "controls": _controls,
    "options": _options,
    "atlas": _atlas,
    "archive": _archive,
    "urdf": _urdf,
}
"""By name."""


def seeds(target: str) -> list[bytes]:
    """Good inputs of a target, to start from.

    Args:
        target: One of `TARGETS`.

    Returns:
        The inputs.
    """
    return {
        "foot": _foot_seeds,
        "controls": _controls_seeds,
        "options": _options_seeds,
        "atlas": _atlas_seeds,
        "archive": _archive_seeds,
        "urdf": lambda: [_small_urdf()],
    }[target]()


def _foot_seeds() -> list[bytes]:
    """Shipped feet, and a small one of the caller's own."""
    small = b"rho: 1.2\nfingers: [{name: a, phalanges: 1, azimuth: 0.0}]\n"
    return [small, json.dumps(_parrot().to_mapping()).encode()]


def _controls_seeds() -> list[bytes]:
    """Numbers, a list, a mapping and a document."""
    toes = by_finger(_parrot(), np.full(14, 0.5))
    document = {"foot": _parrot().to_mapping(), "controls": toes}
    numbers = ",".join(["0.5"] * 14)
    texts = (numbers, f"[{numbers}]", json.dumps(toes), json.dumps(document))
    in_files = [b"\1" + text.encode() for text in texts[1:]]
    return [*(b"\0" + text.encode() for text in texts), *in_files]


def _options_seeds() -> list[bytes]:
    """A good command line of each command."""
    lines = {
        "check": "--radius-mm 8 --height-mm -20 --controls 0,1 --tolerance-mm 0.1",
        "perch": "--radius-mm 8 --yaw-deg 10 --pitch-deg 5 --prefer pull --friction 1",
        "atlas": "--pair 1,3 --cells 4x5 --radii-mm 3:20 --heights-mm -30:-5",
        "sweep": "--radius-mm 3:20:4 --rho 1.1,1.2 --phalanges 2-3-4-5 --levels 4",
        "design": "--radii-mm 3:20 --bounds rho=1.1:1.5 --trials 16 --vary rho",
        "reach": "--finger 3 --omega-deg 15,30 --levels 3 --depth 2",
        "strike": "--prey-radius-mm 15 --miss-mm 1,2,3 --closing-ms 40 --open 0.1",
        "branches": "--pair 1,3 --levels 0,0.5,1 --limit 5 --section circle --tied",
    }
    places = {name: bytes([place]) for place, name in enumerate(COMMANDS)}
    return [
        places[name] + line.replace(" ", "\0").encode() for name, line in lines.items()
    ]


def _atlas_seeds() -> list[bytes]:
    """A whole file, and each of its members."""
    members = sorted(_atlas_members())
    own = [
        bytes([place or len(members)]) + _atlas_members()[name]
        for place, name in enumerate(members)
    ]
    return [b"\0" + _zipped(_atlas_members()), *own]


def _archive_seeds() -> list[bytes]:
    """A small array in an archive."""
    content = io.BytesIO()
    np.save(content, np.zeros((2, 2)))
    return [_zipped({"wrap.npy": content.getvalue()})]


@cache
def _parrot() -> Foot:
    return Foot.preset("parrot")


@cache
def _small_urdf() -> bytes:
    return FootModel(_parrot()).urdf.encode()


@cache
def _folder() -> Path:
    """Where files are made: in memory, where there is such a place."""
    shared = Path("/dev/shm")  # noqa: S108
    where = shared if shared.is_dir() else None
    return Path(tempfile.mkdtemp(prefix="zygopin-fuzz-", dir=where))


def _file(name: str, content: bytes) -> Path:
    """A file with some content."""
    path = _folder() / name
    path.write_bytes(content)
    return path


@cache
def _atlas_members() -> dict[str, bytes]:
    """The members of a small atlas's file, by name."""
    foot, grid = _parrot(), BranchGrid([-0.02, -0.01], [0.004, 0.006])
    codes = np.zeros(grid.shape, np.int8)
    pairs, poses = np.zeros((*grid.shape, 2)), np.zeros((*grid.shape, 14))
    toes = pairs.astype(np.int8)
    made = Atlas(foot, grid, codes, codes, codes, codes, toes, pairs, poses, poses)
    with zipfile.ZipFile(save_atlas(made, _folder() / "seed.npz")) as archive:
        return {name: archive.read(name) for name in archive.namelist()}


def _zipped(members: dict[str, bytes]) -> bytes:
    """Members as an archive."""
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return file.getvalue()
