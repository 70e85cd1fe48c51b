"""Toes that close: they stop where they meet something, neither before nor beyond."""

from __future__ import annotations

import itertools
import math
from functools import partial

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from strikes import make_obstacle

from zygopin.branch import Branch
from zygopin.clearance import skin_distance
from zygopin.finger import Finger
from zygopin.foot import Foot
from zygopin.grasp import TOLERANCE, finger_pairs
from zygopin.obstacle import Sphere
from zygopin.solid_clearance import obstacle_clearance
from zygopin.stance import Stance, azimuths_at
from zygopin.toe_stops import ToeStops

CASES = (
    ("sphere", "owl"),
    ("branch", "paper"),
    ("stump", "parrot"),
    ("box", "owl"),
    ("capsule", "anisodactyl"),
    ("mesh", "paper"),
)
STEPS = 250
"""Steps of the reference that only looks at instants."""


def near_to(obstacle):
    """The clearance to an obstacle, as the toes ask for it."""
    return partial(_near, obstacle)


def _near(obstacle, bones, radii):
    return obstacle_clearance(bones, radii, obstacle)


def toes_at(foot, obstacle, controls=0.0, base=None, reversal=0.0):
    """Toes before they close."""
    values = np.broadcast_to(controls, foot.phalanx_count).astype(float)
    azimuths = azimuths_at(foot, np.array(reversal))
    stance = Stance(foot, np.eye(4) if base is None else base, azimuths, values)
    return ToeStops(stance, near_to(obstacle), TOLERANCE * foot.size)


def closed(*arguments, end=1.0, **options):
    """Toes after they closed."""
    toes = toes_at(*arguments, **options)
    toes.close(end)
    return toes


def toes_over(kind, preset, seed):
    """Toes of a shipped foot, over an obstacle under its base."""
    rng = np.random.default_rng(seed)
    foot, base = Foot.preset(preset), np.eye(4)
    base[:3, :3] = Rotation.from_rotvec(rng.normal(size=3) * 0.3).as_matrix()
    width = foot.size * rng.uniform(0.05, 0.4)
    down = [0, 0, -width - foot.size * rng.uniform(0.02, 0.5)]
    obstacle = make_obstacle(kind, width, down + rng.normal(size=3) * width / 4, rng)
    controls = rng.random(foot.phalanx_count) * rng.choice([0.0, 0.3])
    return toes_at(foot, obstacle, controls, base)


def toes_tolerance(toes):
    """Deepest that the toes may enter anything anew [m]."""
    return TOLERANCE * toes.stance.foot.size


def gaps(toes, progress):
    """Clearances of phalanges, and of pairs of phalanges of different toes."""
    foot, bones = toes.stance.foot, toes.motion(progress).bones
    near = toes.near(bones, foot.radii).distance
    return near, skin_distance(bones, foot.radii, finger_pairs(foot))


def in_contact(toes, progress, tolerance):
    """Phalanges that touch the obstacle or another toe, or overlap from the start."""
    pairs = finger_pairs(toes.stance.foot)
    (near, between), (near_0, between_0) = gaps(toes, progress), gaps(toes, 0.0)
    bare = toes.stance.foot.thickness == 0
    least = tolerance * (3 if bare else 1)
    touching = near <= np.minimum(near_0, 0) + tolerance
    met = between <= np.minimum(between_0, 0) + least
    for side in pairs:
        np.logical_or.at(touching, side, met)
    return touching


