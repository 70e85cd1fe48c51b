"""The tendon's two modes, and what the print makes of them."""

from __future__ import annotations

import cmath
import math

import numpy as np
import pytest
from entry_checks import broken, numbers, with_other_feet

from zygopin import Closing, Foot
from zygopin.foot import GOLDEN_MEAN
from zygopin.paper import talon_path, tendon_map, tendon_print
from zygopin.paper.descents import ball_under_toe, descent, wandering
from zygopin.paper.toe_sums import closing_turns, junctions, placed


def talon(turn, count=5):
    """Tip of a toe whose joints all turn by an angle, by the geometric series."""
    ratio = cmath.exp(-1j * turn) / GOLDEN_MEAN
    return ratio * (1 - ratio**count) / (1 - ratio)


def test_sums_are_the_geometric_series():
    turns = closing_turns(math.pi / 6, [0.0, 0.3, 1.0], 5)
    tips = junctions(GOLDEN_MEAN, turns)[:, -1]
    expected = [talon(v * math.pi / 6) for v in (0.0, 0.3, 1.0)]
    np.testing.assert_allclose(tips, expected, atol=1e-14)


def test_points_are_placed_by_a_turn_about_the_vertical():
    place = placed(np.array([2 - 3j]), math.pi / 2)
    np.testing.assert_allclose(place, [[0, 2, -3]], atol=1e-15)


def test_the_talon_ends_where_the_series_does():
    found = numbers(talon_path.figure_7())
    end = talon(math.pi / 6)
    assert complex(found["closed_re"], found["closed_im"]) == pytest.approx(end)
    assert found["straight"] == pytest.approx(talon(0.0).real)
    (figure,) = talon_path.figure_7().figures
    assert f"({end.real:.3f}, −{-end.imag:.3f})" in figure.caption


def test_another_turn_is_another_map(monkeypatch):
    with_other_feet(monkeypatch, tendon_map, lambda foot: foot.replace(omega=0.6))
    wrong = broken(tendon_map.tlm_map())
    assert {"closing_forward_kinematics", "closing_pinocchio", "strike"} <= wrong
    assert not {"free", "locked", "instant_ball"} & wrong


def test_toes_that_stop_do_not_pass_for_the_papers():
    foot = Foot.preset("paper")
    stopped = descent(
        foot,
        ball_under_toe(),
        controls=wandering(foot),
        closing=Closing(reading="contact", duration=tendon_map.DURATION),
    )
    wrong = {each.name for each in tendon_map._modes(foot, stopped) if not each.holds}
    assert "strike" in wrong
    assert "locked" not in wrong


def test_a_strike_from_elsewhere_has_another_instant(monkeypatch):
    monkeypatch.setattr(tendon_map, "contact_time", lambda: 0.4501)
    wrong = broken(tendon_map.tlm_map())
    assert wrong == {"instant_ball", "instant_branch", "instant_fcl"}


def test_the_printed_sum_has_a_phalanx_too_many():
    found = numbers(tendon_print.erratum_10())
    assert found["base_off"] == pytest.approx(GOLDEN_MEAN - 1)
    assert found["printed_length"] == pytest.approx(talon(0.0, 6).real)
    assert found["first_phalanx"] == pytest.approx(abs(talon(math.pi / 6, 2)))
    assert found["base_moves"] == pytest.approx(
        abs(talon(math.pi / 6, 1) - talon(0.0, 1))
    )


def test_the_sum_to_k_does_not_pass_for_the_printed_one(monkeypatch):
    def to_k(rho, turns):
        return np.roll(junctions(rho, turns), 1, axis=-1)

    monkeypatch.setattr(tendon_print, "junctions", to_k)
    assert {"base_off", "first_phalanx", "printed_length"} <= broken(
        tendon_print.erratum_10()
    )


def test_the_captions_range_ends_early():
    found = numbers(tendon_print.erratum_12())
    assert math.degrees(found["turn_printed"]) == pytest.approx(78.54, abs=0.01)
    assert math.degrees(found["turn_ours"]) == pytest.approx(150)
    early, late = talon(math.pi**2 / 36), talon(math.pi / 6)
    assert found["short"] == pytest.approx(abs(late - early))
    assert f"{early.real:.3f} ahead" in tendon_print.erratum_12().finding
    assert f"not {late.real:.3f}" in tendon_print.erratum_12().finding


def test_another_turn_is_another_range(monkeypatch):
    with_other_feet(monkeypatch, tendon_print, lambda foot: foot.replace(omega=0.6))
    assert {"turn_printed", "turn_ours", "talon"} <= broken(tendon_print.erratum_12())
