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
        node = super().compose_node(parent, index)
        if aliased and isinstance(node, yaml.CollectionNode):
            problem = "an alias repeats this list or mapping: write it out"
            raise yaml.composer.ComposerError(None, None, problem, node.start_mark)
        return node

    def construct_mapping(self, node: Any, deep: bool = False) -> Any:  # noqa: ANN401
        """Refuse a key that is there twice: one of its values would be lost.

        Args:
            node: The mapping's node.
            deep: Whether what it holds is made at once.

        Returns:
            The mapping.

        Raises:
            ConstructorError: A key is there twice.
        """
        seen = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode):
                continue
            if key.value in seen:
                problem, mark = f"{key.value!r} is there twice", key.start_mark
                raise yaml.constructor.ConstructorError(None, None, problem, mark)
            seen.add(key.value)
        return super().construct_mapping(node, deep)


def parsed(text: str) -> Any:  # noqa: ANN401
    """What a YAML text holds.

    Args:
        text: The text.

    Returns:
        Numbers, texts, dates, lists and mappings.

    Raises:
        ValueError: It is not YAML, is too long, names a key twice, or has a tag or an
            alias that is refused.
    """
    if len(text) > MOST:
        raise ValueError(f"{len(text)} characters, where at most {MOST} are read")
    try:
        return yaml.load(text, _Loader)  # noqa: S506 a safe loader
    except RecursionError as error:
        raise ValueError("lists or mappings are nested too deep") from error
    except (yaml.YAMLError, ValueError) as error:
        # Without Python's advice on a number of thousands of digits.
        raise ValueError(str(error).partition("; use sys.")[0]) from error
