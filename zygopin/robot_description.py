"""Where the description is, under the names that robot_descriptions.py gives.

Its loaders read these names of a module, all of them plain strings. They import
`robot_descriptions.<name>`; put this module there under a name of your choice:

>>> import sys
>>> from zygopin import robot_description
>>> sys.modules["robot_descriptions.zygopin_description"] = robot_description
"""

from __future__ import annotations

from zygopin import paths

REPOSITORY_PATH: str = str(paths.PACKAGE_PATH.parent)
"""Folder above the description: the checkout, or the installed package."""

PACKAGE_PATH: str = str(paths.PACKAGE_PATH)
"""Folder of the description: templates, presets, expanded files."""

URDF_PATH: str = str(paths.URDF_PATH)
"""The default preset's URDF. Loaders prefer it to the template."""

SRDF_PATH: str = str(paths.SRDF_PATH)
"""The default preset's SRDF."""

MJCF_PATH: str = str(paths.MJCF_PATH)
"""The default preset's MuJoCo model."""

XACRO_PATH: str = str(paths.XACRO_PATH)
"""The parametric template of the whole foot."""

XACRO_ARGS: dict[str, str] = {"foot": "presets/parrot.yaml"}
"""Arguments with which the template expands to the default preset."""
