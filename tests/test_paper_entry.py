"""The report's records: what a number must be, and whether it is."""

from __future__ import annotations

import math

import pytest

from zygopin.paper.entry import Entry, Measurement, at_least, at_most, equal


@pytest.mark.parametrize(
    ("reference", "number", "admitted"),
    [
        (equal(2.0, 0.5, "x"), 2.5, True),
        (equal(2.0, 0.5, "x"), 1.4, False),
        (equal(2.0, 0.0, "x"), 2.0, True),
        (at_most(2.0, "x"), 2.0, True),
        (at_most(2.0, "x"), 2.1, False),
        (at_least(2.0, "x"), 2.0, True),
        (at_least(2.0, "x"), 1.9, False),
        (equal(2.0, 0.5, "x"), math.nan, False),
        (at_most(2.0, "x"), math.nan, False),
        (at_least(2.0, "x"), math.nan, False),
    ],
)
def test_a_reference_admits_what_stands_as_it_must(reference, number, admitted):
    assert reference.admits(number) is admitted


def entry(key, *measurements, kind="statement"):
    return Entry(key, kind, "A title", "section 1", "", "", "", measurements)


def test_an_entry_holds_where_all_its_numbers_do():
    good = Measurement("a", "words", 1.0, at_most(2.0, "x"))
    bad = Measurement("b", "words", 3.0, at_most(2.0, "x"))
    stated = Measurement("c", "words", 3.0)
    assert entry("one", good, stated).holds
    assert entry("one", good, stated).judged == (good,)
    assert not entry("two", good, bad).holds


@pytest.mark.parametrize(
    ("key", "kind", "label", "number"),
    [
        ("proposition-1", "statement", "Proposition 1", 1),
        ("erratum-13", "erratum", "Erratum 13", 13),
        ("control-system", "statement", "Statement", None),
    ],
)
def test_an_entry_is_called_by_its_number_or_its_kind(key, kind, label, number):
    assert entry(key, kind=kind).label == label
    assert entry(key, kind=kind).number == number
