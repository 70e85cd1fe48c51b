"""A foot as files in one folder, ready to load elsewhere."""

from __future__ import annotations

from pathlib import Path

from zygopin.description import to_urdf
from zygopin.files import write_text
from zygopin.foot import Foot
from zygopin.srdf import to_srdf


def write_description(foot: Foot, folder: Path | str) -> tuple[Path, ...]:
    """Write foot.urdf, foot_tendon.urdf and foot.srdf, ready to load elsewhere.

    Args:
        foot: The foot.
        folder: Where to; created if it is missing.

    Returns:
        The three files.

    Raises:
        DescriptionError: The template is missing or does not expand.
        FileError: The folder cannot be written.
    """
    texts = {
        "foot.urdf": to_urdf(foot),
        "foot_tendon.urdf": to_urdf(foot, tendon=True),
        "foot.srdf": to_srdf(foot),
    }
    return tuple(write_text(Path(folder) / name, text) for name, text in texts.items())
