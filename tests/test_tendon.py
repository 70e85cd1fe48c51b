"""The automaton: no contact is missed, its modes, its guard by hand, and bad input."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from strikes import KINDS, judged, paper_reading, random_strike

from zygopin.branch import Branch
from zygopin.closing import READINGS, Closing
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.finger import Finger
from zygopin.flight import Flight, FreeFlow
from zygopin.foot import Foot
from zygopin.grasp import TOLERANCE
from zygopin.motion import Law, Motion
from zygopin.obstacle import Box, Capsule, ConvexMesh, Sphere
from zygopin.tendon import CLEAR, Contact, TendonFoot

STRIKES = 6
"""Random strikes at each shape of obstacle; `scripts/strike-sweep` does thousands."""

OWL = Foot.preset("owl")
BALL = Sphere(0.02, [0, 0, -0.1])
TOE = Foot(rho=2.0, scale=2.0, thickness=0.2, fingers=(Finger("toe", 1, 0.0),))
"""One phalanx of 1 m with a skin of 0.1 m, which closes by 30 degrees."""


def descent(height, end=1.0, foot=0.0):
    """A base that comes down by a height in a straight line."""
    return Motion.through([0, end], [[0, 0, foot], [0, 0, foot - height]])


def path(times, heights):
    """A base that goes up and down along z."""
    return Motion.through(times, [[0, 0, height] for height in heights])


def kinds(automaton):
    """What happened, in order."""
    return [event.kind for event in automaton.events]


def struck(foot=OWL, obstacle=BALL, motion=None, *, until=1.0, **options):
    """An automaton that has run; `controls` and `reversal` are the flight's."""
    names = ("controls", "reversal")
    given = {name: options.pop(name) for name in names if name in options}
    flight = Flight(motion or descent(0.2), **given)
    automaton = TendonFoot(foot, obstacle, flight, **options)
    automaton.run(until)
    return automaton


def stances(automaton, mode, share):
    """The stance at a share of the first stretch in a mode."""
    phase = next(each for each in automaton.phases if each.mode == mode)
    return phase.stances(np.array([phase.start + share * (phase.end - phase.start)]))


# No contact is missed ------------------------------------------------------------


@pytest.mark.parametrize("kind", KINDS)
def test_random_strikes_miss_no_contact_and_see_none_too_early(kind):
    rng = np.random.default_rng(5)
    found = [
        judged(random_strike(rng, kind, closing=paper_reading()))
        for _ in range(STRIKES)
    ]
    assert all(each.good for each in found)
    assert any(each.stepped_over for each in found)


def test_the_reference_notices_a_guard_that_trusts_a_part_of_the_speed(monkeypatch):
    honest = FreeFlow.speeds
    monkeypatch.setattr(FreeFlow, "speeds", lambda *span: honest(*span) / 20)
    rng = np.random.default_rng(5)
    strikes = (random_strike(rng, "sphere", closing=paper_reading()) for _ in range(20))
    assert not all(judged(strike).good for strike in strikes)


@pytest.mark.parametrize("share", [1e-3, 1e-2])
def test_a_twig_is_met_by_a_foot_that_passes_within_a_fraction_of_a_step(share):
    # 100 m/s: in 1 ms the foot is 0.1 m farther, more than its own length.
    twig = Branch(share * OWL.size, [0.02, 0, -0.51])
    automaton = struck(OWL, twig, descent(1.0, end=0.01), until=0.01)
    event = automaton.events[0]
    height = 0.51 - twig.radius - OWL.radii[event.phalanx - 1]
    assert event.time <= height / 100
    assert event.time >= (height - OWL.radii[0]) / 100


# By hand -------------------------------------------------------------------------


@pytest.mark.parametrize("engine", ["exact", "fcl"])
@pytest.mark.parametrize("speed", [0.1, 1.0, 1000.0])
def test_a_base_over_a_sphere_meets_it_after_height_over_speed(speed, engine):
    height, end = 2.0, 3.0 / speed
    sphere = Sphere(0.4, [0.0, 0.0, -height])
    automaton = struck(
        TOE, sphere, descent(3.0, end), until=end, contact=Contact(engine=engine)
    )
    expected = (height - 0.4 - 0.1) / speed
    tolerance = TOLERANCE * TOE.size
    event = automaton.events[0]
    assert 0 <= expected - event.time + 1e-12 <= 1.001 * tolerance / speed
    assert (event.finger, event.phalanx) == ("toe", 1)
    assert event.clearance == pytest.approx(0, abs=1.001 * tolerance)
    assert event.point == pytest.approx([0, 0, -height + 0.4])


