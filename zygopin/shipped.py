"""The URDFs of the presets, shipped ready, so that no template is expanded for them.

Beside the files stand stamps: digests of a text and of all that it was made from. A
text is used only where its stamp is right, so that a preset, a template or a file that
was changed since is never answered by what it was before.
"""

from __future__ import annotations

import hashlib
import json

from zygopin.foot import Foot
from zygopin.paths import PACKAGE_PATH

STAMPS_PATH = PACKAGE_PATH / "expanded" / "stamps.txt"
"""The stamps: a digest, a space and the name of a file in each line."""


def sources(foot: Foot, *, tendon: bool) -> str:
    """All that a URDF is made from: the foot and the templates.

    Args:
        foot: The foot.
        tendon: Whether it is the one with a tendon.

    Returns:
        One text; feet that differ have different ones.

    Raises:
        OSError: A template cannot be read.
    """
    templates = sorted(PACKAGE_PATH.glob("*.xacro"))
    texts = [path.read_text(encoding="utf-8") for path in templates]
    return "".join([json.dumps([foot.to_mapping(), tendon], sort_keys=True), *texts])


def stamp(made_from: str, urdf: str) -> str:
    """What ties a URDF to all that it was made from.

    Args:
        made_from: Its `sources`.
        urdf: Its text.

    Returns:
        Hexadecimal digits.
    """
    return hashlib.sha256(f"{made_from}\0{urdf}".encode()).hexdigest()


def shipped_urdf(foot: Foot, *, tendon: bool) -> str | None:
    """The shipped URDF of a foot that equals a preset.

    Args:
        foot: The foot.
        tendon: Whether the one with a tendon is wanted.

    Returns:
        The text; None where there is none for this foot, or none that its stamp is
        right for.
    """
    try:
        made_from = sources(foot, tendon=tendon)
        for line in STAMPS_PATH.read_text(encoding="utf-8").splitlines():
            digest, _, name = line.partition(" ")
            urdf = STAMPS_PATH.with_name(name).read_text(encoding="utf-8")
            if stamp(made_from, urdf) == digest:
                return urdf
    except (OSError, ValueError):
        return None  # damaged: the templates may still be whole
    return None
