"""Entries on the paper's sections 4 and 5: each holds, reads well, and is drawn."""

from __future__ import annotations

import pytest
from entry_checks import broken, check_exhibits, check_texts

from zygopin.paper.back_toes import erratum_2, erratum_3
from zygopin.paper.convexity import erratum_11
from zygopin.paper.owl_poses import figure_6
from zygopin.paper.planes import erratum_1
from zygopin.paper.talon_path import figure_7
from zygopin.paper.tendon_map import tlm_map
from zygopin.paper.tendon_print import erratum_10, erratum_12
from zygopin.paper.turning_toe import erratum_14
from zygopin.paper.whole_foot import figure_2, opposable_fingers

ENTRIES = {
    "figure-2": figure_2,
    "opposable-fingers": opposable_fingers,
    "erratum-1": erratum_1,
    "erratum-2": erratum_2,
    "erratum-3": erratum_3,
    "figure-6": figure_6,
    "erratum-14": erratum_14,
    "figure-7": figure_7,
    "tlm-map": tlm_map,
    "erratum-10": erratum_10,
    "erratum-12": erratum_12,
    "erratum-11": erratum_11,
}


@pytest.mark.parametrize("key", ENTRIES)
def test_an_entry_holds_and_is_drawn(key, tmp_path):
    entry = ENTRIES[key]()
    assert entry.key == key
    assert broken(entry) == set()
    check_texts(entry)
    check_exhibits(entry, tmp_path)


def test_numbers_are_the_same_each_time():
    for make in (figure_6, opposable_fingers, tlm_map):
        first, second = make().measurements, make().measurements
        assert first == second
