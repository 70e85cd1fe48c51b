"""The xacro templates, expanded to the URDF of a foot.

A phalanx is a cylinder and two spheres; bare bones (a thickness below a millionth of
the scale) are drawn, and weighed, as rods whose radius is 1 % of their length, because
no loader takes a radius of zero.
"""

from __future__ import annotations

import threading
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory, gettempdir
from xml.parsers.expat import ExpatError

import xacro
import yaml

from zygopin.errors import DescriptionError
from zygopin.foot import Foot
from zygopin.paths import XACRO_PATH

FILE = "foot.yaml"
"""Name of the file in which xacro is given a foot."""

_XACRO = threading.Lock()
"""xacro keeps what it works on in globals: one expansion at a time."""


def expand(foot: Foot, *, tendon: bool = False) -> str:
    """The URDF that the templates make of a foot.

    Args:
        foot: What becomes their argument `foot`, as a file.
        tendon: Their argument of that name.

    Returns:
        The text, indented, without xacro's banner.

    Raises:
        DescriptionError: A template is missing, or is none; or no temporary file can
            be written.
    """
    arguments = {"tendon": "true" if tendon else "false"}
    try:
        with _folder_with(foot) as folder, _expansion():
            arguments["foot"] = str(Path(folder) / FILE)
            document = xacro.process_file(str(XACRO_PATH), mappings=arguments)
    except (xacro.XacroException, ExpatError, OSError, RuntimeError) as error:
        remedy = "restore the shipped template"
        raise DescriptionError(f"{XACRO_PATH.name}: {error}", remedy) from error
    for node in [*document.childNodes]:
        if node is not document.documentElement:
            document.removeChild(node)  # xacro's banner, and the template's own note
    return str(document.toprettyxml(indent="  "))


@contextmanager
def _folder_with(foot: Foot) -> Iterator[str]:
    """A temporary folder that holds a foot's file, and that xacro can be told of."""
    remedy = "set TMPDIR to another folder"
    with ExitStack() as stack:
        try:
            if "$" in (place := gettempdir()):
                problem = f"the folder {place} has a $ in its name, which xacro runs"
                raise DescriptionError(problem, remedy)
            folder = stack.enter_context(TemporaryDirectory(prefix="zygopin-"))
            text = yaml.safe_dump(foot.to_mapping())
            (Path(folder) / FILE).write_text(text, encoding="utf-8")
        except OSError as error:
            problem = f"no temporary file can be written: {error.strerror or error}"
            raise DescriptionError(problem, remedy) from error
        yield folder


@contextmanager
def _expansion() -> Iterator[None]:
    """Use xacro alone, and leave PyYAML's safe loader as it was.

    xacro teaches that loader tags which evaluate expressions, for every later user.
    """
    with _XACRO:
        known = dict(yaml.SafeLoader.yaml_constructors)
        try:
            yield
        finally:
            yaml.SafeLoader.yaml_constructors = known
