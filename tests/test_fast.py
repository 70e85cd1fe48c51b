"""The engine `fast`: the exact engine's numbers, with Numba and without."""

from __future__ import annotations

import os
import subprocess
import sys
from dataclasses import fields

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from planted import planted
from strategies import controls_for, feet, reals

from zygopin import clearance, engine, fast_bones, fast_clearance
from zygopin.branch import Branch, branch_axis
from zygopin.errors import ParameterError, UnknownNameError
from zygopin.foot import Foot
from zygopin.grasp import Criteria, check_grasp, finger_pairs
from zygopin.kinematics import forward_kinematics
from zygopin.verdicts import grasp_verdicts

PARROT = Foot.preset("parrot")
PERCH = Branch(0.008, (0, 0, -0.0097))
PAIRS = finger_pairs(PARROT)

FAST_CHECK = """
from zygopin import Branch, Foot, check_grasp, grasp_verdicts
foot, branch = Foot.preset("parrot"), Branch(0.008, (0, 0, -0.0097))
report = check_grasp(foot, [0.5] * 14, branch, engine="fast")
verdicts = grasp_verdicts(foot, [[0.5] * 14] * 20, branch, engine="fast")
print(report.clearance.round(12).tolist(), verdicts.feasible.tolist())
"""


def assert_same_record(bones, radii, branch, pairs):
    """`fast` measures what the exact engine does, to the last places."""
    exact, least = clearance.distances(bones, radii, branch, pairs)
    fast, gap = fast_clearance.distances(bones, radii, branch, pairs)
    extent = np.abs(bones).max(initial=0) + branch.largest_extent
    for field in fields(exact):
        one, other = getattr(exact, field.name), getattr(fast, field.name)
        unit = 1.0 if field.name in ("t", "normal", "lateral") else extent
        assert one.shape == other.shape
        np.testing.assert_allclose(other / unit, one / unit, rtol=1e-15, atol=1e-15)
    assert gap.shape == least.shape
    np.testing.assert_allclose(gap, least, rtol=0, atol=1e-15 * extent)


@st.composite
def bones_and_branches(draw):
    """A foot's bones, and branches of any pose, endless or not."""
    foot = draw(feet())
    controls = draw(controls_for(foot, (3,)))
    axis = branch_axis(draw(reals(-1.5, 1.5)), draw(reals(-1.5, 1.5)))
    centre = foot.size * np.array(draw(st.tuples(*[reals(-1, 1)] * 3)))
    length = draw(st.none() | reals(0.1, 3).map(lambda x: x * foot.size))
    branch = Branch(foot.size * draw(reals(0.01, 1)), centre, axis, length)
    return foot, forward_kinematics(foot, controls), branch


@given(bones_and_branches())
def test_distances_are_the_exact_engines(case):
    foot, bones, branch = case
    pairs = finger_pairs(foot)
    exact, least = clearance.distances(bones, foot.radii, branch, pairs)
    fast, gap = fast_clearance.distances(bones, foot.radii, branch, pairs)
    # Other numbers are as badly determined as a bone's direction may be.
    rounding = 4e-16 * (foot.size + branch.largest_extent)
    assert np.abs(fast.distance - exact.distance).max() <= rounding
    assert (gap == least).all() or np.abs(gap - least).max() <= rounding


@given(st.data(), st.sampled_from([(), (3,), (fast_bones.FEW + 1,), (4, 5)]))
def test_bones_are_the_exact_engines(data, batch):
    foot = data.draw(feet())
    controls = data.draw(controls_for(foot, batch))
    exact = forward_kinematics(foot, controls)
    fast = forward_kinematics(foot, controls, engine="fast")
    assert fast.shape == exact.shape
    turned = 1 + foot.omega * foot.phalanx_count
    assert np.abs(fast - exact).max() <= 1e-15 * turned * foot.size