def test_a_toe_that_closes_meets_a_sphere_at_its_tangent():
    # The base rests; the control runs from 0 to 1 in a second.
    sphere = Sphere(0.2, [0.7, 0.0, -0.55])
    still = Motion.through([0, 1], np.zeros((2, 3)))
    automaton = struck(TOE, sphere, still, controls=Law.through([0, 1], [[0], [1]]))
    away = math.hypot(0.7, 0.55)
    angle = math.atan2(0.55, 0.7) - math.asin(0.3 / away)
    assert automaton.events[0].time == pytest.approx(angle / TOE.omega, abs=5e-6)


def test_a_base_that_turns_meets_a_sphere_at_its_tangent():
    turns = Rotation.from_euler("z", [[0.0], [2.0]]).as_matrix()
    motion = Motion.through([0, 1], np.zeros((2, 3)), turns)
    closing = paper_reading()
    automaton = struck(TOE, Sphere(0.2, [0, 0.8, 0]), motion, closing=closing)
    angle = math.pi / 2 - math.asin(0.3 / 0.8)
    assert automaton.events[0].time == pytest.approx(angle / 2, abs=5e-6)


def test_a_toe_that_reverses_meets_a_sphere_at_its_tangent():
    finger = Finger("toe", 1, 0.0, reversed_azimuth=2.0)
    still = Motion.through([0, 1], np.zeros((2, 3)))
    automaton = struck(
        TOE.replace(fingers=(finger,)),
        Sphere(0.2, [0, 0.8, 0]),
        still,
        reversal=Law.through([0, 1], [0.0, 1.0]),
        closing=paper_reading(),
    )
    angle = math.pi / 2 - math.asin(0.3 / 0.8)
    assert automaton.events[0].time == pytest.approx(angle / 2, abs=5e-6)


@pytest.mark.parametrize("obstacle", [BALL, Branch(0.01, [0.01, 0, -0.1], (0.2, 1, 0))])
def test_two_engines_meet_an_obstacle_at_the_same_time(obstacle):
    times = [
        struck(obstacle=obstacle, contact=Contact(engine=engine)).events[0].time
        for engine in ("exact", "fcl")
    ]
    speed, tolerance = 0.2, TOLERANCE * OWL.size
    assert times[0] == pytest.approx(times[1], abs=tolerance / speed)


def test_only_first_phalanges_engage_where_only_they_sense():
    # Under the tip of finger 2: the first phalanges pass beside it.
    azimuth = OWL.fingers[1].azimuth
    way = np.array([math.cos(azimuth), math.sin(azimuth)])
    under = Sphere(0.002, [*(0.95 * OWL.lengths[2:5].sum() * way), -0.1])
    anything = struck(obstacle=under, contact=Contact(sensing="any"))
    assert anything.events[0].phalanx > 1
    assert kinds(struck(obstacle=under, contact=Contact(sensing="first"))) == []
    assert kinds(struck(obstacle=under, closing=Closing(reading="paper"))) == []


def test_a_flight_that_meets_nothing_is_free_throughout():
    automaton = struck(obstacle=Sphere(0.01, [1, 0, 0]))
    assert (automaton.mode, automaton.time, automaton.events) == ("free", 1.0, [])
    assert [phase.mode for phase in automaton.phases] == ["free"]


def test_contact_where_the_flight_starts_engages_there():
    near = Sphere(0.02, [0, 0, -0.02 - OWL.radii[0]])
    assert struck(obstacle=near).events[0].time == 0.0


# Modes ---------------------------------------------------------------------------


@pytest.mark.parametrize("reading", READINGS)
def test_a_strike_goes_from_free_through_closing_to_locked(reading):
    closing = Closing(reading=reading, duration=0.03)
    automaton = struck(closing=closing)
    assert [phase.mode for phase in automaton.phases] == ["free", "closing", "locked"]
    first, last = automaton.events[0], automaton.events[-1]
    assert (first.kind, last.kind) == ("engaged", "locked")
    assert last.time == first.time + 0.03
    ends = [(phase.start, phase.end) for phase in automaton.phases]
    assert ends == [(0.0, first.time), (first.time, last.time), (last.time, 1.0)]


@pytest.mark.parametrize("shape", ["linear", "smooth", [0.2, 0.3, 0.9]])
def test_in_the_papers_reading_every_control_is_that_of_the_map(shape):
    closing = Closing(reading="paper", shape=shape)
    controls = np.random.default_rng(1).random(OWL.phalanx_count)
    automaton = struck(closing=closing, controls=controls)
    phase = automaton.phases[1]
    times = np.linspace(phase.start, phase.end, 50)
    found = phase.stances(times).controls
    expected = closing.at(times - automaton.events[0].time)
    assert (found == expected[:, None]).all()
    locked = automaton.phases[2].stances(np.array([0.9])).controls
    assert locked[0] == pytest.approx(closing.at([closing.duration])[0], abs=1e-12)


