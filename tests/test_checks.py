"""Checks at the edge: what passes comes back as what it is used as."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest

from zygopin import checks, kinds
from zygopin.errors import ParameterError

NOT_NUMBERS = [
    *(None, True, np.True_, "1", b"1", bytearray(b"1"), memoryview(b"1")),
    *([1.0], {}, 1j, np.complex128(1), math.nan, math.inf, 10**400),
    *(np.array([1.0]), np.timedelta64(1, "s")),
]


def kind_of(value):
    """Names of cases that are the same in every process: no addresses."""
    return type(value).__name__


@pytest.mark.parametrize("value", [2, 2.0, np.float32(2), np.int64(2), Fraction(2)])
def test_anything_that_is_a_number_becomes_a_float(value):
    result = checks.number("x", value)
    assert type(result) is float
    assert result == 2.0


@pytest.mark.parametrize("value", NOT_NUMBERS, ids=kind_of)
def test_what_is_no_finite_number_is_refused(value):
    with pytest.raises(ParameterError, match=r"^x = .* is not a finite number: give"):
        checks.number("x", value)


def test_a_condition_is_named_with_its_remedy():
    with pytest.raises(ParameterError, match=r"^x = -1 is not positive: turn it round"):
        checks.number(
            "x", -1, allowed="positive", where=lambda x: x > 0, remedy="turn it round"
        )


@pytest.mark.parametrize("value", [2, 2.0, np.int8(2)])
def test_a_whole_number_becomes_an_int(value):
    result = checks.integer("n", value, 1, 3)
    assert type(result) is int
    assert result == 2


@pytest.mark.parametrize("value", [0, 4, 2.5, *NOT_NUMBERS], ids=kind_of)
def test_what_is_no_integer_in_range_is_refused(value):
    with pytest.raises(ParameterError, match="is not an integer from 1 to 3: give an"):
        checks.integer("n", value, 1, 3)


def test_an_array_is_a_copy():
    values = np.array([1.0, 2.0])
    result = checks.array("x", values)
    values[0] = 5.0
    assert result.tolist() == [1.0, 2.0]
    assert result.dtype == float


@pytest.mark.parametrize("value", [[[1], [1, 2]], "abc", object(), [None, "a"]])
def test_what_is_no_array_of_numbers_is_refused(value):
    with pytest.raises(ParameterError, match="is not an array of numbers: give"):
        checks.array("x", value)


@pytest.mark.parametrize(
    ("value", "shown"), [(1.0, r"\(\)"), ([1, 2], r"\(2,\)"), (np.ones((3, 2)), "3, 2")]
)
def test_a_wrong_last_axis_is_refused_with_the_shape(value, shown):
    with pytest.raises(ParameterError, match=rf"x.shape = .*{shown}.*give 3 numbers"):
        checks.array("x", value, last=3)


def test_the_first_bad_entry_is_named_by_its_index():
    values = np.zeros((2, 3))
    values[1, 2] = math.nan
    with pytest.raises(ParameterError, match=r"^x\[1, 2\] = nan is not finite"):
        checks.array("x", values)
    with pytest.raises(ParameterError, match=r"^x = nan is not finite"):
        checks.array("x", math.nan)


def test_batches_broadcast_or_are_refused_by_name():
    assert checks.common_batch("a and b", (3, 1), (4,)) == (3, 4)
    with pytest.raises(
        ParameterError, match=r"^batch shapes of a and b = \(\(3,\), \(4,\)\) is not"
    ):
        checks.common_batch("a and b", (3,), (4,))


@pytest.mark.parametrize("name", ["a", "finger1", "left_toe", "a" * 40])
def test_an_identifier_comes_back(name):
    assert kinds.identifier("name", name) == name


@pytest.mark.parametrize(
    "name", ["", "A", "1a", "a b", "a\n", "<x>", "a.b", "é", "a" * 41, None, 3]
)
def test_a_name_that_is_no_identifier_is_refused(name):
    with pytest.raises(ParameterError, match="is not a lower-case identifier"):
        kinds.identifier("name", name)
