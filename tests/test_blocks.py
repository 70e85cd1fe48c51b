"""Batches in blocks, over threads: each entry once, and what goes wrong comes out."""

from __future__ import annotations

import threading

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from zygopin.blocks import BLOCK, MOST_THREADS, WORTH, entries, in_blocks
from zygopin.errors import ParameterError


@pytest.mark.parametrize("count", [0, 1, BLOCK, BLOCK + 1, 5 * BLOCK - 1])
@pytest.mark.parametrize("threads", [None, 1, 2, 7])
def test_every_entry_is_worked_on_once(count, threads):
    times = np.zeros(count, dtype=int)

    def work(part):
        assert part.stop - part.start <= BLOCK
        times[part] += 1

    in_blocks(work, count, threads)
    assert (times == 1).all()


def test_a_large_batch_uses_the_cores_there_are_and_a_small_one_none(monkeypatch):
    monkeypatch.setattr("zygopin.blocks._cores", lambda: 3)
    for count, most in ((WORTH * BLOCK, 1), (10 * WORTH * BLOCK, 3)):
        seen, meet = set(), threading.Barrier(most, timeout=30)

        def work(_, seen=seen, meet=meet):
            if threading.get_ident() not in seen:
                seen.add(threading.get_ident())
                meet.wait()  # until as many threads as are expected have begun

        in_blocks(work, count)
        assert len(seen) == most
        assert (threading.get_ident() in seen) == (most == 1)


@pytest.mark.parametrize("threads", [1, 3])
def test_an_error_in_a_block_is_raised(threads):
    def work(part):
        if part.start >= BLOCK:
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        in_blocks(work, 4 * BLOCK, threads)


@pytest.mark.parametrize("threads", [0, -1, 2.5, MOST_THREADS + 1, "two", True])
def test_a_number_of_threads_is_an_integer_above_zero(threads):
    with pytest.raises(ParameterError, match=r"threads.*integer from 1 to"):
        in_blocks(lambda _: None, 10, threads)


@given(st.data())
def test_entries_are_those_of_the_broadcast_array(data):
    batch = tuple(data.draw(st.lists(st.integers(1, 4), min_size=1, max_size=3)))
    kept = data.draw(st.lists(st.booleans(), min_size=len(batch), max_size=len(batch)))
    missing = data.draw(st.integers(0, len(batch)))
    leading = [n if keep else 1 for n, keep in zip(batch, kept, strict=True)][missing:]
    tail = tuple(data.draw(st.lists(st.integers(1, 3), max_size=2)))
    values = np.arange(np.prod([*leading, *tail], dtype=int)).reshape((*leading, *tail))
    count = int(np.prod(batch))
    start = data.draw(st.integers(0, count))
    part = slice(start, data.draw(st.integers(start, count)))
    found = entries(values, batch, part, len(tail))
    everything = np.broadcast_to(values, (*batch, *tail)).reshape(count, *tail)
    if leading:
        assert (found == everything[part]).all()
        assert len(found) == part.stop - part.start
    else:
        assert found is values