def test_in_the_reading_contact_controls_start_from_where_they_are():
    controls = np.random.default_rng(1).random(OWL.phalanx_count) / 4
    automaton = struck(controls=controls)
    phase = automaton.phases[1]
    found = phase.stances(np.linspace(phase.start, phase.end, 200)).controls
    assert (found[0] == controls).all()
    assert (np.diff(found, axis=0) >= 0).all()
    near = automaton.near(stances(automaton, "locked", 0.5).bones[0])
    assert (near.distance >= -automaton.tolerance).all()


def test_base_and_turn_stay_as_they_were_once_the_tendon_engaged():
    automaton = struck(reversal=Law.through([0, 1], [0.0, 1.0]))
    time = automaton.events[0].time
    for mode in ("closing", "locked"):
        stance = stances(automaton, mode, 0.7)
        assert stance.base[0, 2, 3] == pytest.approx(-0.2 * time)
        turn = OWL.fingers[3].azimuth + time * OWL.fingers[3].reversal
        assert stance.azimuths[0, 3] == pytest.approx(turn)


def test_locked_toes_do_not_move_whatever_the_controls_say():
    wild = Law.through(np.linspace(0, 1, 9), np.arange(9)[:, None] % 2 * np.ones(14))
    automaton = struck(controls=wild)
    bones = [stances(automaton, "locked", share).bones for share in (0, 0.4, 1)]
    assert (bones[0] == bones[1]).all()
    assert (bones[0] == bones[2]).all()
    assert (bones[0] == stances(automaton, "closing", 1).bones).all()
    automaton.run(50.0)
    assert automaton.mode == "locked"


def test_running_in_parts_is_running_at_once():
    whole, parts = struck(), struck(until=0.1)
    for until in (0.2, 0.2, 0.45, 0.7, 1.0):
        parts.run(until)
    assert kinds(parts) == kinds(whole)
    assert parts.events[0].time == pytest.approx(whole.events[0].time, abs=1e-6)
    assert [phase.mode for phase in parts.phases] == ["free", "closing", "locked"]
    assert parts.phases[-1].end == 1.0


def test_a_closing_that_has_begun_is_finished():
    time = struck().events[0].time
    automaton = struck(until=time + 0.001)
    assert automaton.mode == "locked"
    assert automaton.time == automaton.events[0].time + automaton.closing.duration


# Release -------------------------------------------------------------------------


def test_release_frees_and_a_second_approach_engages_anew():
    motion = path([0, 1, 2, 3], [0, -0.1, 0, -0.1])
    automaton = struck(motion=motion, until=1.0)
    first = automaton.events[0].time
    automaton.release()
    assert automaton.mode == "free"
    automaton.run(3.0)
    again = [event.time for event in automaton.events if event.kind == "engaged"]
    assert again == pytest.approx([first, 2 + first], abs=1e-4)
    modes = [phase.mode for phase in automaton.phases]
    assert modes == ["free", "closing", "locked"] * 2


def test_released_toes_that_still_touch_do_not_engage():
    hover = path([0, 0.8, 2], [0, -0.076, -0.076])
    automaton = struck(motion=hover, until=1.0)
    automaton.release()
    automaton.run(2.0)
    assert automaton.mode == "free"
    assert kinds(automaton)[-1] == "released"


def test_a_hop_that_is_short_for_the_flight_is_enough_to_come_clear():
    def pose(time):
        hop = max(0.0, 3 * CLEAR * TOE.size - abs(time - 5.613) * 5)
        matrix = np.eye(4)
        matrix[2, 3] = max(1 - time, 0) / 10 + hop
        return matrix

    motion = Motion.of(pose, end=7.0, speed=5.0)
    sphere = Sphere(0.5, [0.0, 0, -0.6])
    paper = Closing(reading="paper", duration=0.01)
    automaton = struck(TOE, sphere, motion, until=5.0, closing=paper)
    automaton.release()
    automaton.run(7.0)
    down = 5.613 + 3 * CLEAR * TOE.size / 5
    assert [e.time for e in automaton.events if e.kind == "engaged"] == pytest.approx(
        [1.0, down], abs=1e-4
    )


def test_only_a_locked_foot_is_released():
    with pytest.raises(ParameterError, match="mode = 'free' is not locked"):
        TendonFoot(OWL, BALL, Flight(descent(0.2))).release()
    automaton = struck()
    automaton.run(5.0)
    with pytest.raises(ParameterError, match="span of motion"):
        automaton.release()


# Symmetries ----------------------------------------------------------------------


