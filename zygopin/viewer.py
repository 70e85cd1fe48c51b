"""meshcat's viewer with a recorded scene inside: one page that needs nothing else."""

from __future__ import annotations

import base64
import hashlib
import html
import json
import math
import re
from dataclasses import dataclass, field
from importlib import resources
from pathlib import Path
from string import Template
from typing import Any, Protocol

import meshcat
import numpy as np
import umsgpack
from numpy.typing import NDArray

from zygopin.camera import View
from zygopin.errors import FileError

VIEWER_PATH = Path(meshcat.__file__).parent / "viewer" / "dist"
"""Folder of the viewer's script, as meshcat ships it."""

BACKGROUND = ((1.0, 1.0, 1.0), (0.93, 0.94, 0.95))
"""Colours at the top and the bottom of the picture: red, green, blue in [0, 1]."""

POLICY = (
    "default-src 'none'; script-src {scripts}; style-src 'unsafe-inline'; "
    "img-src data: blob:; base-uri 'none'; form-action 'none'"
)
"""What the page may load: nothing; and run: its own two scripts, by their hashes."""

LIGHTS = {
    "AmbientLight": 0.58,
    "SpotLight": 0.46,
    "FillLight": 0.16,
    "PointLightNegativeX": 0.08,
    "PointLightPositiveX": 0.08,
}
"""Intensities of the viewer's lights, so that no colour is washed out."""

KEY_LIGHT = (-2.2, 3.2, 3.6)
"""Where the strongest light stands: left of, above and before the target, as the eye
has it."""

_CAMERA = "/Cameras/default/rotated/<object>"
_HIDDEN = ("/Grid", "/Axes")


class Command(Protocol):
    """A command of meshcat."""

    def lower(self) -> dict[str, Any]:
        """The command as plain values."""


@dataclass(frozen=True)
class Recorder:
    """Stands where meshcat has its window, and keeps what is sent to it.

    Attributes:
        messages: The commands in order, packed as the viewer reads them.
    """

    messages: list[bytes] = field(default_factory=list)

    def send(self, command: Command) -> None:
        """Keep a command.

        Args:
            command: What a `meshcat.Visualizer` sends.
        """
        self.messages.append(umsgpack.packb(command.lower()))


@dataclass(frozen=True)
class Player:
    """What makes a page play a motion: what its script reads, and its controls.

    Attributes:
        motion: Values that are written as JSON; letters in them are ASCII.
        controls: What stands under the scene, as HTML.
    """

    motion: dict[str, Any]
    controls: str


def set_stage(recorder: Recorder, view: View) -> None:
    """Put the viewer's camera, background and helpers in order.

    Args:
        recorder: What keeps the commands.
        view: Where the scene is seen from.
    """
    visualizer = meshcat.Visualizer(window=recorder)
    for path in _HIDDEN:
        visualizer[path].set_property("visible", False)
    for key, colour in zip(("top_color", "bottom_color"), BACKGROUND, strict=True):
        visualizer["/Background"].set_property(key, list(colour))
    for name, intensity in LIGHTS.items():
        visualizer[f"/Lights/{name}/<object>"].set_property("intensity", intensity)
    key_light = np.round(np.array(KEY_LIGHT) @ view.axes, 6) + 0.0
    visualizer["/Lights/SpotLight"].set_property("visible", True)
    spot = visualizer["/Lights/SpotLight/<object>"]
    spot.set_property("position", key_light.tolist())
    camera = visualizer[_CAMERA]
    camera.set_property("position", _y_up(view.eye))
    camera.set_property("fov", round(math.degrees(view.field_of_view), 6))


def page(
    recorder: Recorder,
    view: View,
    title: str,
    caption: str,
    player: Player | None = None,
) -> str:
    """A page that shows a recorded scene beside a caption.

    Args:
        recorder: The scene's commands.
        view: Where the scene is seen from.
        title: The page's title, as plain text.
        caption: What stands beside the scene, as HTML.
        player: What moves, and its controls; None: nothing does.

    Returns:
        The HTML text; it asks for no file and no server.

    Raises:
        FileError: meshcat's viewer is not where it belongs.
    """
    script = Template(_asset("page.js")).substitute(
        player="" if player is None else _asset("player.js")
    )
    scripts = {"library": _library(), "script": script}
    hashes = " ".join(map(_source_hash, scripts.values()))
    return Template(_asset("page.html")).substitute(
        scripts,
        policy=html.escape(POLICY.format(scripts=hashes)),
        title=html.escape(title),
        style=_asset("page.css") + ("" if player is None else _asset("player.css")),
        player="" if player is None else f"\n{player.controls}",
        caption=caption,
        scene=_scene_data(recorder, view, player),
    )


def _scene_data(recorder: Recorder, view: View, player: Player | None) -> str:
    """What the page's script reads: ASCII letters and numbers only."""
    commands = [base64.b64encode(message).decode() for message in recorder.messages]
    motion = {} if player is None else {"motion": player.motion}
    return json.dumps({"aspect": round(view.aspect, 6), "commands": commands, **motion})


def _library() -> str:
    """The viewer's script under its licences, fit to stand inside a script element."""
    parts = ("main.min.js.LICENSE.txt", "main.min.js")
    try:
        text = "\n".join((VIEWER_PATH / name).read_text("utf-8") for name in parts)
    except (OSError, UnicodeDecodeError) as error:
        problem = "meshcat's viewer cannot be read"
        raise FileError(VIEWER_PATH, problem, "install meshcat again") from error
    return re.sub(r"<(?=/script|!--)", r"\\x3c", text, flags=re.IGNORECASE)


def _asset(name: str) -> str:
    """A file of the page's own."""
    return (resources.files("zygopin") / "assets" / name).read_text("utf-8")


def _source_hash(script: str) -> str:
    """A script's hash as a content security policy names it."""
    digest = hashlib.sha256(script.encode()).digest()
    return f"'sha256-{base64.b64encode(digest).decode()}'"


def _y_up(point: NDArray[Any]) -> list[float]:
    """A point in the viewer's own axes, where y is up."""
    x, y, z = (round(float(value), 6) + 0.0 for value in point)
    return [x, z, -y]