def stepped(toes):
    """Final controls of toes that step, and go back a step where they enter."""
    foot, pairs = toes.stance.foot, finger_pairs(toes.stance.foot)
    finger, rank = foot.finger_of_phalanx, foot.rank_of_phalanx
    stopped = np.full(foot.phalanx_count, np.inf)
    start, tolerance = toes.stance.controls, TOLERANCE * foot.size
    bare = 2 * tolerance if foot.thickness == 0 else 0.0
    near, between = gaps(toes, 0.0)
    driven = (finger[:, None] == finger) & (rank[:, None] >= rank)
    floors = np.minimum(np.append(near, between - bare), 0) - tolerance / 4

    def distances(progress):
        controls = start + (1 - start) * np.minimum(progress, stopped)
        stance = Stance(foot, toes.stance.base, toes.stance.azimuths, controls)
        bones = stance.bones
        between = skin_distance(bones, foot.radii, pairs) - bare
        return np.append(toes.near(bones, foot.radii).distance, between)

    for before, progress in itertools.pairwise(np.linspace(0, 1, STEPS + 1)):
        while True:
            moving = driven @ np.isinf(stopped) > 0
            entered = distances(progress) < floors
            hit = entered[: len(finger)].copy()
            for side in pairs:
                np.logical_or.at(hit, side, entered[len(finger) :])
            hit &= moving
            if not hit.any():
                break
            for toe in np.unique(finger[hit]):
                innermost = rank[hit & (finger == toe)].min()
                driving = (finger == toe) & (rank <= innermost)
                stopped[driving] = np.minimum(stopped[driving], before)
    return start + (1 - start) * np.minimum(1.0, stopped)


# By hand -------------------------------------------------------------------------


@pytest.mark.parametrize("thickness", [0.0, 0.15])
@pytest.mark.parametrize("omega", [0.9, 2.5])
def test_one_phalanx_stops_where_it_is_tangent_to_a_sphere(thickness, omega):
    foot = Foot(
        rho=1.5,
        scale=1.5,
        omega=omega,
        thickness=thickness,
        fingers=(Finger("a", 1, 0.0),),
    )
    centre = np.array([0.6, 0.0, -0.5])
    toes = closed(foot, Sphere(0.2, centre))
    away = math.hypot(0.6, 0.5)
    angle = math.atan2(0.5, 0.6) - math.asin((0.2 + thickness / 1.5) / away)
    assert toes.controls(np.array(1.0)) == pytest.approx([angle / omega], abs=1e-6)
    assert toes.stopped_at == pytest.approx([angle / omega], abs=1e-6)
    (stop,) = toes.stops
    assert (stop.phalanx, stop.point is None) == (0, False)
    assert stop.progress == toes.stopped_at[0]
    upright = np.array([math.sin(angle), 0, math.cos(angle)])
    assert stop.point == pytest.approx(centre + 0.2 * upright, abs=1e-5)


@pytest.mark.parametrize("thickness", [0.0, 0.1])
def test_second_phalanx_wraps_by_twice_the_arc_tangent(thickness):
    # A flat toe on a branch across it: MODEL.md, section 4. Skins scale with ρ too.
    foot = Foot(
        rho=1.25,
        scale=1.25,
        omega=2.0,
        thickness=thickness,
        fingers=(Finger("a", 2, 0.0),),
    )
    inner, outer = 0.3 + foot.radii
    toes = closed(foot, Branch(0.3, [0.7, 0.0, -0.45]))
    away = math.hypot(0.7, 0.45)
    first = math.atan2(0.45, 0.7) - math.asin(inner / away)
    left = 1 - math.sqrt(away**2 - inner**2)
    # From the first phalanx's end down to the axis, and back up to the tangent.
    end = math.hypot(left, inner)
    second = math.pi - math.atan2(inner, left) - math.asin(outer / end)
    if thickness == 0:
        assert second == pytest.approx(2 * math.atan(left / inner))
    expected = np.array([first, second]) / 2.0
    assert toes.controls(np.array(1.0)) == pytest.approx(expected, abs=1e-5)
    assert [stop.phalanx for stop in toes.stops] == [0, 1]


def test_toes_that_meet_nothing_close_to_the_end():
    foot = Foot.preset("anisodactyl")
    toes = closed(foot, Sphere(0.01, [0, 0, 5.0]), controls=0.2, end=0.5)
    free = np.isinf(toes.stopped_at)
    assert toes.controls(np.array(0.5))[free] == pytest.approx(0.2 + 0.8 * 0.5)
    assert all(stop.point is None for stop in toes.stops)


