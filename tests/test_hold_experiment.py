"""What the programmes predict, tried in MuJoCo: bounds that physics sets."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

pytest.importorskip("mujoco", reason="the programmes are tried in MuJoCo")

SCRIPT = Path(__file__).parent.parent / "scripts" / "hold-experiment"

MARGIN = 1.05
"""Largest pull over the programme's upper bound in the poses on the way.

Poses are asked a few times on the way, contacts are soft, and stops are.
"""


@pytest.fixture(scope="module")
def ran(tmp_path_factory):
    """Four pulls: what is printed, and the cases."""
    folder = tmp_path_factory.mktemp("holds")
    files = ["--json", folder / "a.json", "--png", folder / "a.png"]
    words = [sys.executable, SCRIPT, "--cases", "4", *files]
    done = subprocess.run(words, capture_output=True, text=True, check=True)
    assert (folder / "a.png").read_bytes().startswith(b"\x89PNG")
    return done.stdout, json.loads((folder / "a.json").read_text())["cases"]


def test_no_foot_holds_more_than_the_programme_bears(ran):
    _, rows = ran
    assert len(rows) == 4
    for row in rows:
        low, high = row["predicted"]
        assert 0 < low <= high <= row["bound_on_the_way"]
        assert row["simulated"] <= MARGIN * row["bound_on_the_way"]


def test_a_foot_that_squeezes_holds_most_of_it_and_more_than_one_that_does_not(ran):
    _, rows = ran
    held = np.array([row["simulated"] for row in rows])
    predicted = np.array([row["predicted"][1] for row in rows])
    assert (held > 0.4 * predicted).all()
    assert (held > [row["unsqueezed"] for row in rows]).all()
    assert (np.argsort(held) == np.argsort(predicted)).all()


def test_the_table_fits_a_terminal(ran):
    text, _ = ran
    assert "as the programme" in text
    assert max(map(len, text.splitlines())) <= 80
