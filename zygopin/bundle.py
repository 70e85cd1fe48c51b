"""A foot as files in one folder, ready to load elsewhere."""

from __future__ import annotations

from pathlib import Path

from zygopin import checks, kinds
from zygopin.description import to_urdf
from zygopin.files import check_folder, within, write_bytes, write_text
from zygopin.foot import Foot
from zygopin.mesh import to_glb
from zygopin.mjcf import to_mjcf
from zygopin.mjcf_scene import to_mjcf_scene
from zygopin.srdf import to_srdf


def write_description(
    foot: Foot, folder: Path | str, *, mjcf: bool = False, glb: bool = False
) -> tuple[Path, ...]:
    """Write the URDF and the SRDF of both variants, ready to load elsewhere.

    foot.urdf and foot.srdf; foot_tendon.urdf and foot_tendon.srdf, where one leader
    joint moves all others.

    Args:
        foot: The foot.
        folder: Where to; created if it is missing.
        mjcf: Whether to write the MuJoCo models foot.xml and foot_tendon.xml as well,
            and scene.xml, which puts the latter above its perch.
        glb: Whether to add foot.glb, the straight foot as `to_glb` makes it.

    Returns:
        The files.

    Raises:
        DescriptionError: The template is missing or does not expand, or a phalanx is
            too light for MuJoCo.
        FileError: The folder cannot be written.
    """
    kinds.instance("foot", foot, Foot)
    checks.flag("mjcf", mjcf)
    checks.flag("glb", glb)
    check_folder(folder)
    texts = {
        "foot.urdf": to_urdf(foot),
        "foot_tendon.urdf": to_urdf(foot, tendon=True),
        "foot.srdf": to_srdf(foot),
        "foot_tendon.srdf": to_srdf(foot, tendon=True),
    }
    if mjcf:
        texts["foot.xml"] = to_mjcf(foot)
        texts["foot_tendon.xml"] = to_mjcf(foot, tendon=True)
        texts["scene.xml"] = to_mjcf_scene(foot, "foot_tendon.xml")
    meshes = {"foot.glb": to_glb(foot)} if glb else {}
    places = {name: within(folder, name) for name in (*texts, *meshes)}
    return (
        *(write_text(places[name], text) for name, text in texts.items()),
        *(write_bytes(places[name], mesh) for name, mesh in meshes.items()),
    )
