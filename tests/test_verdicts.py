"""Verdicts of many poses: the full check's own, and those of a plain slow reading."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planted import planted
from strategies import controls_for, feet, reals

from zygopin import verdicts
from zygopin.branch import Branch, branch_axis
from zygopin.cases import Cases
from zygopin.clearance import branch_clearance
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Finger, Foot
from zygopin.grasp import Criteria, check_grasp
from zygopin.perch import plan_perch
from zygopin.sieve import Sieve
from zygopin.verdicts import grasp_verdicts

PARROT = Foot.preset("parrot")
PERCH = Branch(0.008, (0, 0, -0.0097))
VERDICTS = ("stable", "grasping", "feasible")


@pytest.fixture(autouse=True)
def sieve_always(monkeypatch):
    """Few cases go through the sieve as well."""
    monkeypatch.setattr(verdicts, "FEW", 0)


def assert_full_check(foot, controls, branch, criteria=None, threads=None):
    """The verdicts of both engines are those of `check_grasp`; they are returned."""
    report = check_grasp(foot, controls, branch, criteria=criteria)
    for engine in verdicts.BATCHED:
        found = grasp_verdicts(
            foot, controls, branch, engine=engine, criteria=criteria, threads=threads
        )
        for name in VERDICTS:
            assert getattr(found, name).shape == getattr(report, name).shape
            assert (getattr(found, name) == getattr(report, name)).all(), (engine, name)
    return found


# The plain reading ------------------------------------------------------------------


def plain_bones(foot, pose):
    """(finger, rank, start, end) of each phalanx: sums of ℓₖ·(cos, sin), one by one."""
    bones = []
    for index, finger in enumerate(foot.fingers):
        part = foot.finger_slices[finger.name]
        end, pitch = np.zeros(3), finger.orientation
        forward = np.array([math.cos(finger.azimuth), math.sin(finger.azimuth), 0])
        for k in range(part.start, part.stop):
            pitch += foot.omega * pose[k]
            way = math.cos(pitch) * forward - math.sin(pitch) * np.eye(3)[2]
            start, end = end, end + foot.lengths[k] * way
            bones.append((index, k - part.start + 1, start, end))
    return bones


def plain_contact(start, end, branch):
    """How far a segment stays from an axis line, where, and the normal there."""
    axis = branch.axis
    u = (end - start) - ((end - start) @ axis) * axis
    w = (start - branch.centre) - ((start - branch.centre) @ axis) * axis
    t = -(w @ u) / (u @ u)
    nearest = w + min(max(t, 0.0), 1.0) * u
    distance = np.linalg.norm(nearest)
    return distance, t, nearest / distance


def plain_apart(one, other):
    """Least distance of two segments: at an end of one, or between the lines."""
    (p, u), (q, v) = ((start, end - start) for start, end in (one, other))

    def at(s, t):
        return np.linalg.norm(p + s * u - q - t * v)

    def nearest(point, start, way):
        return min(max((point - start) @ way / (way @ way), 0.0), 1.0)

    found = [at(s, nearest(p + s * u, q, v)) for s in (0.0, 1.0)]
    found += [at(nearest(q + t * v, p, u), t) for t in (0.0, 1.0)]
    lines = np.linalg.lstsq(np.stack([u, -v], axis=1), q - p, rcond=None)[0]
    return min([*found, at(*lines)] if all(lines >= 0) and all(lines <= 1) else found)


def plain_verdicts(foot, pose, branch, tolerance):
    """Stable, grasping, feasible of one pose, as MODEL.md's sections 4 and 5 read."""
    bones = plain_bones(foot, pose)
    tangent, entered = [], False
    for k, (finger, _, start, end) in enumerate(bones):
        distance, t, normal = plain_contact(start, end, branch)
        clearance = distance - branch.radius - foot.radii[k]
        entered |= clearance < -tolerance
        if abs(clearance) <= tolerance and -1e-9 <= t <= 1 + 1e-9:
            tangent.append((finger, normal))
    products = [
        one[1] @ other[1]
        for one, other in itertools.combinations(tangent, 2)
        if (one[0], other[0]) in foot.opposable_pairs
    ]
    gap = -tolerance if foot.thickness > 0 else tolerance
    for (i, one), (j, other) in itertools.combinations(enumerate(bones), 2):
        if one[0] != other[0] and one[1] + other[1] > 2:
            apart = plain_apart(one[2:], other[2:]) - foot.radii[i] - foot.radii[j]
            entered |= apart < gap
    return bool(products), min(products, default=1.0) <= 1e-9, not entered


