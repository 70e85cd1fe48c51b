"""Controls as they are given on the command line: numbers, JSON, or a JSON file."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from zygopin.errors import FileError
from zygopin.files import read_text

if TYPE_CHECKING:  # the foot comes from the caller, and takes a tenth of a second
    from zygopin.foot import Foot

REMEDY = "give numbers separated by commas, or a JSON file"


def read_controls(text: str, foot: Foot) -> Any:
    """Controls of one pose from the command line.

    Args:
        text: Numbers separated by commas, JSON, or the path of a JSON file: a list, a
            mapping by finger, or a document of `check` or `perch`.
        foot: The foot that they are for.

    Returns:
        The controls, shape (P,).

    Raises:
        FileError: No readable JSON, or controls of another foot or of many poses.
        ParameterError: A control is out of range, or missing.
    """
    from zygopin.kinematics import as_controls

    shown = text if len(text) <= 40 else f"{text[:37]}..."
    content = _parsed_controls(text, shown)
    if isinstance(content, dict):
        stored = content.get("foot")
        if stored is not None and stored != foot.to_mapping():
            remedy = "choose that foot, with --preset or --foot"
            raise FileError(shown, "holds controls of another foot", remedy)
        content = content.get("controls", content)
    if not isinstance(content, (list, dict)):
        raise FileError(shown, "holds no controls", REMEDY)
    controls = as_controls(foot, content)
    if controls.ndim != 1:
        raise FileError(shown, "holds many poses", "give the controls of one")
    return controls


def _parsed_controls(text: str, shown: str) -> Any:
    """What a text of controls holds: numbers, JSON, or the JSON in a file."""
    words = text.split(",")
    if all(map(_is_number, words)):
        return [float(word) for word in words]
    if text.lstrip().startswith(("[", "{")):
        return _parsed_json(text, shown)
    if "," in text or not text.strip():
        raise FileError(repr(shown), "holds no controls", REMEDY)
    return _parsed_json(read_text(text).removeprefix("\ufeff"), shown)


def _parsed_json(text: str, shown: str) -> Any:
    """What a JSON text holds."""
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as error:
        raise FileError(shown, f"not JSON: {error}", REMEDY) from error


def _is_number(word: str) -> bool:
    """Whether a word is a number."""
    try:
        float(word)
    except ValueError:
        return False
    return True
