"""The record of a strike: its arrays keep their values, its modes their places."""

from __future__ import annotations

import numpy as np
import pytest
from made_strikes import made_strike


@pytest.fixture(scope="module")
def strike():
    return made_strike()


def test_records_are_read_only_copies(strike):
    for record in (strike, strike.grip, *strike.events):
        arrays = [x for x in vars(record).values() if isinstance(x, np.ndarray)]
        assert not any(values.flags.writeable for values in arrays)
    assert strike.bones.base is None


def test_modes_start_where_they_change(strike):
    starts = strike.mode_starts
    assert strike.modes[starts].tolist() == ["free", "closing", "locked"]
    assert starts[0] == 0
    assert all(strike.modes[i] != strike.modes[i - 1] for i in starts[1:])
    runs = np.split(strike.modes, starts[1:])
    assert all(len(set(run.tolist())) == 1 for run in runs)