def test_bones_of_many_poses_in_any_order_and_place():
    controls = np.random.default_rng(1).random((2 * fast_bones.BLOCK + 7, 14))
    controls.setflags(write=False)
    made, room = engine.make_engine("fast", PARROT), np.empty((*controls.shape, 2, 3))
    for poses in (controls, controls[::2], np.asfortranarray(controls)):
        exact = forward_kinematics(PARROT, poses)
        assert np.abs(made.bones(poses) - exact).max() <= 1e-15 * PARROT.size
    for threads in (None, 1, 3):
        options = {"engine": "fast", "threads": threads, "out": room}
        assert forward_kinematics(PARROT, controls, **options) is room
        assert np.abs(room[::2] - made.bones(controls[::2])).max() == 0


def test_azimuths_are_turned_as_by_the_exact_engine():
    foot, controls = Foot.preset("owl"), np.full(14, 0.4)
    azimuths = np.array([f.azimuth for f in foot.fingers]) + 0.1
    exact, fast = (
        forward_kinematics(foot, controls, azimuths=azimuths, engine=name)
        for name in ("exact", "fast")
    )
    assert (exact == fast).all()


@pytest.mark.parametrize("length", [None, 0.01, (0.004, 0.03, 0.01)])
@pytest.mark.parametrize("shape", [(), (1,), (3,), (2, 1), (0,)])
def test_poses_and_branches_broadcast(shape, length):
    rng = np.random.default_rng(0)
    bones = forward_kinematics(PARROT, rng.random((*shape, 14)))
    radius = rng.uniform(0.002, 0.01, 3)
    centre = np.stack([0 * radius, 0.002 * rng.random(3), -radius - 0.002], axis=1)
    many = Branch(radius, centre, length=length)
    for branch in (PERCH,) if shape == (0,) else (many, PERCH):
        assert_same_record(bones, PARROT.radii, branch, PAIRS)


def test_a_bone_through_the_axis_is_left_to_the_exact_engine():
    # The first toe goes straight ahead; an upright branch stands midway along it.
    bones = forward_kinematics(PARROT, np.zeros(14))
    middle = bones[1].mean(axis=0)
    branch = Branch(0.0005, middle, (0, 0, 1))
    assert_same_record(bones, PARROT.radii, branch, PAIRS)
    found, _ = fast_clearance.distances(bones, PARROT.radii, branch, PAIRS)
    assert np.isfinite(found.normal).all()


def test_reports_are_the_exact_engines():
    found = planted(PARROT, 3, count=400)
    branch = Branch(found.radius, [0, 0, 1] * found.height[:, None])
    exact = check_grasp(PARROT, found.controls, branch)
    fast = check_grasp(PARROT, found.controls, branch, engine="fast")
    assert exact.grasping.any()
    assert not exact.grasping.all()
    for field in fields(exact):
        one, other = getattr(exact, field.name), getattr(fast, field.name)
        if field.name in ("foot", "branch"):
            assert one is other
        else:
            np.testing.assert_allclose(other, one, rtol=1e-13, atol=1e-15)


def test_verdicts_of_planted_grasps_are_the_exact_engines():
    found = planted(PARROT, 4, axis=(0.2, 1.0, 0.1), count=4000)
    for length in (None, 0.02, 0.008):
        branch = Branch(
            found.radius, [0, 0, 1] * found.height[:, None], (0.2, 1.0, 0.1), length
        )
        exact = grasp_verdicts(PARROT, found.controls, branch)
        fast = grasp_verdicts(PARROT, found.controls, branch, engine="fast")
        for name in ("stable", "grasping", "feasible"):
            assert (getattr(exact, name) == getattr(fast, name)).all()
        assert 0 < exact.grasping.sum() < exact.stable.sum()


def test_loops_that_are_not_compiled_say_the_same():
    chosen = "reports or planted or broadcast or many_poses or through or wider"
    warned = "ignore::RuntimeWarning"  # numbers divided by zero, of bones left aside
    done = subprocess.run(
        [sys.executable, "-mpytest", "-n0", "-W", warned, __file__, "-k", chosen],
        env={**os.environ, "NUMBA_DISABLE_JIT": "1"},
        capture_output=True,
        text=True,
    )
    assert (done.returncode, done.stderr) == (0, ""), done.stdout


