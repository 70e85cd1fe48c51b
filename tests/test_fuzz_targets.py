"""What is fuzzed, on a few made-up inputs: the same ones each time."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

import pytest
from fuzz_targets import TARGETS, fuzz, seeds
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

SCRIPT = Path(__file__).parent.parent / "scripts" / "fuzz"

WORDS = (
    b"nan",
    b"-1",
    b"1e400",
    b"null",
    b"[",
    b"{",
    b'"',
    b"&a",
    b"\0",
    b"\xff",
    b"!!",
)
"""What may stand where something else was."""

EXAMPLES = {"urdf": 20, "atlas": 20, "options": 30}
"""Examples of the targets that take their time."""


@st.composite
def spoilt(draw, good):
    """A good input with some stretches of it replaced, or what is no such input."""
    if draw(st.integers(0, 3)) == 0:
        return draw(st.binary(max_size=200))
    data = draw(st.sampled_from(good))
    for _ in range(draw(st.integers(1, 3))):
        start = draw(st.integers(0, len(data)))
        end = start + draw(st.integers(0, 12))
        other = draw(st.sampled_from(WORDS) | st.binary(max_size=6))
        data = data[:start] + other + data[end:]
    return data


@pytest.mark.parametrize("target", TARGETS)
def test_spoilt_inputs_are_refused_as_documented(target):
    calm = [HealthCheck.too_slow, HealthCheck.data_too_large]

    @settings(max_examples=EXAMPLES.get(target, 50), suppress_health_check=calm)
    @given(spoilt(seeds(target)))
    def run(data):
        fuzz(target, data)

    run()


@pytest.mark.parametrize("target", TARGETS)
def test_the_inputs_to_start_from_are_good(target, monkeypatch):
    monkeypatch.setattr("fuzz_targets.ZygopinError", ())
    for seed in seeds(target):
        TARGETS[target](seed)


def test_the_script_knows_every_target():
    asked = [sys.executable, str(SCRIPT), "--help"]
    told = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    assert "{" + ",".join(TARGETS) + "}" in told


def test_a_find_is_replayed_from_its_file(tmp_path):
    place = tmp_path / "find"
    place.write_bytes(b"rho: [")
    asked = [sys.executable, str(SCRIPT), "foot", "--replay", str(place)]
    told = subprocess.run(asked, capture_output=True, text=True, check=True).stdout
    assert told == f"{place}: as documented\n"


def test_a_find_is_no_documented_error(monkeypatch):
    def broken(_data):
        raise KeyError("rho")

    monkeypatch.setitem(TARGETS, "foot", broken)
    with pytest.raises(KeyError):
        fuzz("foot", b"")


def test_without_atheris_it_says_what_adds_it(tmp_path):
    code = f"""
import runpy, sys
sys.modules["atheris"] = None
sys.argv = ["fuzz", "foot"]
runpy.run_path({str(SCRIPT)!r}, run_name="__main__")
"""
    asked = [sys.executable, "-c", code]
    ended = subprocess.run(
        asked, capture_output=True, text=True, check=False, cwd=tmp_path
    )
    assert ended.returncode == 2
    assert ended.stderr == "atheris is not installed: pip install '.[fuzz]' adds it\n"
    assert list(tmp_path.iterdir()) == []
