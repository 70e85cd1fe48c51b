"""The tools: what to call them, how exactly each can answer, what each makes of mimic.

A tool's limits stand here as numbers that the run proves: a tool that does better or
worse than its row fails.
"""

from __future__ import annotations

import shutil
import subprocess
from dataclasses import dataclass
from importlib.metadata import PackageNotFoundError, version
from typing import Literal

DOUBLE = 1e-9
"""Difference allowed where a tool computes in doubles, over the foot's size."""

SINGLE = 1e-6
"""Difference allowed where single precision comes in, over the foot's size."""

Mimic = Literal["honoured", "as constraint", "ignored", "not read", "-"]
"""What becomes of followers when only their leader is set: they move; they stay, and
a constraint ties them; they stay, though the tool read the mimic; nothing is there.
"-": the tool moves nothing."""


@dataclass(frozen=True)
class Tool:
    """One row.

    Attributes:
        reader: Module in readers/.
        title: What its users call it.
        package: Its distribution, or the Debian package of a program.
        mimic: What it makes of mimic.
        precision: Difference allowed in poses, masses and limits.
        gap: Difference allowed in distances, over the foot's size.
        program: Names of the program, one of which must be there; (): a module.
        weighs_base: Whether its mass and centre have the fixed base in them.
        least_inertia: Principal moment [kg m²] below which it refuses a file.
        notes: What a user should know, a short sentence each.
    """

    reader: str
    title: str
    package: str
    mimic: Mimic
    precision: float = DOUBLE
    gap: float = DOUBLE
    program: tuple[str, ...] = ()
    weighs_base: bool = True
    least_inertia: float = 0.0
    notes: tuple[str, ...] = ()

    def version(self) -> str:
        """The installed version; empty where it is not installed."""
        if self.program:
            return (
                _debian_version(self.package)
                if any(map(shutil.which, self.program))
                else ""
            )
        try:
            return version(self.package)
        except PackageNotFoundError:
            return ""


def _debian_version(package: str) -> str:
    """Upstream's part of a Debian package's version; "?" where dpkg does not know."""
    query = ["dpkg-query", "--show", "--showformat=${Version}", package]
    try:
        shown = subprocess.run(query, capture_output=True, text=True, check=True).stdout
    except (OSError, subprocess.CalledProcessError):
        return "?"
    return shown.partition("+")[0].rpartition("-")[0] or shown.partition("+")[0]


ITERATED = 1e-6
"""Difference allowed in distances where a tool iterates to a tolerance of its own."""

ABSOLUTE = 2e-3
"""The same where that tolerance is a length, as in the FCL of Drake: about 1e-6 m near
cylinders, tails to 3e-5 m, and a parrot's foot is 3 cm long."""

MESHED = 2e-3
"""The same between meshes: a cylinder of 32 sides is 1 - cos(π/32) = 0.5 % of its
radius thinner in the middle of a side."""

NO_BASE = "Total mass and centre of mass leave out the fixed base."
UNKNOWN = "Prints a line for each element or attribute that it does not know."

TOOLS = (
    Tool(
        "pinocchio",
        "Pinocchio",
        "pin",
        "honoured",
        weighs_base=False,
        notes=(
            "Held against the closed form.",
            "Reads mimic with `mimic=True`, else not.",
            NO_BASE,
        ),
    ),
    Tool(
        "mujoco",
        "MuJoCo",
        "mujoco",
        "as constraint",
        gap=ITERATED,
        weighs_base=False,
        least_inertia=1e-14,
        notes=("Fuses the fixed tips into their phalanges: put sites there.", NO_BASE),
    ),
    Tool(
        "drake",
        "Drake",
        "drake",
        "as constraint",
        gap=ABSOLUTE,
        notes=("Its distances near cylinders are off by up to 3e-5 m.",),
    ),
    Tool(
        "pybullet",
        "PyBullet",
        "pybullet",
        "not read",
        precision=SINGLE,  # multiplyTransforms of 0.1 and 0.2 gives 0.30000001192…
        gap=ITERATED,
        weighs_base=False,
        notes=(
            "Its client multiplies frames in single precision.",
            "Distances: load with `URDF_USE_IMPLICIT_CYLINDER` and "
            "`globalScaling=1000`; as loaded they are off by up to 2 mm.",
            NO_BASE,
        ),
    ),
    Tool(
        "sdformat",
        "sdformat, read by Drake",
        "libsdformat-dev",
        "not read",
        gap=ABSOLUTE,
        program=("gz", "ign"),
        notes=(
            "Lumps the fixed tips: each is compared as its phalanx times the URDF's "
            "offset.",
        ),
    ),
    Tool(
        "check_urdf",
        "check_urdf",
        "liburdfdom-tools",
        "-",
        program=("check_urdf",),
        notes=("A parser: every link and its parent are compared.",),
    ),
    Tool("yourdfpy", "yourdfpy", "yourdfpy", "honoured", gap=MESHED),
    Tool(
        "viser",
        "viser (ViserUrdf)",
        "viser",
        "honoured",
        notes=("The frames that it shows, multiplied here.",),
    ),
    Tool("urchin", "urchin", "urchin", "honoured"),
    Tool("skrobot", "scikit-robot", "scikit-robot", "honoured"),
    Tool(
        "roboticstoolbox",
        "Robotics Toolbox",
        "roboticstoolbox-python",
        "not read",
    ),
    Tool("dartpy", "DART (dartpy)", "dartpy", "as constraint"),
    Tool(
        "klampt",
        "Klampt",
        "klampt",
        "honoured",
        notes=(
            "Mimic by its drivers; `setConfig` moves each joint for itself.",
            UNKNOWN,
        ),
    ),
    Tool(
        "idyntree",
        "iDynTree",
        "idyntree",
        "not read",
        notes=("Keep the loader as long as its model, or Python crashes.",),
    ),
    Tool(
        "ikpy",
        "ikpy",
        "ikpy",
        "not read",
        notes=(
            "One chain for each finger: name its links and joints in `base_elements`.",
            "Warns of each fixed link.",
        ),
    ),
    Tool("kinpy", "kinpy", "kinpy", "not read", notes=(UNKNOWN,)),
    Tool(
        "pytorch_kinematics",
        "pytorch-kinematics",
        "pytorch-kinematics",
        "not read",
        precision=SINGLE,  # its urdf.py makes float32 tensors of the origins' rpy
        notes=("Reads the origins' rotations in single precision.", UNKNOWN),
    ),
    Tool(
        "urdf_parser_py",
        "urdf_parser_py",
        "urdf-parser-py",
        "ignored",
        notes=("A parser: its origins and axes, multiplied here.", UNKNOWN),
    ),
)