def test_a_tolerance_wider_than_the_branch_is_left_to_the_exact_engine():
    rng = np.random.default_rng(5)
    foot = PARROT.replace(thickness=0.0)
    controls = 0.2 * rng.random((300, 14))
    branch = Branch(1e-5 * foot.size, (0.0, 0.0, -0.01 * foot.size))
    wide = Criteria(tolerance=0.02 * foot.size)
    exact = grasp_verdicts(foot, controls, branch, criteria=wide)
    fast = grasp_verdicts(foot, controls, branch, engine="fast", criteria=wide)
    assert exact.stable.any()
    for name in ("stable", "grasping", "feasible"):
        assert (getattr(exact, name) == getattr(fast, name)).all()


def test_without_numba_the_exact_engine_answers(monkeypatch):
    for module in ("engine", "kinematics", "verdicts"):
        monkeypatch.setattr(f"zygopin.{module}.has_compiler", lambda: False)
    assert engine.make_engine("fast", PARROT).distances is clearance.distances
    controls = np.random.default_rng(6).random((100, 14))
    fast = grasp_verdicts(PARROT, controls, PERCH, engine="fast")
    exact = grasp_verdicts(PARROT, controls, PERCH)
    assert (fast.feasible == exact.feasible).all()
    bones = forward_kinematics(PARROT, controls, engine="fast")
    assert (bones == forward_kinematics(PARROT, controls)).all()


def test_a_numba_that_cannot_be_loaded_is_none():
    without = f"import sys; sys.modules['numba'] = None; {FAST_CHECK}"
    said = {run(FAST_CHECK), run(without)}
    assert len(said) == 1


def test_compiled_code_is_kept(tmp_path):
    counted = f"""{FAST_CHECK}
from zygopin import verdict_kernels
print(sum(verdict_kernels.across.stats.cache_hits.values()))
"""
    outcomes = [run(counted, NUMBA_CACHE_DIR=str(tmp_path)) for _ in range(2)]
    assert [int(said.split()[-1]) for said in outcomes] == [0, 1]


def test_kept_code_is_not_used_when_what_it_takes_has_changed(tmp_path):
    loops = """
from taken import FACTOR, added
from zygopin.compiler import compiled
@compiled
def loop(x):
    return added(FACTOR * x)
print(loop(1))
"""
    taken = """
from zygopin.compiler import compiled
FACTOR = {}
@compiled
def added(x):
    return x + {}
"""
    (tmp_path / "loops.py").write_text(loops)
    said = []
    for factor, last in ((2, 5), (3, 5), (3, 7)):
        (tmp_path / "taken.py").write_text(taken.format(factor, last))
        said.append(run("import loops", PYTHONPATH=str(tmp_path)).strip())
    assert said == ["7", "8", "10"]


def test_loops_are_compiled_anew_where_no_folder_can_be_written():
    said = run(f"""
from numba.core.caching import CompileResultCacheImpl
CompileResultCacheImpl._locator_classes = []
{FAST_CHECK}""")
    assert said == run(FAST_CHECK)


def run(code, **environment):
    """What a script prints."""
    done = subprocess.run(
        [sys.executable, "-c", code],
        env={**os.environ, **environment},
        capture_output=True,
        text=True,
        check=True,
    )
    assert not done.stderr
    return done.stdout


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"bones": np.zeros((14, 3, 2))}, "bones.shape"),
        ({"bones": np.zeros((2, 3))}, "radii.shape"),
        ({"radii": PARROT.radii[:3]}, "radii.shape"),
        ({"pairs": (np.array([0]), np.array([14]))}, "not from 0 to 13"),
        ({"pairs": (np.array([-1]), np.array([3]))}, "not from 0 to 13"),
    ],
)
def test_what_the_loops_could_not_bear_is_refused(change, message):
    bones = forward_kinematics(PARROT, np.zeros(14))
    given = {"bones": bones, "radii": PARROT.radii, "branch": PERCH, "pairs": PAIRS}
    with pytest.raises(ParameterError, match=message):
        fast_clearance.distances(**{**given, **change})


def test_fcl_takes_no_batches():
    with pytest.raises(UnknownNameError, match="engine"):
        grasp_verdicts(PARROT, np.zeros(14), PERCH, engine="fcl")
    with pytest.raises(UnknownNameError, match="engine"):
        forward_kinematics(PARROT, np.zeros(14), engine="fcl")
