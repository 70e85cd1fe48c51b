"""The tendon's map: its values, its inverse, and maps that no tendon has."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from strategies import reals

from zygopin.closing import READINGS, Closing
from zygopin.errors import ParameterError, UnknownNameError

SHAPES = {
    "linear": "linear",
    "smooth": "smooth",
    "function": lambda t: math.sqrt(t / 0.1),
    "samples": [0.1, 0.1, 0.4, 0.4, 0.9],
    "flat": [0.5, 0.5],
}
DIP = np.linspace(0, 1, 10_001)
DIP[5000] -= 0.01


@pytest.fixture(params=SHAPES, name="closing")
def _closing(request):
    return Closing(duration=0.1, shape=SHAPES[request.param])


def test_named_maps_have_their_formulas():
    times = np.array([0.0, 0.025, 0.05, 0.1])
    linear = Closing(duration=0.1, shape="linear").at(times)
    smooth = Closing(duration=0.1, shape="smooth").at(times)
    assert linear == pytest.approx([0, 0.25, 0.5, 1])
    assert smooth == pytest.approx([0, 3 / 16 - 2 / 64, 0.5, 1])


def test_samples_are_joined_by_straight_lines():
    closing = Closing(duration=0.4, shape=SHAPES["samples"])
    assert closing.at([0, 0.05, 0.1, 0.15, 0.4]) == pytest.approx(
        [0.1, 0.1, 0.1, 0.25, 0.9]
    )


def test_map_never_falls_and_stays_what_it_is_outside_its_time(closing):
    values = closing.at(np.linspace(-0.1, 0.2, 3001))
    assert (np.diff(values) >= 0).all()
    assert values[0] == closing.at([0])[0]
    assert values[-1] == closing.at([0.1])[0]
    assert (values >= 0).all()
    assert (values <= 1).all()


@given(share=reals(0, 1), name=st.sampled_from(sorted(SHAPES)))
def test_when_is_the_first_time_at_which_a_value_is_reached(share, name):
    closing = Closing(duration=0.1, shape=SHAPES[name])
    first, last = closing.at([0, 0.1])
    value = min(first + share * (last - first), last)
    time = closing.when(value)
    assert 0 <= time <= 0.1
    assert closing.at([time])[0] >= value - 1e-12
    if time > 0:
        assert closing.at([math.nextafter(time - 1e-15, 0)])[0] <= value


def test_the_start_and_the_end_are_reached_when_they_are():
    closing = Closing(duration=0.1, shape=SHAPES["samples"])
    assert closing.when(0.1) == 0
    assert closing.when(0.4) == pytest.approx(0.05)
    assert closing.when(0.9) == pytest.approx(0.1)


def test_a_function_gets_times_within_its_span_as_floats():
    seen = []
    Closing(duration=0.2, shape=lambda t: seen.append(t) or t / 0.2)
    assert {type(t) for t in seen} == {float}
    assert min(seen) == 0
    assert max(seen) == 0.2


@pytest.mark.parametrize("reading", READINGS)
def test_readings_are_known_by_name(reading):
    assert Closing(reading=reading).reading == reading


# Bad input -----------------------------------------------------------------------


def fails(_):
    raise RuntimeError("two\nlines")


@pytest.mark.parametrize(
    ("shape", "message"),
    [
        (
            lambda t: 1 - t,
            r"v at equal steps\[1\] = .* is not non-decreasing: a tendon",
        ),
        (DIP, r"v at equal steps\[5000\] = 0.49 is not non-decreasing"),
        (
            lambda t: float(t > 0.02),
            "v at 0.02 s = 1.0 is not continuous: it steps by 1",
        ),
        (lambda t: t + 0.5 * (t >= 0.03), "v at 0.03 s = .* it steps by 0.5"),
        (lambda t: 30 * t, r"v\[.*\] = 1.00.* is not in \[0, 1\]"),
        (lambda t: t - 0.1, r"v\[0\] = -0.1 is not in \[0, 1\]"),
        (fails, r"v\(0\) = 'RuntimeError: two.*lines' is not defined"),
        (lambda t: 1 / t, "ZeroDivisionError"),
        (lambda _: math.nan, r"v\(0\) = nan is not a finite number"),
        (lambda _: None, r"v\(0\) = None is not a finite number"),
        (lambda _: "half", r"v\(0\) = 'half' is not a finite number"),
        (lambda _: [0.1, 0.2], r"v\(0\) = \[0.1, 0.2\] is not a finite number"),
        ([0.5], r"closing.shape.shape = \(1,\)"),
        ([], r"closing.shape.shape = \(0,\)"),
        ([[0, 1], [0, 1]], r"closing.shape.shape = \(2, 2\)"),
        ([0, math.nan], r"closing.shape\[1\] = nan is not finite"),
        ([0, 2], r"is not in \[0, 1\]"),
        ([1, 0], "non-decreasing"),
        (0.5, "at least two samples"),
        (None, "closing.shape = None"),
    ],
)
def test_a_map_that_no_tendon_has_is_named(shape, message):
    with pytest.raises(ParameterError, match=message) as caught:
        Closing(shape=shape)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("duration", [0, -1.0, math.nan, math.inf, None, "long"])
def test_a_closing_takes_some_time(duration):
    with pytest.raises(ParameterError, match=r"closing.duration = .* not a time > 0"):
        Closing(duration=duration)


def test_unknown_names_are_told_with_those_that_exist():
    with pytest.raises(UnknownNameError, match="unknown reading 'papers': did you"):
        Closing(reading="papers")
    with pytest.raises(UnknownNameError, match=r"closing.shape 'quick': .*smooth"):
        Closing(shape="quick")
