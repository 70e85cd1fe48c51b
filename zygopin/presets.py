"""Foot parameters in YAML files: the shipped presets and the caller's own."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from zygopin import kinds
from zygopin.errors import FileError
from zygopin.files import read_text, write_text
from zygopin.paths import PRESETS_PATH
from zygopin.plain_yaml import parsed


def preset_names() -> tuple[str, ...]:
    """Names of the shipped presets.

    Returns:
        The names, sorted.
    """
    return tuple(sorted(path.stem for path in PRESETS_PATH.glob("*.yaml")))


def read_preset(name: str) -> dict[str, Any]:
    """The parameters of a shipped preset.

    Args:
        name: One of `preset_names()`.

    Returns:
        The file's mapping: the fields of a foot [SI], with `description` and
        `sources` (where each number comes from).

    Raises:
        UnknownNameError: There is no preset of that name.
    """
    kinds.one_of("preset", name, preset_names())
    return read_parameters(PRESETS_PATH / f"{name}.yaml")


def read_parameters(path: Path | str) -> dict[str, Any]:
    """The mapping that a YAML file of foot parameters holds.

    Args:
        path: The file.

    Returns:
        The mapping, not yet checked field by field.

    Raises:
        FileError: The file cannot be read, is not YAML, or is not one mapping.
    """
    try:
        content = parsed(read_text(path))
    except ValueError as error:
        raise FileError(path, f"not YAML: {error}", "mend the syntax") from error
    if not isinstance(content, Mapping):
        remedy = (
            "write one mapping of field names to values; `zygopin presets` has some"
        )
        raise FileError(path, f"holds {type(content).__name__}, not a mapping", remedy)
    return dict(content)


def write_parameters(path: Path | str, mapping: Mapping[str, Any]) -> Path:
    """Write foot parameters as a YAML file that `read_parameters` reads back.

    Args:
        path: The file.
        mapping: The parameters, as `Foot.to_mapping` gives them.

    Returns:
        The path.

    Raises:
        FileError: The file cannot be written.
    """
    return write_text(path, yaml.safe_dump(dict(mapping), sort_keys=False))