@pytest.mark.parametrize("scale", [1e-3, 1e3])
def test_a_strike_of_another_size_is_the_same_in_time(scale):
    big = OWL.replace(scale=OWL.scale * scale, thickness=OWL.thickness * scale)
    ball = Sphere(BALL.radius * scale, BALL.centre * scale)
    one, other = struck(), struck(big, ball, descent(0.2 * scale))
    assert other.events[0].time == pytest.approx(one.events[0].time, rel=1e-6)
    assert kinds(other) == kinds(one)
    first, second = (stances(each, "locked", 1).controls for each in (one, other))
    assert second == pytest.approx(first, abs=1e-6)


def test_a_strike_elsewhere_in_the_world_is_the_same():
    turn = Rotation.from_euler("xyz", [0.4, -1.0, 2.0])
    shift = np.array([0.3, -0.2, 0.5])
    places = turn.apply([[0, 0, 0], [0, 0, -0.2]]) + shift
    motion = Motion.through([0, 1], places, [turn.as_matrix()] * 2)
    moved = struck(
        obstacle=Sphere(0.02, turn.apply(BALL.centre.copy()) + shift), motion=motion
    )
    here = struck()
    tolerance = TOLERANCE * OWL.size
    assert moved.events[0].time == pytest.approx(
        here.events[0].time, abs=tolerance / 0.2
    )
    first, second = (stances(each, "locked", 1) for each in (here, moved))
    assert second.controls == pytest.approx(first.controls, abs=1e-4)
    back = turn.inv().apply((second.bones[0] - shift).reshape(-1, 3))
    assert back == pytest.approx(first.bones.reshape(-1, 3), abs=1e-4 * OWL.size)


# Bad input -----------------------------------------------------------------------


@pytest.mark.parametrize(
    "holding",
    [
        Sphere(0.1, [0, 0, -0.05]),
        Branch(0.1, [0, 0, -0.05]),
        Box([0.2, 0.2, 0.2], [0, 0, -0.05]),
        Capsule(0.1, [[0, -1, -0.05], [0, 1, -0.05]]),
        ConvexMesh(np.array([[1, 0, -1], [-1, 1, -1], [-1, -1, -1], [0, 0, 1]]) / 10),
    ],
)
def test_an_obstacle_that_holds_the_base_is_named(holding):
    with pytest.raises(ParameterError, match=r"depth of the base = .* already holds"):
        TendonFoot(OWL, holding, Flight(descent(0.2)))


def test_a_tiny_foot_far_from_the_origin_has_a_base_too():
    far = np.array([1e3, -3e2, 20.0])
    foot = OWL.replace(scale=1e-6, thickness=1e-7)
    motion = Motion.through([0, 1], [far, far - [0, 0, 1e-5]])
    automaton = struck(foot, Sphere(3e-6, far - [0, 0, 6e-6]), motion)
    assert kinds(automaton)[0] == "engaged"
    assert kinds(automaton)[-1] == "locked"


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"obstacle": "tree"}, "obstacle = 'tree' is not a Branch, Sphere"),
        ({"obstacle": Branch([0.1, 0.2], [0, 0, -1])}, "obstacle batch"),
        ({"flight": descent(0.2)}, "flight = 'Motion' is not a Flight"),
        ({"closing": "paper"}, "closing = 'str' is not a Closing"),
        ({"contact": "any"}, "contact = 'str' is not a Contact"),
        ({"contact": Contact(tolerance=1.0)}, "tolerance = 1.0 is not at most"),
        (
            {"flight": Flight(descent(0.2), Law.through([0.5, 1], np.zeros((2, 14))))},
            "span of controls",
        ),
    ],
)
def test_bad_strikes_are_named(changes, message):
    given = {"obstacle": BALL, "flight": Flight(descent(0.2)), **changes}
    with pytest.raises(ParameterError, match=message) as caught:
        TendonFoot(OWL, **given)
    assert "\n" not in str(caught.value)


def test_bad_contacts_are_named_where_they_are_made():
    with pytest.raises(UnknownNameError, match=r"unknown sensing 'all': .*first, any"):
        Contact(sensing="all")
    with pytest.raises(UnknownNameError, match="unknown engine 'bullet'"):
        Contact(engine="bullet")
    for value in (-1.0, 0.0, math.nan, "small"):
        with pytest.raises(ParameterError, match="tolerance"):
            Contact(tolerance=value)


@pytest.mark.parametrize("until", [math.nan, math.inf, None, "end"])
def test_a_time_to_run_to_is_a_number(until):
    with pytest.raises(ParameterError, match="until"):
        struck(until=until)


@pytest.mark.parametrize("name", ["controls", "reversal", "motion"])
def test_what_is_not_defined_until_the_end_is_named(name):
    short = {"controls": np.zeros((2, 14)), "reversal": np.zeros(2)}
    options = {name: Law.through([0, 0.1], short[name])} if name in short else {}
    with pytest.raises(ParameterError, match=f"span of {name}"):
        struck(until=5.0 if name == "motion" else 1.0, **options)