@pytest.mark.parametrize("axis", [(0, 1, 0), (0.3, 1, -0.2)])
def test_verdicts_are_those_of_the_plain_reading(axis):
    made = planted(PARROT, seed=5, axis=axis, count=12_000)
    assert made.grasping.sum() >= 3
    order = np.argsort(~made.grasping, kind="stable")[:40]
    some = made.take(order)
    rng, tolerance = np.random.default_rng(0), 1e-6 * PARROT.size
    centre = some.height[:, None] * np.array([0.0, 0.0, 1.0])
    # Poses that touch, and poses nearby that enter the branch, or miss it.
    apart = rng.uniform(-1, 1, some.controls.shape) * rng.choice([0, 0.05], (40, 1))
    apart[:3] = 0
    poses = np.clip(some.controls + apart, 0, 1)
    branch = Branch(some.radius, centre, axis)
    found = assert_full_check(PARROT, poses, branch)
    seen = set()
    for index, pose in enumerate(poses):
        expected = plain_verdicts(PARROT, pose, branch[index], tolerance)
        assert tuple(getattr(found, name)[index] for name in VERDICTS) == expected
        seen.add(expected)
    assert len(seen) >= 4


# The full check's -------------------------------------------------------------------


@st.composite
def cases(draw):
    """A foot, poses, and branches of any pose that leave the base outside."""
    foot = draw(feet())
    controls = draw(controls_for(foot, (4,)))
    angle = reals(-math.pi / 2, math.pi / 2)
    axis = branch_axis(draw(angle), draw(st.just(math.pi / 2) | angle))
    radius = foot.size * draw(reals(0.01, 1.0))
    across = np.cross(axis, np.eye(3)[np.argmin(np.abs(axis))])
    away = radius * (1 + draw(reals(0, 2))) / np.linalg.norm(across)
    length = draw(st.none() | reals(0.1, 3).map(lambda x: x * foot.size))
    wide = Criteria(tolerance=foot.size * draw(st.just(1e-6) | reals(1e-9, 0.1)))
    return foot, controls, Branch(radius, across * away, axis, length), wide


@given(cases())
def test_verdicts_are_those_of_the_full_check(case):
    foot, controls, branch, criteria = case
    assert_full_check(foot, controls, branch, criteria)
    reading = Criteria("base_to_tip", criteria.tolerance)
    assert_full_check(foot, controls[0], branch, reading)


@pytest.mark.parametrize("noise", [0, 1e-7, 1e-6, 1e-4])
def test_verdicts_of_a_grasp_shaken_about_the_tolerance(noise):
    plan = plan_perch(PARROT, PERCH)
    shaken = plan.controls + np.random.default_rng(0).normal(0, noise, (500, 14))
    found = assert_full_check(PARROT, np.clip(shaken, 0, 1), PERCH)
    if noise == 0:
        assert found.grasping.all()
        assert found.feasible.all()


def test_controls_and_branches_broadcast():
    rng = np.random.default_rng(1)
    controls = rng.random((5, 1, 14)) * 0.4
    radii = rng.uniform(0.002, 0.01, 4)
    below = np.stack([0 * radii, 0 * radii, -1.5 * radii - 0.002], axis=-1)
    assert assert_full_check(PARROT, controls, Branch(radii, below)).stable.shape == (
        5,
        4,
    )
    assert_full_check(PARROT, controls[2, 0], Branch(radii, below))
    assert_full_check(PARROT, controls[2, 0], Branch(radii, (0, 0, -0.02)))
    tilted = Branch(0.004, (0, 0, -0.01), rng.normal(size=(4, 3)) * (1, 1, 0.3))
    assert_full_check(PARROT, controls[:, 0, None], tilted)
    assert_full_check(PARROT, controls[0, 0], tilted)
    single = assert_full_check(PARROT, controls[0, 0], PERCH)
    assert single.stable.shape == ()
    assert grasp_verdicts(PARROT, np.empty((0, 14)), PERCH).stable.shape == (0,)


def test_few_cases_are_measured_at_once(monkeypatch):
    plan = plan_perch(PARROT, PERCH)
    controls = np.stack([plan.controls, np.zeros(14), np.full(14, 0.5)])
    monkeypatch.setattr(verdicts, "FEW", 3)
    monkeypatch.setattr(verdicts, "Sieve", None)
    assert assert_full_check(PARROT, controls, PERCH).grasping.tolist() == [
        True,
        False,
        False,
    ]


def test_controls_may_be_given_by_finger():
    plan = plan_perch(PARROT, PERCH)
    named = {name: plan.controls[part] for name, part in PARROT.finger_slices.items()}
    assert grasp_verdicts(PARROT, named, PERCH).grasping


