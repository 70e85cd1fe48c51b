"""Where the shipped description is: inside the wheel, or the checkout's `urdf/`."""

from __future__ import annotations

from pathlib import Path

_INSTALLED = Path(__file__).parent / "urdf"
_CHECKOUT = Path(__file__).parent.parent / "urdf"

PACKAGE_PATH: Path = _INSTALLED if _INSTALLED.is_dir() else _CHECKOUT
"""Folder of the description: templates, presets, expanded files."""

XACRO_PATH: Path = PACKAGE_PATH / "foot.urdf.xacro"
"""The parametric template of the whole foot."""

PRESETS_PATH: Path = PACKAGE_PATH / "presets"
"""Folder of the presets, one YAML file each."""

URDF_PATH: Path = PACKAGE_PATH / "expanded" / "parrot.urdf"
"""The default preset's URDF, ready to load elsewhere."""

MJCF_PATH: Path = PACKAGE_PATH / "expanded" / "parrot.xml"
"""The default preset's MuJoCo model, a servo at each joint."""

SRDF_PATH: Path = PACKAGE_PATH / "expanded" / "parrot.srdf"
"""The default preset's SRDF: groups, named poses, disabled collisions."""
