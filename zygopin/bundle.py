"""A foot as files in one folder, ready to load elsewhere."""

from __future__ import annotations

from pathlib import Path

from zygopin.description import to_urdf
from zygopin.files import write_text
from zygopin.foot import Foot
from zygopin.mjcf import to_mjcf
from zygopin.mjcf_scene import to_mjcf_scene
from zygopin.srdf import to_srdf


def write_description(
    foot: Foot, folder: Path | str, *, mjcf: bool = False
) -> tuple[Path, ...]:
    """Write foot.urdf, foot_tendon.urdf and foot.srdf, ready to load elsewhere.

    Args:
        foot: The foot.
        folder: Where to; created if it is missing.
        mjcf: Whether to write the MuJoCo models foot.xml and foot_tendon.xml as well,
            and scene.xml, which puts the latter above its perch.

    Returns:
        The files.

    Raises:
        DescriptionError: The template is missing or does not expand, or a phalanx is
            too light for MuJoCo.
        FileError: The folder cannot be written.
    """
    texts = {
        "foot.urdf": to_urdf(foot),
        "foot_tendon.urdf": to_urdf(foot, tendon=True),
        "foot.srdf": to_srdf(foot),
    }
    if mjcf:
        texts["foot.xml"] = to_mjcf(foot)
        texts["foot_tendon.xml"] = to_mjcf(foot, tendon=True)
        texts["scene.xml"] = to_mjcf_scene(foot, "foot_tendon.xml")
    return tuple(write_text(Path(folder) / name, text) for name, text in texts.items())