def test_threads_change_nothing():
    rng = np.random.default_rng(2)
    controls = rng.random((20_000, 14)) * 0.3
    branch = Branch(0.004, (0.012, 0, -0.01))
    one = assert_full_check(PARROT, controls, branch, threads=1)
    assert 0.1 < one.feasible.mean() < 0.9
    for threads in (None, 2, 3):
        other = grasp_verdicts(PARROT, controls, branch, threads=threads)
        for name in VERDICTS:
            assert (getattr(one, name) == getattr(other, name)).all()


def test_a_finite_branch_may_be_passed_by():
    # The second phalanx turns down, through a branch that ends before it gets there.
    foot = Foot(omega=math.pi / 2, fingers=(Finger("toe", 2, math.pi / 2),))
    place = {"radius": 0.1, "centre": (0, -1, -0.2)}
    controls = np.tile([0.0, 1.0], (3, 1))
    assert assert_full_check(foot, controls, Branch(**place, length=3)).feasible.all()
    assert not assert_full_check(foot, controls, Branch(**place)).feasible.any()


def test_only_what_meets_the_branch_is_measured(monkeypatch):
    measured = []

    def recorded(bones, radii, branch):
        measured.append(len(bones))
        return branch_clearance(bones, radii, branch)

    monkeypatch.setattr("zygopin.cases.branch_clearance", recorded)
    controls = np.random.default_rng(3).random((5000, 14))
    grasp_verdicts(PARROT, controls, PERCH)
    assert sum(measured) <= 50


def test_rounding_is_within_the_bound():
    rng = np.random.default_rng(4)
    for _ in range(20):
        sizes = rng.integers(1, 13, rng.integers(1, 6))
        fingers = [
            Finger(f"toe{i}", int(k), *rng.uniform(-1, 6, 2))
            for i, k in enumerate(sizes)
        ]
        omega, scale = rng.uniform(0.1, 6), 10 ** rng.uniform(-3, 3)
        foot = Foot(rng.uniform(1.02, 2.5), omega, scale=scale, fingers=tuple(fingers))
        axis = branch_axis(*rng.uniform(-1.5, 1.5, 2))
        across = np.cross(axis, rng.normal(size=3))
        centre = foot.size * across * rng.uniform(0.5, 2) / np.linalg.norm(across)
        branch = Branch(0.4 * foot.size, centre, axis)
        controls = rng.random((200, foot.phalanx_count))
        some = Cases(foot, controls, branch, (200,), Criteria())
        sieve, every = Sieve(some), slice(0, 200)
        found = np.sqrt(
            sieve._squares(controls, sieve.limits(every).section).T, dtype=float
        )
        exact = check_grasp(foot, controls, branch).clearance
        error = found - (exact + branch.radius + foot.radii)
        bound = sieve.slack - Criteria().metres(foot)
        assert sieve.kind is np.float32
        assert 0.01 * bound < np.abs(error).max() < 0.5 * bound


def test_verdicts_cannot_be_written_and_keep_no_hold_on_the_controls():
    controls = np.zeros((2, 14))
    found = grasp_verdicts(PARROT, controls, PERCH)
    controls += 0.5
    for name in VERDICTS:
        with pytest.raises(ValueError, match="read-only"):
            getattr(found, name)[0] = True


# Bad input --------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("controls", "words"),
    [
        (np.full(14, 1.5), r"controls\[0\].*1\.5.*in \[0, 1\]"),
        (np.full((2, 14), np.nan), r"controls\[0, 0\].*nan.*finite"),
        (np.full((2, 14), -np.inf), "finite"),
        (np.zeros(13), r"controls.shape.*\(13,\).*14"),
        ("words", "array of numbers"),
    ],
)
def test_controls_are_checked(controls, words):
    with pytest.raises(ParameterError, match=words):
        grasp_verdicts(PARROT, controls, PERCH)


def test_other_bad_input_is_named():
    controls = np.zeros((3, 14))
    with pytest.raises(ParameterError, match="holds the base inside"):
        grasp_verdicts(PARROT, controls, Branch(0.008, (0, 0, -0.001)))
    with pytest.raises(ParameterError, match="batch shapes of controls and branch"):
        grasp_verdicts(PARROT, controls, Branch([0.001, 0.002], (0, 0, -0.01)))
    with pytest.raises(ParameterError, match="threads"):
        grasp_verdicts(PARROT, controls, PERCH, threads=0)
    with pytest.raises(UnknownNameError, match="finger"):
        grasp_verdicts(PARROT, {"thumb": [0.0]}, PERCH)
    with pytest.raises(ParameterError, match=r"tolerance.*at most"):
        grasp_verdicts(PARROT, controls, PERCH, criteria=Criteria(tolerance=1.0))