def test_two_toes_that_face_each_other_stop_where_they_meet():
    # Two phalanges each: symmetric, so they meet in the plane between them.
    fingers = (Finger("a", 2, 0.0), Finger("b", 2, math.pi))
    foot = Foot(rho=1.25, scale=1.25, omega=2.5, thickness=0.125, fingers=fingers)
    toes = closed(foot, Sphere(0.1, [0, 0, 9.0]))
    assert {stop.point is None for stop in toes.stops} == {True}
    assert {stop.phalanx for stop in toes.stops} == {1, 3}
    angle = 2.5 * toes.stopped_at[0]
    tip = math.cos(angle) + 0.8 * math.cos(2 * angle)
    assert tip == pytest.approx(foot.radii[1], abs=1e-5)
    assert toes.stopped_at == pytest.approx(np.full(4, angle / 2.5), abs=1e-9)


def test_a_joint_that_is_closed_stays_closed():
    foot = Foot.preset("owl")
    toes = closed(foot, Sphere(0.01, [0, 0, 5.0]), controls=1.0)
    assert toes.controls(np.linspace(0, 1, 7)).tolist() == [[1.0] * 14] * 7
    assert toes.stops == []


def test_a_closing_of_no_extent_stops_nothing():
    toes = closed(Foot.preset("owl"), Sphere(0.02, [0, 0, -0.03]), end=0.0)
    assert toes.stops == []
    assert toes.controls(np.array(0.0)).tolist() == [0.0] * 14


# Laws ----------------------------------------------------------------------------


@pytest.mark.parametrize(("kind", "preset"), CASES)
def test_toes_enter_nothing_and_stop_only_at_contacts(kind, preset):
    toes = toes_over(kind, preset, seed=7)
    foot, tolerance = toes.stance.foot, toes_tolerance(toes)
    toes.close(1.0)
    progress = np.unique([*np.linspace(0, 1, 25), *(s.progress for s in toes.stops)])
    controls = toes.controls(progress)
    assert (np.diff(controls, axis=0) >= 0).all()
    assert (controls[0] == toes.stance.controls).all()
    assert (controls <= 1).all()
    near_0, between_0 = gaps(toes, 0.0)
    least = 2 * tolerance if foot.thickness == 0 else 0.0
    for each in progress:
        near, between = gaps(toes, each)
        assert (near >= np.minimum(near_0, 0) - tolerance).all()
        apart = between_0 >= -tolerance
        assert (between[apart] >= np.minimum(between_0, least)[apart] - tolerance).all()
    touching = in_contact(toes, 1.0, tolerance)
    for part in foot.finger_slices.values():
        stopped = toes.stopped_at[part]
        beyond = np.logical_or.accumulate(touching[part][::-1])[::-1]
        assert (beyond | np.isinf(stopped)).all()
        assert (stopped[1:] >= stopped[:-1]).all()
    for stop in toes.stops:
        assert in_contact(toes, stop.progress, tolerance)[stop.phalanx]
        near, between = gaps(toes, stop.progress)
        left = near[stop.phalanx]
        if stop.point is None:
            mine = (np.stack(toes.pairs) == stop.phalanx).any(axis=0)
            left = between[mine].min()
        assert left == pytest.approx(stop.clearance, abs=tolerance / 10)


@pytest.mark.parametrize(("kind", "preset"), CASES)
def test_toes_stop_where_those_that_step_stop(kind, preset):
    # A step's error grows with each phalanx that turns on from where one stopped.
    toes = toes_over(kind, preset, seed=7)
    expected = stepped(toes)
    toes.close(1.0)
    off = np.abs(toes.controls(np.array(1.0)) - expected)
    assert np.median(off) <= 2 / STEPS
    assert off.max() <= 8 / STEPS


def test_mirrored_toes_stop_alike():
    foot = Foot.preset("parrot")
    toes = closed(foot, Branch(0.006, [0, 0, -0.009], axis=[0.1, 1, 0]))
    fingers = tuple(Finger(f.name, f.phalanges, -f.azimuth) for f in foot.fingers)
    mirrored = closed(
        foot.replace(fingers=fingers), Branch(0.006, [0, 0, -0.009], axis=[-0.1, 1, 0])
    )
    assert mirrored.stopped_at == pytest.approx(toes.stopped_at, rel=1e-9)
