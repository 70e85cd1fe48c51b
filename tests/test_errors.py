"""Errors: one root, one line, and the values kept."""

from __future__ import annotations

import pickle

import pytest

from zygopin.errors import (
    DescriptionError,
    FileError,
    ParameterError,
    UnknownNameError,
    ZygopinError,
)

EXAMPLES = [
    ParameterError("rho", 0.5, "above 1", "give a number such as 1.2"),
    UnknownNameError("finger", "finger5", ["finger1", "thumb"]),
    FileError("a.yaml", "not YAML:\n  line 2", "mend the syntax"),
    DescriptionError("broken\n\nxml", "restore it"),
]


@pytest.mark.parametrize("error", EXAMPLES, ids=lambda e: type(e).__name__)
def test_every_error_has_one_root_one_line_and_an_exit_code(error):
    assert isinstance(error, ZygopinError)
    assert error.exit_code == 2
    assert "\n" not in str(error)


@pytest.mark.parametrize(
    ("error", "builtin"),
    [*zip(EXAMPLES[:3], (ValueError, LookupError, OSError), strict=True)],
)
def test_errors_are_also_what_python_calls_them(error, builtin):
    assert isinstance(error, builtin)


def test_messages_name_value_allowed_and_remedy():
    parameter, unknown, file, description = map(str, EXAMPLES)
    assert parameter == "rho = 0.5 is not above 1: give a number such as 1.2"
    assert unknown == (
        "unknown finger 'finger5': did you mean 'finger1'? choose one of finger1, thumb"
    )
    assert file == "a.yaml: not YAML: line 2: mend the syntax"
    assert description == "broken xml: restore it"


def test_errors_keep_the_offending_values():
    parameter, unknown, file, description = EXAMPLES
    assert (parameter.name, parameter.value) == ("rho", 0.5)
    assert (parameter.allowed, parameter.remedy) == (
        "above 1",
        "give a number such as 1.2",
    )
    assert (unknown.kind, unknown.name) == ("finger", "finger5")
    assert unknown.known == ("finger1", "thumb")
    assert (file.path.name, file.remedy) == ("a.yaml", "mend the syntax")
    assert (description.problem, description.remedy) == ("broken\n\nxml", "restore it")


def test_a_name_unlike_any_other_gets_no_suggestion():
    message = str(UnknownNameError("preset", "zzz", ["owl", "parrot"]))
    assert message == "unknown preset 'zzz': choose one of owl, parrot"


def test_a_long_value_is_cut_and_stays_on_one_line():
    error = ParameterError("rho", "x\n" * 500, "a number", "give one")
    shown = str(error).removeprefix("rho = ").split(" is not ")[0]
    assert len(shown) == 60
    assert shown.endswith("...")
    assert error.value == "x\n" * 500


@pytest.mark.parametrize(
    ("value", "shown"),
    [(10**5000, "an integer of 16610 bits"), ([0.0] * 2000, f"[{'0.0, ' * 11}0...")],
    ids=["digits", "list"],
)
def test_of_a_value_that_is_too_long_to_write_enough_is_shown(value, shown):
    message = str(ParameterError("rho", value, "above 1", "give one"))
    assert message == f"rho = {shown} is not above 1: give one"


def test_a_path_is_told_on_one_line_and_only_as_far_as_it_helps():
    assert str(FileError("a\nb", "is none", "mend it")) == r"'a\nb': is none: mend it"
    message = str(FileError("x" * 1000 + ".yaml", "is none", "mend it"))
    assert message.startswith("...xx")
    assert "x.yaml: is none" in message
    assert len(message) < 330


@pytest.mark.parametrize("error", EXAMPLES, ids=lambda e: type(e).__name__)
def test_errors_cross_process_borders_whole(error):
    copy = pickle.loads(pickle.dumps(error))  # noqa: S301
    assert type(copy) is type(error)
    assert str(copy) == str(error)
    assert vars(copy) == vars(error)
