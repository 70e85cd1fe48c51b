"""The record of a strike: its instants, modes, events and poses agree."""

from __future__ import annotations

import json

import numpy as np
import pytest

from zygopin.branch import Branch
from zygopin.closing import READINGS, Closing
from zygopin.errors import ParameterError
from zygopin.flight import Flight
from zygopin.foot import Foot
from zygopin.kinematics import forward_kinematics
from zygopin.motion import Law, Motion
from zygopin.obstacle import Box, Capsule, ConvexMesh, Sphere
from zygopin.solid_clearance import obstacle_clearance
from zygopin.strike import record, simulate_strike
from zygopin.tendon import Contact, TendonFoot

OWL = Foot.preset("owl")
FALL = Motion.through([0, 1], [[0, 0, 0], [0, 0, -0.2]])
CORNERS = [[2, 0, -1], [-2, 2, -1], [-2, -2, -1], [0, 0, 0]]
OBSTACLES = {
    "sphere": Sphere(0.025, [0, 0, -0.1]),
    "branch": Branch(0.015, [0.005, 0, -0.1]),
    "stump": Branch(0.015, [0.005, 0, -0.1], length=0.1),
    "box": Box([0.04, 0.06, 0.03], [0, 0, -0.1]),
    "capsule": Capsule(0.015, [[0.005, -0.1, -0.1], [0.005, 0.1, -0.1]]),
    "mesh": ConvexMesh(np.array(CORNERS) * 0.03 + [0, 0, -0.1]),
}


def strike(obstacle="sphere", *, reversal=0.0, controls=0.0, **options):
    """A fall of the owl's foot onto an obstacle."""
    flight = Flight(FALL, controls, reversal)
    return simulate_strike(OWL, OBSTACLES[obstacle], flight, **options)


@pytest.fixture(scope="module", name="trajectory", params=OBSTACLES)
def _trajectory(request):
    spread = Law.through([0, 1], [1.0, 0.0])
    return strike(request.param, reversal=spread, controls=0.1, frames=60)


def test_instants_ascend_and_modes_follow_the_automaton(trajectory):
    times, modes = trajectory.times, trajectory.modes
    assert list(dict.fromkeys(modes)) == ["free", "closing", "locked"]
    changes = np.flatnonzero(modes[1:] != modes[:-1])
    assert len(changes) == 2
    steps = np.diff(times)
    assert (steps[changes] == 0).all()
    assert (np.delete(steps, changes) > 0).all()
    assert (times[0], times[-1]) == (0.0, 1.0)


def test_events_are_in_order_at_instants_of_the_record(trajectory):
    times = [event.time for event in trajectory.events]
    assert times == sorted(times)
    assert np.isin(times, trajectory.times).all()
    kinds = [event.kind for event in trajectory.events]
    assert (kinds[0], kinds[-1]) == ("engaged", "locked")
    assert set(kinds[1:-1]) <= {"stopped", "crossed"}
    begins, ends = trajectory.times[trajectory.modes == "closing"][[0, -1]]
    assert (times[0], times[-1]) == (begins, ends)


def test_bones_are_forward_kinematics_moved_by_the_base(trajectory):
    local = forward_kinematics(OWL, trajectory.controls, azimuths=trajectory.azimuths)
    places = trajectory.base[:, None, None, :3, 3]
    assert trajectory.bones == pytest.approx(local + places, abs=1e-15)
    assert (trajectory.base[:, :3, :3] == np.eye(3)).all()


def test_clearances_and_grip_are_those_of_the_bones(trajectory):
    near = obstacle_clearance(trajectory.bones, OWL.radii, trajectory.obstacle)
    assert (trajectory.clearance == near.distance).all()
    assert (trajectory.grip.clearance == near.distance[-1]).all()
    assert (trajectory.clearance >= -trajectory.tolerance).all()
    assert trajectory.grip.feasible


