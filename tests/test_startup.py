"""What starting takes: which heavy modules each command loads, and no others."""

from __future__ import annotations

import dataclasses
import subprocess
import sys

import pytest

from zygopin import Foot
from zygopin.presets import write_parameters

HEAVY = (
    "IPython",
    "PIL",
    "dask",
    "fcl",
    "matplotlib",
    "meshcat",
    "mujoco",
    "numba",
    "numpy",
    "pinocchio",
    "rich",
    "scipy",
    "scipy.optimize",
    "scipy.spatial",
    "trimesh",
    "xacro",
    "xarray",
    "yaml",
    "yourdfpy",
)
"""Modules that take a hundredth of a second to a whole one."""

SCIPY = {"scipy", "scipy.optimize", "scipy.spatial"}
BROUGHT = {
    "dask": {"yaml", "numpy"},
    "matplotlib": {"PIL", "numpy"},
    "meshcat": {"IPython", "PIL", "numpy"},
    "scipy.optimize": SCIPY,
    "scipy.spatial": SCIPY,
    "xarray": {*SCIPY, "numpy"},
    "yourdfpy": {*SCIPY, "fcl", "trimesh", "PIL"},
}
"""What a module may load for itself, in some of its versions."""

FOOT = {"numpy", "yaml"}
TABLE = {*FOOT, "rich"}
FCL = {"fcl", "pinocchio"}
HOLD = {"scipy.optimize", "scipy.spatial"}

CONTROLS = ",".join("0" * 14)
CHECK = ("check", "--radius-mm", "8", "--height-mm=-20", "--controls", CONTROLS)
PERCH = ("perch", "--radius-mm", "8", "--height-mm=-10.4")
ATLAS = ("atlas", "--foot", "{foot}", "--cells", "2", "--workers", "1")
STRIKE = ("strike", "--branch-radius-mm", "8")
DESIGN = ("design", "--foot", "{foot}", "--radii-mm", "8:12", "--vary", "omega")

COMMANDS = [
    (("--help",), set()),
    (("--version",), set()),
    (("presets",), TABLE),
    (("presets", "--json"), {"yaml"}),
    (CHECK, TABLE | FCL),
    ((*CHECK, "--json"), FOOT | FCL),
    ((*CHECK, "--rho", "1.3", "--json"), FOOT | FCL | {"xacro"}),
    (PERCH, TABLE | FCL | HOLD),
    ((*PERCH, "--html", "{out}.html"), TABLE | FCL | HOLD | {"meshcat"}),
    (("urdf", "-o", "{out}"), FOOT),
    (("urdf", "-o", "{out}", "--mjcf", "--foot", "{foot}"), FOOT | {"xacro"}),
    (("urdf", "-o", "{out}", "--glb"), FOOT | {"trimesh", "yourdfpy"}),
    (("reach", "--levels", "3"), TABLE),
    (("reach", "--levels", "3", "--png", "{out}.png"), TABLE | {"matplotlib"}),
    (("validate", "--levels", "2"), TABLE | {"pinocchio", "scipy.spatial"}),
    (("touch", "--height-mm=-10", "--foot", "{foot}"), TABLE),
    (("branches",), TABLE),
    (("branches", "--verify"), TABLE | FCL | {"xacro"}),
    (ATLAS, TABLE | FCL | {"xacro"}),
    ((*ATLAS, "--html", "{out}.html"), TABLE | FCL | {"xacro", "meshcat"}),
    (STRIKE, TABLE),
    ((*STRIKE, "--engine", "fcl"), TABLE | {"fcl"}),
    ((*STRIKE, "--html", "{out}.html"), TABLE | {"meshcat"}),
    ((*DESIGN, "--trials", "16", "--workers", "1"), TABLE | {"scipy.optimize"}),
    (
        ("sweep", "--radius-mm", "8", "--scheduler", "sync", "-o", "{out}.nc"),
        TABLE | {"dask", "xarray"},
    ),
]
"""Each command, and the heavy modules that it cannot do without."""

CALLS = [
    ("import zygopin", set()),
    ("from zygopin import PACKAGE_PATH, ZygopinError", set()),
    ("from zygopin import preset_names; preset_names()", {"yaml"}),
    ("from zygopin import Foot, Branch, forward_kinematics", FOOT),
    ("from zygopin import Foot, to_urdf; to_urdf(Foot.preset('owl'))", FOOT),
    ("from zygopin import Foot, to_urdf; to_urdf(Foot())", FOOT | {"xacro"}),
    ("from zygopin import FootModel", FOOT | {"pinocchio"}),
    ("from zygopin import check_grasp, make_engine, plan_perch, check_hold", FOOT),
]
"""What a program says, and the heavy modules that it then has."""


def loaded(code):
    """The heavy modules that a program of its own has at its end."""
    program = (
        f"import sys\ntry:\n    {code}\n"
        f"finally:\n    print('\\n', *(m for m in {HEAVY!r} if m in sys.modules))\n"
    )
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode in (0, 1), done.stderr
    assert "Traceback" not in done.stderr, done.stderr
    return set(done.stdout.splitlines()[-1].split())


def assert_only(found, row):
    """A row is true: all of it was loaded, and nothing else but what that brings."""
    assert row - found == set(), "in the row, yet not loaded"
    brought = set().union(*(BROUGHT.get(module, set()) for module in row))
    assert found - row - brought == set(), "loaded, yet not in the row"


@pytest.fixture(scope="module")
def foot(tmp_path_factory):
    """The file of a foot of two short toes, which no preset is: all is quick."""
    parrot = Foot.preset("parrot")
    short = (dataclasses.replace(parrot.fingers[i], phalanges=1) for i in (0, 2))
    path = tmp_path_factory.mktemp("foot") / "short.yaml"
    return write_parameters(path, parrot.replace(fingers=tuple(short)).to_mapping())


@pytest.mark.parametrize(
    ("arguments", "row"), COMMANDS, ids=[" ".join(words) for words, _ in COMMANDS]
)
def test_a_command_loads_what_its_row_says(arguments, row, foot, tmp_path):
    words = [word.format(foot=foot, out=tmp_path / "out") for word in arguments]
    assert_only(loaded(f"from zygopin.cli import main; main({words})"), row)


def test_no_command_s_help_loads_anything():
    code = (
        "from zygopin.cli import main\n"
        "    for name in main.commands:\n"
        "        try: main([name, '--help'])\n"
        "        except SystemExit: pass"
    )
    assert_only(loaded(code), set())


@pytest.mark.parametrize(("code", "row"), CALLS)
def test_a_program_loads_what_its_row_says(code, row):
    assert_only(loaded(code), row)


@pytest.mark.parametrize("code", ["import zygopin", "import zygopin.cli"])
def test_the_version_is_looked_up_only_when_asked_for(code):
    program = f"import sys; {code}; print('importlib.metadata' in sys.modules)"
    command = [sys.executable, "-c", program]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    assert done.stdout == "False\n"
