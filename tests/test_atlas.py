"""Atlases: every yes is shown through both engines, no "no" is contradicted."""

from __future__ import annotations

import numpy as np
import pytest
from planted import planted

from zygopin import (
    Answer,
    BranchGrid,
    Finger,
    Foot,
    ParameterError,
    branch_atlas,
    check_grasp,
)
from zygopin.atlas import ROWS, VERDICTS
from zygopin.atlas_parts import share_poses
from zygopin.contact_products import least_products
from zygopin.witnesses import opposing, palmar, touched

PARROT = Foot.preset("parrot")
SMALL = Foot(
    rho=1.2,
    omega=1.4,
    thickness=0.05,
    fingers=(
        Finger("front", 3, 0.2),
        Finger("back", 2, np.pi - 0.2),
        Finger("side", 1, 0.9),
    ),
)
AXES = [(0.0, 1.0, 0.0), (0.25, 1.0, 0.15)]


def grid_of(foot, rows, columns, axis):
    """Branches from the base to beyond the toes' reach."""
    heights = np.linspace(0.1, -1.2, rows) * foot.size
    return BranchGrid(heights, np.linspace(0.03, 0.8, columns) * foot.size, axis)


@pytest.fixture(
    scope="module",
    params=[
        (SMALL, 14, 12, AXES[0]),
        (SMALL, 12, 14, AXES[1]),
        (PARROT, 20, 20, AXES[0]),
    ],
    ids=["small", "oblique", "parrot"],
)
def atlas(request):
    foot, *rest = request.param
    return branch_atlas(foot, grid_of(foot, *rest))


def shown(report):
    """What poses show, each verdict by itself: masks of shape (n,)."""
    foot = report.foot
    met = opposing(foot, touched(foot, report.touching))
    (palms,) = least_products(foot, report.tangent & palmar(report), report.normal)
    quarter = np.nan_to_num(palms, nan=1.0) <= 1e-9
    return {
        "touchable": met & report.feasible,
        "stable": report.stable,
        "feasible": report.stable & report.feasible,
        "grasping": quarter & report.grasping & report.feasible,
    }


@pytest.mark.parametrize("engine", ["exact", "fcl"])
@pytest.mark.parametrize("verdict", VERDICTS)
def test_every_yes_is_shown_by_its_pose(atlas, verdict, engine):
    cells = np.nonzero(atlas.answer(verdict) == Answer.YES)
    assert len(cells[0])
    poses = atlas.controls[cells]
    if verdict == "stable":
        loose = atlas.stable_controls[cells]
        poses = np.where(np.isnan(loose), poses, loose)
    report = check_grasp(atlas.foot, poses, atlas.grid.at(*cells), engine=engine)
    assert shown(report)[verdict].all()
    if verdict != "stable":
        tangent = touched(atlas.foot, report.tangent).sum(axis=-1)
        assert np.array_equal(tangent, atlas.toes[cells][:, 0])


def test_verdicts_include_one_another(atlas):
    for narrow, wide in (
        ("grasping", "feasible"),
        ("feasible", "touchable"),
        ("feasible", "stable"),
    ):
        inner, outer = atlas.answer(narrow), atlas.answer(wide)
        assert (outer[inner == Answer.YES] == Answer.YES).all()
        assert (inner[outer == Answer.NO] == Answer.NO).all()


def test_branches_that_hold_the_base_are_told(atlas):
    for verdict in VERDICTS:
        held = atlas.answer(verdict) == Answer.HOLDS_BASE
        assert np.array_equal(held, ~atlas.grid.valid)
    held = ~atlas.grid.valid
    assert np.isnan(atlas.controls[held]).all()
    assert not atlas.toes[held].any()


def test_all_answers_occur_and_few_stay_open(atlas):
    for verdict in VERDICTS:
        answers = atlas.answer(verdict)
        assert (answers == Answer.YES).any()
        assert (answers == Answer.NO).any()
        assert atlas.undecided(verdict) < 0.06


def test_poses_are_there_where_something_is_shown(atlas):
    posed = np.isfinite(atlas.controls).all(axis=-1)
    assert np.array_equal(posed, atlas.touchable == Answer.YES)
    loose = np.isfinite(atlas.stable_controls).all(axis=-1)
    assert not (loose & (atlas.feasible == Answer.YES)).any()
    either = loose | (atlas.feasible == Answer.YES)
    assert np.array_equal(either, atlas.stable == Answer.YES)


def test_toes_and_wraps_are_within_their_bounds(atlas):
    fewest, most = np.moveaxis(atlas.toes, -1, 0)
    assert (fewest <= most).all()
    wrap, bound = np.moveaxis(atlas.wrap, -1, 0)
    both = np.isfinite(wrap) & np.isfinite(bound)
    assert both.any()
    assert (wrap[both] <= bound[both] + 1e-9).all()


