"""zygopin: a robotics model of the zygodactyl bird's foot.

Every public name is here and is loaded on first use, so that importing the
package costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from importlib.metadata import version as _version

_HOMES = {
    "branch": ("Branch", "branch_axis"),
    "errors": (
        "DescriptionError",
        "FileError",
        "ParameterError",
        "UnknownNameError",
        "ZygopinError",
    ),
    "foot": ("Finger", "Foot", "zygodactyl_fingers"),
    "kinematics": ("forward_kinematics",),
    "paths": ("PACKAGE_PATH", "PRESETS_PATH", "SRDF_PATH", "URDF_PATH", "XACRO_PATH"),
    "presets": ("preset_names",),
}
_HOME_OF = {name: home for home, names in _HOMES.items() for name in names}

__all__ = [
    "PACKAGE_PATH",
    "PRESETS_PATH",
    "SRDF_PATH",
    "URDF_PATH",
    "XACRO_PATH",
    "Branch",
    "DescriptionError",
    "FileError",
    "Finger",
    "Foot",
    "ParameterError",
    "UnknownNameError",
    "ZygopinError",
    "__version__",
    "branch_axis",
    "forward_kinematics",
    "preset_names",
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