def test_a_stopped_phalanx_touches_then_what_its_event_tells(trajectory):
    for event in trajectory.events:
        if event.kind not in ("engaged", "stopped"):
            continue
        index = OWL.finger_slices[event.finger].start + event.phalanx - 1
        row = np.flatnonzero(trajectory.times == event.time)[-1]
        clearance = trajectory.clearance[row, index]
        assert clearance == pytest.approx(
            event.clearance, abs=trajectory.tolerance / 10
        )
        assert abs(event.clearance) <= trajectory.tolerance * (1 + 1e-9)
        bone = trajectory.bones[row, index]
        apart = obstacle_clearance(bone[None], [0.0], trajectory.obstacle)
        assert event.point == pytest.approx(apart.point[0], abs=1e-5)


def test_its_parts_are_json(trajectory):
    events = [
        {
            "kind": e.kind,
            "time": e.time,
            "finger": e.finger,
            "phalanx": e.phalanx,
            "point": None if e.point is None else e.point.tolist(),
            "clearance": e.clearance,
        }
        for e in trajectory.events
    ]
    parts = [events, trajectory.times.tolist(), trajectory.modes.tolist()]
    assert json.loads(json.dumps(parts)) == parts


@pytest.mark.parametrize("reading", READINGS)
@pytest.mark.parametrize("frames", [2, 20, 240])
def test_frames_are_about_as_many_as_asked_for(reading, frames):
    trajectory = strike(frames=frames, closing=Closing(reading=reading))
    count = len(trajectory.times)
    assert trajectory.bones.shape == (count, OWL.phalanx_count, 2, 3)
    most = frames + len(trajectory.events) + 2 * 3
    assert min(frames, 6) <= count <= most


def test_frames_only_add_instants():
    coarse, fine = strike(frames=10), strike(frames=300)
    assert coarse.events[0].time == fine.events[0].time
    assert (coarse.controls[-1] == fine.controls[-1]).all()


def test_a_strike_that_meets_nothing_is_free_to_the_end():
    trajectory = simulate_strike(OWL, Sphere(0.01, [1, 0, 0]), Flight(FALL), frames=50)
    assert set(trajectory.modes) == {"free"}
    assert (len(trajectory.times), trajectory.events) == (50, ())
    assert trajectory.grip.fingers == ()


def test_a_record_goes_on_to_the_lock_where_that_is_later():
    closing = Closing(duration=3.0)
    trajectory = strike(closing=closing)
    assert trajectory.events[-1].kind == "locked"
    assert trajectory.times[-1] == pytest.approx(trajectory.events[-1].time + 1.5)


def test_a_record_of_two_strikes_has_both():
    motion = Motion.through([0, 1, 2, 3], [[0, 0, -h] for h in (0, 0.1, 0, 0.1)])
    automaton = TendonFoot(OWL, OBSTACLES["sphere"], Flight(motion))
    automaton.run(1.0)
    automaton.release()
    automaton.run(3.0)
    trajectory = record(automaton, 90)
    modes = trajectory.modes[
        np.append(True, trajectory.modes[1:] != trajectory.modes[:-1])
    ]
    assert modes.tolist() == ["free", "closing", "locked"] * 2
    kinds = [e.kind for e in trajectory.events if e.kind in ("engaged", "released")]
    assert kinds == ["engaged", "released", "engaged"]


def test_the_two_engines_tell_the_same_strike():
    one, other = (
        strike("branch", contact=Contact(engine=engine), frames=10)
        for engine in ("exact", "fcl")
    )
    assert other.events[0].time == pytest.approx(one.events[0].time, abs=1e-6)
    assert other.controls[-1] == pytest.approx(one.controls[-1], abs=1e-4)


@pytest.mark.parametrize("frames", [1, 0, 2.5, 10**9, None, "many"])
def test_bad_frames_are_named(frames):
    with pytest.raises(ParameterError, match=r"frames = .* is not an integer from 2"):
        strike(frames=frames)


def test_a_flight_without_an_end_is_named():
    with pytest.raises(ParameterError, match="end of the motion = inf is not a finite"):
        simulate_strike(OWL, OBSTACLES["sphere"], Flight(Motion.resting()))


def test_an_automaton_that_has_not_run_has_no_record():
    automaton = TendonFoot(OWL, OBSTACLES["sphere"], Flight(FALL))
    with pytest.raises(ParameterError, match="run it to a later time first"):
        record(automaton)
