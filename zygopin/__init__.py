"""zygopin: a robotics model of the zygodactyl bird's foot.

Every public name is here and is loaded on first use, so that importing the
package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version as _version

_HOMES = {
    "branch": ("Branch", "branch_axis"),
    "description": ("to_srdf", "to_urdf", "write_description"),
    "engine": ("Engine", "make_engine"),
    "errors": (
        "DescriptionError",
        "FileError",
        "ParameterError",
        "UnknownNameError",
        "ZygopinError",
    ),
    "grasp": ("Criteria", "GraspReport", "check_grasp"),
    "finger": ("Finger", "zygodactyl_fingers"),
    "foot": ("Foot",),
    "kinematics": ("forward_kinematics",),
    "model": ("FootModel",),
    "paths": ("PACKAGE_PATH", "PRESETS_PATH", "SRDF_PATH", "URDF_PATH", "XACRO_PATH"),
    "perch": ("PerchPlan", "plan_perch"),
    "presets": ("preset_names",),
    "scene": ("export_scene",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "PACKAGE_PATH",
    "PRESETS_PATH",
    "SRDF_PATH",
    "URDF_PATH",
    "XACRO_PATH",
    "Branch",
    "Criteria",
    "DescriptionError",
    "Engine",
    "FileError",
    "Finger",
    "Foot",
    "FootModel",
    "GraspReport",
    "ParameterError",
    "PerchPlan",
    "UnknownNameError",
    "ZygopinError",
    "__version__",
    "branch_axis",
    "check_grasp",
    "export_scene",
    "forward_kinematics",
    "make_engine",
    "plan_perch",
    "preset_names",
    "to_srdf",
    "to_urdf",
    "write_description",
    "zygodactyl_fingers",
]


def __getattr__(name: str) -> object:
    """Load a public name's module on first use (PEP 562)."""
    if name == "__version__":
        return _version("zygopin")
    if name not in _HOME_OF:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(f"{__name__}.{_HOME_OF[name]}"), name)


def __dir__() -> list[str]:
    return list(__all__)
