"""zygopin: a robotics model of the zygodactyl bird's foot.

Every public name is here and is loaded on first use, so that importing the
package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version as _version

_HOMES = {
    "branch": ("Branch", "branch_axis"),
    "control_system": ("ControlSystem",),
    "description": ("to_srdf", "to_urdf", "write_description"),
    "engine": ("Engine", "make_engine"),
    "errors": (
        "DescriptionError",
        "FileError",
        "MissingExtraError",
        "ParameterError",
        "UnknownNameError",
        "ZygopinError",
    ),
    "grasp": ("Criteria", "GraspReport", "check_grasp"),
    "finger": ("Finger", "zygodactyl_fingers"),
    "foot": ("Foot",),
    "hausdorff": ("HausdorffDistance", "directed_distance", "hausdorff_distance"),
    "ifs": ("ReachableSet", "attractor", "iter_reachable", "reachable_set"),
    "inverse": ("contains", "find_word", "nearest_reachable"),
    "kinematics": ("forward_kinematics",),
    "model": ("FootModel",),
    "paths": ("PACKAGE_PATH", "PRESETS_PATH", "SRDF_PATH", "URDF_PATH", "XACRO_PATH"),
    "perch": ("PerchPlan", "plan_perch"),
    "presets": ("preset_names",),
    "reach": ("FingerReach", "finger_reach"),
    "reach_inverse": ("InverseReach", "inverse_reach"),
    "reach_scene": ("export_reach_scene",),
    "scene": ("export_scene",),
    "spread": ("SpreadStudy", "spread_study", "strike_area", "talon_hull_area"),
    "validation": ("ReachValidation", "ValidationRow", "validate_foot"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "PACKAGE_PATH",
    "PRESETS_PATH",
    "SRDF_PATH",
    "URDF_PATH",
    "XACRO_PATH",
    "Branch",
    "ControlSystem",
    "Criteria",
    "DescriptionError",
    "Engine",
    "FileError",
    "Finger",
    "FingerReach",
    "Foot",
    "FootModel",
    "GraspReport",
    "HausdorffDistance",
    "InverseReach",
    "MissingExtraError",
    "ParameterError",
    "PerchPlan",
    "ReachValidation",
    "ReachableSet",
    "SpreadStudy",
    "UnknownNameError",
    "ValidationRow",
    "ZygopinError",
    "__version__",
    "attractor",
    "branch_axis",
    "check_grasp",
    "contains",
    "directed_distance",
    "export_reach_scene",
    "export_scene",
    "find_word",
    "finger_reach",
    "forward_kinematics",
    "hausdorff_distance",
    "inverse_reach",
    "iter_reachable",
    "make_engine",
    "nearest_reachable",
    "plan_perch",
    "preset_names",
    "reachable_set",
    "spread_study",
    "strike_area",
    "talon_hull_area",
    "to_srdf",
    "to_urdf",
    "validate_foot",
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