@pytest.mark.parametrize("axis", AXES)
@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("foot", [SMALL, PARROT], ids=["small", "parrot"])
def test_what_random_poses_show_is_never_denied(foot, seed, axis):
    found = planted(foot, seed, axis, count=60_000)
    for mask, verdicts in (
        (np.ones(len(found.height), dtype=bool), ("stable",)),
        (found.feasible, ("touchable", "feasible")),
        (found.grasping, ("grasping",)),
    ):
        some = found.take(np.flatnonzero(mask)[:6])
        assert len(some.height)
        heights, rows = np.unique(some.height, return_inverse=True)
        radii, columns = np.unique(some.radius, return_inverse=True)
        answers = branch_atlas(foot, BranchGrid(heights, radii, axis))
        for verdict in verdicts:
            given = answers.answer(verdict)[rows.ravel(), columns.ravel()]
            assert (given != Answer.NO).all()
            assert (given == Answer.YES).mean() > 0.6


@pytest.mark.parametrize("factor", [1e-3, 1e3])
def test_similar_feet_have_similar_atlases(factor):
    larger = SMALL.replace(scale=factor, thickness=factor * SMALL.thickness)
    one, other = (
        branch_atlas(foot, grid_of(foot, 8, 7, AXES[0])) for foot in (SMALL, larger)
    )
    for verdict in VERDICTS:
        assert np.array_equal(one.answer(verdict), other.answer(verdict))


def test_processes_share_the_work_and_change_nothing():
    foot, told = SMALL, []
    heights = np.linspace(-1.2, -0.1, 2 * ROWS + 1) * foot.size
    grid = BranchGrid(heights, np.array([0.1, 0.3]) * foot.size)
    one = branch_atlas(foot, grid, progress=told.append)
    two = branch_atlas(foot, grid, workers=2)
    for name in (*VERDICTS, "toes", "wrap", "controls", "stable_controls"):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))
    assert told == [f"{n} of 201 heights" for n in (0, 101, 201)]
    # Interleaved as they should be: heights next to one another mostly agree.
    assert (np.diff(one.grasping[:, 0]) != 0).sum() < 12


def test_parts_of_a_map_share_their_poses():
    size = SMALL.size
    grid = BranchGrid(
        np.linspace(-0.6, -0.75, 9) * size, np.linspace(0.3, 0.5, 8) * size
    )
    whole = branch_atlas(SMALL, grid)
    arrays = {
        name: np.array(getattr(whole, name))
        for name in (*VERDICTS, "toes", "wrap", "controls", "stable_controls")
    }
    # Every second height is as if another part had found nothing there.
    lost = np.zeros(grid.shape, dtype=bool)
    lost[1::2] = whole.feasible[1::2] == Answer.YES
    for name in ("touchable", "stable", "feasible"):
        arrays[name][lost] = Answer.UNDECIDED
    arrays["grasping"][lost & (whole.grasping == Answer.YES)] = Answer.UNDECIDED
    arrays["controls"][lost] = np.nan
    arrays["toes"][lost, 0] = 0
    share_poses(SMALL, grid, arrays)
    again = lost & (arrays["feasible"] == Answer.YES)
    assert again.sum() > 0.6 * lost.sum()
    assert (arrays["touchable"][again] == Answer.YES).all()
    assert (arrays["stable"][again] == Answer.YES).all()
    cells = np.nonzero(again)
    poses = arrays["controls"][cells]
    found = shown(check_grasp(SMALL, poses, grid.at(*cells), engine="fcl"))
    assert found["feasible"].all()
    grasping = arrays["grasping"][cells] == Answer.YES
    assert np.array_equal(found["grasping"] & grasping, grasping)
    # What was decided is as it was.
    same = ~lost & (whole.feasible != Answer.UNDECIDED)
    same &= whole.grasping != Answer.UNDECIDED
    assert np.array_equal(
        arrays["controls"][same], whole.controls[same], equal_nan=True
    )


def test_no_foot_grasps_without_opposite_toes():
    foot = SMALL.replace(fingers=SMALL.fingers[:1])
    found = branch_atlas(foot, grid_of(foot, 5, 5, AXES[0]))
    for verdict in VERDICTS:
        assert not (found.answer(verdict) > 0).any()


def test_a_toe_seen_edge_on_is_left_open():
    foot = SMALL.replace(fingers=(Finger("a", 2, 0.0), Finger("b", 2, np.pi)))
    grid = BranchGrid(np.array([-0.4, -0.6]), np.array([0.1, 0.2]), (1.0, 0.0, 0.0))
    found = branch_atlas(foot, grid)
    assert not (found.feasible == Answer.YES).any()


@pytest.mark.parametrize(
    ("changes", "words"),
    [
        ({"foot": "parrot"}, "foot"),
        ({"grid": [1.0]}, "grid"),
        ({"workers": 0}, "workers"),
        ({"grid": BranchGrid([-0.5], [1e-9])}, r"branch\.radius"),
        ({"grid": BranchGrid([-1e9], [1.0])}, "extent of the branch"),
    ],
)
def test_bad_input_is_refused_before_the_work(changes, words):
    given = {"foot": SMALL, "grid": grid_of(SMALL, 2, 2, AXES[0])} | changes
    with pytest.raises(ParameterError, match=words):
        branch_atlas(**given)
