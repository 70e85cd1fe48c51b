"""YAML as plain values: reading it runs nothing, and makes little of little."""

from __future__ import annotations

from typing import Any

import yaml

MOST = 2**16
"""Characters that are read: five times what the longest foot takes. Some of YAML's
numbers take as long as the square of their length."""

_OWN = "tag:yaml.org,2002:"
"""What the tags of YAML itself begin with."""


class _Loader(yaml.SafeLoader):
    """The safe loader, with YAML's own tags alone, and without what multiplies."""

    # A copy: xacro teaches the safe loader tags that evaluate what they are given, for
    # all that use it, and this may be imported, or read a file, in the meantime.
    yaml_constructors = {  # noqa: RUF012 as PyYAML has it
        tag: make
        for tag, make in yaml.SafeLoader.yaml_constructors.items()
        if tag is None or tag.startswith(_OWN)
    }

    def compose_node(self, parent: Any, index: Any) -> Any:  # noqa: ANN401
        """Refuse an alias of anything but a single value: such can stand for billions.

        Args:
            parent: The node around it.
            index: Its place there.

        Returns:
            The node.

        Raises:
            ComposerError: It stands for a list or a mapping.
        """
        aliased = self.check_event(yaml.AliasEvent)
        node: Any = super().compose_node(parent, index)
        if aliased and not isinstance(node, yaml.ScalarNode):
            problem = "an alias repeats this list or mapping: write it out"
            raise yaml.composer.ComposerError(None, None, problem, node.start_mark)
        return node


def parsed(text: str) -> Any:  # noqa: ANN401
    """What a YAML text holds.

    Args:
        text: The text.

    Returns:
        Numbers, texts, dates, lists and mappings.

    Raises:
        ValueError: It is not YAML, is too long, or has a tag or an alias that is
            refused.
    """
    if len(text) > MOST:
        raise ValueError(f"{len(text)} characters, where at most {MOST} are read")
    try:
        return yaml.load(text, _Loader)  # noqa: S506 a safe loader
    except (yaml.YAMLError, RecursionError) as error:
        raise ValueError(str(error)) from error
