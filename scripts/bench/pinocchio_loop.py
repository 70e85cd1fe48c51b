"""Pinocchio at its best: a loop in C++ around its own library, compiled on the spot.

Its headers and libraries come with the wheel; Eigen's headers come with the wheel
cmeel-eigen, with Debian's libeigen3-dev, or from the folder that EIGEN_INCLUDE names.
"""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import sys
from collections.abc import Callable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from zygopin.clearance import Floats

SOURCE = Path(__file__).with_name("pinocchio_loop.cpp")

OPTIONS = (
    *("-O3", "-DNDEBUG", "-std=c++17", "-shared", "-fPIC", "-w"),
    # The algorithms as they are in the library: compiled anew they are no faster.
    "-DPINOCCHIO_ENABLE_TEMPLATE_INSTANTIATION",
)

LIBRARIES = ("-lpinocchio_default", "-lboost_serialization")

TIME_LIMIT = 600
"""Seconds that the compiler may take; it takes half a minute."""

KEPT = Path.home() / ".cache" / "zygopin-benchmark"
"""Where the library stays for the next run."""


class PinocchioLoop:
    """Forward kinematics of many configurations, without Python in between.

    Args:
        urdf: The robot, whose joints turn about their own y axes.
        links: Links whose origins are asked for.

    Attributes:
        joints: Names of the joints, in the order of a configuration.
    """

    def __init__(self, urdf: str, links: Sequence[str]) -> None:
        import pinocchio as pin

        model = pin.buildModelFromXML(urdf)
        frames = [
            model.frames[model.getFrameId(link, pin.FrameType.BODY)] for link in links
        ]
        moving = range(1, model.njoints)
        self.joints = [model.names[i] for i in moving]
        self._width = len(links)
        self._numbers: tuple[Any, ...] = (
            np.array([model.parents[i] for i in moving], dtype=np.int32),
            np.array([model.jointPlacements[i].homogeneous for i in moving]),
            len(moving),
            np.array([frame.parentJoint for frame in frames], dtype=np.int32),
            np.array([frame.placement.translation for frame in frames]),
            len(frames),
        )
        self._library = _library()

    def points(self, q: Floats, threads: int) -> Callable[[], Floats]:
        """The links' origins in many configurations.

        Args:
            q: Joint angles [rad], shape (N, joints).
            threads: Threads that share them.

        Returns:
            What computes origins [m], shape (N, links, 3).
        """
        room = np.empty((len(q), self._width, 3))
        return self._shared(self._library.loop_points, q, threads, room)

    def placements(self, q: Floats, threads: int) -> Callable[[], Floats]:
        """The joints' placements in many configurations, which nobody reads."""
        return self._shared(self._library.loop_joints, q, threads, None)

    def _shared(
        self,
        function: Callable[..., object],
        q: Floats,
        threads: int,
        room: Floats | None,
    ) -> Callable[[], Floats]:
        """A function of the library on parts of the rows, each with its own Data."""
        cuts = np.linspace(0, len(q), threads + 1).astype(int)
        parts = [slice(*cut) for cut in pairwise(cuts)]
        loops = [self._new() for _ in parts]
        pool = ThreadPoolExecutor(threads)

        def some(loop: ctypes.c_void_p, part: slice) -> None:
            rows = q[part]
            out = () if room is None else (_pointer(room[part]),)
            function(loop, _pointer(rows), ctypes.c_long(len(rows)), *out)

        def whole() -> Floats:
            if threads == 1:
                some(loops[0], parts[0])
            else:
                list(pool.map(some, loops, parts))
            return q if room is None else room

        return whole

    def _new(self) -> ctypes.c_void_p:
        """A model with Data of its own; it lives as long as the process."""
        arrays = np.ndarray
        values = [_pointer(x) if isinstance(x, arrays) else x for x in self._numbers]
        return ctypes.c_void_p(self._library.loop_new(*values))


def why_not() -> str:
    """Why the loop cannot be built here; empty if it can."""
    if not shutil.which("g++"):
        return "there is no g++"
    if not _eigen():
        return "Eigen's headers are not there: pip install cmeel-eigen"
    try:
        _library()
    except (OSError, subprocess.SubprocessError) as error:
        return f"it does not compile: {error}"
    return ""


@cache
def _library() -> ctypes.CDLL:
    """The compiled loop; compiled once for each source and Pinocchio."""
    import pinocchio as pin

    prefix, eigen = _prefix(), _eigen()
    command = ["g++", *OPTIONS, f"-I{prefix}/include", f"-I{eigen}", str(SOURCE)]
    command += [f"-L{prefix}/lib", f"-Wl,-rpath,{prefix}/lib", *LIBRARIES]
    key = repr((command, SOURCE.read_bytes(), pin.__version__)).encode()
    KEPT.mkdir(parents=True, exist_ok=True)
    file = KEPT / f"loop-{hashlib.sha256(key).hexdigest()[:16]}.so"
    if not file.exists():
        print("compiling Pinocchio's loop (half a minute)", file=sys.stderr)
        half = file.with_suffix(f".{os.getpid()}")
        subprocess.run(
            [*command, "-o", str(half)],
            check=True,
            timeout=TIME_LIMIT,
            capture_output=True,
        )
        half.replace(file)
    library = ctypes.CDLL(str(file))
    library.loop_new.restype = ctypes.c_void_p
    return library


def _prefix() -> Path:
    """Where the wheels of Pinocchio put headers and libraries."""
    import pinocchio as pin

    parents = Path(pin.__file__).parents
    return next(p for p in parents if p.name == "cmeel.prefix")


def _eigen() -> Path | None:
    """The folder of Eigen's headers."""
    given = [Path(os.environ["EIGEN_INCLUDE"])] if "EIGEN_INCLUDE" in os.environ else []
    places = [*given, _prefix() / "include" / "eigen3", Path("/usr/include/eigen3")]
    return next((p for p in places if (p / "Eigen" / "Core").is_file()), None)


def _pointer(array: NDArray[Any]) -> ctypes.c_void_p:
    """Where an array's numbers begin."""
    return ctypes.c_void_p(array.ctypes.data)
