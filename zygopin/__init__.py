"""zygopin: a robotics model of the zygodactyl bird's foot.

Every public name is here and is loaded on first use, so that importing the
package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version as _version

_HOMES = {
    "attack": ("Attack",),
    "branch": ("Branch", "branch_axis"),
    "bundle": ("write_description",),
    "closing": ("Closing",),
    "control_system": ("ControlSystem",),
    "description": ("to_urdf",),
    "engagement_plots": ("plot_engagement",),
    "engine": ("Engine", "make_engine"),
    "errors": (
        "DescriptionError",
        "FileError",
        "MissingExtraError",
        "ParameterError",
        "UnknownNameError",
        "ZygopinError",
    ),
    "finger": ("Finger", "zygodactyl_fingers"),
    "flight": ("Flight",),
    "foot": ("Foot",),
    "grasp": ("Criteria", "GraspReport", "check_grasp"),
    "grip": ("Grip",),
    "hausdorff": ("HausdorffDistance", "directed_distance", "hausdorff_distance"),
    "ifs": ("ReachableSet", "attractor", "iter_reachable", "reachable_set"),
    "inverse": ("contains", "find_word", "nearest_reachable"),
    "kinematics": ("forward_kinematics",),
    "model": ("FootModel",),
    "motion": ("Law", "Motion"),
    "obstacle": ("Box", "Capsule", "ConvexMesh", "Sphere"),
    "paths": ("PACKAGE_PATH", "PRESETS_PATH", "SRDF_PATH", "URDF_PATH", "XACRO_PATH"),
    "perch": ("PerchPlan", "plan_perch"),
    "poses": ("named_poses",),
    "presets": ("preset_names",),
    "reach": ("FingerReach", "finger_reach"),
    "reach_inverse": ("InverseReach", "inverse_reach"),
    "reach_scene": ("export_reach_scene",),
    "remark": ("ContactKept", "Counterexample", "contact_kept", "counterexample"),
    "remark_plots": ("plot_remark",),
    "scene": ("export_scene",),
    "solid_clearance": ("obstacle_clearance",),
    "spread": ("SpreadStudy", "spread_study", "strike_area", "talon_hull_area"),
    "srdf": ("to_srdf",),
    "strike": ("simulate_strike",),
    "strike_output": ("save_strike",),
    "strike_plots": ("plot_strike",),
    "strike_scene": ("export_strike",),
    "tendon": ("Contact", "TendonFoot"),
    "trajectory": ("StrikeEvent", "StrikeTrajectory"),
    "validation": ("ReachValidation", "ValidationRow", "validate_foot"),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "PACKAGE_PATH",
    "PRESETS_PATH",
    "SRDF_PATH",
    "URDF_PATH",
    "XACRO_PATH",
    "Attack",
    "Box",
    "Branch",
    "Capsule",
    "Closing",
    "Contact",
    "ContactKept",
    "ControlSystem",
    "ConvexMesh",
    "Counterexample",
    "Criteria",
    "DescriptionError",
    "Engine",
    "FileError",
    "Finger",
    "FingerReach",
    "Flight",
    "Foot",
    "FootModel",
    "GraspReport",
    "Grip",
    "HausdorffDistance",
    "InverseReach",
    "Law",
    "MissingExtraError",
    "Motion",
    "ParameterError",
    "PerchPlan",
    "ReachValidation",
    "ReachableSet",
    "Sphere",
    "SpreadStudy",
    "StrikeEvent",
    "StrikeTrajectory",
    "TendonFoot",
    "UnknownNameError",
    "ValidationRow",
    "ZygopinError",
    "__version__",
    "attractor",
    "branch_axis",
    "check_grasp",
    "contact_kept",
    "contains",
    "counterexample",
    "directed_distance",
    "export_reach_scene",
    "export_scene",
    "export_strike",
    "find_word",
    "finger_reach",
    "forward_kinematics",
    "hausdorff_distance",
    "inverse_reach",
    "iter_reachable",
    "make_engine",
    "named_poses",
    "nearest_reachable",
    "obstacle_clearance",
    "plan_perch",
    "plot_engagement",
    "plot_remark",
    "plot_strike",
    "preset_names",
    "reachable_set",
    "save_strike",
    "simulate_strike",
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
